// Tables of points as programs export them: grids whose lines are uneven, grids that are turned,
// clouds, in any order and with columns of other properties.
#include "simulator/flow/point_cells.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/flow_csv.h"
#include "simulator/flow/flow_mapping.h"
#include "simulator/flow/nearest_areas.h"
#include "simulator/flow/regular_cells.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string refusal_of(const std::string& text) {
  try {
    parse_flow_csv(text, "points.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// x borders of cells in a row, as written in a table with sizes along y.
std::vector<double> borders_of(const std::vector<double>& centres) {
  std::vector<double> borders;
  for (const auto& [low, high] : uneven_cells(std::vector<int>(centres.size(), 0), centres)) {
    if (borders.empty() || borders.back() != low) borders.push_back(low);
    borders.push_back(high);
  }
  return borders;
}

TEST(UnevenCells, AreFoundFromTheirMiddles) {
  // 100, 100, 100, 200, 200 m
  EXPECT_THAT(borders_of({50, 150, 250, 400, 600}), ElementsAre(0, 100, 200, 300, 500, 700));
  // Layers of 10, 4, 10, 10, 10, 10 m
  EXPECT_THAT(borders_of({5, 12, 19, 29, 39, 49}), ElementsAre(0, 10, 14, 24, 34, 44, 54));
}

TEST(UnevenCells, LeaveHolesWhereLinesAreMissing) {
  EXPECT_THAT(borders_of({0, 100, 300, 400, 500}), ElementsAre(-50, 50, 150, 250, 350, 450, 550));
}

TEST(UnevenCells, ReachHalfWayWhereNothingElseFits) {
  // Cells of a width each around their middles: 10, 20, 61, 70 leave no tiling.
  EXPECT_THAT(borders_of({10, 20, 61, 70}), ElementsAre(5, 15, 40.5, 65.5, 74.5));
  // Whole numbers are multiples of 1, which says nothing of their cells.
  EXPECT_THAT(borders_of({0, 1, 58, 91, 124}), ElementsAre(-0.5, 0.5, 29.5, 74.5, 107.5, 140.5));
}

TEST(PointTables, MayBeRectilinear) {
  const FlowField field = parse_flow_csv(
      "x [m], y [m], 1990-01-01 [bar]\n50, 0, 1\n150, 0, 2\n300, 0, 3\n500, 0, 4\n"
      "50, 60, 5\n150, 60, 6\n300, 60, 7\n500, 60, 8\n",
      "uneven");
  ASSERT_EQ(field.cells.size(), 8U);
  EXPECT_EQ(field.cells[2].low.head<2>(), Eigen::Vector2d(200, -30));
  EXPECT_EQ(field.cells[2].high.head<2>(), Eigen::Vector2d(400, 30));
  EXPECT_THAT(field.notes, ElementsAre(HasSubstr("not equally spaced along x"),
                                       "has no depth: its values hold at all depths"));
}

TEST(PointTables, HaveLayersOfTheirOwnInEachColumn) {
  const FlowField field = parse_flow_csv(
      "x [m], y [m], depth [m], dx [m], dy [m], 1990-01-01 [bar]\n"
      "0, 0, 1005, 9, 9, 1\n0, 0, 1012, 9, 9, 2\n0, 0, 1019, 9, 9, 3\n0, 0, 1029, 9, 9, 4\n"
      "0, 0, 1039, 9, 9, 5\n0, 0, 1049, 9, 9, 6\n9, 0, 2010, 9, 9, 7\n9, 0, 2030, 9, 9, 8\n",
      "layers");
  EXPECT_EQ(field.cells[1].low.z(), -1014);
  EXPECT_EQ(field.cells[1].high.z(), -1010);
  EXPECT_EQ(field.cells[6].low.z(), -2020);
  EXPECT_EQ(field.cells[6].high.z(), -2000);
}

/// As exported: columns and rows in any order, capitals, other properties, both quantities.
TEST(PointTables, AreReadAsTheyAreExported) {
  const std::string table =
      "I;Z [ft];Pressure [psi];DATE;PORO;X [km];Y [km];TEMPERATURE [degC]\n"
      "1;-9000;4000;1995-01-01 00:00:00;0.2;0;0;90\n1;-9000;5000;1990-01-01 00:00:00;0.2;0;0;100\n"
      "2;-9000;5001;1990-01-01 00:00:00;0.2;0.1;0;101\n2;-9000;4001;1995-01-01;0.2;0.1;0;91\n"
      "1;-9010;5002;1990-01-01 00:00:00;0.2;0;0;102\n1;-9010;4002;1995-01-01;0.2;0;0;92\n"
      "1;-9000;5003;1990-01-01 00:00:00;0.2;0;0.1;103\n1;-9000;4003;1995-01-01;0.2;0;0.1;93\n";
  const FlowField field = parse_flow_csv(table, "exported");
  ASSERT_EQ(field.cells.size(), 4U);
  EXPECT_LT(field.date[0], field.date[1]);
  EXPECT_DOUBLE_EQ(field.value(0, 0), 5000 * 6894.757293168361);
  EXPECT_DOUBLE_EQ(field.value(3, 1), 4003 * 6894.757293168361);
  EXPECT_NEAR(field.cells[0].high.z(), -8995 * 0.3048, 1e-9);
  EXPECT_NEAR(field.cells[2].high.z(), -9005 * 0.3048, 1e-9);
  EXPECT_THAT(field.notes, ElementsAre("has columns that are not used: \"I\", \"PORO\""));
  const FlowField heat = parse_flow_csv(table, "exported", FlowQuantity::temperature);
  EXPECT_DOUBLE_EQ(heat.value(1, 1), 91 + 273.15);
}

TEST(PointTables, AreRefusedWhereTheyCannotBeMeant) {
  EXPECT_THAT(refusal_of("x [m], y [m], z [m], 1990-01-01 [bar]\n0, 0, 2000, 9\n"),
              HasSubstr("points.csv:2: z is above 0: it counts upwards; name the column depth"));
  EXPECT_THAT(refusal_of("x [m], y [m], z [m], depth [m], 1990-01-01 [bar]\n"),
              HasSubstr("columns of z and of depth"));
  EXPECT_THAT(refusal_of("time [year], x [m], y [m], pressure [bar]\n"),
              HasSubstr("\"time [year]\" counts from a day that is not given; write dates"));
  EXPECT_THAT(refusal_of("date, x [m], y [m], depht [m], pressure [bar]\n"),
              HasSubstr("\"depht [m]\" is none of x, y, depth, z"));
  EXPECT_THAT(refusal_of("x [m], y [m], depth [m], 1990-01-01 [bar]\n0, 0, 2000, 9\n7, 3, 2010, "
                         "9\n1, 9, 2020, 9\n"),
              HasSubstr("depth has one value at each place, as no two points have the same x and "
                        "y"));
  std::string row = "x [m], y [m], 1990-01-01 [bar]\n";
  for (const double i : {0., 1., 3., 4., 7., 9.}) row += concat(i, ", ", 2 * i + 1, ", 300\n");
  EXPECT_THAT(refusal_of(row), HasSubstr("all points lie on one line in plan"));
}

Eigen::Vector2d turned(double x, double y, double angle) {
  return {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y};
}

TEST(NearestAreas, OfATurnedGridAreItsCells) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 7; ++j)
      places.push_back(Eigen::Vector2d(6e5, 5.8e6) + turned(100 * i, 80 * j, 0.3));
  }
  const NearestAreas areas = nearest_areas(places);
  ASSERT_EQ(areas.area.size(), places.size());
  EXPECT_NEAR(areas.rim, 40, 1e-6);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_end = i / 7 == 0 || i / 7 == 11;  // the rim is half of the smaller spacing
    EXPECT_NEAR(polygon_area(areas.area[i]), is_end ? 90 * 80 : 8000, 0.01) << i;
  }
}

TEST(NearestAreas, HoldWhatIsNearestAndNothingTwice) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(0, 1000);
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 300; ++i) places.emplace_back(within(random), within(random));
  const NearestAreas areas = nearest_areas(places);
  const auto holds = [](const ConvexPolygon& polygon, const Eigen::Vector2d& at) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i],
                            to = at - polygon[i];
      if (along.x() * to.y() - along.y() * to.x() < 0) return false;
    }
    return polygon.size() > 2;
  };
  int n_held = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d at(within(random), within(random));
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if ((places[k] - at).norm() < (places[nearest] - at).norm()) nearest = k;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!holds(areas.area[k], at)) continue;
      EXPECT_EQ(k, nearest);
      ++n_held;
    }
  }
  EXPECT_GT(n_held, 1900);
  double sum = 0;
  for (const ConvexPolygon& area : areas.area) sum += polygon_area(area);
  EXPECT_LT(sum, 1040 * 1040);
}

TEST(NearestAreas, LeaveOutWhatIsFarFromAllPlaces) {
  std::vector<Eigen::Vector2d> places;  // a ring 200 m wide around a hole of 1800 m
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      if (std::max(std::abs(i), std::abs(j)) >= 9) places.emplace_back(100 * i + 0.1 * j, 100 * j);
    }
  }
  double sum = 0;
  for (const ConvexPolygon& area : nearest_areas(places).area) sum += polygon_area(area);
  const double ring = std::pow(2100, 2) - std::pow(1700, 2);
  EXPECT_GT(sum, ring);
  EXPECT_LT(sum, 1.8 * ring) << "all of it: 2.9";
}

/// The same pressures as a table of boxes and as points of a turned grid: a body within both takes
/// the same mean.
TEST(PointTables, OfATurnedGridGiveWhatItsCellsGive) {
  constexpr double kAngle = 25 * std::numbers::pi / 180;
  std::string boxes = "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar]\n";
  std::string points = "x [m], y [m], depth [m], 1990-01-01 [bar]\n";
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (int k = 0; k < 3; ++k) {
        const double x = 100 * i, y = 120 * j, depth = 2000 + 20 * k,
                     value = 200 + i + 3 * j + 7 * k;
        boxes += concat(x, ",", y, ",", depth, ",100,120,20,", value, "\n");
        const Eigen::Vector2d at = turned(x, y, -kAngle);
        points += concat(at.x(), ",", at.y(), ",", depth, ",", value, "\n");
      }
    }
  }
  const FlowField of_boxes = parse_flow_csv(boxes, "boxes");
  const FlowField cloud = parse_flow_csv(points, "points");
  EXPECT_THAT(cloud.notes, ElementsAre(HasSubstr("has points at 121 places that are not a grid")));
  EXPECT_THAT(of_boxes.notes, IsEmpty());
  const FlowField of_points = placed(cloud, {0, 0}, kAngle);
  const MappedCell body{.corners = between_sides({-333, -300}, {210, 250}, 1995, 2033, 444),
                        .region = 0};
  const auto mean = [&](const FlowField& field) {
    const FlowMapping mapping =
        map_flow(field, {body}, {"body"}, {.outside = OutsideRule::unchanged});
    EXPECT_NEAR(mapping.covered[0], 1, 1e-6);
    double sum = 0;
    for (const auto& weight : mapping.weights[0])
      sum += weight.value * field.value(weight.flow_cell, 0);
    return sum;
  };
  EXPECT_NEAR(mean(of_points), mean(of_boxes), 1e-6 * mean(of_boxes));
}

}  // namespace
}  // namespace faultsim
