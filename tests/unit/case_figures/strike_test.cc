// Charts of faults that do not strike along y, or that bend.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/case_figures/fields_of_one_fault.h"
#include "tests/unit/case_figures/read_curves.h"
#include "tests/unit/figure/svg_reader.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

/// A vertical fault of five columns of three points, 100 m apart along its trace and 50 m down; χ
/// is largest, 0.9, in the middle of the last column but one.
struct FaultAlong : FieldsOfOneFault {
  template <typename Trace>
  explicit FaultAlong(Trace trace) : FieldsOfOneFault(fault_along(trace)) {}
  StoredFields fields(std::size_t, std::size_t) const override {
    StoredFields now;
    now.traction = now.slip = Eigen::Matrix3Xd::Zero(3, 15);
    now.critical_index = Eigen::VectorXd::LinSpaced(15, 0.10, 0.24);
    now.critical_index[10] = 0.9;
    now.fault_pressure_change = Eigen::VectorXd::Zero(15);
    now.state.assign(15, 0);
    return now;
  }

 private:
  template <typename Trace>
  static StoredFault fault_along(Trace trace) {
    StoredFault fault;
    fault.name = "F2";
    fault.points.resize(3, 15);
    for (int c = 0; c < 5; ++c) {
      const Eigen::Vector2d place = trace(100.0 * c);
      for (int r = 0; r < 3; ++r) {
        fault.points.col(3 * c + r) << place, -2000 - 50 * r;
        fault.split.push_back(1);
        if (c > 0 && r > 0)
          fault.faces.push_back({3 * c + r - 4, 3 * c + r - 3, 3 * c + r, 3 * c + r - 1});
      }
    }
    return fault;
  }
};

std::string drawn(const FaultAlong& fields, CaseChart chart) {
  const Scene scene = field_scene();
  CaseResult result = small_result();
  result.plane_strain = false;
  return draw_case({result, scene, &fields, {}}, {chart, "F2", {}, false});
}

/// Widths of the faces of the upper row, along the axis of the map, from left to right.
std::vector<double> widths_of(const std::string& svg) {
  const figure::ReadScale x = figure::read_scale(svg, true), y = figure::read_scale(svg, false);
  std::vector<std::pair<double, double>> found;
  for (const figure::SvgElement& one : figure::elements_of(svg)) {
    if (one.name != "polygon" || one.has("fill", "none")) continue;
    double low = 1e9, high = -1e9, top = 1e9;
    for (const auto& corner : one.points()) {
      low = std::min(low, x.value(corner.x));
      high = std::max(high, x.value(corner.x));
      top = std::min(top, y.value(corner.y));
    }
    if (std::abs(top - 2000) < 1) found.emplace_back(low, high - low);
  }
  std::ranges::sort(found);
  std::vector<double> widths;
  for (const auto& [from, width] : found) widths.push_back(width);
  return widths;
}

void expect_widths_and_column(const FaultAlong& fault, const char* axis) {
  const std::string map = drawn(fault, CaseChart::fault_map);
  EXPECT_THAT(widths_of(map), testing::Pointwise(testing::DoubleNear(1), {100., 100., 100., 100.}));
  EXPECT_THAT(map, HasSubstr(axis));
  const std::string profiles = drawn(fault, CaseChart::profiles);
  expect_values(read_off(profiles, 0, false, 3), {2000, 2050, 2100}, 0.1);
  expect_values(read_off(profiles, 0, true, 3, 3), {0.19, 0.9, 0.21}, 0.01);
}

TEST(ChartsOfFaults, ThatStrikeEastWestAreAlongTheirStrike) {
  expect_widths_and_column(FaultAlong([](double s) { return Eigen::Vector2d(s, 7); }),
                           ">along strike, towards x, m<");
}

TEST(ChartsOfFaults, ThatBendAreAlongTheirTrace) {
  expect_widths_and_column(FaultAlong([](double s) {
                             return Eigen::Vector2d(std::max(0.0, s - 200), std::min(s, 200.0));
                           }),
                           ">along strike, 45° from y towards x, m<");
  expect_widths_and_column(FaultAlong([](double s) {  // it comes back beside itself
                             return Eigen::Vector2d(std::clamp(s - 100, 0.0, 100.0),
                                                    std::min(s, 100.0) - std::max(0.0, s - 200));
                           }),
                           "along strike, ");
}

}  // namespace
}  // namespace faultsim
