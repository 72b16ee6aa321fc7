#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "simulator/loading/run_case.h"
#include "simulator/result/result_bytes.h"
#include "simulator/scene/read_scene.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

/// Cases on a surface of operators (/numerics/surface), from the scene's text to the result.
namespace faultsim {
namespace {

using testing::HasSubstr;

const char* const kOver =
    R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"},
                 {"parameter": "central_dip", "from": "2 deg", "to": "16 deg"}],
        "tolerance": 1e-3})";

JsonDocument field(const Changes& changes) {
  JsonDocument document = parse_json(starter_scene("field"), "field.json");
  apply(
      {{"/tier", "screening"}, {"friction_angle", "24 deg"}, {"/output/observation_points", "[]"}},
      document);
  apply(changes, document);
  return document;
}

Simulation on_surface(const char* surface = kOver) {
  Simulation simulation;
  simulation.hold(field({{"/numerics/surface", surface}}));
  return simulation;
}

const Changes kSample = {{"salt_stiffness", "33 GPa"}, {"central_dip", "5.5 deg"}};
const Changes kOther = {{"salt_stiffness", "71 GPa"}, {"central_dip", "14 deg"}};

std::string bits(CaseResult result) {
  result.seconds = 0;
  for (StepResult& step : result.steps) step.seconds = 0;
  return result_to_bytes(result);
}

std::string refusal_of(const Changes& changes) {
  try {
    load_scene(field(changes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SurfaceCase, IsCloseToTheExactCaseAndSaysThatItIsNoExactOne) {
  Simulation simulation = on_surface();
  const CaseResult found = simulation.run(kSample);
  Simulation exact;
  exact.hold(field(kSample));
  const CaseResult wanted = exact.run();
  ASSERT_EQ(found.steps.size(), wanted.steps.size());
  EXPECT_EQ(found.outcome, wanted.outcome);
  double worst = 0, most_slip = 0;
  for (std::size_t s = 0; s < found.steps.size(); ++s) {
    for (std::size_t f = 0; f < found.steps[s].faults.size(); ++f) {
      const FaultMetrics &a = found.steps[s].faults[f], &b = wanted.steps[s].faults[f];
      worst = std::max(worst, std::abs(a.chi_bar - b.chi_bar));
      most_slip = std::max(most_slip, b.max_slip);
      EXPECT_NEAR(a.max_slip, b.max_slip, 2e-3 * b.max_slip + 1e-6);
    }
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst, 0);
  EXPECT_GT(most_slip, 1e-3) << "nothing slips: the test says little";
  ASSERT_TRUE(found.surface);
  EXPECT_FALSE(wanted.surface);
  EXPECT_GT(found.surface->n_operators, 4);
  EXPECT_LE(found.surface->slip, found.surface->tolerance);
  EXPECT_THAT(found.warnings.back(), HasSubstr("interpolated between"));
  EXPECT_NE(found.identity, wanted.identity);
  EXPECT_NE(found.operator_fingerprint, wanted.operator_fingerprint);
}

TEST(SurfaceCase, HasExactGeometry) {
  Simulation simulation = on_surface(), exact;
  simulation.change(kSample);
  simulation.prepare();
  exact.hold(field(kSample));
  exact.prepare();
  const FaultGeometry &a = simulation.prepared().op->geometry, &b = exact.prepared().op->geometry;
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(a.dof_area, b.dof_area);
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    EXPECT_EQ(a.nodes[k].position, b.nodes[k].position);
    EXPECT_EQ(a.nodes[k].normal, b.nodes[k].normal);
    EXPECT_EQ(a.nodes[k].effective_shear_modulus, b.nodes[k].effective_shear_modulus);
  }
}

TEST(SurfaceCase, HasTheSameBitsWhateverCaseCameFirst) {
  Simulation one = on_surface(), other = on_surface();
  const std::string first = bits(one.run(kSample)), second = bits(one.run(kOther));
  EXPECT_EQ(bits(other.run(kOther)), second);
  EXPECT_EQ(bits(other.run(kSample)), first);
  EXPECT_FALSE(one.prepare()) << "the surface is there";
}

TEST(SurfaceCase, SharesItsFamilyAndNotItsIdentity) {
  const auto loaded = [](Changes changes, const char* surface = kOver) {
    changes.push_back({"/numerics/surface", surface});
    return load_scene(field(changes));
  };
  const LoadedScene one = loaded(kSample), other = loaded(kOther);
  EXPECT_EQ(one.plan.family, other.plan.family);
  EXPECT_NE(one.identity, other.identity);
  EXPECT_NE(one.plan.family, load_scene(field(kSample)).plan.family);
  const LoadedScene wider = loaded(
      kSample, R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "90 GPa"}]})");
  EXPECT_NE(wider.plan.family, one.plan.family);
  EXPECT_NE(wider.identity, one.identity);
  auto stiffer = kSample;
  stiffer.push_back({"/materials/underburden/youngs_modulus", "35 GPa"});
  EXPECT_NE(loaded(stiffer).plan.family, one.plan.family);
}

TEST(SurfaceCase, IsRefusedWhereItCannotBe) {
  const auto with = [](const std::string& over) {
    return Change{"/numerics/surface", R"({"over": [)" + over + "]}"};
  };
  const std::string salt = R"({"parameter": "salt_stiffness", "from": "20 GPa", "to": "60 GPa"})";
  EXPECT_THAT(refusal_of({with(salt), {"salt_stiffness", "80 GPa"}}), HasSubstr("lies outside"));
  EXPECT_THAT(refusal_of({with(salt), {"salt_viscosity", "1e17 Pa s"}}), HasSubstr("salt creeps"));
  EXPECT_THAT(refusal_of({with(salt + "," + salt)}), HasSubstr("twice"));
  EXPECT_THAT(
      refusal_of({with(R"({"parameter": "friction_angle", "from": "1 deg", "to": "2 deg"})")}),
      HasSubstr("no surface can be over"));
  EXPECT_THAT(refusal_of({with(R"({"parameter": "offset", "from": "60 m", "to": "140 m"})")}),
              HasSubstr("no mesh_offset"));
  EXPECT_THAT(
      refusal_of({with(R"({"parameter": "salt_stiffness", "from": "60 m", "to": "1 GPa"})")}),
      HasSubstr("60 m"));
}

TEST(SurfaceCase, SaysThatItsToleranceIsNotReached) {
  Simulation simulation = on_surface(
      R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"}],
          "tolerance": 1e-6, "most_operators": 3})");
  try {
    simulation.prepare();
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("does not reach its tolerance: with 3 operators"));
  }
}

}  // namespace
}  // namespace faultsim
