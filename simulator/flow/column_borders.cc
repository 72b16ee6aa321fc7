#include <algorithm>
#include <array>
#include <map>

#include "simulator/common/errors.h"
#include "simulator/flow/cell_columns.h"
#include "simulator/flow/regular_cells.h"

namespace faultsim {
namespace {

using Reach = std::array<double, 2>;
using ColumnReaches = std::vector<std::vector<Reach>>;  ///< per column and cell, m downwards.

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ColumnReaches reaches_of_thickness(const std::vector<CellColumn>& columns) {
  ColumnReaches reach(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (const CellCentre& cell : columns[c].cells)
      reach[c].push_back({cell.depth - 0.5 * cell.thickness, cell.depth + 0.5 * cell.thickness});
  }
  return reach;
}

class ReachFinder {
 public:
  explicit ReachFinder(const std::vector<CellColumn>& columns) : columns_(columns) {}

  ColumnReaches find() {
    for (const CellColumn& column : columns_) add_runs(column.cells);
    FAULTSIM_DEMAND(!all_.empty(), "no cell touches another");
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      for (std::size_t i = 0; i < reach_[c].size(); ++i) {
        if (reach_[c][i][0] < reach_[c][i][1]) continue;
        const CellCentre& cell = columns_[c].cells[i];
        const double half = 0.5 * thickness_of(cell.layer);
        reach_[c][i] = {cell.depth - half, cell.depth + half};
      }
    }
    return std::move(reach_);
  }

 private:
  /// Cells alone get none yet.
  void add_runs(const std::vector<CellCentre>& cells) {
    std::vector<Reach>& reach = reach_.emplace_back();
    std::vector<double> run;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      run.push_back(cells[i].depth);
      if (i + 1 < cells.size() && cells[i + 1].touches(cells[i])) continue;
      const std::vector<Reach> found = run.size() > 1 ? touching_cells(run) : std::vector<Reach>(1);
      reach.insert(reach.end(), found.begin(), found.end());
      run.clear();
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double thickness = reach[i][1] - reach[i][0];
      if (thickness <= 0) continue;
      of_layer_[cells[i].layer].push_back(thickness);
      all_.push_back(thickness);
    }
  }

  double thickness_of(int layer) {
    const auto [known, is_new] = median_.try_emplace(layer, 0);
    if (is_new) {
      const auto same = of_layer_.find(layer);
      known->second = median_of(same == of_layer_.end() ? all_ : same->second);
    }
    return known->second;
  }

  const std::vector<CellColumn>& columns_;
  ColumnReaches reach_;
  std::map<int, std::vector<double>> of_layer_;  ///< thicknesses, m.
  std::vector<double> all_;
  std::map<int, double> median_;  ///< of a layer's.
};

void set_borders_of(CellColumn& column, std::vector<Reach> reach) {
  constexpr double kPinched = 0.25;
  const std::vector<CellCentre>& cells = column.cells;
  column.borders.clear();
  column.tops.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    bool is_joined = false;
    if (i > 0) {
      const Reach &own = reach[i], &above = reach[i - 1];
      const double gap = own[0] - above[1],
                   thinner = std::min(own[1] - own[0], above[1] - above[0]);
      is_joined = cells[i].touches(cells[i - 1]) || gap < kPinched * thinner;
      if (is_joined) column.borders.back().depth += 0.5 * gap;
    }
    if (!is_joined) column.borders.push_back({cells[i].layer, reach[i][0]});
    column.tops.push_back(column.borders.size() - 1);
    column.borders.push_back({cells[i].layer + 1, reach[i][1]});
  }
}

}  // namespace

void set_borders(std::vector<CellColumn>& columns) {
  const bool is_known = columns.front().cells.front().thickness > 0;
  const ColumnReaches reach =
      is_known ? reaches_of_thickness(columns) : ReachFinder(columns).find();
  for (std::size_t c = 0; c < columns.size(); ++c) set_borders_of(columns[c], reach[c]);
}

}  // namespace faultsim
