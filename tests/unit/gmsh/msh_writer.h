#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Writes files of format MSH 4.1 for tests, from its description and without a line of the reader.
namespace faultsim::msh {

struct Name {
  int dimension, number;
  std::string name;
};
/// A curve, surface or volume.
struct Entity {
  int dimension, tag;
  std::vector<int> physical;
};
struct NodeBlock {
  int dimension, entity;
  std::vector<std::uint64_t> tags;
  std::vector<std::vector<double>> points;  ///< x, y, z; with more the block is parametric.
};
struct ElementBlock {
  int dimension, entity, type;
  std::vector<std::vector<std::uint64_t>> rows;  ///< tag, nodes.
};
struct File {
  std::vector<Name> names;
  std::vector<Entity> entities;  ///< by dimension.
  std::vector<NodeBlock> nodes;
  std::vector<ElementBlock> elements;
};

/// @param end  of lines.
std::string text(const File& file, const std::string& end = "\n");
enum class ByteOrder { little, big };
std::string binary(const File& file, ByteOrder order);

/// Two tetrahedra, west of and east of the triangle of nodes 2, 3, 4:
///
///   1 (0 0 0)   2 (1 0 0)   3 (0 1 0)   4 (0 0 1)   5 (1 1 1)
///
/// Volume 1 is "west" (10), volume 2 "east" (3), surface 7 "fault" (4). Its text has 42 lines.
File two_tetrahedra();

}  // namespace faultsim::msh
