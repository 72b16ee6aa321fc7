// Blocks and faults that end along strike where they say: what must hold of whole cases.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/verification/field_runs.h"

namespace faultsim {
namespace {

constexpr double kSamePlace = 1e-6;  // m

Settings coarse(const Settings& more) {
  Settings all = kSlipping;
  all.emplace_back("/mesh",
                   R"({"strike": "600 m", "dip": "80 m", "normal": "150 m", "growth": 2})");
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::optional<std::size_t> node_at(const Fields& fields, const Eigen::Vector3d& place) {
  return find_node(fields,
                   [&](const Eigen::Vector3d& one) { return (one - place).norm() < kSamePlace; });
}

/// The same blocks and faults, said one by one: the same bits, whatever is said of all.
TEST(FieldExtents, ThatAreAlikeAreThoseOfAll) {
  const Fields common = run(coarse({}), {});
  const Fields own = run(coarse({{"/geometry/blocks/0/length", "2 km"},
                                 {"/geometry/blocks/1/y_from", "-1 km"},
                                 {"/geometry/blocks/1/y_to", "1 km"},
                                 {"/geometry/block_length", "1234 m"},
                                 {"/faults/0/length", "2400 m"},
                                 {"/faults/1/y_from", "-1200 m"},
                                 {"/faults/1/y_to", "1200 m"},
                                 {"/faults/2/length", "2.4 km"},
                                 {"/geometry/fault_length", "3 km"}}),
                         {});
  ASSERT_TRUE(own.plan.half_domain);
  ASSERT_EQ(own.geometry.nodes.size(), common.geometry.nodes.size());
  ASSERT_EQ(own.steps.size(), common.steps.size());
  for (std::size_t step = 0; step < own.steps.size(); ++step) {
    EXPECT_EQ(own.steps[step].traction, common.steps[step].traction) << step;
    EXPECT_EQ(own.steps[step].jump, common.steps[step].jump) << step;
  }
}

/// Nothing of a field tells north from south: seen in a mirror it has the results seen in it.
TEST(FieldExtents, AFieldSeenInAMirrorHasTheResultsSeenInIt) {
  const Fields here = run(coarse({{"/geometry/blocks/0/y_from", "-600 m"},
                                  {"/geometry/blocks/0/y_to", "1300 m"},
                                  {"/geometry/blocks/1/y_to", "400 m"},
                                  {"/faults/0/y_to", "1800 m"},
                                  {"/faults/2/y_from", "-900 m"},
                                  {"/faults/2/y_to", "700 m"}}),
                          {});
  const Fields there = run(coarse({{"/geometry/blocks/0/y_from", "-1300 m"},
                                   {"/geometry/blocks/0/y_to", "600 m"},
                                   {"/geometry/blocks/1/y_from", "-400 m"},
                                   {"/faults/0/y_from", "-1800 m"},
                                   {"/faults/2/y_from", "-700 m"},
                                   {"/faults/2/y_to", "900 m"}}),
                           {});
  ASSERT_FALSE(here.plan.half_domain || there.plan.half_domain);
  ASSERT_EQ(here.geometry.nodes.size(), there.geometry.nodes.size());
  const auto mirrored = [&](const Eigen::Vector3d& x) {
    return node_at(here, {x.x(), -x.y(), x.z()});
  };
  const Difference d = compare(here, there, mirrored, -1);
  EXPECT_EQ(d.compared, static_cast<int>(here.geometry.nodes.size()));
  EXPECT_GT(d.largest_jump, 0.01);
  EXPECT_LT(d.traction, 1e-8);
  EXPECT_LT(d.jump, 1e-8);
  EXPECT_GT(compare(here, there, mirrored).jump, 1e-3) << "some slip is along strike";
}

/// Blocks of lengths of their own, each centred: half of the domain says it all.
TEST(FieldExtents, HalfTheDomainOfCentredExtentsIsThatOfTheWhole) {
  const Settings centred = coarse({{"/geometry/blocks/0/length", "1400 m"},
                                   {"/geometry/blocks/1/length", "2600 m"},
                                   {"/faults/0/length", "1800 m"},
                                   {"/faults/2/length", "3 km"},
                                   {"/faults/2/overshoot", "300 m"}});
  const Fields half = run(centred, {{"/numerics/half_domain", "on"}});
  const Fields full = run(centred, {{"/numerics/half_domain", "off"}});
  ASSERT_TRUE(half.plan.half_domain && !full.plan.half_domain);
  const Difference d = compare(half, full, [&](const Eigen::Vector3d& x) {
    return x.y() < -kSamePlace ? std::optional<std::size_t>() : node_at(half, x);
  });
  EXPECT_EQ(d.compared, static_cast<int>(half.geometry.nodes.size()));
  EXPECT_GT(d.largest_jump, 0.01);
  EXPECT_LT(d.traction, 1e-8);
  EXPECT_LT(d.jump, 1e-8);
}

/// Traction changes from the start, of locked faults: what the blocks' pressures alone make.
std::vector<Eigen::MatrixXd> locked_changes(const Fields& fields) {
  std::vector<Eigen::MatrixXd> changes;
  for (const FaultFields& step : fields.steps) {
    EXPECT_EQ(step.jump.norm(), 0) << "faults are locked";
    changes.push_back(step.traction - fields.steps.front().traction);
  }
  return changes;
}

/// Pressures of parts add up. Blocks whose pressure stays put the same lines into all three meshes,
/// and the sideburden is of the reservoir's rock.
TEST(FieldExtents, TractionsOfTwoPartsOfABlockAddUpToThoseOfTheWhole) {
  const auto part = [](const char* from, const char* to) {
    return run({{"/tier", "custom"},
                {"/output/observation_points", "[]"},
                {"/friction/cohesion", "1 GPa"},
                {"/mesh", R"({"strike": "500 m", "dip": "80 m", "normal": "150 m", "growth": 2})"},
                {"/numerics/half_domain", "off"},
                {"/faults", R"([{"name": "F1"}, {"name": "F2"}, {"name": "F3"}, {"name": "F4"}])"},
                {"/geometry/blocks",
                 concat(R"([{"name": "west", "from": "-2 km", "to": "0 m", "y_from": ")", from,
                        R"(", "y_to": ")", to,
                        R"("}, {"name": "all", "from": "0 m", "to": "1 km", "y_from": "-900 m", )"
                        R"("y_to": "1300 m"}, {"name": "east", "from": "1 km", "to": "2 km", )"
                        R"("y_from": "200 m", "y_to": "1300 m"}])")},
                {"/compartments", R"({"all": {"scale": 0}, "east": {"scale": 0}})"}},
               {});
  };
  const Fields whole = part("-900 m", "1300 m"), south = part("-900 m", "200 m"),
               north = part("200 m", "1300 m");
  ASSERT_EQ(whole.geometry.nodes.size(), south.geometry.nodes.size());
  ASSERT_EQ(whole.geometry.nodes.size(), north.geometry.nodes.size());
  const auto all = locked_changes(whole), a = locked_changes(south), b = locked_changes(north);
  double largest = 0, difference = 0, of_part = 0;
  for (std::size_t step = 0; step < all.size(); ++step) {
    largest = std::max(largest, all[step].cwiseAbs().maxCoeff());
    of_part =
        std::max(of_part, std::min(a[step].cwiseAbs().maxCoeff(), b[step].cwiseAbs().maxCoeff()));
    difference = std::max(difference, (all[step] - a[step] - b[step]).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 1e6);
  EXPECT_GT(of_part, 0.3 * largest) << "each says something";
  EXPECT_LT(difference, 1e-9 * largest);
}

}  // namespace
}  // namespace faultsim
