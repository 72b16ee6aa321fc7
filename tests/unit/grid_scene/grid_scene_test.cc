#include "simulator/grid_scene/grid_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/grid_pictures.h"
#include "simulator/grid_scene/line_check.h"
#include "simulator/grid_scene/mesh_size.h"
#include "simulator/grid_scene/outline.h"
#include "simulator/grid_scene/trace_ends.h"
#include "simulator/horizons/body_check.h"
#include "simulator/horizons/cut_map.h"
#include "tests/unit/grid_scene/made_scene.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::cross_product;
using corner_point::made;
using corner_point::MadeGrid;
using corner_point::nearest_on_line;
using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

const corner_point::MadeFault kLine{{900, -200}, {2100, 2200}};

TEST(GridScene, DrawsAFaultOnItsLineWithItsDipAndReach) {
  const MadeScene all = scene_of(made(grid_of_a_fault(0.5)));
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  const ModelFault& fault = all.made.lines.faults[0];
  for (const Vector2d& at : fault.trace) {
    // The trace is drawn at the reservoir's depth; the line was made where pillars do not lean.
    const Vector2d before(at.x() - 0.5 * (-2000 - all.made.lines.reference_z), at.y());
    EXPECT_LT(distance_from_line(kLine, before), 50);
  }
  // Right of a trace that goes north-east lies the east, where pillars lean to.
  const double across = 0.5 * 2400 / std::hypot(1200, 2400);
  ASSERT_EQ(fault.leans.size(), 1u) << "pillars that dip alike";
  EXPECT_NEAR(fault.leans[0], across, 0.05);
  const std::string dip = all.made.scene["faults"][0]["dip_from_vertical"];
  EXPECT_NEAR(std::stod(dip), std::atan(across) * 180 / std::numbers::pi, 2);
  double highest = -1e9, lowest = 1e9;
  for (const Vector3d& at : all.made.surfaces[0].points) {
    if (nearest_on_line(fault.trace, at.head<2>()).distance > 120) continue;
    highest = std::max(highest, at.z());
  }
  for (const Vector3d& at : all.made.surfaces[1].points) {
    if (nearest_on_line(fault.trace, at.head<2>()).distance > 120) continue;
    lowest = std::min(lowest, at.z());
  }
  EXPECT_NEAR(fault.top, highest + 150, 10);
  EXPECT_NEAR(fault.bottom, lowest - 150, 10);
}

TEST(GridScene, LetsFaultsEndOutsideOfTheOutlineAndParts) {
  const MadeScene all = scene_of(made(grid_of_a_fault(0.5)));
  const ModelLines& lines = all.made.lines;
  ASSERT_EQ(lines.outlines.size(), 1u);
  const ModelFault& fault = lines.faults[0];
  for (const Vector2d& tip : {fault.trace.front(), fault.trace.back()}) {
    EXPECT_FALSE(is_within(lines.outlines, tip));
    EXPECT_GT(nearest_on_line(closed(lines.outlines[0]), tip).distance, 180);  // 4 m for 1 m throw
    EXPECT_GT((tip - lines.low).minCoeff(), 4000);
    EXPECT_GT((lines.high - tip).minCoeff(), 4000);
  }
  ASSERT_EQ(all.made.compartments.size(), 2u);
  for (const ModelCompartment& one : all.made.compartments) {
    const double side =
        cross_product(fault.trace.back() - fault.trace.front(), one.inside - fault.trace.front());
    // The right side lies deeper.
    const double other = all.structure.compartments[1 - one.source].mean_top;
    EXPECT_EQ(side > 0, all.structure.compartments[one.source].mean_top > other);
    EXPECT_TRUE(is_within(lines.outlines, one.inside));
  }
  EXPECT_EQ(first_misfit(lines), std::nullopt);
}

/// Upright pillars: a surface is known wherever it is.
TEST(GridScene, HasPointsOfBothSidesBesideAFaultWithItsThrow) {
  const MadeScene all = scene_of(made(grid_of_a_fault(0)));
  const ModelFault& fault = all.made.lines.faults[0];
  std::array<int, 2> n = {0, 0};
  for (const Vector3d& at : all.made.surfaces[0].points) {
    const auto on = nearest_on_line(fault.trace, at.head<2>());
    if (on.along == 0 || on.distance > 1.01 || !is_within(all.made.lines.outlines, on.point))
      continue;
    const Vector2d along = fault.trace[1] - fault.trace[0];
    const bool is_right = cross_product(along, at.head<2>() - fault.trace[0]) < 0;
    EXPECT_NEAR(at.z(), corner_point::made_top(at.head<2>()) - (is_right ? 60 : 0), 0.3);
    EXPECT_NEAR(on.distance, 1, 0.01);
    n[is_right ? 0 : 1] += 1;
  }
  EXPECT_GT(n[0], 20);
  EXPECT_GT(n[1], 20);
}

/// Rock right of an oblique fault that dips away from it by `slope` more than on its left, on
/// pillars that lean across the fault.
corner_point::CornerPointGrid grid_with_drag(double lean, double slope) {
  MadeGrid plan = grid_of_a_fault(0);
  const Vector2d along = (plan.faults[0].to - plan.faults[0].from).normalized();
  const Vector2d right(along.y(), -along.x());
  plan.lean = lean * right;
  corner_point::CornerPointGrid grid = made(plan);
  std::size_t corner = 0;
  for (int plane = 0; plane < 2 * grid.size[2]; ++plane)
    for (int row = 0; row < 2 * grid.size[1]; ++row)
      for (int place = 0; place < 2 * grid.size[0]; ++place, ++corner) {
        const Vector2d pillar((place + 1) / 2 * plan.dx, (row + 1) / 2 * plan.dy),
            column((place / 2 + 0.5) * plan.dx, (row / 2 + 0.5) * plan.dy);
        if (right.dot(column - plan.faults[0].from) > 0)
          grid.corner_z[corner] -= slope * right.dot(pillar - plan.faults[0].from);
      }
  return grid;
}

/// Per pillar of the only fault but the last ones, how far along the trace it stands, m, and how
/// much lower the right side is there, by the corners of the grid's top.
std::vector<std::pair<double, double>> throws_of_grid(const MadeScene& all) {
  const corner_point::ColumnMap map(all.grid);
  const auto top = [&](int column, int pillar) {
    return all.grid.z(column, 0, map.corner_at(column, pillar));
  };
  const std::vector<corner_point::FaultEdge>& edges = all.structure.faults.at(0).edges;
  std::vector<std::pair<double, double>> throws;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const int pillar = edges[e].to;
    const Vector2d at = all.grid.pillars[pillar].at(all.made.lines.reference_z);
    throws.emplace_back(nearest_on_line(all.made.lines.faults[0].trace, at).along,
                        top(edges[e].left, pillar) - top(edges[e].right, pillar));
  }
  return throws;
}

/// Points of a surface a metre beside the only fault, left and right of it: along the trace, m, and
/// z.
std::array<std::vector<std::pair<double, double>>, 2> points_beside(const MadeScene& all,
                                                                    const ModelSurface& surface) {
  std::array<std::vector<std::pair<double, double>>, 2> sides;
  for (const Vector3d& at : surface.points) {
    const Polyline line = all.made.lines.faults[0].at(at.z(), all.made.lines.reference_z);
    const auto on = nearest_on_line(line, at.head<2>());
    if (on.distance > 1.5) continue;
    const bool is_right =
        cross_product(line[on.piece + 1] - line[on.piece], at.head<2>() - line[on.piece]) < 0;
    sides[is_right ? 1 : 0].emplace_back(on.along, at.z());
  }
  return sides;
}

/// Pillars of a grid stand up to half a cell from the straight line that is the model's fault. By
/// the slopes of each side their throws would differ there by 0.15 of that way; and a fault that
/// dips is elsewhere at the height that they have then.
TEST(GridScene, KeepsTheThrowOfEachPillarWhereItsSidesSlopeDifferently) {
  const MadeScene all = scene_of(grid_with_drag(1.2, 0.15));
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  const auto throws = throws_of_grid(all);
  ASSERT_GT(throws.size(), 30u);
  for (const ModelSurface& surface : all.made.surfaces) {
    const auto [left, right] = points_beside(all, surface);
    double least = 1e300, largest = 0;
    for (const auto& [along, down] : throws) {
      const auto nearest = [&, at = along](const auto& side) {
        return *std::ranges::min_element(
            side, {}, [&](const auto& point) { return std::abs(point.first - at); });
      };
      const auto l = nearest(left), r = nearest(right);
      EXPECT_NEAR(l.first, along, 10) << "no point of the left side";
      EXPECT_NEAR(r.first, along, 10) << "no point of the right side";
      // The base is taken some metres along the fault from the corners of the grid, which lean a
      // little along the trace.
      EXPECT_NEAR(l.second - r.second, down, surface.thickness.empty() ? 0.01 : 2) << along;
      least = std::min(least, down);
      largest = std::max(largest, down);
    }
    EXPECT_GT(largest - least, 5) << "else nothing was shown";
  }
}

/// A fault that dips by 45 degrees, and four columns that rise against it by 60 m each: between
/// leaning pillars by 1.5. The reservoir is 40 m thick on all pillars.
TEST(GridScene, KeepsAConstantThicknessOfColumnsThatAreSteepAgainstAFault) {
  const MadeGrid plan{.size = {16, 8, 2}, .dy = 100, .lean = {1, 0}, .thickness = {20, 20}};
  corner_point::CornerPointGrid grid = made(plan);
  std::size_t corner = 0;
  for (int plane = 0; plane < 2 * plan.size[2]; ++plane)
    for (int row = 0; row < 2 * plan.size[1]; ++row)
      for (int place = 0; place < 2 * plan.size[0]; ++place, ++corner) {
        const double depth = 1800 + 20 * ((plane + 1) / 2) + (place / 2 >= 8 ? 60 : 0);
        grid.corner_z[corner] = 60 * std::clamp((place + 1) / 2 - 6, 0, 4) - depth;
      }
  GridSceneOptions options;
  options.lines = {.margin = 2000, .base_depth = 4000, .strike = 100};
  const MadeScene all = scene_of(grid, {}, options);
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  ASSERT_EQ(all.made.surfaces.size(), 2u);
  const ModelSurface& base = all.made.surfaces[1];
  ASSERT_GT(base.points.size(), 100u);
  for (std::size_t p = 0; p < base.points.size(); ++p)
    EXPECT_NEAR(base.thickness[p], 40, 1) << base.points[p].transpose();
  EXPECT_FALSE(says(all.made.remarks, "by leaps"));
}

TEST(GridScene, IsTheSceneOfTheContract) {
  const GridScene made_scene = scene_of(made(grid_of_a_fault(0.5))).made;
  const nlohmann::ordered_json& scene = made_scene.scene;
  EXPECT_EQ(scene["geometry"]["kind"], "horizons");
  const auto& layers = scene["geometry"]["layers"];
  ASSERT_EQ(layers.size(), 3u);
  EXPECT_EQ(layers[0]["top"], "0 m");
  EXPECT_EQ(layers[1]["top"]["csv"], "field-reservoir.csv");
  EXPECT_EQ(layers[2]["name"], "underburden");
  ASSERT_EQ(made_scene.tables.size(), 2u);
  EXPECT_EQ(made_scene.tables[0].name, "field-reservoir.csv");
  EXPECT_THAT(made_scene.tables[0].text, testing::StartsWith("x [m],y [m],depth [m]\n"));
  EXPECT_FALSE(scene["faults"][0].contains("throw"));
  EXPECT_EQ(scene["geometry"]["compartments"][1]["layers"][0], "reservoir");
  EXPECT_EQ(scene["stages"][0]["pressure_change"], "-100 bar");
  EXPECT_TRUE(says(made_scene.remarks, "no reports"));
  // Rock of 2200 and, half of the reservoir, 2400 kg/m3.
  const double gradient =
      std::stod(scene["initial_state"]["vertical_stress_gradient"].get<std::string>());
  EXPECT_LT(gradient, -21.58);
  EXPECT_GT(gradient, -22);
}

TEST(GridScene, HasNothingOfFaultsWhereThereAreNone) {
  const GridScene made_scene = scene_of(made(MadeGrid{})).made;
  for (const char* key : {"faults", "friction", "fault_pressure"})
    EXPECT_FALSE(made_scene.scene.contains(key)) << key;
  EXPECT_EQ(made_scene.compartments.size(), 1u);
  EXPECT_EQ(made_scene.lines.dividers.size(), 2u);
}

TEST(GridScene, TakesPressuresAndDatesOfReports) {
  FlowField field;
  field.cells = {{{0, 0, -2010}, {100, 100, -1990}}, {{0, 0, -2110}, {100, 100, -2090}}};
  field.date = {0, 86400.0 * 365, 86400.0 * 730 + 3600};
  field.value.resize(2, 3);
  field.value << 2.2e7, 2e7, 1.8e7, 2.3e7, 2e7, 1.8e7;
  const GridScene made_scene = scene_of(made(grid_of_a_fault(0.5)), {}, {}, &field).made;
  const nlohmann::ordered_json& scene = made_scene.scene;
  EXPECT_EQ(scene["pressure_field"]["file"], "FIELD.EGRID");
  EXPECT_EQ(scene["stages"][0]["until"], "1972-01-01T01:00:00");
  EXPECT_EQ(scene["initial_state"]["pressure"], "20 bar");
}

TEST(GridScene, KeepsThinReservoirsApart) {
  MadeGrid grid = grid_of_a_fault(0);
  grid.thickness = {0.5, 0, 1};
  const MadeScene all = scene_of(made(grid));
  EXPECT_TRUE(says(all.made.remarks, "the reservoir is 1.5 m thick at its thinnest"));
  const double least = 0.06 * all.made.lines.strike;
  const std::vector<Vector3d>&top = all.made.surfaces[0].points,
        &base = all.made.surfaces[1].points;
  ASSERT_EQ(top.size(), base.size());
  for (std::size_t p = 0; p < top.size(); ++p) EXPECT_GE(top[p].z() - base[p].z(), least - 0.1);
}

/// The rock of a thin reservoir is not doubled for the sake of its cells.
TEST(GridScene, LeavesReservoirsAsThinAsTheyAre) {
  MadeGrid grid = grid_of_a_fault(0);
  grid.thickness = {2, 2, 2};
  const GridScene made_scene = scene_of(made(grid)).made;
  ASSERT_GT(0.2 * made_scene.lines.strike, 6);
  ASSERT_LT(0.06 * made_scene.lines.strike, 6);
  const std::vector<double>& thickness = made_scene.surfaces[1].thickness;
  EXPECT_NEAR(std::accumulate(thickness.begin(), thickness.end(), 0.0) /
                  static_cast<double>(thickness.size()),
              6, 0.3);
}

TEST(GridScene, HasLayersOfTheGridOnRequest) {
  GridSceneOptions options;
  options.surfaces.every = 1;
  options.surfaces.least_layer = 12;
  const GridScene made_scene = scene_of(made(grid_of_a_fault(0)), {}, options).made;
  ASSERT_EQ(made_scene.surfaces.size(), 3u);  // 10 m of the first layer are too few
  EXPECT_EQ(made_scene.surfaces[1].layer, 2);
  EXPECT_TRUE(says(made_scene.remarks, "the tops of layers 2 of the grid"));
  EXPECT_EQ(made_scene.scene["geometry"]["compartments"][0]["layers"].size(), 2u);
  EXPECT_EQ(made_scene.scene["geometry"]["layers"][2]["material"], "reservoir");
}

TEST(GridScene, GoesOnFromTipsOnRequest) {
  MadeGrid grid = grid_of_a_fault(0);
  grid.faults = {{{1000, -200}, {1500, 1100}, [](double s) { return s < 1 ? 60.0 : 0.0; }}};
  EXPECT_EQ(scene_of(made(grid)).made.compartments.size(), 1u);
  const MadeScene all = scene_of(made(grid), {.extend_faults = true});
  EXPECT_EQ(all.made.compartments.size(), 2u);
  ASSERT_EQ(all.made.lines.dividers.size(), 3u);
  EXPECT_EQ(all.made.lines.dividers[0].name, "on_from_F1");
}

/// Columns of the active map, counted over it, in parts of the map that no compartment has.
std::vector<int> columns_in_none(const MadeScene& all) {
  horizons::LayeredBody body = body_of_lines(all.made.lines);
  for (const ModelCompartment& one : all.made.compartments)
    body.compartments.push_back({one.name, one.inside, {}, one.also});
  std::vector<Problem> problems;
  const horizons::MapMesh map =
      horizons::mesh_map(body, horizons::meeting_lines(body, problems), problems);
  const std::vector<int> filled = horizons::fill_compartments(map, body.compartments, problems);
  EXPECT_TRUE(problems.empty());
  const corner_point::ColumnMap columns(all.grid);
  std::vector<Vector2d> middles;
  for (int column = 0; column < all.grid.n_columns(); ++column) {
    if (!columns.is_inside(column)) continue;
    const auto [i, j] = all.grid.place(column);
    middles.emplace_back(100 * (i + 0.5), 80 * (j + 0.5));
  }
  std::vector<int> none;
  const std::vector<int> around = horizons::triangles_around(map, middles);
  for (std::size_t c = 0; c < around.size(); ++c) {
    if (around[c] < 0 || filled[around[c]] < 0) none.push_back(static_cast<int>(c));
  }
  return none;
}

/// One equilibrium region on both sides of a fault is one compartment of two parts, whatever their
/// sizes; so is one that lies above another.
TEST(ModelCompartments, HaveAllPartsThatFaultsDivideThemInto) {
  MadeGrid plan{.size = {16, 12, 2}, .thickness = {20, 20}};
  plan.faults = {{{1200, -200}, {1200, 1200}, [](double) { return 60.0; }}};
  corner_point::CornerPointGrid grid = made(plan);
  for (const bool is_layered : {false, true}) {
    grid.equilibrium_region.assign(grid.is_active.size(), 1);
    const std::size_t half = grid.is_active.size() / 2;
    if (is_layered)
      std::fill(grid.equilibrium_region.begin() + static_cast<std::ptrdiff_t>(half),
                grid.equilibrium_region.end(), 2);
    const MadeScene all =
        scene_of(grid, {.compartments = corner_point::CompartmentRule::equilibrium_regions});
    ASSERT_EQ(all.made.lines.faults.size(), 1u);
    ASSERT_EQ(all.made.compartments.size(), 1u);
    const ModelCompartment& one = all.made.compartments[0];
    ASSERT_EQ(one.also.size(), 1u);
    EXPECT_LT(one.inside.x(), 1200) << "the larger part first";
    EXPECT_GT(one.also[0].x(), 1200);
    EXPECT_EQ(columns_in_none(all), std::vector<int>());
    EXPECT_EQ(all.made.scene["geometry"]["compartments"][0]["also_inside"].size(), 1u);
    EXPECT_TRUE(says(all.made.remarks, "is in 2 parts between lines of the model"));
    EXPECT_FALSE(says(all.made.remarks, "in no compartment"));
    EXPECT_EQ(says(all.made.remarks, "is part of another one in the model"), is_layered);
  }
}

/// A strip between two faults that is too narrow for the mesh is said with its columns.
TEST(ModelCompartments, SayHowManyColumnsAreInNone) {
  MadeGrid plan{.size = {16, 12, 2}, .thickness = {20, 20}};
  plan.faults = {{{700, -200}, {700, 1200}, [](double) { return 60.0; }},
                 {{800, -200}, {800, 1200}, [](double) { return 60.0; }}};
  GridSceneOptions options;
  options.lines.strike = 95;
  const MadeScene all = scene_of(made(plan), {}, options);
  const std::size_t n_none = columns_in_none(all).size();
  EXPECT_EQ(all.made.lines.faults.size(), 2u);
  EXPECT_EQ(n_none, 0u);
  options.lines.strike = 101;
  const MadeScene coarse = scene_of(made(plan), {}, options);
  EXPECT_EQ(coarse.made.lines.faults.size(), 2u);
  EXPECT_TRUE(says(coarse.made.remarks,
                   concat("no compartment of the model has ", columns_in_none(coarse).size(),
                          " of 192 columns within the outline")));
}

/// Beside a hole that the outline takes in there is no edge: the fault ends in the rock, and is not
/// led to another edge. What is inactive there is nowhere, else the map takes it in itself.
TEST(GridScene, LeavesAFaultInTheRockThatEndsAtAHoleTakenIn) {
  MadeGrid plan{.size = {20, 24, 2}, .thickness = {20, 20}};
  plan.faults = {{{500, -200}, {500, 1000}, [](double s) { return s < 0.93 ? 60.0 : 0.0; }}};
  plan.inactive = {{5, 11, -1}};
  corner_point::CornerPointGrid grid = made(plan);
  for (std::size_t plane = 0; plane < 4; ++plane)
    for (const std::size_t row : {22, 23})
      for (const std::size_t place : {10, 11}) grid.corner_z[(plane * 48 + row) * 40 + place] = 0;
  const MadeScene all = scene_of(grid);
  ASSERT_EQ(all.structure.faults.size(), 1u);
  const corner_point::Fault& source = all.structure.faults[0];
  EXPECT_EQ(source.begin.kind, corner_point::EndKind::grid_edge);
  EXPECT_EQ(source.end.kind, corner_point::EndKind::grid_edge);
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  const Polyline& trace = all.made.lines.faults[0].trace;
  const Vector2d& north = trace.back().y() > trace.front().y() ? trace.back() : trace.front();
  const Vector2d& south = trace.back().y() > trace.front().y() ? trace.front() : trace.back();
  EXPECT_LT((north - Vector2d(500, 880)).norm(), 150) << north.transpose();
  EXPECT_LT(south.y(), -100) << "beyond the edge";
  EXPECT_EQ(columns_in_none(all), std::vector<int>());
}

/// By up to a cell the end is moved, from further away some cells of the trace are led there.
TEST(TraceEnds, AreLedToAFaultThatTheyDoNotTouch) {
  const Polyline other = {{0, -500}, {0, 500}};
  for (const double away : {40.0, 150.0}) {
    const Polyline trace = {{-1000, 0}, {-away, 10}};
    const Polyline led = led_to(trace, other, 100);
    EXPECT_LT(nearest_on_line(other, led.back()).distance, 1e-9) << away;
    EXPECT_LT(led.back().norm(), 20) << away;
    EXPECT_EQ(led.size(), away < 100 ? 2u : 3u);
  }
  const Polyline touches = {{-1000, 0}, {-1, 10}};
  EXPECT_EQ(led_to(touches, other, 100), touches);
}

ModelLines lines_in_a_box(const std::vector<ModelFault>& faults) {
  ModelLines lines;
  lines.low = {-5000, -5000};
  lines.high = {5000, 5000};
  lines.reference_z = -2000;
  lines.base = -4000;
  lines.strike = 100;
  lines.faults = faults;
  for (std::size_t f = 0; f < faults.size(); ++f) {
    ModelFault& fault = lines.faults[f];
    fault.name = concat("F", f + 1);
    fault.source = static_cast<int>(f);
    fault.top = -1800;
    fault.bottom = -2200;
  }
  return lines;
}

/// Two faults, 30 m from each other where a divider from west to east crosses both.
std::vector<ModelFault> near_each_other(double x) {
  return {{.name = "", .trace = {{x, -2000}, {x, 2000}}},
          {.name = "", .trace = {{x + 300, -2000}, {x + 30, 0}, {x + 300, 2000}}}};
}

ModelLines with_divider(const std::vector<ModelFault>& faults) {
  ModelLines lines = lines_in_a_box(faults);
  lines.dividers.push_back({"across", {{-5000, 0}, {5000, 0}}});
  return lines;
}

/// Without F2 the divider fits, and F3, which ends at F2, has to end in the rock.
TEST(LineCheck, BlamesAFaultThatOthersEndAt) {
  std::vector<ModelFault> faults = near_each_other(0);
  faults.push_back(
      {.name = "", .trace = {{1500, -1500}, {232.5, -1500}}, .last_end = LineEnd::fault});
  const std::optional<Misfit> misfit = first_misfit(with_divider(faults));
  ASSERT_TRUE(misfit);
  EXPECT_THAT(misfit->what, HasSubstr("meets two others"));
  EXPECT_EQ(misfit->fault, 1);
}

/// Of that the scene is told, which is written all the same.
TEST(LineCheck, BlamesNoFaultForCellsThatAreTooSmall) {
  ModelLines lines = lines_in_a_box({{.name = "", .trace = {{0, -2000}, {0, 2000}}}});
  lines.strike = 1;
  std::vector<Problem> problems;
  horizons::check_numbers(body_of_lines(lines), problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/cells");
  EXPECT_FALSE(first_misfit(lines));
}

/// Two such places: no fault alone cures both.
TEST(LineCheck, BlamesOneOfTwoFaultsThatDoNotFitOnRequest) {
  std::vector<ModelFault> faults = near_each_other(-1500);
  for (const ModelFault& one : near_each_other(1500)) faults.push_back(one);
  const std::optional<Misfit> of_all = first_misfit(with_divider(faults)),
                              of_the_first =
                                  first_misfit(with_divider(faults), Blame::of_the_first);
  ASSERT_TRUE(of_all && of_the_first);
  EXPECT_EQ(of_all->fault, -1);
  EXPECT_TRUE(of_the_first->fault == 1 || of_the_first->fault == 3) << of_the_first->fault;
}

/// Faults of square cells 100 m wide.
MadeScene scene_of_squares(std::array<int, 3> size, std::vector<corner_point::MadeFault> faults,
                           const corner_point::StructureOptions& structure = {}) {
  GridSceneOptions options;
  options.lines.strike = 100;
  return scene_of(
      made({.size = size, .dy = 100, .thickness = {20, 20}, .faults = std::move(faults)}),
      structure, options);
}

/// Straight sides with a fault at the middle of each.
TEST(GridScene, PartsARectangleWithFaultsAtTheMiddlesOfItsSides) {
  const auto step = [](double) { return 60.0; };
  const corner_point::MadeFault north{{600, -200}, {600, 1000}, step},
      east{{-200, 400}, {1400, 400}, step}, half{{-200, 400}, {1400, 400}, step, 0};
  const MadeScene x = scene_of_squares({12, 8, 2}, {north, east});
  EXPECT_EQ(x.made.lines.faults.size(), 2u);
  EXPECT_EQ(x.made.compartments.size(), 4u);
  EXPECT_EQ(first_misfit(x.made.lines), std::nullopt);
  const MadeScene t = scene_of_squares({12, 8, 2}, {north, half});
  EXPECT_EQ(t.made.lines.faults.size(), 2u);
  EXPECT_EQ(t.made.compartments.size(), 3u);
  EXPECT_EQ(first_misfit(t.made.lines), std::nullopt);
}

/// What goes on from a tip reaches the middle of a side too.
TEST(GridScene, PartsARectangleAwayFromLinesOnFromTips) {
  const MadeScene all = scene_of_squares(
      {24, 24, 2},
      {{{1200, 0}, {1200, 2400}, [](double s) { return std::max(0.0, 60 - 144 * s); }}},
      {.extend_faults = true});
  EXPECT_EQ(all.made.lines.faults.size(), 1u);
  EXPECT_EQ(all.made.lines.dividers.size(), 3u);
  EXPECT_EQ(all.made.compartments.size(), 2u);
  EXPECT_EQ(first_misfit(all.made.lines), std::nullopt);
}

/// Cells eight times as long as wide: half a cell is half of the side across the outline.
TEST(Outline, HoldsTheColumnsOfLongNarrowCells) {
  const MadeScene all =
      scene_of(made({.size = {5, 20, 2}, .dx = 50, .dy = 400, .thickness = {20, 20}}));
  ASSERT_EQ(all.made.lines.outlines.size(), 1u);
  double area = 0;
  const Polyline& outline = all.made.lines.outlines[0];
  for (std::size_t k = 0; k < outline.size(); ++k)
    area += cross_product(outline[k], outline[(k + 1) % outline.size()]) / 2;
  EXPECT_NEAR(area, 250 * 8000, 0.05 * 250 * 8000);
  EXPECT_FALSE(says(all.made.remarks, "the outline leaves out"));
}

TEST(Outline, SaysHowManyColumnsItLeavesOut) {
  MadeGrid plan{.size = {16, 8, 2}, .thickness = {20, 20}};
  for (int j = 0; j < 8; ++j) {
    plan.inactive.push_back({12, j, -1});
    plan.inactive.push_back({13, j, -1});
    if (j < 4) plan.inactive.insert(plan.inactive.end(), {{14, j, -1}, {15, j, -1}});
  }
  EXPECT_TRUE(
      says(scene_of(made(plan)).made.remarks, "the outline leaves out 8 of 104 active columns"));
}

TEST(GridPictures, SayWhatWasRecognised) {
  const MadeScene all = scene_of(made(grid_of_a_fault(0.5)));
  const std::string map = map_picture(all.structure, all.made);
  for (const char* text : {">F1, 60 m<", ">C1<", ">C2<", "stroke-dasharray"})
    EXPECT_THAT(map, HasSubstr(text));
  const std::string section = section_picture(all.grid, all.structure, all.made);
  EXPECT_THAT(section, HasSubstr("A section across F1 where its throw is largest"));
  EXPECT_THAT(section, HasSubstr("<circle"));
  const MadeScene none = scene_of(made(MadeGrid{}));
  EXPECT_THAT(section_picture(none.grid, none.structure, none.made),
              HasSubstr("A section from west to east"));
}

TEST(SceneText, KeepsShortThingsOnALine) {
  const nlohmann::ordered_json scene = {{"b", 1}, {"a", {{"x", {"1 m", "2 m"}}, {"e", {}}}}};
  EXPECT_EQ(scene_text(scene),
            "{\n  \"b\": 1,\n  \"a\": { \"x\": [\"1 m\", \"2 m\"], \"e\": null }\n}\n");
  nlohmann::ordered_json list;
  for (int k = 0; k < 30; ++k) list["long"].push_back(1000 + k);
  EXPECT_THAT(scene_text(list), HasSubstr("\"long\": [\n    1000,\n"));
  EXPECT_EQ(nlohmann::ordered_json::parse(scene_text(list)), list);
}

TEST(Outline, IsWithinHalfACellOfTheActiveMap) {
  MadeGrid grid{.size = {40, 30, 1}, .thickness = {20}};
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 30; ++j) {
      if (std::hypot((i - 20) / 18.0, (j - 15) / 13.0) > 1) grid.inactive.push_back({i, j, -1});
    }
  }
  const corner_point::CornerPointGrid cells = made(grid);
  const corner_point::ColumnMap map(cells);
  Remarks remarks;
  const std::vector<Polyline> outlines = active_outlines(map, 100, -2000, remarks);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_LT(outlines[0].size(), 40u);
  double area = 0;
  for (std::size_t k = 0; k < outlines[0].size(); ++k)
    area += cross_product(outlines[0][k], outlines[0][(k + 1) % outlines[0].size()]) / 2;
  const double is = std::numbers::pi * 1800 * 13 * 80;
  EXPECT_NEAR(area, is, 0.03 * is) << "counter-clockwise";
  int n_wrong = 0;
  for (int column = 0; column < cells.n_columns(); ++column) {
    const auto [i, j] = cells.place(column);
    const Vector2d middle((i + 0.5) * 100, (j + 0.5) * 80);
    if (nearest_on_line(closed(outlines[0]), middle).distance < 80) continue;
    n_wrong += is_within(outlines, middle) != map.is_inside(column);
  }
  EXPECT_EQ(n_wrong, 0);
}

}  // namespace
}  // namespace faultsim::grid_scene
