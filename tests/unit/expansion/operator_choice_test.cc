#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/expansion/expansion.h"
#include "campaign/expansion/rows.h"
#include "simulator/common/errors.h"

/// Which operators a campaign takes by its `operators`.
namespace faultsweep {
namespace {

using ::testing::HasSubstr;

constexpr const char* kStiffAndWeak = R"("salt_stiffness": {"from": "20 GPa", "to": "60 GPa"},
    "friction_angle": {"from": "15 deg", "to": "35 deg"})";

Expansion expand_with(const std::string& design, const std::string& operators) {
  const std::string text =
      R"({"format": 1, "name": "test", "base": "docs/examples/scenes/rotliegend.json",
    "set": {"/tier": "screening", "/numerics/plane_strain": "on"}, )" +
      operators + R"("design": )" + design + "}";
  return expand(parse_campaign(text, FAULTSIM_SOURCE_DIR "/spec.json"));
}

std::string sample(long n, const std::string& parameters) {
  return R"({"kind": "monte-carlo", "samples": )" + std::to_string(n) + R"(, "parameters": {)" +
         parameters + "}}";
}

Expansion expand_sample(long n, const std::string& parameters, const std::string& operators) {
  return expand_with(sample(n, parameters), operators);
}

std::string policy(const std::string& name) {
  return R"("operators": {"policy": ")" + name + R"(", "tolerance": 0.004}, )";
}

TEST(OperatorChoice, IsOneSurfaceForASampleOfModuli) {
  const Expansion exact = expand_sample(30, kStiffAndWeak, ""),
                  surface = expand_sample(30, kStiffAndWeak, policy("surface"));
  EXPECT_EQ(exact.families.size(), 30u);
  ASSERT_EQ(surface.families.size(), 1u);
  const int n = surface.families[0].plan->n_operators;
  EXPECT_GT(n, 1);
  EXPECT_THAT(surface.notes.front(), HasSubstr(concat("about ", n, " exact ones")));
  const nlohmann::json& over = surface.spec.groups[0].scene.at("numerics").at("surface").at("over");
  ASSERT_EQ(over.size(), 1u) << "friction changes no operator";
  EXPECT_EQ(over[0].at("parameter"), "/materials/salt/youngs_modulus");
  EXPECT_EQ(over[0].at("from"), "20 GPa");
  EXPECT_EQ(over[0].at("to"), "60 GPa");
}

/// Probing cases are of the same design, none of the sample, and leave the surface's own
/// parameters alone.
TEST(OperatorChoice, DrawsProbingCasesOfTheOtherParameters) {
  const Expansion one = expand_sample(30, kStiffAndWeak, policy("surface")),
                  again = expand_sample(30, kStiffAndWeak, policy("surface"));
  const nlohmann::json& probes = one.spec.groups[0].scene.at("numerics").at("surface").at("probes");
  EXPECT_EQ(probes.at("tolerance"), 0.004);
  EXPECT_EQ(probes, again.spec.groups[0].scene.at("numerics").at("surface").at("probes"));
  ASSERT_EQ(probes.at("cases").size(), 32u);
  std::set<std::string> seen;
  const Parameter& friction = one.spec.groups[0].parameters[1];
  for (int value = 2; value < friction.n_values(); ++value) seen.insert(friction.text(value));
  EXPECT_EQ(seen.size(), 30u);
  for (const nlohmann::json& values : probes.at("cases")) {
    ASSERT_EQ(values.size(), 1u);
    const std::string angle = values.at("/friction/friction_angle");
    EXPECT_TRUE(angle.ends_with(" deg"));
    EXPECT_GE(std::stod(angle), 15);
    EXPECT_LE(std::stod(angle), 35);
    EXPECT_EQ(seen.count(angle), 0u);
  }
}

TEST(OperatorChoice, IsExactWhereRowsAreFewerThanOperators) {
  const Expansion few = expand_sample(5, kStiffAndWeak, policy("automatic")),
                  many = expand_sample(50, kStiffAndWeak, policy("automatic"));
  EXPECT_EQ(few.families.size(), 5u);
  EXPECT_THAT(few.notes.front(), HasSubstr("are exact"));
  EXPECT_EQ(many.families.size(), 1u);
  EXPECT_THAT(many.notes.front(), HasSubstr("are interpolated over salt_stiffness"));
}

/// Ten intervals between 0 and 200 m hold very different shares of the range.
TEST(OperatorChoice, KeepsIntervalsOfFewRowsExact) {
  const std::string offset = R"("offset": {"from": "0 m", "to": "200 m"})";
  const Expansion all = expand_sample(150, offset, policy("surface")),
                  large = expand_sample(150, offset, policy("automatic"));
  const auto count = [](const Expansion& one, bool surfaces) {
    long n = 0;
    for (const Family& family : one.families) {
      if ((family.plan->n_operators > 1) == surfaces) n += surfaces ? 1 : std::ssize(family.cases);
    }
    return n;
  };
  EXPECT_GT(count(all, true), 6) << "surfaces";
  EXPECT_LT(count(large, true), count(all, true));
  EXPECT_GE(count(large, true), 1);
  EXPECT_GT(count(large, false), count(all, false)) << "exact cases";
  EXPECT_THAT(large.notes.front(), HasSubstr(concat(count(large, false), " rows have exact ones")));
  for (const Family& family : large.families) {
    const int n = family.plan->n_operators;
    EXPECT_GE(std::ssize(family.cases), n > 1 ? n : 1);
  }
}

/// Of `rank --certify`: each builds its own, and is planned for, with its memory, as such.
TEST(OperatorChoice, GivesExactTwinsOfASurfaceFamiliesOfTheirOwn) {
  const Expansion surface = expand_sample(30, kStiffAndWeak, policy("surface"));
  nlohmann::ordered_json twins = surface.spec.document.value;
  twins["base"] = surface.spec.groups[0].scene;
  twins.erase("set");
  twins["operators"] = {{"exact_rows", {4, 11, 29}}};
  const Expansion exact = expand(parse_campaign(twins.dump(), FAULTSIM_SOURCE_DIR "/spec.json"));
  ASSERT_EQ(exact.families.size(), 3u);
  for (const Family& family : exact.families) EXPECT_EQ(family.plan->n_operators, 1);
}

/// Each offset of a nested design comes with many stiffnesses, also where it has no surface.
TEST(OperatorChoice, GivesExactRowsOfOneOffsetFamiliesOfTheirOwn) {
  const std::string outer = sample(8, R"("offset": {"from": "0 m", "to": "200 m"})"),
                    inner = sample(12, R"("salt_stiffness": {"from": "20 GPa", "to": "60 GPa"})");
  const Expansion all = expand_with(
      R"({"kind": "nested", "designs": [)" + outer + ", " + inner + "]}", policy("automatic"));
  long n_exact = 0;
  for (const Family& family : all.families) {
    if (family.plan->n_operators > 1) continue;
    EXPECT_EQ(family.cases.size(), 1u);
    ++n_exact;
  }
  EXPECT_GE(n_exact, 12);
  EXPECT_LT(n_exact, 96);
}

TEST(OperatorChoice, SaysWhatASurfaceCannotBeOver) {
  try {
    expand_sample(5,
                  R"("salt_stiffness": {"distribution": "log-normal", "median": "40 GPa",
                     "factor": 1.5})",
                  policy("surface"));
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/operators/policy"));
    EXPECT_THAT(error.what(), HasSubstr("bounded range"));
  }
  EXPECT_EQ(expand_sample(5, R"("friction_angle": {"from": "15 deg", "to": "35 deg"})",
                          policy("automatic"))
                .families.size(),
            1u);
}

}  // namespace
}  // namespace faultsweep
