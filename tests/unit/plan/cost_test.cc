#include "simulator/plan/cost.h"

#include <gtest/gtest.h>

#include "simulator/common/stopwatch.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

Scene reference(const std::vector<std::pair<std::string, std::string>>& changes) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
  for (const auto& [pointer, value] : changes) set_value(document, pointer, value);
  return read_scene(document);
}

/// The plan with its savings.
Plan planned_twice(const Scene& scene) {
  std::vector<Problem> problems;
  Plan plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  add_savings(scene, plan);
  return plan;
}

const Reduction& find(const Plan& plan, const std::string& name) {
  for (const Reduction& reduction : plan.reductions) {
    if (reduction.name == name) return reduction;
  }
  throw std::out_of_range(name);
}

TEST(DissectedFactor, OfOneBlockIsDense) {
  GridShape shape;
  shape.n_lines = {2, 2, 2};
  const FactorSize size = dissected_factor(shape);
  EXPECT_DOUBLE_EQ(size.entries, 24 * 24);
  EXPECT_DOUBLE_EQ(size.flops, 24.0 * 24 * 24 / 3);
  EXPECT_DOUBLE_EQ(size.largest_update, 0);
}

/// 3 x 5 nodes of 2 unknowns: a cut of 3 nodes between two blocks of 6.
TEST(DissectedFactor, OfOneCutByHand) {
  GridShape shape;
  shape.n_lines = {3, 1, 5};
  shape.unknowns_per_node = 2;
  const FactorSize size = dissected_factor(shape);
  EXPECT_DOUBLE_EQ(size.entries, 6 * 6 + 2 * 12 * (12 + 6));
  EXPECT_DOUBLE_EQ(size.flops, 6 * 6 * 6 / 3.0 + 2 * (18 * 18 * 18 - 6 * 6 * 6) / 3.0);
  EXPECT_DOUBLE_EQ(size.largest_update, 6 * 6);
  EXPECT_DOUBLE_EQ(size.heaviest_way, 6 * 6 + 12 * (12 + 6));
}

/// Each cell goes up one way and is a column of the block.
TEST(InfluenceCost, GrowsWithTheCells) {
  GridShape shape;
  shape.n_lines = {40, 20, 30};
  shape.faults = {{.lines = {{{20, 21}, {5, 15}, {5, 25}}}}};
  const InfluenceCost none = influence_cost(shape, 0, 3), some = influence_cost(shape, 1000, 3);
  EXPECT_DOUBLE_EQ(some.bytes, 8 * 1000 * (600 + 3));
  EXPECT_NEAR(some.peak_bytes - none.peak_bytes, some.bytes, 1);
  EXPECT_GT(some.seconds, none.seconds);
  EXPECT_LT(some.seconds, 3);
  EXPECT_GT(some.peak_bytes, operator_cost(shape).factor_bytes);
}

/// The same with a fault of one node pair on the lowest line: 2 jumps below that block and the cut
/// above it, and their own dense block.
TEST(DissectedFactor, JumpsComeLast) {
  GridShape shape;
  shape.n_lines = {3, 1, 5};
  shape.unknowns_per_node = 2;
  shape.faults.push_back({{{{1, 2}, {0, 1}, {0, 1}}}});
  EXPECT_DOUBLE_EQ(shape.n_jump(), 2);
  EXPECT_DOUBLE_EQ(dissected_factor(shape).entries,
                   6 * (6 + 2) + 12 * (12 + 6 + 2) + 12 * (12 + 6) + 2 * 2);
}

/// A mesh that nobody can run is still planned, at once, and the figures go on where those of the
/// largest that is dissected end.
TEST(DissectedFactor, GoesOnBeyondWhatIsDissected) {
  const auto cube = [](int n) {
    GridShape shape;
    shape.n_lines = {n, n, n};
    shape.faults.push_back({{{{n / 2, n / 2 + 1}, {n / 4, 3 * n / 4}, {n / 4, 3 * n / 4}}}});
    return shape;
  };
  const FactorSize below = dissected_factor(cube(125)), above = dissected_factor(cube(150));
  EXPECT_NEAR(above.entries / below.entries, 2.07, 0.2);  // (150/125)^4
  EXPECT_NEAR(above.flops / below.flops, 2.99, 0.3);      // (150/125)^6
  const Stopwatch watch;
  EXPECT_GT(dissected_factor(cube(100000)).flops, 1e27);
  EXPECT_LT(watch.seconds(), 30) << "gone through";
}

TEST(Savings, AreThePlanTheOtherWayRound) {
  const Scene scene = reference({{"/tier", "demonstration"}});
  const Plan plan = planned_twice(scene);
  const Reduction& half = find(plan, "half_domain");
  ASSERT_TRUE(half.applied && half.saving);
  EXPECT_EQ(half.saving->with.n_unknowns, plan.n_unknowns);
  const Plan full =
      planned_twice(reference({{"/tier", "demonstration"}, {"/numerics/half_domain", "off"}}));
  EXPECT_EQ(half.saving->without.memory_bytes, full.memory_bytes);
  EXPECT_EQ(half.saving->without.operator_seconds, full.operator_seconds);
  const Reduction& off = find(full, "half_domain");
  ASSERT_TRUE(!off.applied && off.saving);
  EXPECT_EQ(off.saving->with.operator_seconds, plan.operator_seconds);
  EXPECT_EQ(off.bound, half.bound);

  const Plan flat =
      planned_twice(reference({{"/tier", "demonstration"}, {"/numerics/plane_strain", "on"}}));
  ASSERT_TRUE(find(plan, "plane_strain").saving && find(flat, "plane_strain").saving);
  EXPECT_EQ(find(plan, "plane_strain").saving->with.n_unknowns, flat.n_unknowns);
  EXPECT_EQ(find(flat, "plane_strain").saving->without.n_unknowns, plan.n_unknowns);
  EXPECT_FALSE(find(flat, "half_domain").saving) << "not possible in a plane";
}

TEST(Savings, AreSaidInShares) {
  const PlannedSize with{100, 2, 3e9}, without{200, 9, 4e9};
  EXPECT_EQ(saving_text({with, without}), "25 % of the memory, 4.5 times less operator time");
  EXPECT_EQ(saving_text({{1, 1, 1e6}, {1, 1320, 1e9}}),
            "99.9 % of the memory, 1320 times less operator time");
}

/// Identity must not depend on predicted figures: they change with every new fit.
TEST(Savings, AreNoPartOfTheFamily) {
  const Scene scene = reference({{"/tier", "screening"}});
  std::vector<Problem> problems;
  Plan plan = make_plan(scene, problems);
  const std::string family = plan.family;
  add_savings(scene, plan);
  EXPECT_EQ(plan.family, family);
  plan.operator_seconds = plan.memory_bytes = 1;
  EXPECT_EQ(operator_fingerprint(scene, plan, "blas"),
            operator_fingerprint(scene, make_plan(scene, problems), "blas"));
}

}  // namespace
}  // namespace faultsim
