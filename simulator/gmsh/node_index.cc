#include "simulator/gmsh/node_index.h"

#include <algorithm>

namespace faultsim {

NodeIndex::NodeIndex(const std::vector<std::int64_t>& tags) {
  constexpr std::int64_t kEntriesPerNode = 4;
  const std::int64_t largest = tags.empty() ? 0 : std::ranges::max(tags);
  if (largest / kEntriesPerNode <= std::ssize(tags)) {
    fill_table(tags, largest);
  } else {
    sort(tags);
  }
  std::ranges::sort(repeated_);
}

void NodeIndex::fill_table(const std::vector<std::int64_t>& tags, std::int64_t largest) {
  table_.assign(static_cast<std::size_t>(largest) + 1, -1);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (tags[i] == 0) continue;
    int& entry = table_[static_cast<std::size_t>(tags[i])];
    if (entry < 0) {
      entry = static_cast<int>(i);
    } else {
      repeated_.emplace_back(static_cast<int>(i), entry);
    }
  }
}

void NodeIndex::sort(const std::vector<std::int64_t>& tags) {
  std::vector<std::pair<std::int64_t, int>> all;
  all.reserve(tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (tags[i] != 0) all.emplace_back(tags[i], static_cast<int>(i));
  }
  std::ranges::sort(all);
  for (const auto& one : all) {
    if (sorted_.empty() || sorted_.back().first != one.first) {
      sorted_.push_back(one);
    } else {
      repeated_.emplace_back(one.second, sorted_.back().second);
    }
  }
}

int NodeIndex::find(std::int64_t tag) const {
  if (!table_.empty()) {
    const bool is_within = tag > 0 && tag < std::ssize(table_);
    return is_within ? table_[static_cast<std::size_t>(tag)] : -1;
  }
  const auto found =
      std::ranges::lower_bound(sorted_, tag, {}, &decltype(sorted_)::value_type::first);
  return found != sorted_.end() && found->first == tag ? found->second : -1;
}

}  // namespace faultsim
