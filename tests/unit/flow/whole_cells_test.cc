// The flow grid's own integrals: kept whatever the model covers of it.
#include "simulator/flow/whole_cells.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> kSides{"west", "east"};
constexpr MappingRules kWhole{.integral = IntegralRule::flow_grid};

/// 10 x 2 x 2 cells of 100 m around y = 0 below 2 km. Pressures fall in the west, and more on and
/// on; in the east they rise here and fall there.
FlowField two_reservoirs() {
  FlowField field;
  field.date = {0, 1e8, 2e8};
  field.value = Eigen::MatrixXd::Constant(40, 3, 3e7);
  for (int f = 0; f < 40; ++f) {
    const Eigen::Vector3d low(100 * (f % 10), f / 10 % 2 == 0 ? -100 : 0, -2000 - 100 * (f / 20));
    field.cells.push_back({low, low + Eigen::Vector3d::Constant(100)});
    const bool is_west = f % 10 < 5;
    field.value(f, 1) -= is_west ? 1e6 + 2e4 * f : 1e6 * std::sin(5.0 * f);
    field.value(f, 2) -= is_west ? 5e6 + 3e4 * f * f : 4e6 * std::cos(11.0 * f);
  }
  return field;
}

CellCorners box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return {{{low.x(), low.y(), low.z()},
           {high.x(), low.y(), low.z()},
           {high.x(), high.y(), low.z()},
           {low.x(), high.y(), low.z()},
           {low.x(), low.y(), high.z()},
           {high.x(), low.y(), high.z()},
           {high.x(), high.y(), high.z()},
           {low.x(), high.y(), high.z()}}};
}

/// Two compartments that meet at x = 530 m, 30 m beside where the flow grid has the fault (its
/// pressures turn at 500 m), too short in the west, too thick in the east.
std::vector<MappedCell> model() {
  std::vector<MappedCell> cells;
  const auto add = [&](double from, double to, double base, int region) {
    for (int i = 0; i < 6; ++i) {
      const double h = (to - from) / 6;
      cells.push_back({.corners = box({from + h * i, -95, base}, {from + h * (i + 1), 95, -1900}),
                       .region = region});
    }
  };
  add(50, 530, -2095, 0);
  add(530, 1010, -2110, 1);
  return cells;
}

/// ∫Δp dV over the cells of our compartment and over the flow grid's half of it.
struct Integrals {
  double ours = 0, flow = 0, size = 0;
  double own_size = 0;  ///< of ours.
};

Integrals integrals(const FlowField& field, const std::vector<MappedCell>& cells, int side,
                    const Eigen::VectorXd& change, int report) {
  Integrals sums;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (cells[c].region != side) continue;
    const double one = cell_volume(cells[c].corners) * change[static_cast<Eigen::Index>(c)];
    sums.ours += one;
    sums.own_size += std::abs(one);
  }
  for (int f = 0; f < 40; ++f) {
    if ((f % 10 >= 5) != (side == 1)) continue;
    sums.flow += 1e6 * (field.value(f, report) - field.value(f, 0));
    sums.size += 1e6 * std::abs(field.value(f, report) - field.value(f, 0));
  }
  return sums;
}

TEST(WholeCells, KeepTheIntegralsOfBothSidesAtAllReports) {
  const FlowField field = two_reservoirs();
  const std::vector<MappedCell> cells = model();
  const FlowMapping mapping = map_flow(field, cells, kSides, kWhole);
  const Eigen::MatrixXd means = mapped_change(mapping, field, 0);
  Eigen::MatrixXd change = means;
  const std::vector<IntegralBalance> balance =
      keep_integrals(mapping, field, 0, {0, 1, 2}, kSides, change);
  for (int side = 0; side < 2; ++side) {
    double off = 0, size = 0;
    for (int t = 0; t < 3; ++t) {
      const Integrals sums = integrals(field, cells, side, change.col(t), t);
      EXPECT_NEAR(sums.ours, sums.flow, 1e-13 * sums.size) << kSides[side] << " " << t;
      const Integrals before = integrals(field, cells, side, means.col(t), t);
      off = std::max(off, std::abs(before.ours - before.flow));
      size = std::max(size, before.own_size);
      if (t > 0) {
        EXPECT_GT(std::abs(before.ours - before.flow), 1e-3 * sums.size);
      }
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const auto row = static_cast<Eigen::Index>(c);
        if (cells[c].region != side || t == 0) continue;
        EXPECT_GT(change(row, t) * means(row, t), 0);
      }
      if (t < 2) continue;
      EXPECT_NEAR(balance[side].mapped, before.ours, 1e-13 * sums.size);
      EXPECT_NEAR(balance[side].flow_grid, sums.flow, 1e-13 * sums.size);
    }
    EXPECT_NEAR(balance[side].largest_scaling, off / size, 1e-12);
  }
}

/// The strip between the two faults holds flow cells of the east, which do not reach the west;
/// cells of the west without any of their own take the nearest of the west.
TEST(WholeCells, ReachTheirOwnCompartmentOnly) {
  FlowField field = two_reservoirs();
  for (int f = 0; f < 40; ++f)
    for (int t = 1; t < 3; ++t) field.value(f, t) = f % 10 < 5 ? 2e7 : 3e7;
  std::vector<MappedCell> cells = model();
  cells.push_back({.corners = box({505, -80, -2080}, {525, 80, -2050}), .region = 0});
  const auto changes = [&](const MappingRules& rules) {
    return Eigen::VectorXd(mapped_change(map_flow(field, cells, kSides, rules), field, 0).col(1));
  };
  const Eigen::VectorXd own = changes(kWhole), mixed = changes({});
  EXPECT_LT((own.head(6).array() + 1e7).abs().maxCoeff(), 1e-6);
  EXPECT_LT(own.segment(6, 6).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(own[12], -1e7, 1e-6);
  EXPECT_GT(mixed[5], -7e6);
  EXPECT_EQ(mixed[12], 0);
}

TEST(WholeCells, CountWhereTheyLieMostlyElseWithTheNearest) {
  const FlowField field = two_reservoirs();
  const std::vector<MappedCell> cells = model();
  const FlowMapping mapping = map_flow(field, cells, kSides, kWhole);
  for (int side = 0; side < 2; ++side) {
    EXPECT_EQ(mapping.flow_cells[side].size(), 20u);  // those below 2.08 km and at the rims too
    for (const FlowMapping::Weight& own : mapping.flow_cells[side]) {
      EXPECT_EQ(own.flow_cell % 10 >= 5, side == 1);
      EXPECT_NEAR(own.value, 1e6, 1e-6);
    }
  }
  EXPECT_TRUE(map_flow(field, cells, kSides, {}).flow_cells.empty());
}

/// Whatever their numbers: a table of compartments by flow cells would not fit in any memory.
TEST(WholeCells, CountWithTheFirstOfCompartmentsThatHoldAsMuch) {
  FlowField field = two_reservoirs();
  field.cells.resize(4);
  std::vector<MappedCell> cells = model();
  cells.resize(4);
  cells[0].region = 2'000'000'000;
  cells[1].region = 7;
  cells[2].region = cells[3].region = 8;
  cells[2].fraction = cells[3].fraction = 0.5;
  const std::vector<std::vector<FlowMapping::Weight>> overlaps = {
      {{0, 5}, {1, 5}, {3, 1}}, {{0, 5}, {1, 4}}, {{1, 4}, {3, 4}}, {{1, 8}}};
  const std::vector<int> owner = compartments_of_flow_cells(field, cells, overlaps);
  EXPECT_THAT(owner, testing::ElementsAre(7, 8, 8, 8));
}

/// Half of a domain has half of the integral, a section that of a metre.
TEST(WholeCells, CountAsFarAsTheyAreModelled) {
  FlowField field = two_reservoirs();
  for (int f = 0; f < 40; ++f) field.value(f, 2) = field.value(f / 20 * 20 + f % 10, 2);
  std::vector<MappedCell> half = model(), section = model();
  for (MappedCell& cell : half) {
    for (Eigen::Vector3d& corner : cell.corners) corner.y() = std::max(corner.y(), 0.0);
  }
  for (MappedCell& cell : section) cell.corners = at_section(cell.corners, 12);
  const auto flow_grid = [&](const std::vector<MappedCell>& cells, const MappingRules& rules) {
    const FlowMapping mapping = map_flow(field, cells, kSides, rules);
    Eigen::MatrixXd change = mapped_change(mapping, field, 0);
    return keep_integrals(mapping, field, 0, {0, 1, 2}, kSides, change)[0].flow_grid;
  };
  MappingRules of_half = kWhole, of_section = kWhole;
  of_half.y_range[0] = 0;
  of_section.y_range = {11.5, 12.5};
  const double whole = flow_grid(model(), kWhole);
  EXPECT_NEAR(flow_grid(half, of_half), whole / 2, 1e-12 * std::abs(whole));
  EXPECT_NEAR(flow_grid(section, of_section), whole / 200, 1e-12 * std::abs(whole));
  EXPECT_NEAR(volume_between(field.cells[0], {-30, -10}), 20 * 1e4, 1e-8);
  EXPECT_EQ(volume_between(field.cells[0], {0, 50}), 0);
}

/// At the first report only a flow cell beside the model has changed.
TEST(WholeCells, KeepWhatHappensBesideTheModelOnly) {
  FlowField field = two_reservoirs();
  std::vector<MappedCell> cells = model();
  std::erase_if(cells, [](const MappedCell& cell) { return cell.corners[0].x() < 100; });
  for (int f = 0; f < 40; ++f) field.value(f, 1) = f % 10 == 0 ? 2.9e7 : 3e7;
  const FlowMapping mapping = map_flow(field, cells, kSides, kWhole);
  Eigen::MatrixXd change = mapped_change(mapping, field, 0);
  ASSERT_EQ(change.col(1).norm(), 0);
  keep_integrals(mapping, field, 0, {0, 1, 2}, kSides, change);
  for (int t = 1; t < 3; ++t) {
    const Integrals sums = integrals(field, cells, 0, change.col(t), t);
    EXPECT_NEAR(sums.ours, sums.flow, 1e-13 * sums.size) << t;
  }
  EXPECT_EQ(integrals(field, cells, 1, change.col(1), 1).ours, 0);
}

/// In the west one flow cell changes, beside the model; against what happens in the east that is
/// nothing.
TEST(WholeCells, TakeATinyChangeBesideAQuietCompartment) {
  FlowField field = two_reservoirs();
  std::vector<MappedCell> cells = model();
  std::erase_if(cells, [](const MappedCell& cell) { return cell.corners[0].x() < 100; });
  const auto of_change = [&](double pressure) {
    for (int f = 0; f < 40; ++f)
      for (int t = 1; t < 3; ++t) field.value(f, t) = f % 10 < 5 ? 3e7 : 2e7;
    field.value(0, 1) = field.value(0, 2) = 3e7 - pressure;
    const FlowMapping mapping = map_flow(field, cells, kSides, kWhole);
    Eigen::MatrixXd change = mapped_change(mapping, field, 0);
    EXPECT_EQ(integrals(field, cells, 0, change.col(2), 2).own_size, 0);
    EXPECT_EQ(keep_integrals(mapping, field, 0, {0, 1, 2}, kSides, change)[0].largest_scaling, 0);
    const Integrals sums = integrals(field, cells, 0, change.col(2), 2);
    EXPECT_NEAR(sums.ours, sums.flow, 1e-13 * sums.size);
    EXPECT_LT(sums.flow, 0);
  };
  of_change(1e3);
  EXPECT_THAT(([&] { of_change(5e6); }),
              ThrowsMessage<InputError>(HasSubstr("differ by more than 1000 times the former")));
}

TEST(WholeCells, RefuseGridsThatDoNotBelongTogether) {
  const FlowField field = two_reservoirs();
  std::vector<MappedCell> cells = model();
  for (MappedCell& cell : cells) {
    if (cell.region == 0) cell.fraction = 0.01;
  }
  const FlowMapping mapping = map_flow(field, cells, kSides, kWhole);
  Eigen::MatrixXd change = mapped_change(mapping, field, 0);
  EXPECT_THAT(([&] {
                keep_integrals(mapping, field, 0, {0, 1, 2}, kSides, change);
              }),
              ThrowsMessage<InputError>(AllOf(
                  HasSubstr("over west and over the flow cells that count with it differ by "),
                  HasSubstr("it has 1.78e+05 m3, they 2e+07 m3"))));
}

}  // namespace
}  // namespace faultsim
