// Scenes of random grids: lines fit together for the builder of bodies, which makes cells of them,
// and points lie on the side of the fault that their depth says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "simulator/common/errors.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/line_check.h"
#include "simulator/horizons/build_body.h"
#include "tests/unit/corner_point/random_grid.h"
#include "tests/unit/grid_scene/made_scene.h"

namespace faultsim::grid_scene {
namespace {

using Eigen::Vector2d;

/// A flat reservoir between the lines of a scene.
horizons::LayeredBody flat_body(const GridScene& made) {
  horizons::LayeredBody body = body_of_lines(made.lines);
  body.horizons = {{"top", horizons::ConstantDepth{made.lines.reference_z + 20}},
                   {"base", horizons::ConstantDepth{made.lines.reference_z - 40}}};
  body.layers = {{0}, {1}, {2}};
  int region = 0;
  for (const ModelCompartment& one : made.compartments)
    body.compartments.push_back({one.name, one.inside, {-1, region++, -1}, one.also});
  return body;
}

TEST(RandomScenes, HaveLinesThatFitAndCompartmentsThatArePartedByThem) {
  int n_faults = 0, n_drawn = 0, n_built = 0, n_columns = 0, n_parted = 0;
  constexpr unsigned kGrids = 16;
  for (unsigned seed = 0; seed < kGrids; ++seed) {
    GridSceneOptions options;
    options.lines.n_cells = 60'000;
    const MadeScene all =
        scene_of(made(corner_point::RandomGrid(seed).grid()), {}, std::move(options));
    n_faults += static_cast<int>(all.structure.faults.size());
    n_drawn += static_cast<int>(all.made.lines.faults.size());
    n_columns += all.structure.n_active_columns;
    for (const ModelCompartment& one : all.made.compartments)
      n_parted += all.structure.compartments[one.source].n_columns;
    EXPECT_EQ(all.structure.faults.size() - all.made.lines.faults.size(),
              std::ranges::count_if(all.made.remarks,
                                    [](const auto& remark) {
                                      return remark.text.find("is not in the model") !=
                                             std::string::npos;
                                    }))
        << seed;
    EXPECT_FALSE(says(all.made.remarks, ", near none")) << seed << ": an end lost its fault";
    try {
      const horizons::BuiltBody built = build_body(flat_body(all.made), "scene");
      n_built += 1;
      EXPECT_LT(built.mesh.n_cells(), 250'000u) << seed;
      EXPECT_EQ(built.mesh.faults.size(), all.made.lines.faults.size());
    } catch (const InputError& error) {
      std::cout << seed << ": " << error.what() << "\n";
    }
  }
  std::cout << n_faults << " faults, " << n_drawn << " drawn; " << n_built << " built; " << n_parted
            << " of " << n_columns << " columns in compartments\n";
  EXPECT_GE(n_built, kGrids * 9 / 10);
  EXPECT_GE(n_drawn, n_faults * 9 / 10);
  EXPECT_GE(n_parted, n_columns * 9 / 10);
}

/// The body of a scene with its surfaces.
horizons::LayeredBody body_of(const GridScene& made) {
  horizons::LayeredBody body = flat_body(made);
  body.horizons.clear();
  for (const ModelSurface& one : made.surfaces) {
    if (one.thickness.empty())
      body.horizons.push_back({one.name, horizons::PointDepth{one.points}});
    else
      body.horizons.push_back({one.name, horizons::HungDepth{one.thickness}});
  }
  return body;
}

/// A thin reservoir on pillars whose depths are off by `noise`, with a throw of many thicknesses.
corner_point::CornerPointGrid noisy_grid(unsigned seed, double noise) {
  corner_point::MadeGrid plan = grid_of_a_fault(1.2);
  plan.thickness = {3, 0, 4};
  corner_point::CornerPointGrid grid = made(plan);
  std::mt19937 random(seed);
  std::normal_distribution<double> off(0, noise);
  const auto [n_i, n_j, n_k] = grid.size;
  std::vector<double> of_pillar;
  for (int p = 0; p < (n_i + 1) * (n_j + 1); ++p) of_pillar.push_back(off(random));
  std::size_t corner = 0;
  for (int plane = 0; plane < 2 * n_k; ++plane)
    for (int row = 0; row < 2 * n_j; ++row)
      for (int place = 0; place < 2 * n_i; ++place)
        grid.corner_z[corner++] +=
            of_pillar[static_cast<std::size_t>((row + 1) / 2 * (n_i + 1) + (place + 1) / 2)];
  return grid;
}

TEST(RandomScenes, OfThinReservoirsWithNoiseHaveSurfacesThatDoNotCross) {
  const auto builds = [](const horizons::LayeredBody& body) {
    try {
      build_body(body, "scene");
      return true;
    } catch (const InputError& error) {
      return std::string(error.what()).find("cross, worst by") == std::string::npos;
    }
  };
  constexpr int kGrids = 6;
  for (unsigned seed = 0; seed < kGrids; ++seed) {
    GridSceneOptions options;
    options.lines.n_cells = 40'000;
    options.surfaces.least_layer = 5;
    const GridScene scene = scene_of(noisy_grid(seed, 15), {}, options).made;
    ASSERT_EQ(scene.surfaces.size(), 2u);
    const ModelSurface &top = scene.surfaces[0], &base = scene.surfaces[1];
    ASSERT_EQ(top.points.size(), base.thickness.size());
    EXPECT_GE(*std::ranges::min_element(base.thickness), 5);
    EXPECT_TRUE(builds(body_of(scene))) << seed;
  }
}

/// Where pillars of the model are not those of the grid, the base is the grid's all the same.
TEST(RandomScenes, HaveTheirBaseOnTheGridsOwn) {
  corner_point::MadeGrid plan = grid_of_a_fault(0.6);
  plan.thickness = {20, 20, 20};
  const MadeScene all = scene_of(made(plan));
  const auto& base = all.made.surfaces[1].points;
  double worst = 0;
  std::size_t n_inside = 0;
  for (const Eigen::Vector3d& at : base) {
    const auto on = corner_point::nearest_on_line(
        all.made.lines.faults[0].at(at.z(), all.made.lines.reference_z), at.head<2>());
    if (on.distance < 200 || on.along == 0) continue;
    // The grid's base below the point of its pillar at the same height.
    const Vector2d pillar = at.head<2>() - plan.lean * (plan.reference - at.z());
    const double grids = corner_point::made_top(pillar) - 60, low = grids - 60;
    worst = std::max(worst, std::min(std::abs(at.z() - grids), std::abs(at.z() - low)));
    n_inside += 1;
  }
  EXPECT_GT(n_inside, 400u);
  EXPECT_LT(worst, 0.3) << "m; 15 m sines of 4.4 km between pillars 100 m apart";
}

/// One fault across the grid at any angle, pillars that lean; right is 60 m lower, which tells the
/// sides apart whatever lines say.
int points_beside_a_fault(unsigned n) {
  int n_near = 0;
  for (unsigned seed = 0; seed < n; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(0, std::numbers::pi), lean(-1, 1);
    corner_point::MadeGrid grid{.size = {30, 30, 2}, .thickness = {15, 25}, .faults = {}};
    grid.lean = {lean(random), lean(random)};
    const double direction = angle(random);
    const Vector2d middle(1500, 1200),
        along(3000 * std::cos(direction), 3000 * std::sin(direction));
    grid.faults = {{middle - along, middle + along, [](double) { return 60.0; }}};
    const MadeScene all = scene_of(made(grid));
    EXPECT_EQ(all.made.lines.faults.size(), 1u) << seed;
    const ModelFault& fault = all.made.lines.faults.at(0);
    for (const ModelSurface& surface : all.made.surfaces) {
      const double below = surface.layer < 0 ? 0 : 40;
      // Tips beyond the grid are of both sides.
      for (std::size_t p = 0; p + 2 < surface.points.size(); ++p) {
        const Eigen::Vector3d& at = surface.points[p];
        const Polyline line = fault.at(at.z(), all.made.lines.reference_z);
        const auto on = corner_point::nearest_on_line(line, at.head<2>());
        if (on.along == 0 || on.along >= corner_point::line_length(line) || on.distance > 300)
          continue;
        n_near += 1;
        const Vector2d pillar = at.head<2>() - grid.lean * (grid.reference - at.z());
        const bool is_low = at.z() - (corner_point::made_top(pillar) - below) < -30;
        const Vector2d piece = line[on.piece + 1] - line[on.piece];
        const bool is_right = corner_point::cross_product(piece, at.head<2>() - line[on.piece]) < 0;
        // The fault was made from `from` to `to`; its trace goes from the west.
        const bool runs_back = piece.dot(along) < 0;
        EXPECT_EQ(is_low, is_right != runs_back) << seed << ", " << at.transpose();
        EXPECT_GT(on.distance, 0.99) << seed;
      }
    }
  }
  return n_near;
}

TEST(RandomScenes, HaveNoPointOnTheWrongSideOfAFault) { EXPECT_GT(points_beside_a_fault(8), 1300); }

TEST(RandomScenes, SlowThirtyHaveNoPointOnTheWrongSideOfAFault) {
  EXPECT_GT(points_beside_a_fault(30), 5000);
}

}  // namespace
}  // namespace faultsim::grid_scene
