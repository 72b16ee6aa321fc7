#include "simulator/gmsh/read_nodes.h"

#include <array>

#include "simulator/gmsh/block_walk.h"

namespace faultsim {
namespace {

/// With up to three coordinates within curve, surface or volume.
constexpr std::array<const char*, 4> kPointForms{"x, y and z", "x, y, z and u", "x, y, z, u and v",
                                                 "x, y, z, u, v and w"};

class NodeReader {
 public:
  NodeReader(Records& records, FileProblems& problems, GmshContent& content)
      : records_(records), problems_(problems), content_(content) {}

  bool read() {
    const bool all =
        walk_blocks(records_, problems_, "$Nodes", "node", "nodes", [this] { return block(); });
    return all && is_whole_;
  }

 private:
  std::int64_t block() {
    records_.next("the dimension and number of an entity, 0 or 1, and the number of its nodes");
    const int head = records_.place();
    const std::int64_t dimension = records_.integer();
    records_.integer();
    const std::int64_t parametric = records_.integer(), n = records_.count();
    if (!records_.is_whole()) return -1;
    if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1) {
      problems_.add(head, kSaveAnew, [&] {
        return concat("a block of nodes has dimension ", dimension, " and parametric ", parametric,
                      ", not 0 to 3 and 0 or 1");
      });
      return -1;
    }
    const int n_more = parametric == 1 ? static_cast<int>(dimension) : 0;
    constexpr int kNumberBytes = 8, kNumbers = 4;  // a tag and x, y, z
    if (!records_.may_hold(n, kNumberBytes * (kNumbers + n_more)))
      return add_endless_block(problems_, head, n, "node", "nodes"), -1;
    const std::int64_t n_tags = tags(n), n_points = n_tags == n ? points(n, n_more) : 0;
    if (n_points == n) return n;
    add_short_block(problems_, head, n, n_points, "node", "nodes");
    is_whole_ = false;
    return n;
  }

  /// How many there were.
  std::int64_t tags(std::int64_t n) {
    std::int64_t i = 0;
    for (; i < n && records_.next("the tag of a node"); ++i) {
      const std::int64_t tag = records_.count();
      const bool is_read = records_.is_whole();
      if (!is_read) is_whole_ = false;
      if (is_read && tag == 0) {
        problems_.add(records_.place(), "number nodes from 1",
                      [] { return "a node has the tag 0"; });
      }
      content_.node_tags.push_back(is_read ? tag : 0);
      content_.node_places.push_back(records_.place());
      content_.points.emplace_back(0, 0, 0);
    }
    return i;
  }

  std::int64_t points(std::int64_t n, int n_more) {
    Eigen::Vector3d* point = content_.points.data() + content_.points.size() - n;
    std::int64_t i = 0;
    for (; i < n && records_.next(kPointForms[static_cast<std::size_t>(n_more)]); ++i) {
      for (double& x : *point++) x = records_.real();
      records_.skip(n_more);
      records_.is_whole();
    }
    return i;
  }

  Records& records_;
  FileProblems& problems_;
  GmshContent& content_;
  bool is_whole_ = true;
};

}  // namespace

bool read_nodes(Records& records, FileProblems& problems, GmshContent& content) {
  return NodeReader(records, problems, content).read();
}

}  // namespace faultsim
