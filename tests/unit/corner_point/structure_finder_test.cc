// Grids made here with known faults, and what is recognised of them. Judges know the faults that
// the grids were made with, and the corners; they share no code with the recognition.
#include "simulator/corner_point/structure_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "made_grid.h"
#include "simulator/common/errors.h"

namespace faultsim::corner_point {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kDegree = std::numbers::pi / 180;

auto constant(double offset) {
  return [offset](double) { return offset; };
}
/// All of it up to s = 0, then less, and nothing from s = 1 on.
auto tapering(double offset) {
  return [offset](double s) { return offset * std::clamp(1 - s, 0.0, 1.0); };
}

std::string text_of(const GridStructure& found) {
  std::string text;
  for (const StructureRemark& remark : found.report) text += remark.text + "\n";
  return text;
}

/// x = 700 from south to north, the east lower by 30 m.
MadeGrid with_straight_fault(double offset = 30) {
  return {.faults = {{{700, 0}, {700, 1280}, constant(offset)}}};
}

TEST(GridStructure, FindsAStraightFault) {
  const GridStructure found = recognise_structure(made(with_straight_fault()), {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  const Fault& fault = found.faults[0];
  EXPECT_EQ(fault.edges.size(), 16u);
  ASSERT_EQ(fault.trace.size(), 2u);
  EXPECT_LT((fault.trace[0] - Eigen::Vector2d(700, 0)).norm(), 1e-3);
  EXPECT_LT((fault.trace[1] - Eigen::Vector2d(700, 1280)).norm(), 1e-3);
  EXPECT_NEAR(fault.length, 1280, 1e-3);
  EXPECT_EQ(fault.offset.size(), 17u);
  for (const double offset : fault.offset) EXPECT_NEAR(offset, 30, 1e-9);
  for (int p = 0; p <= 16; ++p) EXPECT_NEAR(fault.along[static_cast<std::size_t>(p)], 80 * p, 1e-3);
  EXPECT_NEAR(fault.largest_offset, 30, 1e-9);
  EXPECT_EQ(fault.down, Side::right);
  EXPECT_NEAR(fault.dip.median, 90 * kDegree, 1e-9);
  EXPECT_EQ(fault.dips_towards, Side::neither);
  EXPECT_EQ(fault.begin.kind, EndKind::grid_edge);
  EXPECT_EQ(fault.end.kind, EndKind::grid_edge);
  EXPECT_FALSE(fault.end.tapers);
  EXPECT_TRUE(found.junctions.empty());
  EXPECT_TRUE(found.left_out.empty()) << text_of(found);
}

TEST(GridStructure, SaysWhichSideIsLowerByTheMapNotByIndices) {
  MadeGrid grid = with_straight_fault();
  grid.is_left_handed = true;  // the fault's line goes on to y < 0
  const GridStructure mirrored = recognise_structure(made(grid), {});
  ASSERT_EQ(mirrored.faults.size(), 1u);
  EXPECT_LT(mirrored.faults[0].trace[0].y(), mirrored.faults[0].trace[1].y());
  EXPECT_EQ(mirrored.faults[0].down, Side::right);
  EXPECT_NEAR(mirrored.faults[0].offset[3], 30, 1e-9);
  const GridStructure raised = recognise_structure(made(with_straight_fault(-30)), {});
  EXPECT_EQ(raised.faults[0].down, Side::left);
  EXPECT_NEAR(raised.faults[0].offset[3], -30, 1e-9);
}

/// Pillars meet 1250 m above the reservoir. Whichever two points of each a file gives, below the
/// place where they meet or above it, they are the same pillars.
TEST(GridStructure, IsThatOfTheCornersWhereverPillarsAreGiven) {
  CornerPointGrid near = made(with_straight_fault());
  for (Pillar& pillar : near.pillars) {
    const double x = pillar.bottom.x();
    pillar.top = {1000 + 0.6 * (x - 1000), pillar.top.y(), -1500};
    pillar.bottom = {1000 + 1.4 * (x - 1000), pillar.bottom.y(), -2500};
  }
  CornerPointGrid far = near;
  for (Pillar& pillar : far.pillars) pillar.top << pillar.at(0), 0;
  ASSERT_GT(far.pillars[0].top.x(), far.pillars[1].top.x()) << "crossed there";
  const GridStructure expected = recognise_structure(near, {}),
                      found = recognise_structure(far, {});
  ASSERT_EQ(expected.faults.size(), 1u);
  EXPECT_EQ(expected.faults[0].down, Side::right);
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].down, Side::right);
  EXPECT_EQ(found.faults[0].dips_towards, expected.faults[0].dips_towards);
  EXPECT_EQ(found.faults[0].edges.size(), expected.faults[0].edges.size());
  for (std::size_t e = 0; e < found.faults[0].edges.size(); ++e) {
    EXPECT_EQ(found.faults[0].edges[e].left, expected.faults[0].edges[e].left);
    EXPECT_EQ(found.faults[0].edges[e].right, expected.faults[0].edges[e].right);
  }
  for (const double offset : found.faults[0].offset) EXPECT_NEAR(offset, 30, 1e-9);
  EXPECT_EQ(text_of(found), text_of(expected));
}

TEST(GridStructure, SeparatesCompartmentsByFaults) {
  const GridStructure found = recognise_structure(made(with_straight_fault()), {});
  ASSERT_EQ(found.compartments.size(), 2u);
  const Compartment &east = found.compartments[0], &west = found.compartments[1];
  EXPECT_EQ(east.cells.size(), 13u * 16 * 3);
  EXPECT_EQ(west.n_columns, 7 * 16);
  EXPECT_NEAR(east.area, 1300 * 1280, 1e-6);
  EXPECT_NEAR(west.volume, 700 * 1280 * 45, 1e-4);
  EXPECT_EQ(found.compartment_of_cell[0], 1);
  EXPECT_EQ(found.compartment_of_cell[19], 0);
  // The mean of the corners' heights, by the trapezoidal rule.
  double mean = 0;
  for (int i = 7; i < 20; ++i) {
    for (const int right : {0, 1}) mean += (made_top({100.0 * (i + right), 640}) - 30) / 26;
  }
  EXPECT_NEAR(east.mean_top, mean, 1e-9);
  EXPECT_NEAR(east.mean_base, mean - 45, 1e-9);
}

TEST(GridStructure, HasHorizonsOnEachSideOfAFault) {
  const GridStructure found = recognise_structure(made(with_straight_fault()), {});
  ASSERT_EQ(found.horizons.size(), 4u);
  const std::array depth = {0.0, 10.0, 30.0, 45.0};
  for (std::size_t h = 0; h < 4; ++h) {
    const Horizon& horizon = found.horizons[h];
    EXPECT_EQ(horizon.is_base, h == 3);
    EXPECT_EQ(horizon.points.size(), 22u * 17);
    EXPECT_EQ(horizon.largest_step, 0);
    for (const HorizonPoint& point : horizon.points) {
      const bool is_east = point.compartment == 0;
      EXPECT_TRUE(is_east ? point.position.x() >= 700 : point.position.x() <= 700);
      EXPECT_NEAR(point.position.z(),
                  made_top(point.position.head<2>()) - depth[h] - (is_east ? 30 : 0), 1e-9);
    }
  }
  EXPECT_EQ(found.layers[1].n_active, 320);
  EXPECT_NEAR(found.layers[1].thickness, 20, 1e-9);
}

TEST(GridStructure, FollowsATaperToItsTip) {
  // 40 m up to y = 320, nothing from y = 960 on.
  const MadeGrid grid{.faults = {{{700, 320}, {700, 960}, tapering(40)}}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 1u);
  const Fault& fault = found.faults[0];
  for (std::size_t p = 0; p < fault.offset.size(); ++p) {
    EXPECT_NEAR(fault.pillars[p].y(), 80.0 * static_cast<double>(p), 1e-9);
    EXPECT_NEAR(fault.offset[p], tapering(40)((fault.pillars[p].y() - 320) / 640), 1e-9);
  }
  EXPECT_EQ(fault.begin.kind, EndKind::grid_edge);
  EXPECT_EQ(fault.end.kind, EndKind::tip);
  EXPECT_TRUE(fault.end.tapers);
  EXPECT_FALSE(fault.begin.tapers);
  // The last edge of 6.1 m or more is the one from 10 to 5 m.
  EXPECT_EQ(fault.edges.size(), 11u);
  EXPECT_NEAR(fault.end.offset, 10, 1e-9);
  ASSERT_EQ(found.left_out.size(), 1u);
  EXPECT_EQ(found.left_out[0].reason, LeftOutReason::small_offset);
  EXPECT_EQ(found.left_out[0].n_edges, 1);
  EXPECT_EQ(found.left_out[0].continues, 0);
  EXPECT_NEAR(found.left_out[0].largest_offset, 5, 1e-9);
  EXPECT_EQ(found.compartments.size(), 1u);
  EXPECT_THAT(text_of(found), HasSubstr("fault 1 ends in the grid: it does not separate"));
  // A horizon is known on both sides of the fault, whichever compartment that is.
  std::vector<double> heights;
  for (const HorizonPoint& point : found.horizons[0].points) {
    if (point.pillar == 7 + 21 * 2) heights.push_back(point.position.z());
  }
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(std::abs(heights[0] - heights[1]), 40, 1e-9);
  // A lower threshold takes it in.
  EXPECT_EQ(recognise_structure(made(grid), {.least_offset = 1}).faults[0].edges.size(), 12u);
}

TEST(GridStructure, ProlongsATipOnRequest) {
  const MadeGrid grid{.faults = {{{700, 320}, {700, 960}, tapering(40)}}};
  const GridStructure found = recognise_structure(made(grid), {.extend_faults = true});
  EXPECT_EQ(found.faults[0].end.n_extension, 5);
  ASSERT_EQ(found.compartments.size(), 2u);
  EXPECT_EQ(found.compartments[1].n_columns, 7 * 16);
  EXPECT_THAT(text_of(found), HasSubstr("extended by 5 pillar edges"));
}

TEST(GridStructure, FindsWhereAFaultEndsAtAnother) {
  const MadeGrid grid{
      .faults = {{{700, 0}, {700, 1280}, constant(30)}, {{0, 640}, {2000, 640}, constant(20), 0}}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 2u) << text_of(found);
  ASSERT_EQ(found.junctions.size(), 1u);
  const Junction& junction = found.junctions[0];
  EXPECT_FALSE(junction.crosses);
  EXPECT_LT((junction.position - Eigen::Vector2d(700, 640)).norm(), 1e-3);
  const Fault& stem = found.faults[static_cast<std::size_t>(junction.fault)];
  EXPECT_EQ(stem.edges.size(), 13u);
  EXPECT_EQ(stem.begin.kind, EndKind::junction);
  EXPECT_EQ(stem.begin.other, junction.other);
  EXPECT_EQ(stem.end.kind, EndKind::grid_edge);
  for (const double offset : stem.offset) EXPECT_NEAR(offset, 20, 1e-9);
  EXPECT_EQ(found.compartments.size(), 3u);
}

/// An oblique fault that ends at another does so on the other's trace.
TEST(GridStructure, EndsTheTraceOfAFaultOnThatOfTheOther) {
  for (const double slope : {0.4, 0.23, -0.3}) {
    const Eigen::Vector2d begin(705, 655), along(1300, 1300 * slope);
    const MadeGrid grid{.faults = {{{700, 0}, {700, 1280}, constant(30)},
                                   {begin - along, begin + along, constant(20), 0}}};
    const GridStructure found = recognise_structure(made(grid), {});
    ASSERT_EQ(found.junctions.size(), 1u) << text_of(found);
    const Eigen::Vector2d at = found.junctions[0].position;
    EXPECT_NEAR(at.x(), 700, 1e-3);
    EXPECT_NEAR(at.y(), 655, 60);
    const Fault& stem = found.faults[static_cast<std::size_t>(found.junctions[0].fault)];
    EXPECT_EQ(stem.trace.front(), at);
    for (const Eigen::Vector2d& point : stem.trace)
      EXPECT_LT(distance_from_line(grid.faults[1], point), 0.5 * stem.cell) << slope;
  }
}

TEST(GridStructure, CutsSpursOff) {
  CornerPointGrid grid = made(with_straight_fault());
  for (int k = 0; k < 3; ++k) {
    for (const bool bottom : {false, true})
      grid.corner_z[grid.corner_index(grid.column(7, 5), k, {false, false, bottom})] -= 12;
  }
  const GridStructure found = recognise_structure(grid, {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].edges.size(), 16u);
  EXPECT_TRUE(found.junctions.empty());
  ASSERT_EQ(found.left_out.size(), 1u);
  EXPECT_EQ(found.left_out[0].reason, LeftOutReason::short_chain);
  EXPECT_EQ(found.left_out[0].n_edges, 1);
  EXPECT_NEAR(found.left_out[0].largest_offset, 12, 1e-9);
}

TEST(GridStructure, FindsWhereFaultsCross) {
  const MadeGrid grid{
      .faults = {{{700, 0}, {700, 1280}, constant(30)}, {{0, 640}, {2000, 640}, constant(20)}}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 2u) << text_of(found);
  EXPECT_EQ(found.faults[0].edges.size(), 20u);
  EXPECT_EQ(found.faults[1].edges.size(), 16u);
  ASSERT_EQ(found.junctions.size(), 1u);
  EXPECT_TRUE(found.junctions[0].crosses);
  EXPECT_LT((found.junctions[0].position - Eigen::Vector2d(700, 640)).norm(), 1e-3);
  EXPECT_EQ(found.compartments.size(), 4u);
}

/// Lines at an acute angle share stairs, and are two faults that cross all the same.
TEST(GridStructure, FindsWhereFaultsCrossAtAnAcuteAngle) {
  const MadeGrid grid{
      .size = {30, 30, 2},
      .dx = 100,
      .dy = 100,
      .faults = {{{0, 760}, {3000, 2130}, constant(30)}, {{0, 1990}, {3000, 1010}, constant(20)}}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 2u) << text_of(found);
  ASSERT_EQ(found.junctions.size(), 1u) << text_of(found);
  EXPECT_TRUE(found.junctions[0].crosses);
  for (const Fault& fault : found.faults) {
    const MadeFault& line = grid.faults[fault.trace[0].y() < 1500 ? 0 : 1];
    for (const Eigen::Vector2d& point : fault.trace) EXPECT_LT(distance_from_line(line, point), 60);
    EXPECT_EQ(fault.begin.kind, EndKind::grid_edge);
    EXPECT_EQ(fault.end.kind, EndKind::grid_edge);
  }
  EXPECT_EQ(found.compartments.size(), 4u);
}

/// Stairs of every slope; an oblique line is within half a cell of them.
TEST(GridStructure, StraightensStairs) {
  for (const double slope : {0.13, 0.35, 0.5, 0.8, 1.0, 1.7, -0.6, -1.2}) {
    const Eigen::Vector2d middle(1010, 645), along(1, slope);
    const MadeFault oblique{middle - 1000 * along, middle + 1000 * along, constant(25)};
    const GridStructure found = recognise_structure(made({.faults = {oblique}}), {});
    ASSERT_EQ(found.faults.size(), 1u) << slope << "\n" << text_of(found);
    const Fault& fault = found.faults[0];
    EXPECT_LE(fault.trace.size(), 3u) << slope;
    for (const Eigen::Vector2d& point : fault.trace)
      EXPECT_LT(distance_from_line(oblique, point), 0.5 * fault.cell) << slope;
    EXPECT_LE(fault.largest_distance, 0.5 * fault.cell);
    for (const double offset : fault.offset) EXPECT_NEAR(offset, 25, 1e-9);
    EXPECT_EQ(found.compartments.size(), 2u);
  }
}

TEST(GridStructure, LeavesInactiveColumnsOut) {
  MadeGrid grid = with_straight_fault();
  for (int j = 0; j < 4; ++j) grid.inactive.push_back({7, j, -1});
  grid.inactive.push_back({3, 3, 1});
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 1u);
  EXPECT_EQ(found.faults[0].edges.size(), 12u);
  EXPECT_EQ(found.faults[0].begin.kind, EndKind::grid_edge);
  EXPECT_EQ(found.n_active_columns, 316);
  EXPECT_EQ(found.n_active_cells, 960 - 12 - 1);
  EXPECT_EQ(found.layers[1].n_inactive, 1);
  EXPECT_NEAR(found.compartments[0].area, 1300 * 1280 - 4 * 8000, 1e-6);
  EXPECT_NEAR(found.compartments[1].volume, 700 * 1280 * 45 - 8000 * 20, 1e-4);
  EXPECT_EQ(found.compartment_of_cell[7], -1);
  EXPECT_THAT(text_of(found), HasSubstr("1 inactive cell in active columns"));
}

/// Two columns beside the fault and two on its other side, which the others enclose.
TEST(GridStructure, FaultsGoOnThroughHoles) {
  MadeGrid grid = with_straight_fault();
  const GridStructure whole = recognise_structure(made(grid), {});
  grid.inactive = {{6, 5, -1}, {6, 9, -1}, {7, 5, -1}, {7, 10, -1}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].edges.size(), whole.faults[0].edges.size());
  EXPECT_NEAR(found.faults[0].largest_offset, whole.faults[0].largest_offset, 1e-9);
  EXPECT_EQ(found.compartments.size(), 2u);
  EXPECT_EQ(found.n_active_columns, 316);
  EXPECT_EQ(found.n_hole_columns, 4);
  EXPECT_THAT(text_of(found), HasSubstr("4 inactive columns enclosed by active ones"));
}

/// Nobody says where inactive cells lie: at the surface, or with the bottom above the top.
TEST(GridStructure, HolesWhoseCellsLieElsewhereAreNone) {
  MadeGrid grid = with_straight_fault();
  grid.inactive = {{6, 5, -1}};
  const CornerPointGrid whole = made(grid);
  EXPECT_EQ(recognise_structure(whole, {}).n_hole_columns, 1);
  for (const bool is_upright : {true, false}) {
    CornerPointGrid broken = whole;
    for (int k = 0; k < 3; ++k)
      for (const bool right : {false, true})
        for (const bool back : {false, true}) {
          const std::size_t top = broken.corner_index(broken.column(6, 5), k, {right, back, false}),
                            base = broken.corner_index(broken.column(6, 5), k, {right, back, true});
          if (is_upright) broken.corner_z[top] = broken.corner_z[base] = 0;
          if (!is_upright) std::swap(broken.corner_z[top], broken.corner_z[base]);
        }
    EXPECT_EQ(recognise_structure(broken, {}).n_hole_columns, 0) << is_upright;
  }
}

/// Neighbours whose active layers have nothing in common are compared in all.
TEST(GridStructure, ComparesAllLayersWhereNoneIsActiveOnBothSides) {
  MadeGrid grid = with_straight_fault();
  for (int j = 0; j < 16; ++j)
    for (const int k : {1, 2}) grid.inactive.push_back({6, j, k});
  for (int j = 0; j < 16; ++j)
    for (const int k : {0, 1}) grid.inactive.push_back({7, j, k});
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_NEAR(found.faults[0].largest_offset, 30, 1e-9);
}

/// Of the offset counts what both sides have: an inactive layer that lies elsewhere says nothing.
TEST(GridStructure, ComparesLayersThatAreActiveOnBothSides) {
  MadeGrid grid = with_straight_fault();
  for (int j = 0; j < 16; ++j) grid.inactive.push_back({7, j, 0});
  CornerPointGrid broken = made(grid);
  for (int j = 0; j < 16; ++j) {
    for (const bool right : {false, true}) {
      for (const bool back : {false, true})
        broken.corner_z[broken.corner_index(broken.column(7, j), 0, {right, back, false})] += 500;
    }
  }
  const GridStructure found = recognise_structure(broken, {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_NEAR(found.faults[0].largest_offset, 30, 1e-9);
}

TEST(GridStructure, SaysWhatHasCollapsed) {
  MadeGrid grid = with_straight_fault();
  grid.thickness = {10, 0, 15};
  CornerPointGrid squeezed = made(grid);
  for (const bool right : {false, true}) {
    for (const bool back : {false, true}) {
      squeezed.corner_z[squeezed.corner_index(319, 0, {right, back, false})] =
          squeezed.z(319, 0, {right, back, true});
    }
  }
  const GridStructure found = recognise_structure(squeezed, {});
  EXPECT_EQ(found.n_collapsed_cells, 321);
  EXPECT_TRUE(found.layers[1].is_collapsed);
  EXPECT_FALSE(found.layers[0].is_collapsed);
  EXPECT_EQ(found.layers[0].n_collapsed, 1);
  EXPECT_THAT(text_of(found), HasSubstr("321 cells have no thickness; wholly collapsed layers: 2; "
                                        "layers with collapsed cells: 1 (1)"));
}

TEST(GridStructure, HasBothSurfacesOfAGap) {
  CornerPointGrid grid = made(with_straight_fault());
  for (int column = 0; column < grid.n_columns(); ++column) {
    for (const bool right : {false, true}) {
      for (const bool back : {false, true})
        grid.corner_z[grid.corner_index(column, 0, {right, back, true})] += 4;
    }
  }
  const GridStructure found = recognise_structure(grid, {});
  ASSERT_EQ(found.horizons.size(), 5u);
  EXPECT_TRUE(found.horizons[1].is_base);
  EXPECT_NEAR(found.horizons[1].points[0].position.z() - found.horizons[2].points[0].position.z(),
              4, 1e-9);
  EXPECT_NEAR(found.largest_gap, 4, 1e-9);
  EXPECT_THAT(text_of(found), HasSubstr("gaps of up to 4 m"));
}

/// Pillars 49 to 67 degrees from the vertical, obliquely to the fault, as real fields have them.
TEST(GridStructure, MeasuresTheDipOfFaultsByTheirPillars) {
  for (const double angle : {49.0, 58.0, 67.0}) {
    for (const double across : {1.0, -1.0, 0.6}) {
      MadeGrid grid = with_straight_fault();
      const double lean = std::tan(angle * kDegree);
      grid.lean = {lean * across, lean * std::sqrt(1 - across * across)};
      const GridStructure found = recognise_structure(made(grid), {.reference_z = -2000});
      ASSERT_EQ(found.faults.size(), 1u);
      const Fault& fault = found.faults[0];
      EXPECT_NEAR(fault.pillar_angle.median, angle * kDegree, 1e-9);
      const double dip = std::atan(1 / (lean * std::abs(across)));
      EXPECT_NEAR(fault.dip.median, dip, 1e-9);
      EXPECT_NEAR(fault.dip.most - fault.dip.least, 0, 1e-9);
      EXPECT_NEAR(fault.dip_direction, (across > 0 ? 90 : 270) * kDegree, 1e-9);
      EXPECT_NEAR(fault.direction_spread, 0, 1e-9);
      EXPECT_EQ(fault.dips_towards, across > 0 ? Side::right : Side::left);
      EXPECT_EQ(fault.is_normal(), across > 0);
      EXPECT_LT((fault.trace[0] - Eigen::Vector2d(700, 0)).norm(), 1e-3);
      // 100 m below, the trace has gone with the pillars.
      const GridStructure below = recognise_structure(made(grid), {.reference_z = -2100});
      EXPECT_NEAR(below.faults[0].trace[0].x(), 700 + 100 * grid.lean.x(), 1e-3);
    }
  }
}

/// Pillars that lean more and more along the fault.
TEST(GridStructure, HasTheSpreadOfDips) {
  CornerPointGrid grid = made(with_straight_fault());
  for (int j = 0; j <= 16; ++j) {
    Pillar& pillar = grid.pillars[static_cast<std::size_t>(grid.pillar(7, j))];
    const double angle = (10 + 2 * j) * kDegree;  // from the vertical
    pillar.top.x() = 700 - 500 * std::tan(angle);
    pillar.bottom.x() = 700 + 500 * std::tan(angle);
  }
  const GridStructure found = recognise_structure(grid, {.reference_z = -2000});
  ASSERT_EQ(found.faults.size(), 1u);
  const Spread& dip = found.faults[0].dip;
  EXPECT_NEAR(dip.median, 64 * kDegree, 1e-9);
  EXPECT_NEAR(dip.most, 80 * kDegree, 1e-9);
  EXPECT_NEAR(dip.least, 48 * kDegree, 1e-9);
  EXPECT_NEAR(found.faults[0].pillar_angle.most, 42 * kDegree, 1e-9);
}

TEST(GridStructure, HasBothSidesLowerAlongAHinge) {
  const MadeGrid grid{.faults = {{{700, 0}, {700, 1280}, [](double s) { return 30 - 60 * s; }}}};
  const GridStructure found = recognise_structure(made(grid), {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].down, Side::both);
  EXPECT_EQ(found.faults[0].edges.size(), 16u);
  EXPECT_NEAR(found.faults[0].offset[4], 15, 1e-9);
  EXPECT_NEAR(found.faults[0].offset[12], -15, 1e-9);
  EXPECT_EQ(found.n_bridged, 2);  // from 3.75 through 0 to -3.75 m
  EXPECT_TRUE(found.left_out.empty());
  EXPECT_THAT(text_of(found), HasSubstr("2 pillar edges of smaller offsets between the tips"));
  const GridStructure apart = recognise_structure(made(grid), {.bridge_gaps = false});
  EXPECT_EQ(apart.faults.size(), 2u);
  EXPECT_EQ(apart.left_out.size(), 1u);
}

TEST(GridStructure, LeavesShortChainsOutAndSaysSo) {
  CornerPointGrid grid = made(with_straight_fault());
  for (int k = 0; k < 3; ++k) {  // at one pillar the two columns west of it
    for (const bool bottom : {false, true}) {
      grid.corner_z[grid.corner_index(grid.column(14, 5), k, {true, true, bottom})] -= 12;
      grid.corner_z[grid.corner_index(grid.column(14, 6), k, {true, false, bottom})] -= 12;
    }
  }
  const GridStructure found = recognise_structure(grid, {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  ASSERT_EQ(found.left_out.size(), 1u) << text_of(found);
  EXPECT_EQ(found.left_out[0].reason, LeftOutReason::short_chain);
  EXPECT_NEAR(found.left_out[0].largest_offset, 12, 1e-9);
  EXPECT_EQ(found.left_out[0].n_edges, 2);
  EXPECT_LT((found.left_out[0].low - Eigen::Vector2d(1500, 400)).norm(), 1e-9);
  EXPECT_LT((found.left_out[0].high - Eigen::Vector2d(1500, 560)).norm(), 1e-9);
  EXPECT_NEAR(found.horizons[0].largest_step, 12, 1e-9);
  EXPECT_EQ(recognise_structure(grid, {.fewest_edges = 1}).faults.size(), 2u);
}

TEST(GridStructure, TakesConnectionsForFaultsOnRequest) {
  CornerPointGrid grid = made(with_straight_fault(3));
  for (int j = 0; j < 16; ++j) {
    grid.connections.push_back({grid.cell(grid.column(6, j), 1), grid.cell(grid.column(7, j), 0)});
  }
  const GridStructure without = recognise_structure(grid, {});
  EXPECT_TRUE(without.faults.empty());
  ASSERT_EQ(without.left_out.size(), 1u);
  EXPECT_EQ(without.left_out[0].n_edges, 16);
  EXPECT_EQ(without.n_connections, 16);
  EXPECT_EQ(without.n_connections_on_faults, 0);
  const GridStructure with = recognise_structure(grid, {.faults_by_connections = true});
  ASSERT_EQ(with.faults.size(), 1u);
  EXPECT_NEAR(with.faults[0].offset[0], 3, 1e-9);
  EXPECT_EQ(with.n_connections_on_faults, 16);
}

TEST(GridStructure, HasCompartmentsByRegionOnRequest) {
  CornerPointGrid grid = made(with_straight_fault());
  for (int cell = 0; cell < grid.n_cells(); ++cell)
    grid.fluid_region.push_back(cell < grid.n_columns() ? 4 : 2);
  const GridStructure found =
      recognise_structure(grid, {.compartments = CompartmentRule::fluid_regions});
  ASSERT_EQ(found.compartments.size(), 2u);
  EXPECT_EQ(found.compartments[0].region, 2);
  EXPECT_NEAR(found.compartments[1].volume, 2000 * 1280 * 10, 1e-4);
  EXPECT_NEAR(found.compartments[0].mean_top - found.compartments[0].mean_base, 35, 1e-9);
  EXPECT_EQ(found.horizons[0].points[0].compartment, 1);
  EXPECT_EQ(found.horizons[1].points[0].compartment, 0);
}

/// Layers 0, 2 and 5 of six are active and of a region each.
TEST(GridStructure, InactiveLayersAreOfTheNextActiveOnesUpwardsFirst) {
  MadeGrid spec{.size = {4, 3, 6}, .thickness = {10, 10, 10, 10, 10, 10}};
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i)
      for (const int k : {1, 3, 4}) spec.inactive.push_back({i, j, k});
  }
  CornerPointGrid grid = made(spec);
  for (int cell = 0; cell < grid.n_cells(); ++cell)
    grid.fluid_region.push_back(cell / grid.n_columns());
  const GridStructure found =
      recognise_structure(grid, {.compartments = CompartmentRule::fluid_regions});
  ASSERT_EQ(found.compartments.size(), 3u);
  std::vector<int> compartments;
  for (const Horizon& horizon : found.horizons)
    compartments.push_back(horizon.points[0].compartment);
  EXPECT_THAT(compartments, testing::ElementsAre(0, 0, 1, 1, 2, 2, 2));
}

CornerPointGrid with_a_ring() {
  CornerPointGrid grid = made({});
  for (int j = 5; j < 9; ++j) {
    for (int i = 6; i < 11; ++i) {
      for (int k = 0; k < 3; ++k) {
        for (int corner = 0; corner < 8; ++corner)
          grid.corner_z[grid.corner_index(
              grid.column(i, j), k, {corner % 2 == 1, corner / 2 % 2 == 1, corner > 3})] -= 25;
      }
    }
  }
  return grid;
}

TEST(GridStructure, FindsARing) {
  const GridStructure found = recognise_structure(with_a_ring(), {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].edges.size(), 18u);
  EXPECT_EQ(found.faults[0].begin.kind, EndKind::closed);
  EXPECT_EQ(found.faults[0].trace.front(), found.faults[0].trace.back());
  for (const double offset : found.faults[0].offset) EXPECT_NEAR(std::abs(offset), 25, 1e-9);
  ASSERT_EQ(found.compartments.size(), 2u);
  EXPECT_EQ(found.compartments[1].n_columns, 20);
}

/// A spur that goes straight on where the fault turns does not take its place.
TEST(GridStructure, CutsSpursOffCorners) {
  CornerPointGrid grid = with_a_ring();
  for (int k = 0; k < 3; ++k) {
    for (const bool bottom : {false, true})
      grid.corner_z[grid.corner_index(grid.column(5, 5), k, {true, false, bottom})] -= 12;
  }
  const GridStructure found = recognise_structure(grid, {});
  ASSERT_EQ(found.faults.size(), 1u) << text_of(found);
  EXPECT_EQ(found.faults[0].edges.size(), 18u);
  EXPECT_EQ(found.faults[0].begin.kind, EndKind::closed);
  ASSERT_EQ(found.left_out.size(), 1u);
  EXPECT_EQ(found.left_out[0].n_edges, 1);
}

TEST(GridStructure, RefusesOptionsWithAllThatIsWrong) {
  const CornerPointGrid grid = made(with_straight_fault());
  const StructureOptions wrong{.least_offset = -1,
                               .negligible_offset = 0,
                               .fewest_edges = 0,
                               .straightening = 0,
                               .compartments = CompartmentRule::equilibrium_regions,
                               .no_thickness = -1};
  try {
    recognise_structure(grid, wrong);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 6u);
    EXPECT_THAT(error.what(), HasSubstr("/least_offset: -1 m is below negligible_offset"));
    EXPECT_THAT(error.what(), HasSubstr("EQLNUM is missing; put the INIT file beside the grid"));
  }
}

}  // namespace
}  // namespace faultsim::corner_point
