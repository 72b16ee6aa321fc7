#include "simulator/linalg/panels.h"

#include <algorithm>
#include <numeric>

namespace faultsim {
namespace {

/// Columns that one task finishes: wide enough for the speed of dgemm, narrow enough for several
/// threads at the last separators.
constexpr int kPanelWidth = 256;
/// Columns that one update takes at once: a longer product is scattered less often, a shorter one
/// is waited for less.
constexpr int kSourceWidth = 1024;
static_assert(kSourceWidth % kPanelWidth == 0);

double factor_flops(double width, double height) {
  return width * width * (width / 3 + height - width);
}

}  // namespace

PanelSchedule::PanelSchedule(const Supernodes& supernodes) {
  cut(supernodes);
  list_updates(supernodes);
  find_subtrees(supernodes);
}

void PanelSchedule::cut(const Supernodes& supernodes) {
  for (long s = 0; s < supernodes.count; ++s) {
    first_panel_.push_back(n_panels());
    const int width = static_cast<int>(supernodes.width(s));
    for (int first = 0; first < width; first += kPanelWidth) {
      const int own = std::min(kPanelWidth, width - first);
      panels.push_back({s, first, own});
      const double height = static_cast<double>(supernodes.height(s) - first);
      flops.push_back(2.0 * first * own * height + factor_flops(own, height));
    }
  }
  first_panel_.push_back(n_panels());
}

void PanelSchedule::list_updates(const Supernodes& supernodes) {
  std::vector<int> panel_of(supernodes.n);
  for (int p = 0; p < n_panels(); ++p) {
    const Columns& panel = panels[p];
    std::fill_n(panel_of.begin() + supernodes.begin[panel.supernode] + panel.first, panel.width, p);
  }
  // Calls visit(panel, update) for all that supernode s owes.
  const auto for_each_debt = [&](long s, const auto& visit) {
    const long* rows = supernodes.rows_of(s);
    const int width = static_cast<int>(supernodes.width(s));
    const int height = static_cast<int>(supernodes.height(s));
    for (int row = width, next = row; row < height; row = next) {
      const int panel = panel_of[rows[row]];
      while (next < height && panel_of[rows[next]] == panel) ++next;
      for (int first = 0; first < width; first += kSourceWidth) {
        const int own = std::min(kSourceWidth, width - first);
        const int last_panel = first_panel_[s] + (first + own - 1) / kPanelWidth;
        visit(panel, PanelUpdate{{s, first, own}, row, next - row, last_panel});
      }
    }
  };
  update_begin.assign(n_panels() + 1, 0);
  for (long s = 0; s < supernodes.count; ++s) {
    for_each_debt(s, [&](int panel, const PanelUpdate&) { ++update_begin[panel + 1]; });
  }
  std::partial_sum(update_begin.begin(), update_begin.end(), update_begin.begin());
  updates.resize(update_begin.back());
  std::vector<long> end(update_begin.begin(), update_begin.end() - 1);
  for (long s = 0; s < supernodes.count; ++s) {
    for_each_debt(s, [&](int panel, const PanelUpdate& update) {
      updates[end[panel]++] = update;
      const long n_rows = supernodes.height(s) - update.row;
      largest_product = std::max(largest_product, n_rows * update.n_columns);
      flops[panel] += 2.0 * static_cast<double>(n_rows * update.n_columns) * update.source.width;
    });
  }
}

/// The supernodes below s in the elimination tree are [first, s] where the order is a postorder;
/// a set of trailing unknowns that was put last need not be one.
void PanelSchedule::find_subtrees(const Supernodes& supernodes) {
  std::vector<long> owner(supernodes.n), size(supernodes.count, 1);
  first_below_.resize(supernodes.count);
  std::iota(first_below_.begin(), first_below_.end(), 0L);
  for (long s = 0; s < supernodes.count; ++s) {
    std::fill(owner.begin() + supernodes.begin[s], owner.begin() + supernodes.begin[s + 1], s);
  }
  for (long s = 0; s < supernodes.count; ++s) {
    if (supernodes.height(s) == supernodes.width(s)) continue;
    const long parent = owner[supernodes.rows_of(s)[supernodes.width(s)]];
    size[parent] += size[s];
    first_below_[parent] = std::min(first_below_[parent], first_below_[s]);
  }
  for (long s = 0; s < supernodes.count; ++s) {
    if (size[s] != s - first_below_[s] + 1) first_below_[s] = -1;
  }
}

std::vector<PanelSchedule::Task> PanelSchedule::tasks(int n_threads) const {
  constexpr int kSubtreesPerThread = 8;
  std::vector<double> before(n_panels() + 1, 0);
  std::partial_sum(flops.begin(), flops.end(), before.begin() + 1);
  const double most = n_threads > 1 ? before.back() / (kSubtreesPerThread * n_threads) : 0;
  std::vector<Task> subtrees, single;
  const auto flops_of = [&](const Task& task) { return before[task.last] - before[task.first]; };
  for (long s = static_cast<long>(first_below_.size()) - 1; s >= 0;) {
    if (first_below_[s] >= 0) {
      const Task subtree = {first_panel_[first_below_[s]], first_panel_[s + 1]};
      if (flops_of(subtree) <= most) {
        subtrees.push_back(subtree);
        s = first_below_[s] - 1;
        continue;
      }
    }
    for (int p = first_panel_[s + 1] - 1; p >= first_panel_[s]; --p) single.push_back({p, p + 1});
    --s;
  }
  std::ranges::reverse(subtrees);
  std::ranges::stable_sort(subtrees,
                           [&](const Task& a, const Task& b) { return flops_of(a) > flops_of(b); });
  subtrees.insert(subtrees.end(), single.rbegin(), single.rend());
  return subtrees;
}

}  // namespace faultsim
