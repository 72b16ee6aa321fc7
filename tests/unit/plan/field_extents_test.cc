// What is planned of fields whose blocks and faults end where they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/plan/field_bodies.h"
#include "simulator/plan/plan.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Changes = std::vector<std::pair<std::string, std::string>>;

Scene scene_with(const Changes& changes) {
  JsonDocument document = rotliegend();
  set_value(document, "/tier", "custom");
  set_value(document, "/mesh",
            R"({"strike": "400 m", "dip": "60 m", "normal": "200 m", "growth": 1.8})");
  return varied(document, changes);
}

Plan plan_without_problems(const Scene& scene) {
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  EXPECT_THAT(problems, IsEmpty());
  return plan;
}

TEST(FieldExtents, HalfTheDomainIsModelledOfSymmetricBlocksAlone) {
  const Plan plain = plan_without_problems(scene_with({}));
  ASSERT_TRUE(plain.half_domain);
  EXPECT_TRUE(
      plan_without_problems(scene_with({{"/geometry/blocks/1/length", "1500 m"}})).half_domain);
  const Changes north = {{"/geometry/blocks/1/y_to", "1200 m"}};
  const Plan whole = plan_without_problems(scene_with(north));
  EXPECT_FALSE(whole.half_domain);
  EXPECT_GT(whole.n_cells, 1.5 * static_cast<double>(plain.n_cells));
  EXPECT_EQ(whole.reductions.at(1).reason,
            "block east reaches from y = -1000 m to 1200 m, which is not symmetric about y = 0");
  const Plan south = plan_without_problems(scene_with({{"/faults/2/y_from", "-900 m"}}));
  EXPECT_FALSE(south.half_domain);
  EXPECT_EQ(south.reductions.at(1).reason,
            "fault F3 reaches from y = -900 m to 1200 m, which is not symmetric about y = 0");
  EXPECT_TRUE(plan_without_problems(scene_with({{"/faults/2/length", "3 km"}})).half_domain);
  Changes flat = north;
  flat.emplace_back("/numerics/plane_strain", "on");
  EXPECT_TRUE(plan_without_problems(scene_with(flat)).plane_strain);
}

TEST(FieldExtents, HalfTheDomainIsRefusedWhereBlocksAreNotSymmetric) {
  std::vector<Problem> problems;
  make_plan(scene_with({{"/geometry/blocks/1/y_to", "1200 m"}, {"/numerics/half_domain", "on"}}),
            problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/numerics/half_domain");
  EXPECT_THAT(problems[0].what, HasSubstr("block east reaches from y = -1000 m to 1200 m"));
  EXPECT_THAT(problems[0].cure, HasSubstr("set it to \"off\""));
}

TEST(FieldExtents, AreAFamilyOfTheirOwn) {
  const auto family = [](const Changes& changes) { return family_of(scene_with(changes)); };
  const std::string plain = family({});
  EXPECT_EQ(family({{"/geometry/blocks/1/length", "2 km"}}), plain);
  const std::string shorter = family({{"/geometry/blocks/1/length", "1500 m"}});
  EXPECT_NE(shorter, plain);
  EXPECT_NE(shorter, family({{"/geometry/blocks/0/length", "1500 m"}}));
  EXPECT_NE(shorter, family({{"/geometry/blocks/1/y_to", "750 m"}}));
  EXPECT_NE(family({{"/geometry/blocks/1/y_to", "750 m"}}),
            family({{"/geometry/blocks/1/y_to", "700 m"}}))
      << "of the whole domain both";
  EXPECT_NE(shorter,
            family({{"/geometry/blocks/1/length", "1500 m"}, {"/geometry/block_length", "1700 m"}}))
      << "the west block is longer";
  EXPECT_EQ(
      family({{"/geometry/blocks/0/length", "1600 m"},
              {"/geometry/blocks/1/length", "1500 m"},
              {"/geometry/block_length", "1700 m"}}),
      family({{"/geometry/blocks/0/length", "1600 m"}, {"/geometry/blocks/1/length", "1500 m"}}))
      << "no block is as long as that";
}

TEST(FieldExtents, OfFaultsAreAFamilyOfTheirOwn) {
  const auto family = [](const Changes& changes) { return family_of(scene_with(changes)); };
  const std::string plain = family({}), longer = family({{"/faults/1/length", "3 km"}});
  EXPECT_NE(longer, plain);
  EXPECT_NE(longer, family({{"/faults/0/length", "3 km"}}));
  EXPECT_NE(longer, family({{"/faults/1/y_to", "1500 m"}}));
  EXPECT_NE(family({{"/faults/1/overshoot", "200 m"}}), plain);
  EXPECT_EQ(family({{"/faults/1/overshoot", "150 m"}}), plain);
  Changes all;
  for (const char* fault : {"0", "1", "2"})
    all.emplace_back(std::string("/faults/") + fault + "/length", "3 km");
  const std::string own = family(all);
  all.emplace_back("/geometry/fault_length", "4 km");
  EXPECT_EQ(family(all), own);
}

/// The prediction counts the grid that is made.
TEST(FieldExtents, AreCountedAsTheyAreMeshed) {
  const Scene scene = scene_with({{"/geometry/blocks/0/y_from", "-300 m"},
                                  {"/geometry/blocks/1/length", "1500 m"},
                                  {"/faults/0/y_to", "10 km"},
                                  {"/faults/1/y_from", "-2 km"},
                                  {"/faults/2/overshoot", "400 m"}});
  const Plan plan = plan_without_problems(scene);
  const Mesh mesh = scene_mesh(scene, plan);
  EXPECT_EQ(plan.n_cells, std::ssize(mesh.cells));
  long n_jump = 0;
  for (const FaultSurface& fault : mesh.faults) n_jump += 3 * std::ssize(fault.nodes);
  EXPECT_EQ(plan.n_jump, n_jump);
}

/// Flow fields are mapped to what a block covers.
TEST(FieldExtents, BodiesOfBlocksEndWithThem) {
  const Scene scene = scene_with(
      {{"/geometry/blocks/0/y_from", "-300 m"}, {"/geometry/blocks/1/length", "1500 m"}});
  const std::vector<MappedCell> bodies = field_bodies(scene, plan_without_problems(scene), 0);
  ASSERT_EQ(bodies.size(), 6u);
  const auto along = [](const MappedCell& body) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Eigen::Vector3d& corner : body.corners) {
      low = std::min(low, corner.y());
      high = std::max(high, corner.y());
    }
    return std::array{low, high};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_THAT(along(bodies[i]), ElementsAre(-300, 1000)) << i;
    EXPECT_THAT(along(bodies[3 + i]), ElementsAre(-750, 750)) << i;
  }
}

}  // namespace
}  // namespace faultsim
