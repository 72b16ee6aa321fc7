#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "simulator/mesh/uncut_mesh.h"
#include "tests/unit/mesh/cut_body.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using test::body_of;
using test::made_of;
using test::PlanePart;

const PlanePart kThrough = {"A", {1, 0, 0}, 2};
const PlanePart kEnding = {"B", {0, 1, 0}, 2, [](const Vector3d& x) { return x.x() > 2; }};
const PlanePart kCrossing = {"C", {0, 0, 1}, 2};

UncutMesh cube_with(const std::vector<PlanePart>& faults) {
  return body_of(made_of(4, 3), 4, faults);
}

double total_area(const FaultSurface& fault) {
  return std::accumulate(fault.nodes.begin(), fault.nodes.end(), 0.0,
                         [](double sum, const FaultNode& node) { return sum + node.area; });
}

/// How many copies there are at each place.
std::map<int, int> copies_at(const Mesh& mesh) {
  std::map<int, int> count;
  for (const NodeCopy& copy : mesh.copies) ++count[copy.first];
  return count;
}

std::string said(const UncutMesh& body) {
  try {
    cut(body, "body.msh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Cut, AThroughGoingFaultHasTwoCopiesEverywhere) {
  const Mesh mesh = cut(cube_with({kThrough}), "");
  ASSERT_EQ(mesh.faults.size(), 1u);
  const FaultSurface& fault = mesh.faults[0];
  EXPECT_EQ(fault.nodes.size(), 25u);
  EXPECT_EQ(fault.faces.size(), 32u);
  EXPECT_NEAR(total_area(fault), 16, 1e-12);
  // 25 corners and the middles of 2 · 4 · 5 + 16 sides.
  EXPECT_EQ(mesh.copies.size(), 2u * (25 + 56));
  for (const FaultNode& node : fault.nodes) {
    EXPECT_EQ(node.normal, Vector3d(1, 0, 0));
    EXPECT_EQ(node.dip, Vector3d(0, 0, -1));
    EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(node.minus_node)],
              mesh.nodes[static_cast<std::size_t>(node.plus_node)]);
  }
  for (const NodeCopy& copy : mesh.copies) {
    const bool is_corner = copy.first < 125;
    EXPECT_EQ(copy.shares.size(), is_corner ? 1u : 2u);
    for (const JumpShare& share : copy.shares)
      EXPECT_EQ(std::abs(share.weight), is_corner ? 0.5 : 0.25);
  }
}

TEST(Cut, CellsHaveTheCopyOfTheirSide) {
  const Mesh mesh = cut(cube_with({kThrough, kEnding}), "");
  std::map<int, double> weight_of_a, weight_of_b;
  for (const NodeCopy& copy : mesh.copies)
    for (const JumpShare& share : copy.shares)
      (share.fault == 0 ? weight_of_a : weight_of_b)[copy.node] += share.weight;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    Vector3d centre = Vector3d::Zero();
    for (const int node : mesh.cells.corners(cell))
      centre += mesh.nodes[static_cast<std::size_t>(node)] / 4;
    for (const int node : mesh.cells[cell]) {
      if (weight_of_a.contains(node)) {
        EXPECT_EQ(weight_of_a[node] > 0, centre.x() > 2);
      }
      if (weight_of_b.contains(node)) {
        EXPECT_EQ(weight_of_b[node] > 0, centre.y() > 2);
      }
    }
  }
}

TEST(Cut, AnEndAtAnotherFaultIsFound) {
  const Mesh mesh = cut(cube_with({kThrough, kEnding}), "");
  int n_three = 0;
  for (const auto& [first, count] : copies_at(mesh)) n_three += count == 3;
  EXPECT_EQ(n_three, 5 + 4);  // corners and middles of sides on the line where B ends
  EXPECT_EQ(mesh.faults[0].nodes.size(), 25u);
  EXPECT_EQ(mesh.faults[1].nodes.size(), 15u);
  EXPECT_NEAR(total_area(mesh.faults[1]), 8, 1e-12);
}

TEST(Cut, AnEvenTractionOfTheFaultThatGoesOnDoesNoWorkWithTheOther) {
  const Mesh mesh = cut(cube_with({kThrough, kEnding}), "");
  // At an inner node of the line: hats of A beside B below and above it are its facets' thirds.
  for (const NodeCopy& copy : mesh.copies) {
    const Vector3d& x = mesh.nodes[static_cast<std::size_t>(copy.first)];
    if (copy.first >= 125 || x.x() != 2 || x.y() != 2) continue;
    double area_below = 0, area_above = 0, w_below = 0, w_above = 0;
    for (const FaultFace& face : mesh.faults[0].faces) {
      bool touches = false;
      double y = 0;
      for (std::size_t v = 0; v < 3; ++v) {
        const Vector3d& at = mesh.faults[0].points[static_cast<std::size_t>(face.points[v])];
        touches = touches || at == x;
        y += at.y() / 3;
      }
      if (touches) (y < 2 ? area_below : area_above) += face.area / 3;
    }
    for (const NodeCopy& other : mesh.copies)
      for (const JumpShare& share : other.shares)
        if (other.first == copy.first && share.fault == 1)
          (share.weight < 0 ? w_below : w_above) = share.weight;
    EXPECT_NEAR(w_below * area_below + w_above * area_above, 0, 1e-12);
    EXPECT_NEAR(w_above - w_below, 1, 1e-12);
  }
}

TEST(Cut, CrossingFaultsHaveFourCopies) {
  const Mesh mesh = cut(cube_with({kThrough, kCrossing}), "");
  int n_four = 0;
  for (const auto& [first, count] : copies_at(mesh)) n_four += count == 4;
  EXPECT_EQ(n_four, 5 + 4);
  EXPECT_EQ(mesh.faults[0].nodes.size(), 25u);
  EXPECT_EQ(mesh.faults[1].nodes.size(), 25u + 5) << "on both sides of A";
  EXPECT_EQ(mesh.faults[1].points.size(), 30u);
}

TEST(Cut, ATipIsNotSplit) {
  const Mesh mesh = cut(
      cube_with({{"F", {1, 0, 0}, 2, [](const Vector3d& x) { return x.y() > 1 && x.y() < 3; }}}),
      "");
  EXPECT_EQ(mesh.faults[0].nodes.size(), 5u) << "y = 2";
  EXPECT_EQ(mesh.faults[0].points.size(), 15u);
  EXPECT_EQ(std::ranges::count(mesh.faults[0].node_of_point, -1), 10);
}

TEST(Cut, SidesDoNotDependOnHowFacetsAreTurned) {
  UncutMesh body = cube_with({{"F", {0.0, 1, 0}, 2}});
  const Mesh mesh = cut(body, "");
  for (std::size_t k = 0; k < body.faults[0].facets.size(); k += 2)
    std::swap(body.faults[0].facets[k][0], body.faults[0].facets[k][1]);
  const Mesh turned = cut(body, "");
  EXPECT_EQ(mesh.cells, turned.cells);
  for (std::size_t k = 0; k < mesh.faults[0].nodes.size(); ++k)
    EXPECT_EQ(mesh.faults[0].nodes[k].normal, Vector3d(0, 1, 0));
}

TEST(Cut, ACurvedFaultMeetsAPlaneSideInTheSidesPlane) {
  UncutMesh body = cube_with({kThrough});
  for (Vector3d& x : body.nodes) {
    if (x.z() > 0 && x.z() < 4) x.z() += 0.15 * std::sin(3 * x.y() + 5 * x.z());
    x.x() += 0.2 * std::sin(x.z());  // triangles of the cylinder that are not alike
  }
  const Mesh mesh = cut(body, "");
  double largest_off = 0;
  for (const FaultNode& node : mesh.faults[0].nodes) {
    const double y = mesh.nodes[static_cast<std::size_t>(node.minus_node)].y();
    if (y == 0 || y == 4) {
      EXPECT_EQ(node.normal.y(), 0);
      EXPECT_EQ(node.strike, Vector3d(0, -1, 0));
    }
    largest_off = std::max(largest_off, std::abs(node.normal.y()));
  }
  EXPECT_LT(largest_off, 0.1);
  const Mesh oblique = cut(cube_with({{"F", {1, -1, 0}, 0}}), "");
  for (const FaultNode& node : oblique.faults[0].nodes)
    EXPECT_NEAR(std::abs(node.normal.y()), std::sqrt(0.5), 1e-12)
        << "it meets the sides at 45 degrees";
}

TEST(Cut, BoundaryGroupsHaveTheirNodes) {
  const Mesh mesh = cut(cube_with({kThrough}), "");
  EXPECT_EQ(mesh.boundary.size(), 6u * 32);
  for (const BoundaryFace& face : mesh.boundary) {
    const int side = face.group.index;
    ASSERT_EQ(face.nodes().size(), 6u);
    for (const int node : face.nodes())
      EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(node)][side / 2], side % 2 == 0 ? 0 : 4);
    const auto at = [&](int v) {
      return mesh.nodes[static_cast<std::size_t>(face.places[static_cast<std::size_t>(v)])];
    };
    EXPECT_EQ(at(3), Vector3d((at(0) + at(1)) / 2));
    EXPECT_EQ(at(4), Vector3d((at(1) + at(2)) / 2));
    const Vector3d out = (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(side % 2 == 0 ? -out[side / 2] : out[side / 2], 0);
  }
}

TEST(Cut, EveryProblemIsSaidAtOnce) {
  UncutMesh body =
      cube_with({kThrough, {"B", {1, 0, 0}, 2, [](const Vector3d& x) { return x.y() < 1; }}});
  body.faults[0].facets.push_back({0, 1, 124, -1});
  body.faults.push_back({"outside", body.boundary[0].facets});
  body.boundary[1].facets.push_back(body.faults[0].facets[0]);
  EXPECT_EQ(
      said(body),
      "body.msh: fault \"A\": 1 of 33 facets are not faces of cells, the first at x 1.666667, y "
      "1.333333, z 1.333333 m; embed the fault in the volumes before they are meshed\n"
      "body.msh: fault \"B\": 8 of 8 facets belong to \"A\" too, the first at x 2, y "
      "0.6666667, z 0.3333333 m; let each facet belong to one fault\n"
      "body.msh: fault \"B\" has no facet inside; leave it out\n"
      "body.msh: fault \"outside\": 32 of 32 facets are on the outside of the body, the first "
      "at x 0, y 0.6666667, z 0.3333333 m; let the fault end at the outside or leave it out\n"
      "body.msh: fault \"outside\" has no facet inside; leave it out\n"
      "body.msh: boundary \"x+\": 1 of 33 facets are not on the outside of the body, the "
      "first at x 2, y 0.6666667, z 0.3333333 m; let its surfaces bound the volumes, on one "
      "side only");
}

TEST(Cut, AFaultThatBranchesIsRefused) {
  UncutMesh body = cube_with({kThrough, kEnding});
  body.faults[0].facets.insert(body.faults[0].facets.end(), body.faults[1].facets.begin(),
                               body.faults[1].facets.end());
  body.faults.pop_back();
  EXPECT_EQ(
      said(body),
      "body.msh: fault \"A\" branches along 4 edges, the first at x 2, y 2, z 0.5 m; give each "
      "branch a name of its own");
}

TEST(Cut, AVIsRefusedWithItsPlace) {
  const UncutMesh body =
      cube_with({{"A", {1, 0, 0}, 2, [](const Vector3d& x) { return x.y() > 2; }},
                 {"B", {0, 1, 0}, 2, [](const Vector3d& x) { return x.x() > 2; }}});
  EXPECT_EQ(
      said(body),
      "body.msh: the faults \"A\", \"B\" cut the rock only together, at 9 nodes, the first at x "
      "2, y 2, z 0 m: a jump there would belong to none; let one of them extend beyond the other, "
      "or make them one fault");
}

TEST(Cut, OverlappingCellsAreRefused) {
  UncutMesh body = cube_with({});
  body.nodes.push_back({0.1, 0.2, 0.3});
  const std::vector<int> face(body.corners.begin() + 1, body.corners.begin() + 4);
  body.corners.insert(body.corners.end(), face.begin(), face.end());
  body.corners.push_back(125);
  body.material.push_back(0);
  body.region.push_back(-1);
  body.region_fraction.push_back(0);
  EXPECT_THAT(said(body), testing::HasSubstr("1 face is of more than two cells, the first at "));
}

TEST(Quality, ARegularTetrahedronHasOne) {
  Mesh mesh;
  mesh.cells = Cells(CellShape::tetrahedron);
  const std::vector<Vector3d> corners = {{1, 1, 1}, {-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}};
  mesh.nodes = corners;
  for (const auto& [a, b] : kTetrahedronSides) mesh.nodes.push_back((corners[a] + corners[b]) / 2);
  const double volume =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]);
  if (volume > 0) {
    mesh.cells.add({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  } else {
    mesh.cells.add({0, 2, 1, 3, 6, 5, 4, 7, 9, 8});
  }
  EXPECT_NEAR(check_quality(mesh).min_scaled_jacobian, 1, 1e-12);
  EXPECT_NEAR(check_quality(mesh).max_aspect, 1, 1e-12);
  mesh.nodes[3] = 0.9999 * (corners[0] + corners[1] + corners[2]) / 3 + 1e-4 * corners[3];
  EXPECT_THAT(check_quality(mesh).refusal, testing::HasSubstr("is too distorted"));
}

}  // namespace
}  // namespace faultsim
