#include "simulator/flow/eclipse_result.h"

#include <array>
#include <cmath>
#include <opm/io/eclipse/EGrid.hpp>
#include <opm/io/eclipse/ERst.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/eclipse_files.h"
#include "simulator/flow/eclipse_grid.h"
#include "simulator/flow/eclipse_problems.h"

namespace faultsim {
namespace {

using Opm::EclIO::EGrid;
using Opm::EclIO::ERst;

/// A value in SI is size · number + zero.
struct Scale {
  double size = 1, zero = 0;
  double of(float number) const { return size * static_cast<double>(number) + zero; }
};

/// What a report has, as it stands in the file.
struct ReportValues {
  std::vector<float> number;
  Scale scale;
};

/// Places in INTEHEAD, from 0 (Opm/output/eclipse/VectorItems/intehead.hpp says the same).
constexpr std::size_t kUnit = 2, kDay = 64, kMonth = 65, kYear = 66, kHour = 206, kMinute = 207,
                      kMicroseconds = 410;

/// METRIC, FIELD, LAB: bar, psi, atm; °C, °F, °C.
Scale scale_of(int unit, FlowQuantity quantity) {
  constexpr double kPsi = 6894.757293168361, kAtmosphere = 101325;  // Pa
  constexpr double kKelvin = 273.15, kRankine = 5.0 / 9, kFahrenheit = 459.67 * kRankine;
  if (quantity == FlowQuantity::pressure)
    return {unit == 1 ? 1e5 : unit == 2 ? kPsi : kAtmosphere, 0};
  return unit == 2 ? Scale{kRankine, kFahrenheit} : Scale{1, kKelvin};
}

/// Where the grid's own x and y lie on the map: p = origin + x along_x + y along_y.
struct MapAxes {
  Eigen::Vector2d origin = {0, 0}, along_x = {1, 0}, along_y = {0, 1};

  Eigen::Vector3d on_map(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d at = origin + p.x() * along_x + p.y() * along_y;
    return {at.x(), at.y(), p.z()};
  }
};

class EclipseReader : EclipseProblems {
 public:
  EclipseReader(const std::filesystem::path& path, FlowQuantity quantity)
      : files_(eclipse_files(path)), quantity_(quantity) {}

  FlowField read() {
    read_grid();
    if (files_.restarts.empty()) {
      refuse(files_.grid, "there is no restart file beside it",
             "put its .UNRST or .X0000, .X0001, ... into the same folder");
    }
    for (const auto& file : files_.restarts) {
      if (problems_.size() < kMostProblems) guarded(file, [&] { read_restart(file); });
    }
    throw_if_any(files_.grid);
    return result();
  }

 private:
  static constexpr std::size_t kMostProblems = 20;

  void read_grid() {
    std::error_code error;
    if (!std::filesystem::is_regular_file(files_.grid, error)) {
      refuse(files_.grid, "there is no such grid",
             "let the flow simulator write an EGRID (GRIDFILE) beside the restarts");
      throw_if_any(files_.grid);
    }
    guarded(files_.grid, [&] { take_cells(); });
    throw_if_any(files_.grid);
  }

  void take_cells() {
    EGrid grid(files_.grid.string());
    if (!grid.list_of_lgrs().empty()) {
      return refuse(files_.grid, "has local grid refinements (" + grid.list_of_lgrs().front() + ")",
                    "write the result on the global grid; refined cells are not read");
    }
    if (grid.is_radial()) return refuse(files_.grid, "is a radial grid", "use a corner-point grid");
    const EclipseGrid arrays = read_eclipse_grid(files_.grid);
    const double metre = take_length(arrays);
    if (arrays.is_on_map)
      say_on_map(grid);
    else
      take_axes(grid, metre);
    if (!problems_.empty()) return;
    grid.load_grid_data();
    for (int cell = 0; cell < grid.totalNumberOfCells(); ++cell) {
      const std::array<int, 3> ijk = grid.ijk_from_global_index(cell);
      if (grid.active_index(ijk[0], ijk[1], ijk[2]) < 0) continue;
      std::array<double, 8> x, y, depth;
      grid.getCellCorners(cell, x, y, depth);
      stand_upright(arrays, ijk, x, y);
      take_cell(x, y, depth, metre);
    }
    if (cells_.empty()) refuse(files_.grid, "has no active cell", "");
  }

  /// A pillar whose points lie at one depth has one place in the map (corner_point/Pillar), which
  /// opm-common's division by its height does not find.
  static void stand_upright(const EclipseGrid& arrays, const std::array<int, 3>& ijk,
                            std::array<double, 8>& x, std::array<double, 8>& y) {
    for (std::size_t k = 0; k < 8; ++k) {
      const std::size_t i = static_cast<std::size_t>(ijk[0]) + k % 2,
                        j = static_cast<std::size_t>(ijk[1]) + k / 2 % 2;
      const std::size_t pillar = 6 * (i + (static_cast<std::size_t>(arrays.size[0]) + 1) * j);
      if (arrays.coord.at(pillar + 2) != arrays.coord.at(pillar + 5)) continue;
      x[k] = static_cast<double>(arrays.coord[pillar]);
      y[k] = static_cast<double>(arrays.coord[pillar + 1]);
    }
  }

  /// m per unit of the grid. Pressures lie where the faults of the same files do (corner_point).
  double take_length(const EclipseGrid& arrays) {
    if (!arrays.length_unit.empty() && !eclipse_metre(arrays.length_unit)) {
      refuse(files_.grid, "GRIDUNIT says \"" + arrays.length_unit + "\"",
             "METRES, FEET and CM are known; correct GRIDUNIT in the flow model");
    }
    const EclipseLength length = eclipse_length(arrays, depth_ratio(arrays));
    if (!length.remark.empty()) notes_.push_back("has a grid of doubtful unit: " + length.remark);
    return length.metre;
  }

  void say_on_map(const EGrid& grid) {
    if (grid.get_mapaxes().size() < 6) return;
    notes_.emplace_back(
        "already has map coordinates (GRIDUNIT says MAP): the MAPAXES of its grid are not applied");
  }

  /// A point on the grid's y axis, its origin, a point on its x axis, on the map.
  void take_axes(const EGrid& grid, double metre) {
    const std::vector<float>& axes = grid.get_mapaxes();
    if (axes.size() < 6) return;
    if (are_no_axes(axes)) {
      notes_.emplace_back("has MAPAXES of zeros, which say nothing: they were not applied");
      return;
    }
    const std::string misfit = axes_misfit(axes);
    if (!misfit.empty()) {
      return refuse(
          files_.grid, "has axes on the map (MAPAXES) that " + misfit,
          "correct MAPAXES in the flow model, or remove it and give the scene's \"origin\"");
    }
    metre = eclipse_metre(grid.get_mapunits()).value_or(metre);
    const auto point = [&](std::size_t i) {
      return Eigen::Vector2d(metre * static_cast<double>(axes[i]),
                             metre * static_cast<double>(axes[i + 1]));
    };
    const Eigen::Vector2d y = point(0) - point(2), x = point(4) - point(2);
    axes_ = {point(2), x.normalized(), y.normalized()};
    say_moved();
  }

  /// Axes that leave everything where it is say nothing.
  void say_moved() {
    if (axes_.origin == Eigen::Vector2d(0, 0) && axes_.along_x == Eigen::Vector2d(1, 0) &&
        axes_.along_y == Eigen::Vector2d(0, 1))
      return;
    const double azimuth = std::atan2(axes_.along_y.x(), axes_.along_y.y()) / kDegree;
    const double turn =
        axes_.along_x.x() * axes_.along_y.y() - axes_.along_x.y() * axes_.along_y.x();
    notes_.push_back(concat("was placed on the map by the MAPAXES of its grid: its x = y = 0 at ",
                            formatted("%.7g m, %.7g m, its y along the azimuth %.4g deg",
                                      axes_.origin.x(), axes_.origin.y(), azimuth),
                            turn < 0 ? ", its x to the left of that" : ""));
  }

  /// Corners come as (i, j) of the top, then of the bottom; VTK begins at the bottom and goes
  /// round.
  void take_cell(const std::array<double, 8>& x, const std::array<double, 8>& y,
                 const std::array<double, 8>& depth, double metre) {
    constexpr std::array<std::size_t, 8> kOrder = {4, 5, 7, 6, 0, 1, 3, 2};
    CellCorners corners;
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t k = kOrder[i];
      corners[i] = axes_.on_map(metre * Eigen::Vector3d(x[k], y[k], -depth[k]));
    }
    cells_.push_back(flow_cell_around(corners));
  }

  /// Arrays are read when they are asked for, and forgotten after their report: of files of many
  /// gigabytes only the values are kept.
  void read_restart(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    if (ending.rfind(".x", 0) == 0) {
      return refuse(file, "has an ending in small letters, from which a report is not told",
                    "rename it to " + file.stem().string() + ".X" + ending.substr(2));
    }
    ERst restart(file.string());
    for (const int report : restart.listOfReportStepNumbers()) {
      if (problems_.size() >= kMostProblems) return;
      take_report(restart, report, file);
      restart.clearData();
    }
  }

  void take_report(ERst& restart, int report, const std::filesystem::path& file) {
    const std::string key = quantity_ == FlowQuantity::pressure ? "PRESSURE" : "TEMP";
    const std::string name = concat("report ", report);
    if (!restart.hasArray(key, report)) {
      return refuse(file, name + " has no " + key,
                    "ask the flow simulator for it: RPTRST with BASIC=2");
    }
    const std::vector<int> head = restart.getRestartData<int>("INTEHEAD", report);
    if (head.size() <= kYear) return refuse(file, name + " has no date", "");
    const std::vector<float>& values = restart.getRestartData<float>(key, report);
    if (values.size() != cells_.size()) {
      return refuse(
          file,
          concat(name, " is from another grid: it has ", values.size(), " values, but ",
                 files_.grid.filename().string(), " has ", cells_.size(), " active cells"),
          "keep the files of one run together");
    }
    take_values(values, scale_of(head[kUnit], quantity_), name, file);
    take_date(head, name, file);
  }

  void take_values(const std::vector<float>& values, const Scale& scale, const std::string& name,
                   const std::filesystem::path& file) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double si = scale.of(values[i]);
      if (std::isfinite(si) && si >= 0) continue;
      return refuse(file, concat(name, " has the value ", values[i], " in active cell ", i + 1),
                    "give absolute values for all active cells");
    }
    values_.push_back({values, scale});
  }

  void take_date(const std::vector<int>& head, const std::string& name,
                 const std::filesystem::path& file) {
    const auto at = [&](std::size_t i) { return i < head.size() ? head[i] : 0; };
    const std::string text = formatted("%04d-%02d-%02d", at(kYear), at(kMonth), at(kDay));
    const std::optional<double> day = parse_date(text);
    if (!day) return refuse(file, name + " has the date " + text, "");
    const double date = *day + 3600.0 * at(kHour) + 60.0 * at(kMinute) + 1e-6 * at(kMicroseconds);
    if (!dates_.empty() && date <= dates_.back()) {
      return refuse(file,
                    name + " of " + text + " does not come after the one before, of " +
                        date_text(dates_.back()),
                    "keep the files of one run together, without those of a restarted one");
    }
    dates_.push_back(date);
  }

  FlowField result() const {
    FlowField field;
    field.date = dates_;
    field.notes = notes_;
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (flow_cell_volume(cells_[c]) <= 0) continue;
      kept.push_back(c);
      field.cells.push_back(cells_[c]);
    }
    field.value.resize(std::ssize(kept), std::ssize(dates_));
    for (Eigen::Index t = 0; t < field.value.cols(); ++t) {
      const ReportValues& report = values_[static_cast<std::size_t>(t)];
      for (Eigen::Index c = 0; c < field.value.rows(); ++c)
        field.value(c, t) = report.scale.of(report.number[kept[static_cast<std::size_t>(c)]]);
    }
    return field;
  }

  EclipseFiles files_;
  FlowQuantity quantity_;
  MapAxes axes_;
  std::vector<FlowCell> cells_;       ///< active ones, in the order of the values.
  std::vector<double> dates_;         ///< s since 1970.
  std::vector<ReportValues> values_;  ///< per report.
  std::vector<std::string> notes_;    ///< FlowField::notes.
};

}  // namespace

bool reads_eclipse() { return true; }

FlowField read_eclipse(const std::filesystem::path& path, FlowQuantity quantity) {
  return EclipseReader(path, quantity).read();
}

}  // namespace faultsim
