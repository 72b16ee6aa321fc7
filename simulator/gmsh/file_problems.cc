#include "simulator/gmsh/file_problems.h"

#include <algorithm>
#include <utility>

namespace faultsim {
namespace {

constexpr int kMostOfAKind = 20;

}  // namespace

bool FileProblems::is_spelled_out(int place, const char* cure) {
  OfAKind& kind = kinds_[cure];
  if (kind.n == kMostOfAKind) kind.first_counted = place;
  return ++kind.n <= kMostOfAKind;
}

std::string FileProblems::name_of(int place) const {
  return concat(is_binary_ ? "byte " : "line ", place);
}

void FileProblems::require_none() const {
  if (list_.empty()) return;
  std::vector<One> all = list_;
  for (const auto& [cure, kind] : kinds_) {
    if (kind.n > kMostOfAKind)
      all.push_back({kind.first_counted,
                     concat(kind.n - kMostOfAKind, " more are wrong in the same way, from here on"),
                     cure.data()});
  }
  std::ranges::stable_sort(all, {}, &One::place);
  std::vector<Problem> problems;
  for (const One& one : all) {
    const bool is_byte = is_binary_ && one.place > 0;
    problems.push_back({"", is_binary_ ? 0 : one.place,
                        is_byte ? name_of(one.place) + ": " + one.what : one.what, one.cure});
  }
  throw InputError(source_, std::move(problems));
}

}  // namespace faultsim
