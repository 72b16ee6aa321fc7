#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulator/loading/run_case.h"
#include "simulator/model/operator_basis.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_bytes.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"
#include "simulator/surface/operator_surface.h"

/// Cases on a surface of operators (/numerics/surface), from the scene's text to the result.
namespace faultsim {
namespace {

using testing::HasSubstr;

const char* const kOver =
    R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"},
                 {"parameter": "central_dip", "from": "2 deg", "to": "16 deg"}],
        "tolerance": 1e-3})";

/// Cells as coarse as faults that slip allow: a surface is built of many operators.
JsonDocument field(const Changes& changes) {
  JsonDocument document = parse_json(starter_scene("field"), "field.json");
  apply({{"/tier", "custom"},
         {"/numerics", R"({"plane_strain": "on"})"},
         {"/mesh", R"({"strike": "1000 m", "dip": "50 m", "normal": "300 m", "growth": 2})"},
         {"friction_angle", "24 deg"},
         {"/output/observation_points", "[]"}},
        document);
  apply(changes, document);
  return document;
}

/// A folder of one's own for operators, gone at the end.
class Cache {
 public:
  Cache() {
    std::string name = (std::filesystem::temp_directory_path() / "surface_case_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Cache() { std::filesystem::remove_all(folder_); }
  CachePolicy policy() const { return {.folder = folder_}; }
  /// The file of an operator or surface.
  std::filesystem::path file(const std::string& fingerprint) const {
    return folder_ / (fingerprint + ".h5");
  }

 private:
  std::filesystem::path folder_;
};

Simulation on_surface(const char* surface = kOver, const CachePolicy& cache = {}) {
  Simulation simulation;
  simulation.keep_operators(cache);
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

void expect_same(const OperatorNode& a, const OperatorNode& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.strike, b.strike);
  EXPECT_EQ(a.dip, b.dip);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.dof, b.dof);
  EXPECT_EQ(a.effective_shear_modulus, b.effective_shear_modulus);
  EXPECT_EQ(a.poisson_ratio, b.poisson_ratio);
  EXPECT_EQ(a.edge_strike, b.edge_strike);
  EXPECT_EQ(a.edge_dip, b.edge_dip);
  ASSERT_EQ(a.pressure.size(), b.pressure.size());
  for (std::size_t i = 0; i < a.pressure.size(); ++i) {
    EXPECT_EQ(a.pressure[i].minus_region, b.pressure[i].minus_region);
    EXPECT_EQ(a.pressure[i].plus_region, b.pressure[i].plus_region);
    EXPECT_EQ(a.pressure[i].weight, b.pressure[i].weight);
  }
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
  EXPECT_EQ(a.locked_positions, b.locked_positions);
  for (std::size_t k = 0; k < a.nodes.size(); ++k) expect_same(a.nodes[k], b.nodes[k]);
  for (std::size_t f = 0; f < a.faults.size(); ++f) {
    EXPECT_EQ(a.faults[f].name, b.faults[f].name);
    EXPECT_EQ(a.faults[f].points, b.faults[f].points);
    EXPECT_EQ(a.faults[f].faces, b.faults[f].faces);
  }
}

TEST(SurfaceCase, SumsUpTheColumnsOfNodesThatMoveAndNoOthers) {
  Simulation simulation = on_surface();
  simulation.run(kSample);
  const auto& h =
      dynamic_cast<const InterpolatedCompliance&>(*simulation.prepared().op->compliance);
  EXPECT_GT(h.n_made(), 0);
  EXPECT_LT(h.n_made(), h.size());
  const Eigen::MatrixXd all = simulation.prepared().op->h();
  EXPECT_EQ(all, all.transpose().eval());
  for (int j = 0; j < h.size(); ++j) EXPECT_EQ(h.diagonal(j), all(j, j));
}

TEST(SurfaceCase, IsReadFromTheCacheAndMadeAgainWhereItIsDamaged) {
  const Cache cache;
  Simulation builder = on_surface(kOver, cache.policy()),
             reader = on_surface(kOver, cache.policy());
  const CaseResult built = builder.run(kSample);
  const std::filesystem::path file = cache.file(built.operator_fingerprint);
  ASSERT_TRUE(std::filesystem::is_regular_file(file));
  reader.change(kSample);
  reader.prepare();
  EXPECT_TRUE(reader.prepared().from_cache);
  const CaseResult read = reader.run(kSample);
  EXPECT_EQ(bits(read), bits(built));
  EXPECT_EQ(bits(on_surface().run(kSample)), bits(built)) << "with a cache as without";

  std::fstream(file, std::ios::in | std::ios::out).seekp(-9, std::ios::end).put('x');
  Simulation again = on_surface(kOver, cache.policy());
  EXPECT_EQ(bits(again.run(kSample)), bits(built));
  EXPECT_FALSE(again.prepared().from_cache);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST(RequireDefinite, LooksAtTheJumpsListedAndNoOthers) {
  Eigen::MatrixXd h(3, 3);
  h << 2, 0, 1, 0, 2, 3, 1, 3, 2;
  FaultOperator op;
  op.compliance = std::make_shared<DenseCompliance>(h);
  EXPECT_NO_THROW(require_definite(op, {}));
  EXPECT_NO_THROW(require_definite(op, {0, 2}));
  EXPECT_THROW(require_definite(op, {1, 2}), InputError);
}

TEST(SurfaceCase, HasTheSameBitsWhateverCaseCameFirst) {
  Simulation one = on_surface(), other = on_surface();
  const std::string first = bits(one.run(kSample)), second = bits(one.run(kOther));
  EXPECT_EQ(bits(other.run(kOther)), second);
  EXPECT_EQ(bits(other.run(kSample)), first);
  EXPECT_FALSE(one.prepare()) << "the surface is there";
}

/// A change outside of the surface's parameters takes another surface.
TEST(SurfaceCase, OfAnotherFamilyIsNotOfTheSurfaceThatIsThere) {
  const char* const over =
      R"({"over": [{"parameter": "salt_stiffness", "from": "30 GPa", "to": "60 GPa"}],
          "tolerance": 1e-2})";
  const Change stiffer{"/materials/underburden/youngs_modulus", "60 GPa"};
  Simulation simulation = on_surface(over);
  simulation.run(Changes{{"salt_stiffness", "33 GPa"}});
  const std::string found = bits(simulation.run({{"salt_stiffness", "33 GPa"}, stiffer}));
  Simulation fresh = on_surface(over);
  EXPECT_EQ(found, bits(fresh.run({{"salt_stiffness", "33 GPa"}, stiffer})));
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

TEST(SurfaceCase, IsOfMoreThanOneOperator) {
  EXPECT_THAT(
      refusal_of({{"/numerics/surface",
                   R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "60 GPa"}],
                       "most_operators": 1})"}}),
      HasSubstr("write a whole number from 2 to 2000"));
}

TEST(SurfaceCase, IsRefusedWhereAnObservationPointChangesItsNode) {
  // Near a fault that leans over, the nodes move past the point as the dip changes.
  JsonDocument document = field({{"/numerics/surface", kOver}});
  apply({{"/output/observation_points",
          R"([{"name": "beside_F2", "position": ["200 m", "0 m", "-2400 m"]}])"}},
        document);
  Simulation simulation;
  simulation.hold(document);
  try {
    simulation.prepare();
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("beside_F2 is nearest to different nodes"));
  }
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
