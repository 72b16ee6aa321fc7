#include "simulator/model/fault_profile.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "simulator/model/fault_operator.h"

namespace faultsim {
namespace {

/// A vertical fault along y, by (distance along strike, depth) of its points, m.
struct Surface {
  /// @param split  whether the sides can move apart at that point.
  void point(double along, double depth, bool split) {
    fault.points.emplace_back(0, along, -depth);
    fault.node_of_point.push_back(split ? fault.n_nodes++ : -1);
    if (!split) return;
    OperatorNode node;
    node.position = fault.points.back();
    node.strike = Eigen::Vector3d::UnitY();
    node.dip = -Eigen::Vector3d::UnitZ();
    nodes.push_back(node);
  }
  std::vector<Profile> profiles() const { return fault_profiles(fault, nodes); }

  OperatorFault fault;
  std::vector<OperatorNode> nodes;
};

/// Points at all pairs of the coordinates, along strike in the outer loop; the rim is not split.
Surface grid(const std::vector<double>& along, const std::vector<double>& depth) {
  Surface surface;
  const int n_rows = static_cast<int>(depth.size()), n_columns = static_cast<int>(along.size());
  for (int c = 0; c < n_columns; ++c) {
    for (int r = 0; r < n_rows; ++r) {
      surface.point(along[c], depth[r], c > 0 && r > 0 && c + 1 < n_columns && r + 1 < n_rows);
      const int at = c * n_rows + r;
      if (c > 0 && r > 0) surface.fault.faces.push_back({at - n_rows - 1, at - n_rows, at, at - 1});
    }
  }
  return surface;
}

void expect_samples(const Profile& profile, const std::vector<int>& node,
                    const std::vector<double>& position) {
  ASSERT_EQ(profile.samples.size(), node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    const ProfileSample& sample = profile.samples[i];
    EXPECT_EQ(sample.node[0], node[i]);
    EXPECT_EQ(sample.node[1], node[i]);
    EXPECT_EQ(sample.weight[0], 1);
    EXPECT_EQ(sample.moving, 1);
    EXPECT_EQ(sample.position, position[i]);
  }
}

TEST(FaultProfiles, OfAGridAreItsLinesDownDip) {
  const std::vector<Profile> profiles =
      grid({0, 10, 30, 70}, {1000, 1002, 1006, 1014, 1030}).profiles();
  ASSERT_EQ(profiles.size(), 2u);
  expect_samples(profiles[0], {0, 1, 2}, {2, 6, 14});
  expect_samples(profiles[1], {3, 4, 5}, {2, 6, 14});
  EXPECT_EQ(profiles[0].width, 15);  // half of 10 and of 20
  EXPECT_EQ(profiles[1].width, 30);
  for (const Profile& profile : profiles) {
    EXPECT_EQ(profile.tip_before, 0);
    EXPECT_EQ(profile.tip_after, 30);
    EXPECT_EQ(profile.length(), 30);
    EXPECT_EQ(profile.edge, (std::vector<double>{1, 4, 10, 22}));
    EXPECT_EQ(profile.share(1), 6);
    EXPECT_TRUE(profile.strike_edge);
  }
}

TEST(FaultProfiles, InPlaneStrainThereIsOneOfOneMetre) {
  Surface surface;
  for (int k = 0; k < 11; ++k) {
    surface.point(0, 10 * k, k > 0);  // the body ends at the last
    if (k > 0) surface.fault.faces.push_back({k - 1, k, k, k - 1});
  }
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 1u);
  const Profile& profile = profiles[0];
  EXPECT_EQ(profile.width, 1);
  EXPECT_FALSE(profile.strike_edge);
  EXPECT_EQ(profile.tip_before, 0);
  EXPECT_TRUE(std::isnan(profile.tip_after));
  EXPECT_EQ(profile.samples.size(), 10u);
  EXPECT_EQ(profile.edge.front(), 5);
  EXPECT_EQ(profile.edge.back(), 100);
  EXPECT_EQ(profile.share(0), 10);
  EXPECT_EQ(profile.share(9), 5);
  EXPECT_EQ(profile.length(), 100);
}

TEST(FaultProfiles, WhereTheBodyCutsTheFaultIsNoEdge) {
  Surface surface = grid({-10, 0, 10, 20}, {0, 5, 10});
  for (std::size_t k = 0; k < 3; ++k) {  // half of the fault: it begins at the plane y = 0
    surface.fault.points.erase(surface.fault.points.begin());
    surface.fault.node_of_point.erase(surface.fault.node_of_point.begin());
  }
  surface.fault.faces.erase(surface.fault.faces.begin(), surface.fault.faces.begin() + 2);
  for (auto& face : surface.fault.faces)
    for (int& point : face) point -= 3;
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_EQ(profiles[0].width, 5);
  EXPECT_FALSE(profiles[0].strike_edge);
  EXPECT_EQ(profiles[1].width, 10);
  EXPECT_TRUE(profiles[1].strike_edge);
}

/// A fault that bends along strike, one end by 40 degrees: its profiles go straight down all the
/// same.
TEST(FaultProfiles, OfACurvedFaultGoDownTheMeanDip) {
  Surface surface = grid({0, 10, 20, 30, 40, 50}, {1000, 1010, 1020, 1030});
  const auto bent = [](double along) { return 0.0085 * (50 - along) * (50 - along); };
  for (Eigen::Vector3d& point : surface.fault.points) point.x() = bent(point.y());
  for (OperatorNode& node : surface.nodes) {
    const double slope = -2 * 0.0085 * (50 - node.position.y());
    node.area = 100;
    node.strike = Eigen::Vector3d(slope, 1, 0).normalized();
    node.normal = node.strike.cross(Eigen::Vector3d::UnitZ());
    node.position.x() = bent(node.position.y());
  }
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const int first = 2 * static_cast<int>(k);
    ASSERT_EQ(profiles[k].samples.size(), 2u);
    EXPECT_EQ(profiles[k].samples[0].node[0], first);
    EXPECT_EQ(profiles[k].samples[1].node[0], first + 1);
    EXPECT_NEAR(profiles[k].length(), 30, 1e-9);
  }
}

/// A trace of two legs of 40 m that turns by an angle between them: as wide as it is long, and no
/// profile joins both legs, also where the second comes back beside the first.
TEST(FaultProfiles, OfABentFaultAreTogetherAsWideAsItsTraceIsLong) {
  for (const double degrees : {20., 60., 90., 120., 150., 179.}) {
    SCOPED_TRACE(degrees);
    Surface surface = grid({0, 10, 20, 30, 40, 50, 60, 70, 80}, {1000, 1010, 1020, 1030});
    const double turn = degrees * std::numbers::pi / 180;
    const Eigen::Vector3d first = Eigen::Vector3d::UnitY(),
                          second(std::sin(turn), std::cos(turn), 0);
    const auto bent = [&](const Eigen::Vector3d& straight) -> Eigen::Vector3d {
      const double along = straight.y();
      return std::min(along, 40.) * first + std::max(along - 40, 0.) * second +
             Eigen::Vector3d(0, 0, straight.z());
    };
    for (OperatorNode& node : surface.nodes) {
      node.area = 100;
      node.strike = node.position.y() < 40 ? first : second;
      node.normal = node.strike.cross(Eigen::Vector3d::UnitZ());
      node.position = bent(node.position);
    }
    for (Eigen::Vector3d& point : surface.fault.points) point = bent(point);
    const std::vector<Profile> profiles = surface.profiles();
    ASSERT_EQ(profiles.size(), 7u);
    double width = 0;
    for (const Profile& profile : profiles) {
      EXPECT_EQ(profile.samples.size(), 2u);
      EXPECT_NEAR(profile.length(), 30, 1e-9);
      width += profile.width;
    }
    EXPECT_NEAR(width, 70, 1e-9);  // half of the first and of the last cell is no profile's
  }
}

/// Two parts of one fault that overlap along strike, 100 m apart.
TEST(FaultProfiles, KeepToTheirPart) {
  Surface surface = grid({0, 10, 20, 30, 40}, {1000, 1010, 1020, 1030});
  const Surface other = grid({25, 35, 45, 55, 65}, {1000, 1010, 1020, 1030});
  const int n = static_cast<int>(surface.fault.points.size());
  for (std::size_t i = 0; i < other.fault.points.size(); ++i) {
    const Eigen::Vector3d& point = other.fault.points[i];
    surface.point(point.y(), -point.z(), other.fault.node_of_point[i] >= 0);
    surface.fault.points.back().x() = 100;
  }
  for (std::array<int, 4> face : other.fault.faces) {
    for (int& corner : face) corner += n;
    surface.fault.faces.push_back(face);
  }
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 6u);
  for (const Profile& profile : profiles) {
    ASSERT_EQ(profile.samples.size(), 2u);
    EXPECT_EQ(profile.samples[0].node[0] < 6, profile.samples[1].node[0] < 6);
    EXPECT_EQ(profile.width, 10);
    EXPECT_EQ(profile.length(), 30);
  }
  EXPECT_EQ(profiles[2].samples[0].node[0], 4);  // at 30 m; the other part begins at 35 m
  EXPECT_EQ(profiles[3].samples[0].node[0], 6);
}

TEST(FaultProfiles, WithoutNodesThereAreNone) {
  Surface surface;
  surface.point(0, 0, false);
  surface.point(0, 1, false);
  surface.fault.faces = {{0, 1, 1, 0}};
  EXPECT_TRUE(surface.profiles().empty());
}

/// Grid lines that lean by 5 m along strike per row: dip lines through the nodes cross edges.
TEST(FaultProfiles, CrossFacesWhoseEdgesDoNotGoDownDip) {
  Surface surface;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      surface.point(20 * c + 5 * r, 10 * r, c > 0 && c < 3 && r > 0 && r < 3);
      const int at = 4 * c + r;
      if (c > 0 && r > 0) surface.fault.faces.push_back({at - 5, at - 4, at, at - 1});
    }
  }
  // Nodes 0 at (25, 10), 1 at (30, 20), 2 at (45, 10), 3 at (50, 20); faces are 25 m wide.
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 2u);  // through nodes 0 and 2; 5 m are less than half a face
  const Profile& profile = profiles[0];
  ASSERT_EQ(profile.samples.size(), 2u);
  EXPECT_EQ(profile.tip_before, 0);  // on the edge from (20, 0) to (40, 0)
  EXPECT_EQ(profile.samples[0].node[0], 0);
  EXPECT_EQ(profile.samples[0].position, 10);
  // At 25 m of the edge from (10, 20), unsplit, to node 1: a quarter of the way from the node.
  EXPECT_EQ(profile.samples[1].node, (std::array<int, 2>{1, 1}));
  EXPECT_DOUBLE_EQ(profile.samples[1].moving, 0.75);
  EXPECT_DOUBLE_EQ(profile.samples[1].position, 20);
  EXPECT_DOUBLE_EQ(profile.tip_after, 30);
  EXPECT_DOUBLE_EQ(profile.edge.back(), 25);
}

TEST(FaultProfiles, WeighTheEndsOfTheEdgesThatTheyCross) {
  Surface surface;  // a triangle between node 0 and the edge from node 1 to node 2
  surface.point(10, 0, true);
  surface.point(0, 8, true);
  surface.point(40, 16, true);
  surface.fault.faces = {{0, 1, 2, 2}};
  const std::vector<Profile> profiles = surface.profiles();
  ASSERT_EQ(profiles.size(), 2u);  // at 0 and 40 m: 10 m from the first are less than half of 40 m
  EXPECT_EQ(profiles[0].samples.size(), 1u);
  EXPECT_EQ(profiles[0].width, 20);
  surface.point(25, 4, true);
  surface.fault.faces = {{0, 1, 3, 3}, {1, 2, 3, 3}};  // 25 m wide, so that there is one at 25 m
  const std::vector<Profile> three = surface.profiles();
  ASSERT_EQ(three.size(), 3u);
  ASSERT_EQ(three[1].samples.size(), 2u);
  EXPECT_EQ(three[1].samples[0].node[0], 3);
  const ProfileSample& sample = three[1].samples[1];
  EXPECT_EQ(sample.node, (std::array<int, 2>{2, 1}));  // the heavier first
  EXPECT_DOUBLE_EQ(sample.weight[0], 0.625);
  EXPECT_DOUBLE_EQ(sample.weight[1], 0.375);
  EXPECT_DOUBLE_EQ(sample.position, 9);  // at 13 m of depth
  const Eigen::VectorXd values = Eigen::Vector4d(0, 8, 16, 0);
  EXPECT_DOUBLE_EQ(sample.of(values), 13);
  EXPECT_DOUBLE_EQ(sample.slip(values), 13);
}

}  // namespace
}  // namespace faultsim
