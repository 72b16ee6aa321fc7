#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/corner_point_grid.h"

namespace faultsim::corner_point {
namespace {

/// A file's arrays become a grid; what is wrong with them is gathered.
class GridMaker {
 public:
  GridMaker(const EclipseGrid& file, std::string source)
      : file_(file), source_(std::move(source)) {}

  CornerPointGrid make() {
    check_sizes();
    stop_at_problems();  // what follows indexes the arrays
    grid_.size = file_.size;
    take_active();
    take_units();
    take_axes();
    take_pillars();
    take_corners();
    take_connections();
    grid_.equilibrium_region = of_all_cells(file_.equilibrium_region, "EQLNUM");
    grid_.fluid_region = of_all_cells(file_.fluid_region, "FIPNUM");
    stop_at_problems();
    check_layers();
    stop_at_problems();
    return std::move(grid_);
  }

 private:
  void refuse(const std::string& what, const std::string& cure) {
    problems_.push_back({"", 0, what, cure});
  }
  void stop_at_problems() {
    if (!problems_.empty()) throw InputError(source_, std::move(problems_));
  }

  void check_sizes() {
    const auto& [n_i, n_j, n_k] = file_.size;
    if (n_i < 1 || n_j < 1 || n_k < 1) {
      return refuse(concat("has ", n_i, " x ", n_j, " x ", n_k, " cells"),
                    "give 1 or more along each axis (GRIDHEAD)");
    }
    const auto i = static_cast<std::size_t>(n_i), j = static_cast<std::size_t>(n_j);
    const std::size_t n_cells = i * j * static_cast<std::size_t>(n_k);
    constexpr std::size_t kMostCells = 250'000'000;  // corners are counted in int
    if (n_cells > kMostCells)
      return refuse(concat("has ", n_cells, " cells"), concat("at most ", kMostCells, " are read"));
    check_size("COORD", file_.coord.size(), 6 * (i + 1) * (j + 1));
    check_size("ZCORN", file_.zcorn.size(), 8 * n_cells);
    if (!file_.active.empty()) check_size("ACTNUM", file_.active.size(), n_cells);
  }

  void check_size(const std::string& name, std::size_t is, std::size_t should_be) {
    if (is == should_be) return;
    refuse(concat(name, " has ", is, " numbers, but a grid of this size has ", should_be),
           "write the grid again from the flow simulator");
  }

  void take_active() {
    grid_.is_active.assign(grid_.n_cells(), 1);
    for (std::size_t c = 0; c < file_.active.size(); ++c)
      grid_.is_active[c] = file_.active[c] != 0 ? 1 : 0;
    n_active_ = std::ranges::count(grid_.is_active, 1);
    if (n_active_ == 0) refuse("has no active cell", "set ACTNUM of the reservoir's cells to 1");
  }

  void take_units() {
    if (!file_.length_unit.empty() && !eclipse_metre(file_.length_unit)) {
      refuse("GRIDUNIT says \"" + file_.length_unit + "\"",
             "METRES, FEET and CM are known; correct GRIDUNIT in the flow model");
    }
    const EclipseLength length = eclipse_length(file_, depth_ratio(file_));
    metre_ = length.metre;
    if (!length.remark.empty()) grid_.remarks.push_back(length.remark);
  }

  /// A point on the grid's y axis, its origin, a point on its x axis, on the map.
  void take_axes() {
    if (file_.map_axes.size() < 6) return;
    if (file_.is_on_map) {
      grid_.remarks.push_back(
          "coordinates are on the map (GRIDUNIT says MAP): MAPAXES not applied");
      return;
    }
    if (are_no_axes(file_.map_axes)) {
      grid_.remarks.push_back("MAPAXES are zeros, which say nothing: not applied");
      return;
    }
    const std::string misfit = axes_misfit(file_.map_axes);
    if (!misfit.empty()) {
      return refuse("has axes on the map (MAPAXES) that " + misfit,
                    "correct MAPAXES in the flow model, or remove it");
    }
    const double metre = eclipse_metre(file_.map_unit).value_or(metre_);
    const auto point = [&](std::size_t i) {
      return Eigen::Vector2d(metre * static_cast<double>(file_.map_axes[i]),
                             metre * static_cast<double>(file_.map_axes[i + 1]));
    };
    const Eigen::Vector2d y = point(0) - point(2), x = point(4) - point(2);
    origin_ = point(2);
    along_x_ = x.normalized();
    along_y_ = y.normalized();
    const bool moves = origin_.norm() > 0 || along_x_.x() < 1 || along_y_.y() < 1;
    if (moves) grid_.remarks.push_back("coordinates were put on the map by MAPAXES");
  }

  Eigen::Vector3d point_of(std::size_t at) const {
    const double x = metre_ * static_cast<double>(file_.coord[at]),
                 y = metre_ * static_cast<double>(file_.coord[at + 1]);
    const Eigen::Vector2d on_map = origin_ + x * along_x_ + y * along_y_;
    return {on_map.x(), on_map.y(), -metre_ * static_cast<double>(file_.coord[at + 2])};
  }

  void take_pillars() {
    for (std::size_t at = 0; at < file_.coord.size(); at += 6) {
      const Pillar pillar{point_of(at), point_of(at + 3)};
      grid_.pillars.push_back(pillar);
      if (pillar.top.allFinite() && pillar.bottom.allFinite()) continue;
      n_bad_pillars_ += 1;
      if (n_bad_pillars_ == 1) first_bad_pillar_ = static_cast<int>(at / 6);
    }
    if (n_bad_pillars_ == 0) return;
    const int n = grid_.size[0] + 1;
    refuse(concat("COORD: ", counted(n_bad_pillars_, "pillar has", "pillars have"),
                  " a coordinate that is not a number, the first at i = ",
                  first_bad_pillar_ % n + 1, ", j = ", first_bad_pillar_ / n + 1),
           "write the grid again from the flow simulator");
  }

  void take_corners() {
    grid_.corner_z =
        mapped(file_.zcorn, [&](float depth) { return -metre_ * static_cast<double>(depth); });
    const auto n_bad =
        std::ranges::count_if(grid_.corner_z, [](double z) { return !std::isfinite(z); });
    if (n_bad > 0) {
      refuse(concat("ZCORN: ", counted(n_bad, "depth is not a number", "depths are not numbers")),
             "write the grid again from the flow simulator");
    }
  }

  void take_connections() {
    const auto is_cell = [&](int cell) { return cell >= 0 && cell < grid_.n_cells(); };
    for (const std::array<int, 2>& pair : file_.connections) {
      if (is_cell(pair[0]) && is_cell(pair[1])) {
        grid_.connections.push_back(pair);
        continue;
      }
      return refuse(concat("NNC1 and NNC2 connect cells ", pair[0] + 1, " and ", pair[1] + 1,
                           " of ", grid_.n_cells()),
                    "keep the files of one run together");
    }
  }

  /// INIT has a number for each active cell. One of another grid matters only to who asks for it.
  std::vector<int> of_all_cells(const std::vector<int>& of_active, const std::string& name) {
    if (of_active.empty()) return {};
    if (std::ssize(of_active) != n_active_) {
      const std::string misfit = concat(name, " of the INIT file has ", of_active.size(),
                                        " numbers, but the grid has ", n_active_, " active cells");
      grid_.region_misfits[name] = misfit;
      grid_.remarks.push_back(misfit + ": it is left out");
      return {};
    }
    std::vector<int> all(grid_.is_active.size(), 0);
    std::size_t next = 0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (grid_.is_active[c] != 0) all[c] = of_active[next++];
    }
    return all;
  }

  /// Layers count downwards, and no cell of an active column is inside out: active ones are
  /// refused, the others become flat.
  void check_layers() {
    int n_inverted = 0, first = -1, n_flattened = 0;
    double most = 0;
    for (int column = 0; column < grid_.n_columns(); ++column) {
      if (!grid_.has_active_cell(column)) continue;
      for (int k = 0; k < grid_.size[2]; ++k) {
        if (!grid_.is_inverted(column, k)) continue;
        const int cell = grid_.cell(column, k);
        if (grid_.is_active[cell] == 0) {
          n_flattened += 1;
          most = std::max(most, flatten(column, k));
        } else if (n_inverted++ == 0) {
          first = cell;
        }
      }
    }
    if (n_inverted > 0) refuse_inverted(n_inverted, first);
    if (n_flattened == 0) return;
    grid_.remarks.push_back(
        concat(counted(n_flattened, "inactive cell has its bottom above its top",
                       "inactive cells have their bottoms above their tops"),
               formatted(", by up to %.3g m: the bottom was taken to lie at the top there", most)));
  }

  /// Puts corners of the bottom that lie above those of the top down to these. How far, m, at most.
  double flatten(int column, int k) {
    double most = 0;
    for (const CornerPlace& top : kTopCorners) {
      double& bottom = grid_.corner_z[grid_.corner_index(column, k, {top.right, top.back, true})];
      const double down = bottom - grid_.z(column, k, top);
      if (down <= 0) continue;
      bottom = grid_.z(column, k, top);
      most = std::max(most, down);
    }
    return most;
  }

  void refuse_inverted(int n, int first) {
    const std::array<int, 2> at = grid_.place(first % grid_.n_columns());
    refuse(concat(counted(n, "cell has its bottom above its top",
                          "cells have their bottoms above their tops"),
                  ", the first at i = ", at[0] + 1, ", j = ", at[1] + 1,
                  ", k = ", first / grid_.n_columns() + 1),
           "correct them in the flow model: layers count downwards, and depths (ZCORN) grow "
           "downwards");
  }

  const EclipseGrid& file_;
  std::string source_;
  CornerPointGrid grid_;
  double metre_ = 1;
  Eigen::Vector2d origin_ = {0, 0}, along_x_ = {1, 0}, along_y_ = {0, 1};
  std::ptrdiff_t n_active_ = 0;
  int n_bad_pillars_ = 0, first_bad_pillar_ = 0;
  std::vector<Problem> problems_;
};

}  // namespace

CornerPointGrid corner_point_grid(const EclipseGrid& file, const std::string& source) {
  return GridMaker(file, source).make();
}

CornerPointGrid read_corner_point_grid(const std::filesystem::path& path) {
  return corner_point_grid(read_eclipse_grid(path), path.filename().string());
}

}  // namespace faultsim::corner_point
