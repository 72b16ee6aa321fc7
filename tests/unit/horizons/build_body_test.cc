#include "simulator/horizons/build_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numeric>

#include "simulator/horizons/tet_quality.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector3d;
using test::dipping;
using test::dipping_fault;
using test::kDegree;
using test::refusal_of;
using test::reservoir_body;
using testing::HasSubstr;

/// Volumes by layer and by side of x = 0 at z = -2000 of a plane that dips by 60 degrees.
struct SideVolumes {
  std::map<std::pair<int, bool>, double> of;

  explicit SideVolumes(const BuiltBody& built) {
    const UncutMesh& mesh = built.mesh;
    for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
      const auto x = [&](std::size_t v) { return mesh.nodes[mesh.corners[4 * cell + v]]; };
      const double volume = (x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) / 6;
      const Vector3d middle = (x(0) + x(1) + x(2) + x(3)) / 4;
      const bool hangs = middle.x() > (-2000 - middle.z()) / std::tan(60 * kDegree);
      of[{built.layer[cell], hangs}] += volume;
    }
  }
};

/// Of the footwall between two depths.
double footwall_volume(double low, double high) {
  const double middle = (low + high) / 2;
  return (high - low) * 4000 * (3000 + (-2000 - middle) / std::tan(60 * kDegree));
}

double area_of(const UncutMesh& mesh, const FacetGroup& group) {
  double area = 0;
  for (const std::array<int, 4>& f : group.facets)
    area +=
        (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]).norm() / 2;
  return area;
}

std::size_t n_faces(const Mesh& mesh) {
  return std::accumulate(mesh.faults.begin(), mesh.faults.end(), std::size_t{0},
                         [](std::size_t n, const FaultSurface& f) { return n + f.faces.size(); });
}

std::size_t n_facets(const UncutMesh& mesh) {
  return std::accumulate(mesh.faults.begin(), mesh.faults.end(), std::size_t{0},
                         [](std::size_t n, const FacetGroup& f) { return n + f.facets.size(); });
}

TEST(BuildBody, WithoutFaultsIsLayers) {
  const BuiltBody built = build_body(reservoir_body(), "body");
  const SideVolumes volumes(built);
  const auto layer = [&](int k) { return volumes.of.at({k, false}) + volumes.of.at({k, true}); };
  EXPECT_NEAR(layer(0), 1900 * 24e6, 1);
  EXPECT_NEAR(layer(1), 200 * 24e6, 1);
  EXPECT_NEAR(layer(2), 1900 * 24e6, 1);
  EXPECT_EQ(built.n_extra_nodes, 0u);
  const Mesh mesh = cut(built.mesh, "body");
  EXPECT_EQ(check_quality(mesh).refusal, "");
}

TEST(BuildBody, ADippingFaultWithThrowIsExact) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].moved = FaultThrow{100};
  body.compartments = {{"west", {-1000, 0}, {-1, 0, -1}}, {"east", {1000, 0}, {-1, 1, -1}}};
  const BuiltBody built = build_body(body, "body");
  const SideVolumes volumes(built);
  const double all = footwall_volume(-4000, 0);
  EXPECT_NEAR(volumes.of.at({1, false}), footwall_volume(-2050, -1850), 1) << "50 m up";
  EXPECT_NEAR(volumes.of.at({0, false}), footwall_volume(-1850, 0), 1);
  EXPECT_NEAR(volumes.of.at({2, false}), all - footwall_volume(-2050, 0), 1);
  EXPECT_NEAR(volumes.of.at({1, true}), 24e6 * 200 - footwall_volume(-2150, -1950), 1);
  EXPECT_NEAR(volumes.of.at({0, true}), 24e6 * 1950 - footwall_volume(-1950, 0), 1);
  const UncutMesh& mesh = built.mesh;
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    EXPECT_EQ(mesh.material[cell], built.layer[cell]);
    EXPECT_EQ(mesh.region[cell], built.layer[cell] == 1 ? built.compartment[cell] : -1);
    EXPECT_EQ(mesh.region_fraction[cell], mesh.region[cell] < 0 ? 0 : 1);
  }
  EXPECT_GT(built.smallest_sicn, 0.1);
}

TEST(BuildBody, TellsTheThrowsOfItsFaults) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].profiles.clear();
  body.faults[0].moved.reset();
  // Deeper by 40 to 80 m on the right of the trace, seen along it.
  PointDepth points;
  for (const double x : {-2900., -1500., -300., 300., 1500., 2900.})
    for (double y = -2000; y <= 2000; y += 250)
      points.points.emplace_back(x, y, -1800 - (x > 0 ? 60 + y / 100 : 0));
  body.horizons[0].depth = points;
  std::vector<FoundThrow> throws = build_body(body, "body").throws;
  ASSERT_EQ(throws.size(), 2u);
  EXPECT_EQ(throws[0].fault, 0);
  EXPECT_EQ(throws[1].horizon, 1);
  EXPECT_NEAR(throws[0].least, 40, 1e-9);
  EXPECT_NEAR(throws[0].middle, 60, 1);
  EXPECT_NEAR(throws[0].largest, 80, 1e-9);
  EXPECT_EQ(throws[1].largest, 0) << "a depth that is the same everywhere has no step";
  std::ranges::reverse(body.faults[0].trace);
  throws = build_body(body, "body").throws;
  EXPECT_NEAR(throws[0].least, -80, 1e-9) << "now deeper on the left";
  EXPECT_NEAR(throws[0].largest, -40, 1e-9);
  body.faults[0].moved = FaultThrow{100};
  body.horizons[0].depth = ConstantDepth{-1900};
  for (const FoundThrow& one : build_body(body, "body").throws)
    EXPECT_NEAR(one.middle, 100, 1e-6) << "down on the right, the hanging wall";
}

TEST(BuildBody, ADippingFaultIsCutAllOver) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].moved = FaultThrow{100};
  const BuiltBody built = build_body(body, "body");
  const Mesh mesh = cut(built.mesh, "body");
  ASSERT_EQ(mesh.faults.size(), 1u);
  EXPECT_EQ(mesh.faults[0].faces.size(), built.mesh.faults[0].facets.size());
  EXPECT_EQ(std::ranges::count(mesh.faults[0].node_of_point, -1), 0);
  double area = 0;
  for (const FaultNode& node : mesh.faults[0].nodes) {
    area += node.area;
    EXPECT_LT((node.normal - Vector3d(std::sin(60 * kDegree), 0, std::cos(60 * kDegree))).norm(),
              1e-9);
  }
  EXPECT_NEAR(area, 4000 * 4000 / std::sin(60 * kDegree), 1e-3);
  EXPECT_EQ(check_quality(mesh).refusal, "");
}

TEST(BuildBody, TheOutsideIsSixPlanes) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  const UncutMesh mesh = build_body(body, "body").mesh;
  const std::vector<double> areas = {16e6, 16e6, 24e6, 24e6, 24e6, 24e6};
  const std::vector<double> planes = {-3000, 3000, -2000, 2000, -4000, 0};
  ASSERT_EQ(mesh.boundary.size(), 6u);
  for (std::size_t side = 0; side < 6; ++side) {
    EXPECT_NEAR(area_of(mesh, mesh.boundary[side]), areas[side], 1e-3) << mesh.boundary[side].name;
    for (const std::array<int, 4>& facet : mesh.boundary[side].facets)
      for (std::size_t v = 0; v < 3; ++v)
        EXPECT_NEAR(mesh.nodes[facet[v]][static_cast<Eigen::Index>(side / 2)], planes[side], 1e-9);
  }
}

TEST(BuildBody, AFaultInTheRockHasATipAllAround) {
  LayeredBody body = reservoir_body();
  LayeredFault fault = dipping_fault();
  fault.trace = {{0, -1000}, {0, 1000}};
  fault.first_end = fault.last_end = TraceEnd::in_rock;
  fault.top = -1500;
  fault.bottom = -2500;
  fault.moved = FaultThrow{80, 0.5, 600};
  body.faults = {fault};
  const BuiltBody built = build_body(body, "body");
  EXPECT_NEAR(area_of(built.mesh, built.mesh.faults[0]), 2000 * 1000 / std::sin(60 * kDegree),
              1e-3);
  const Mesh mesh = cut(built.mesh, "body");
  const FaultSurface& surface = mesh.faults[0];
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    const Vector3d& at = surface.points[p];
    const bool is_tip = std::abs(at.y()) > 999.999 || at.z() > -1500.001 || at.z() < -2499.999;
    EXPECT_EQ(surface.node_of_point[p] < 0, is_tip) << at.transpose();
  }
}

/// Depth of the top of layer 1 beside the fault, by side, over y.
std::map<bool, std::map<double, double>> horizon_beside(const BuiltBody& built) {
  std::map<int, int> sides;  // node of the fault -> which sides have it at the top of layer 1
  std::map<std::pair<int, bool>, std::array<bool, 2>> touches;
  const UncutMesh& mesh = built.mesh;
  std::vector<bool> on_fault(mesh.nodes.size(), false);
  for (const std::array<int, 4>& facet : mesh.faults[0].facets)
    for (std::size_t v = 0; v < 3; ++v) on_fault[facet[v]] = true;
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    Vector3d middle = Vector3d::Zero();
    for (std::size_t v = 0; v < 4; ++v) middle += mesh.nodes[mesh.corners[4 * cell + v]] / 4;
    const bool hangs = middle.x() > (-2000 - middle.z()) / std::tan(60 * kDegree);
    for (std::size_t v = 0; v < 4; ++v)
      if (on_fault[mesh.corners[4 * cell + v]] && built.layer[cell] < 2)
        touches[{mesh.corners[4 * cell + v], hangs}][built.layer[cell]] = true;
  }
  std::map<bool, std::map<double, double>> depth;
  for (const auto& [key, layers] : touches)
    if (layers[0] && layers[1])
      depth[key.second][std::round(mesh.nodes[key.first].y())] = mesh.nodes[key.first].z();
  return depth;
}

TEST(BuildBody, ThrowTapersToATip) {
  LayeredBody body = reservoir_body();
  LayeredFault fault = dipping_fault();
  fault.trace = {{0, -2000}, {0, 1000}};
  fault.last_end = TraceEnd::in_rock;
  fault.moved = FaultThrow{100, 0.25, 600, 1000};
  body.faults = {fault};
  const auto depth = horizon_beside(build_body(body, "body"));
  ASSERT_GT(depth.at(true).size(), 10u);
  for (const auto& [y, foot] : depth.at(false)) {
    const double part = std::min(1.0, (1000 - y) / 1000), hanging = depth.at(true).at(y);
    if (100 * part < 0.12 * 200) {
      EXPECT_EQ(foot, hanging) << "joined at y " << y;
      continue;
    }
    EXPECT_NEAR(foot, -1900 + 25 * part, 1e-6) << "at y " << y;
    EXPECT_NEAR(hanging, -1900 - 75 * part, 1e-6) << "at y " << y;
  }
}

/// Horizons of points that step down to the right of dipping_fault().
LayeredBody stepped_body(double step) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  PointDepth top;
  for (double x = -2900; x < 3000; x += 200)
    for (double y = -1900; y < 2000; y += 200) {
      const bool is_right = x > (body.trace_depth + 1900) / std::tan(60 * test::kDegree);
      top.points.emplace_back(x, y, is_right ? -1900 - step : -1900);
    }
  body.horizons[1].depth = HungDepth{std::vector<double>(top.points.size(), 200)};
  body.horizons[0].depth = std::move(top);
  return body;
}

TEST(BuildBody, ThrowsOfPointsStayFromThreeHundredthsOfACellOn) {
  ASSERT_EQ(reservoir_body().cells.at_faults, 200);
  const BuiltBody kept = build_body(stepped_body(8), "body");
  EXPECT_EQ(kept.n_snapped, 0);
  for (const FoundThrow& one : kept.throws) {
    EXPECT_NEAR(one.least, 8, 1e-6);
    EXPECT_NEAR(one.largest, 8, 1e-6);
  }
  const BuiltBody joined = build_body(stepped_body(4), "body");
  EXPECT_GT(joined.n_snapped, 0);
  for (const FoundThrow& one : joined.throws) EXPECT_EQ(one.largest, 0);
}

TEST(BuildBody, ThrowsThatAreGivenStayFromTwelveHundredthsOfACellOn) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].moved = FaultThrow{16, 0.5};
  for (const FoundThrow& one : build_body(body, "body").throws) EXPECT_EQ(one.largest, 0);
  body.faults[0].moved = FaultThrow{32, 0.5};
  for (const FoundThrow& one : build_body(body, "body").throws) EXPECT_NEAR(one.least, 32, 1e-6);
}

TEST(BuildBody, ReservoirsSideBySideAreJoinedWhereLinesCross) {
  // The top of one side meets the bottom of the other near a pillar, or half way between two.
  for (const double taper : {3000., 1000.}) {
    LayeredBody body = reservoir_body();
    LayeredFault fault = dipping_fault();
    fault.trace = {{0, -2000}, {0, 1500}};
    fault.last_end = TraceEnd::in_rock;
    fault.moved = FaultThrow{450, 0.5, 900, taper};
    body.faults = {fault};
    const BuiltBody built = build_body(body, "body");
    const Mesh mesh = cut(built.mesh, "body");
    EXPECT_EQ(n_faces(mesh), n_facets(built.mesh));
    EXPECT_GT(built.n_snapped, 0);
    EXPECT_GT(built.smallest_sicn, 0.05);
  }
}

/// Between the last pillar and the tip, where both sides are one, the top of one side would cross
/// the bottom of the other: they are joined at the pillar, not at the tip.
TEST(BuildBody, AThrowThatEndsWithinACellLeavesTheTipItsLayers) {
  LayeredBody body = reservoir_body();
  LayeredFault fault = dipping_fault();
  fault.trace = {{0, -2000}, {0, 1000}};
  fault.last_end = TraceEnd::in_rock;
  fault.moved = FaultThrow{460, 0.5, 900, 150};
  body.faults = {fault};
  const BuiltBody built = build_body(body, "body");
  EXPECT_GT(built.n_snapped, 0);
  EXPECT_GT(built.smallest_sicn, 0.05);
  const auto depth = horizon_beside(built);
  const double tip = std::prev(depth.at(false).end())->first;
  EXPECT_NEAR(tip, 1000, 50);
  const auto last = std::next(depth.at(false).rbegin());
  EXPECT_NEAR(last->second, -1900 + 230, 1) << "the top of the footwall stays";
  EXPECT_NEAR(depth.at(true).at(last->first), -1900 - 100, 1) << "that of the other side rises";
}

/// How many places have so many copies of a node, up to four.
std::vector<int> places_of_copies(const Mesh& mesh) {
  std::map<int, std::size_t> copies;
  for (const NodeCopy& copy : mesh.copies) ++copies[copy.first];
  std::vector<int> places(5, 0);
  for (const auto& [first, n] : copies) ++places.at(n);
  return places;
}

TEST(BuildBody, ATIsFoundByCut) {
  LayeredBody body = reservoir_body();
  LayeredFault branch = dipping_fault();
  branch.name = "B";
  branch.trace = {{0, -300}, {1500, 400}};
  branch.first_end = TraceEnd::at_fault;
  branch.last_end = TraceEnd::in_rock;
  branch.profiles = dipping(70);
  branch.top = -1500;
  branch.bottom = -2600;
  branch.moved = FaultThrow{60, 0.5, 600};
  body.faults = {dipping_fault(), branch};
  body.faults[0].moved = FaultThrow{100};
  const BuiltBody built = build_body(body, "body");
  const Mesh mesh = cut(built.mesh, "body");
  EXPECT_EQ(n_faces(mesh), n_facets(built.mesh));
  const std::vector<int> places = places_of_copies(mesh);
  EXPECT_GT(places[3], 5);
  EXPECT_EQ(places[4], 0);
}

TEST(BuildBody, AnXIsFoundByCut) {
  LayeredBody body = reservoir_body();
  LayeredFault crossing = dipping_fault();
  crossing.name = "X";
  crossing.trace = {{-1300, -400}, {1400, 300}};
  crossing.first_end = crossing.last_end = TraceEnd::in_rock;
  crossing.profiles = dipping(75);
  crossing.top = -1500;
  crossing.bottom = -2600;
  body.faults = {dipping_fault(), crossing};
  body.faults[0].moved = FaultThrow{100};
  const BuiltBody built = build_body(body, "body");
  const Mesh mesh = cut(built.mesh, "body");
  EXPECT_EQ(n_faces(mesh), n_facets(built.mesh));
  EXPECT_GT(places_of_copies(mesh)[4], 5);
}

TEST(BuildBody, HorizonsThatCrossAreRefusedWithPlace) {
  LayeredBody body = reservoir_body();
  body.horizons[0].depth = PlaneDepth{-1900, {0, 0}, {0.1, 0}};
  EXPECT_THAT(refusal_of(body),
              HasSubstr("/horizons/1: \"top\" and \"bottom\" cross, worst by 100 m at x -3000"));
  body.horizons[0].depth = ConstantDepth{10};
  EXPECT_THAT(refusal_of(body), HasSubstr("the top of the box and \"top\" cross"));
  body.horizons[0].depth = ConstantDepth{-1900};
  body.horizons[1].depth = ConstantDepth{-4000};
  EXPECT_THAT(refusal_of(body), HasSubstr("\"bottom\" and the base of the box cross"));
}

TEST(BuildBody, AllNumbersThatMakeNoSenseAreToldAtOnce) {
  LayeredBody body = reservoir_body();
  body.layers.pop_back();
  body.cells.far = 10;
  body.faults = {dipping_fault()};
  body.faults[0].profiles = dipping(4);
  body.faults[0].bottom = -5000;
  body.faults[0].moved = FaultThrow{100, 0.5, 0};
  body.compartments = {{"west", {0, 0}, {1}}};
  const std::string said = refusal_of(body);
  for (const char* what : {"horizons bound 3 layers, not 2", "sizes of cells",
                           "/faults/0/profiles/0: \"F\" dips by 4 degrees", "reaches from z -5000",
                           "the throw of \"F\"", "has 1 region for 2 layers"})
    EXPECT_THAT(said, HasSubstr(what));
  body.faults[0].profiles = {{{-1000, 100}, {-1000, 0}}};
  EXPECT_THAT(refusal_of(body), HasSubstr("a profile of \"F\" does not go down"));
  body.faults[0].profiles.resize(3);
  EXPECT_THAT(refusal_of(body), HasSubstr("\"F\" has 3 profiles for 2 points of its trace"));
}

/// "2 mm" for "200 m", say: told at once, and not after minutes when memory ends.
TEST(BuildBody, MoreCellsThanAnybodySolvesAreRefusedBeforeTheyAreMade) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.cells = {0.002, 800, 0.3};
  EXPECT_THAT(refusal_of(body), HasSubstr("cells of 0.002 m at the faults and 800 m at most "
                                          "would make a body of about 92400000 million cells"));
  body.cells = {0.5, 0.5, 0.3};
  EXPECT_THAT(refusal_of(body), HasSubstr("about 5322240 million cells")) << "all over";
  body.cells = {8, 8, 0.3};
  body.faults.clear();
  EXPECT_THAT(refusal_of(body), HasSubstr("about 1299 million cells"));
  body.dividers = {{"rim", {{1000, -2000}, {1000, 2000}}}};
  body.cells = {0.01, 800, 0.3};
  EXPECT_THAT(refusal_of(body), HasSubstr("about 57750 million cells")) << "8 cm at the divider";
}

/// Where growth is nothing, bands about faults are as wide as the box and count once.
TEST(BuildBody, CellsOfFaultsSideBySideCountOnce) {
  LayeredBody body = reservoir_body();
  for (int k = 0; k < 20; ++k) {
    LayeredFault fault = dipping_fault();
    fault.name = "F" + std::to_string(k);
    for (Eigen::Vector2d& point : fault.trace) point.x() = -2900 + 290 * k;
    body.faults.push_back(fault);
  }
  body.cells = {150, 151, 1e-5};
  EXPECT_THAT(refusal_of(body), testing::Not(HasSubstr("million cells")));
}

TEST(TetQuality, IsOneOfARegularAndSignedOfATurnedOne) {
  const Vector3d a(0, 0, 0), b(2, 0, 0), c(1, std::sqrt(3.0), 0),
      d(1, 1 / std::sqrt(3.0), std::sqrt(8.0 / 3));
  EXPECT_NEAR(scaled_inverse_condition({a, b, c, d}), 1, 1e-12);
  EXPECT_NEAR(scaled_inverse_condition({a, c, b, d}), -1, 1e-12);
  EXPECT_EQ(scaled_inverse_condition({a, b, c, a}), 0);
  // Flat by half: A = diag(1, 1, 1/2), |A| |A⁻¹| = 3/2 · √6.
  const Vector3d half(d.x(), d.y(), d.z() / 2);
  EXPECT_NEAR(scaled_inverse_condition({a, b, c, half}), 2 / std::sqrt(6.0), 1e-12);
}

}  // namespace
}  // namespace faultsim::horizons
