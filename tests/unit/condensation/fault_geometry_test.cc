#include "simulator/condensation/fault_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/mesh/mesh_spec.h"

namespace faultsim {
namespace {

/// The geometry of a patch, its strike and dip in degrees, in a box of cells of 1 m.
FaultGeometry geometry_of(double strike, double dip, bool ellipse, double length, double width) {
  constexpr double kDegree = 0.017453292519943295;
  BoxMeshSpec spec{};
  spec.from = {-12, -12, -12};
  spec.to = {12, 12, 12};
  spec.layer_materials = {0};
  spec.fault_names = {"F"};
  spec.patches = {{{0, 0, 0},
                   strike * kDegree,
                   dip * kDegree,
                   length,
                   width,
                   ellipse ? PatchShape::ellipse : PatchShape::rectangle}};
  spec.sizes = {1, 1, 1, 1.3, 0, 0};
  const Mesh mesh = make_mesh(spec);
  return fault_geometry(mesh, {{10e9, 0.2}}, DofMap(mesh, {}, 0), false);
}

double area_of(const FaultGeometry& geometry) {
  double area = 0;
  for (const OperatorNode& node : geometry.nodes) area += node.area;
  return area;
}

/// By what profiles stand for: their dual cells times their widths.
double profile_area(const OperatorFault& fault) {
  double area = 0;
  for (const Profile& p : fault.profiles) area += p.width * (p.edge.back() - p.edge.front());
  return area;
}

TEST(FaultGeometry, ProfilesAreTheLinesOfCellsWhereTheseGoDownDip) {
  for (const bool ellipse : {false, true}) {
    for (const auto& [strike, dip] :
         {std::pair{0.0, 30.0}, {30.0, 0.0}, {0.0, 90.0}, {30.0, 25.0}}) {
      if (ellipse && strike != 0 && dip != 0) continue;
      SCOPED_TRACE(testing::Message() << ellipse << " strike " << strike << " dip " << dip);
      const FaultGeometry geometry = geometry_of(strike, dip, ellipse, 10, 8);
      const OperatorFault& fault = geometry.faults[0];
      std::vector<int> nodes;
      for (const Profile& profile : fault.profiles) {
        for (const ProfileSample& sample : profile.samples) {
          nodes.push_back(sample.node[0]);
          EXPECT_EQ(sample.weight[0], 1);
          EXPECT_EQ(sample.moving, 1);
        }
      }
      std::sort(nodes.begin(), nodes.end());
      ASSERT_EQ(nodes.size(), geometry.nodes.size());  // each once
      EXPECT_TRUE(std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end());
      EXPECT_NEAR(profile_area(fault), area_of(geometry), (ellipse ? 0.02 : 1e-9) * 80);
    }
  }
}

/// Lines of cells lean along strike in the plane of a patch with strike and dip. Lengths along them
/// times widths across strike would be more than its area.
TEST(FaultGeometry, ProfilesGoDownDipWhereLinesOfCellsDoNot) {
  for (const bool ellipse : {true, false}) {
    const FaultGeometry geometry =
        ellipse ? geometry_of(35, 30, true, 12, 10) : geometry_of(20, 15, false, 1000, 1000);
    const OperatorFault& fault = geometry.faults[0];
    const OperatorNode& frame = geometry.nodes[0];
    std::size_t n_between = 0;
    for (const Profile& profile : fault.profiles) {
      std::vector<Eigen::Vector3d> places;
      for (const ProfileSample& sample : profile.samples) {
        if (sample.moving < 1) continue;
        places.push_back(sample.weight[0] * geometry.nodes[sample.node[0]].position +
                         sample.weight[1] * geometry.nodes[sample.node[1]].position);
        EXPECT_NEAR(places.back().dot(frame.strike), places.front().dot(frame.strike), 1e-5);
        EXPECT_GE(places.back().dot(frame.dip), places.front().dot(frame.dip));
        n_between += sample.weight[1] > 0;
      }
    }
    EXPECT_GT(2 * n_between, geometry.nodes.size());
    const double exact = ellipse ? M_PI * 6 * 5 : area_of(geometry);
    EXPECT_NEAR(profile_area(fault), exact, (ellipse ? 0.1 : 0.03) * exact) << ellipse;
  }
}

}  // namespace
}  // namespace faultsim
