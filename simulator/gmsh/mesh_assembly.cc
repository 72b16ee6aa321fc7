#include "simulator/gmsh/mesh_assembly.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/common/text.h"
#include "simulator/gmsh/node_index.h"
#include "simulator/gmsh/physical_groups.h"

namespace faultsim {
namespace {

constexpr const char* kOneShape = "mesh all volumes with tetrahedra, or all with hexahedra";
constexpr const char* kFirstOrder =
    "use elements of first order: Mesh.ElementOrder = 1, or gmsh -order 1";

/// Corners between which node n_corners + k lies, of tetrahedra; of triangles the first three.
constexpr std::array<std::pair<int, int>, 6> kSides{
    {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}}};

class MeshAssembly {
 public:
  MeshAssembly(const GmshContent& content, FileProblems& problems)
      : content_(content),
        problems_(problems),
        index_(content.node_tags),
        groups_(content, problems),
        is_corner_(content.node_tags.size(), 0) {}

  GmshMesh assemble() {
    check_nodes();
    check_shapes();
    check_orders();
    for (const ElementBlock& block : content_.blocks) {
      if (block.kind->dimension == 3) add_cells(block);
    }
    for (const ElementBlock& block : content_.blocks) {
      if (block.kind->dimension == 2) add_facets(block);
    }
    if (content_.has_all_elements && count_cells() == 0) {
      problems_.add(0,
                    "give volumes a Physical Volume, without which Gmsh saves none, and mesh: -3",
                    [] { return "there are no cells"; });
    }
    if (!problems_.is_empty()) return {};
    name_groups(3, mesh_.cell_group, cell_groups_, mesh_.cell_groups);
    name_groups(2, mesh_.facet_group, facet_groups_, mesh_.facet_groups);
    keep_corners();
    return std::move(mesh_);
  }

 private:
  void check_nodes() {
    for (const auto& [node, before] : index_.repeated()) {
      problems_.add(place_of(node), "renumber the nodes (RenumberMeshNodes) and save the mesh",
                    [&, i = node, other = before] {
                      return concat("node ", tag_of(i), " is given twice, first at ",
                                    problems_.name_of(place_of(other)));
                    });
    }
  }
  int place_of(int node) const { return content_.node_places[static_cast<std::size_t>(node)]; }
  std::int64_t tag_of(int node) const { return content_.node_tags[static_cast<std::size_t>(node)]; }

  std::int64_t count_cells() const {
    std::int64_t n = 0;
    for (const ElementBlock& block : content_.blocks) {
      if (block.kind->dimension == 3) n += std::ssize(block.tags);
    }
    return n;
  }

  /// Tetrahedra alone, or hexahedra alone.
  void check_shapes() {
    std::vector<std::pair<const ElementKind*, std::int64_t>> shapes;
    int place = 0;
    for (const ElementBlock& block : content_.blocks) {
      if (block.kind->dimension != 3 || block.tags.empty()) continue;
      if (shapes.empty()) place = block.place;
      const auto same = std::ranges::find_if(shapes, [&](const auto& one) {
        return std::string_view(one.first->many) == block.kind->many;
      });
      if (same == shapes.end()) {
        shapes.emplace_back(block.kind, std::ssize(block.tags));
      } else {
        same->second += std::ssize(block.tags);
      }
    }
    if (shapes.empty()) return;
    mesh_.corners_per_cell = shapes[0].first->n_corners;
    if (shapes.size() == 1 && shapes[0].first->shape != ElementShape::other) return;
    problems_.add(place, kOneShape, [&] {
      return "cells are " + joined(shapes, ", ", [](const auto& one) {
               return counted(one.second, one.first->one, one.first->many);
             });
    });
  }

  /// Kinds that matter and are not read.
  void check_orders() {
    std::map<int, std::pair<const ElementBlock*, std::int64_t>> kinds;  // by type
    for (const ElementBlock& block : content_.blocks) {
      const ElementKind& kind = *block.kind;
      const bool is_free = kind.dimension == 2 && groups_.of(2, block.entity).empty();
      if (kind.is_read || kind.shape == ElementShape::other || is_free) continue;
      auto& entry = kinds[kind.type];
      if (entry.first == nullptr) entry.first = &block;
      entry.second += std::ssize(block.tags);
    }
    for (const auto& [type, entry] : kinds) {
      problems_.add(entry.first->place, kFirstOrder, [&, block = entry.first, n = entry.second] {
        return concat("there ", n == 1 ? "is " : "are ",
                      counted(n, block->kind->one, block->kind->many), " of ", block->kind->n_nodes,
                      " nodes");
      });
    }
  }

  void add_cells(const ElementBlock& block) {
    is_all_of_cells_ = is_all_of_cells_ && block.kind->is_read;
    if (!block.kind->is_read) return;
    const std::vector<std::int64_t>& groups = groups_.of(3, block.entity);
    const std::int64_t group = groups.empty() ? 0 : groups[0];
    std::vector<int> nodes;
    for (std::size_t i = 0; i < block.tags.size(); ++i) {
      if (!find_nodes(block, i, nodes)) {
        is_all_of_cells_ = false;
        continue;
      }
      nodes.resize(static_cast<std::size_t>(block.kind->n_corners));
      mesh_.cells.insert(mesh_.cells.end(), nodes.begin(), nodes.end());
      for (const int node : nodes) is_corner_[static_cast<std::size_t>(node)] = 1;
      cell_groups_.push_back(group);
    }
  }

  void add_facets(const ElementBlock& block) {
    const std::vector<std::int64_t>& groups = groups_.of(2, block.entity);
    if (!block.kind->is_read || groups.empty()) return;
    const std::ptrdiff_t begin = std::ssize(mesh_.facets);
    std::vector<int> nodes;
    for (std::size_t i = 0; i < block.tags.size(); ++i) {
      if (!find_nodes(block, i, nodes)) continue;
      nodes.resize(static_cast<std::size_t>(block.kind->n_corners));
      check_corners(block, i, nodes);
      std::array<int, 4> corners{-1, -1, -1, -1};
      std::ranges::copy(nodes, corners.begin());
      mesh_.facets.push_back(corners);
      facet_groups_.push_back(groups[0]);
    }
    const std::vector<std::array<int, 4>> own(mesh_.facets.begin() + begin, mesh_.facets.end());
    for (std::size_t k = 1; k < groups.size(); ++k) {
      mesh_.facets.insert(mesh_.facets.end(), own.begin(), own.end());
      facet_groups_.insert(facet_groups_.end(), own.size(), groups[k]);
    }
  }

  /// Corners of facets that no cell has.
  void check_corners(const ElementBlock& block, std::size_t i, std::span<const int> corners) {
    if (!content_.has_all_elements || !is_all_of_cells_) return;
    for (const int node : corners) {
      if (is_corner_[static_cast<std::size_t>(node)] != 0) continue;
      problems_.add(block.places[i],
                    "make the surface one of the volumes' (BooleanFragments), or embed it "
                    "(Surface{...} In Volume{...}), and mesh again",
                    [&] {
                      const std::int64_t group = groups_.of(2, block.entity)[0];
                      return concat(name_of(block, i), " of ", table_quote(groups_.name(2, group)),
                                    " has node ", tag_of(node),
                                    ", which is not a corner of a cell");
                    });
      return;
    }
  }

  std::string name_of(const ElementBlock& block, std::size_t i) const {
    return concat(block.kind->one, ' ', block.tags[i]);
  }

  /// The nodes of an element; false where they cannot be, which is told.
  bool find_nodes(const ElementBlock& block, std::size_t i, std::vector<int>& nodes) {
    const auto n = static_cast<std::size_t>(block.kind->n_nodes);
    nodes.clear();
    for (std::size_t k = i * n; k < (i + 1) * n; ++k) {
      nodes.push_back(index_.find(block.nodes[k]));
      if (nodes.back() >= 0) continue;
      if (content_.has_all_nodes) {
        problems_.add(block.places[i], kSaveAnew, [&] {
          return concat(name_of(block, i), " has node ", block.nodes[k],
                        ", which is not in $Nodes");
        });
      }
      return false;
    }
    const std::span<const int> corners(nodes.data(),
                                       static_cast<std::size_t>(block.kind->n_corners));
    for (std::size_t k = 1; k < corners.size(); ++k) {
      if (!contains(corners.first(k), corners[k])) continue;
      problems_.add(block.places[i],
                    "remove duplicates from the geometry (Coherence) and mesh again", [&] {
                      return concat(name_of(block, i), " has node ", tag_of(corners[k]),
                                    " at two of its corners");
                    });
      return false;
    }
    measure_bend(*block.kind, nodes);
    return true;
  }

  void measure_bend(const ElementKind& kind, const std::vector<int>& nodes) {
    const auto point = [&](std::size_t k) -> const Eigen::Vector3d& {
      return content_.points[static_cast<std::size_t>(nodes[k])];
    };
    const auto n_corners = static_cast<std::size_t>(kind.n_corners);
    for (std::size_t k = 0; n_corners + k < nodes.size(); ++k) {
      const Eigen::Vector3d middle = 0.5 * point(static_cast<std::size_t>(kSides[k].first)) +
                                     0.5 * point(static_cast<std::size_t>(kSides[k].second));
      mesh_.largest_bend = std::max(mesh_.largest_bend, (point(n_corners + k) - middle).norm());
    }
  }

  /// From numbers of groups to those that are there, in order, and their names.
  void name_groups(int dimension, std::vector<int>& of_elements,
                   const std::vector<std::int64_t>& numbers,
                   std::vector<std::string>& names) const {
    std::vector<std::int64_t> used = numbers;
    std::ranges::sort(used);
    drop_repeated(used);
    for (const std::int64_t group : used) names.push_back(groups_.name(dimension, group));
    of_elements.reserve(numbers.size());
    for (const std::int64_t group : numbers) {
      const auto place = std::ranges::lower_bound(used, group);
      of_elements.push_back(static_cast<int>(place - used.begin()));
    }
  }

  /// Drops the nodes that are no corners of cells.
  void keep_corners() {
    std::vector<int> kept(is_corner_.size(), -1);
    for (std::size_t i = 0; i < is_corner_.size(); ++i) {
      if (is_corner_[i] == 0) continue;
      kept[i] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.push_back(content_.points[i]);
      mesh_.node_tags.push_back(content_.node_tags[i]);
    }
    for (int& node : mesh_.cells) node = kept[static_cast<std::size_t>(node)];
    for (std::array<int, 4>& facet : mesh_.facets) {
      for (int& node : facet) node = node < 0 ? -1 : kept[static_cast<std::size_t>(node)];
    }
  }

  const GmshContent& content_;
  FileProblems& problems_;
  NodeIndex index_;
  PhysicalGroups groups_;
  std::vector<char> is_corner_;  ///< per node of the file: of a cell.
  bool is_all_of_cells_ = true;
  std::vector<std::int64_t> cell_groups_, facet_groups_;  ///< numbers, per cell and facet.
  GmshMesh mesh_;
};

}  // namespace

GmshMesh assemble_mesh(const GmshContent& content, FileProblems& problems) {
  return MeshAssembly(content, problems).assemble();
}

}  // namespace faultsim
