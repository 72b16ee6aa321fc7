#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simulator/gmsh/element_kinds.h"

namespace faultsim {

/// A thing with a name, or one that belongs to physical groups, and its place in the file.
struct PhysicalName {
  std::string name;
  int place = 0;
};
struct GmshEntity {
  std::vector<std::int64_t> physical;  ///< numbers of its physical groups, ascending.
  int place = 0;
};

/// Elements of one kind of one entity.
struct ElementBlock {
  const ElementKind* kind;
  std::int64_t entity;
  int place;
  std::vector<std::int64_t> tags;   ///< per element.
  std::vector<std::int64_t> nodes;  ///< tags; kind->n_nodes for each element.
  std::vector<int> places;          ///< per element.
};

/// What stands in a file, as numbers: all that is needed of it, nothing put together.
struct GmshContent {
  /// By dimension (2, 3; others are empty), then by number.
  std::array<std::map<std::int64_t, PhysicalName>, 4> names;
  std::array<std::map<std::int64_t, GmshEntity>, 4> entities;
  std::vector<std::int64_t> node_tags;  ///< 0 = not readable.
  std::vector<Eigen::Vector3d> points;  ///< per node.
  std::vector<int> node_places;         ///< of its tag.
  std::vector<ElementBlock> blocks;     ///< of dimensions 2 and 3, of known kinds.
  /// Whether all of a section was there to be read: what is missed may else be in what was not.
  bool has_all_entities = false, has_all_nodes = false, has_all_elements = false;
};

}  // namespace faultsim
