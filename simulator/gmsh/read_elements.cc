#include "simulator/gmsh/read_elements.h"

#include <string>
#include <utility>

#include "simulator/gmsh/block_walk.h"

namespace faultsim {
namespace {

class ElementReader {
 public:
  ElementReader(Records& records, FileProblems& problems, GmshContent& content)
      : records_(records), problems_(problems), content_(content) {}

  bool read() {
    const bool all = walk_blocks(records_, problems_, "$Elements", "element", "elements",
                                 [this] { return block(); });
    return all && is_whole_;
  }

 private:
  std::int64_t block() {
    records_.next("the dimension and number of an entity, a type and the number of its elements");
    const int head = records_.place();
    const std::int64_t dimension = records_.integer(), entity = records_.integer(),
                       type = records_.integer(), n = records_.count();
    if (!records_.is_whole()) return -1;
    const ElementKind* kind = element_kind(type);
    if (kind == nullptr) return skip_unknown(head, type, n);
    constexpr int kNumberBytes = 8;
    if (!records_.may_hold(n, kNumberBytes * (1 + kind->n_nodes)))
      return add_endless_block(problems_, head, n, kind->one, kind->many), -1;
    if (dimension != kind->dimension) {
      problems_.add(head, kSaveAnew, [&] {
        return concat("an entity of dimension ", dimension, " cannot have ", kind->many);
      });
      is_whole_ = false;
    }
    elements({kind, entity, head, {}, {}, {}}, n, dimension == kind->dimension && dimension >= 2);
    return n;
  }

  /// In text elements are lines, whatever they hold.
  std::int64_t skip_unknown(int head, std::int64_t type, std::int64_t n) {
    problems_.add(head, "use elements of first order: Mesh.ElementOrder = 1, or gmsh -order 1",
                  [&] { return concat("elements of type ", type, " are not known here"); });
    is_whole_ = false;
    if (problems_.is_binary()) return -1;
    std::int64_t i = 0;
    while (i < n && records_.next("an element")) ++i;
    return i == n ? n : -1;
  }

  void elements(ElementBlock block, std::int64_t n, bool is_kept) {
    const ElementKind& kind = *block.kind;
    const auto n_nodes = static_cast<std::size_t>(kind.n_nodes);
    const std::string form =
        concat("the tag of an element and those of its ", counted(kind.n_nodes, "node", "nodes"));
    std::int64_t i = 0;
    for (; i < n && records_.next(form); ++i) {
      const std::size_t begin = block.nodes.size();
      const std::int64_t tag = records_.count();
      block.nodes.resize(begin + n_nodes);
      for (std::size_t k = begin; k < begin + n_nodes; ++k) block.nodes[k] = records_.count();
      const bool is_read = records_.is_whole();
      if (!is_read) is_whole_ = false;
      if (!is_read || !is_kept) {
        block.nodes.resize(begin);
        continue;
      }
      block.tags.push_back(tag);
      block.places.push_back(records_.place());
    }
    if (i < n) {
      add_short_block(problems_, block.place, n, i, kind.one, kind.many);
      is_whole_ = false;
    }
    if (!block.tags.empty()) content_.blocks.push_back(std::move(block));
  }

  Records& records_;
  FileProblems& problems_;
  GmshContent& content_;
  bool is_whole_ = true;
};

}  // namespace

bool read_elements(Records& records, FileProblems& problems, GmshContent& content) {
  return ElementReader(records, problems, content).read();
}

}  // namespace faultsim
