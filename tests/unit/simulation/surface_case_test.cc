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
#include "simulator/simulation/inside.h"
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
  Inside::hold(simulation, field({{"/numerics/surface", surface}}));
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
  Inside::hold(exact, field(kSample));
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
  Inside::hold(exact, field(kSample));
  exact.prepare();
  const FaultGeometry &a = Inside::prepared(simulation).op->geometry,
                      &b = Inside::prepared(exact).op->geometry;
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

TEST(SurfaceCase, SumsUpRunsWithNodesThatMoveAndNoOthers) {
  const auto compliance = [](const Simulation& simulation) -> auto& {
    return dynamic_cast<const InterpolatedCompliance&>(
        *Inside::prepared(simulation).op->compliance);
  };
  Simulation locked = on_surface();
  Changes strong = kSample;
  strong.push_back({"cohesion", "50 MPa"});
  locked.run(strong);
  EXPECT_EQ(compliance(locked).n_made(), 0);
  Simulation simulation = on_surface();
  simulation.run(kSample);
  const auto& h = compliance(simulation);
  EXPECT_GT(h.n_made(), 0);
  const Eigen::MatrixXd all = Inside::prepared(simulation).op->h();
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
  EXPECT_TRUE(Inside::prepared(reader).from_cache);
  const CaseResult read = reader.run(kSample);
  EXPECT_EQ(bits(read), bits(built));
  EXPECT_EQ(bits(on_surface().run(kSample)), bits(built)) << "with a cache as without";

  std::fstream(file, std::ios::in | std::ios::out).seekp(-9, std::ios::end).put('x');
  Simulation again = on_surface(kOver, cache.policy());
  EXPECT_EQ(bits(again.run(kSample)), bits(built));
  EXPECT_FALSE(Inside::prepared(again).from_cache);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

/// The exact operator whose factors are wanted beside a surface is kept under a name of its own.
TEST(SurfaceCase, KeepsItsFileWhereFactorsAreWanted) {
  const char* const over =
      R"({"over": [{"parameter": "salt_stiffness", "from": "30 GPa", "to": "60 GPa"}],
          "tolerance": 1e-2})";
  const Changes sample = {{"salt_stiffness", "33 GPa"}};
  const Cache cache;
  const CaseResult built = on_surface(over, cache.policy()).run(sample);
  Simulation displaced = on_surface(over, cache.policy());
  displaced.change(sample);
  displaced.prepare({}, true);
  ASSERT_TRUE(Inside::prepared(displaced).bulk);
  Simulation reader = on_surface(over, cache.policy());
  const CaseResult read = reader.run(sample);
  EXPECT_TRUE(Inside::prepared(reader).from_cache);
  EXPECT_EQ(Inside::prepared(reader).remark, "");
  EXPECT_EQ(bits(read), bits(built));
  Simulation exact;
  exact.keep_operators(cache.policy());
  Inside::hold(exact, field(sample));
  exact.prepare();
  EXPECT_TRUE(Inside::prepared(exact).from_cache);
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
  const std::string east = R"({"parameter": "offset", "from": "-10 m", "to": "140 m"})",
                    west = R"({"parameter": "/geometry/blocks/0/offset", "from": "-9 m",
                               "to": "140 m"})";
  EXPECT_THAT(refusal_of({with(east), {"/geometry/blocks/1/mesh_offset", "100 m"}}),
              HasSubstr("contains 0 m"));
  EXPECT_THAT(refusal_of({with(east + "," + west)}), HasSubstr("two blocks"));
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

/// Two of all intervals between 0 and 200 m: lines meet at both, and at 150 m.
TEST(SurfaceCase, JoinsIntervalsOfAnOffset) {
  const char* const over =
      R"({"over": [{"parameter": "offset", "from": "0 m", "to": "200 m"}], "tolerance": 1e-2})";
  Simulation simulation = on_surface(over);
  std::vector<std::string> families;
  for (const char* offset : {"60 m", "100 m", "170 m"}) {
    const CaseResult found = simulation.run(Changes{{"offset", offset}});
    // On cells of the interval's layout.
    const double layout = Inside::scene(simulation).scene.field.blocks[1].mesh_offset.value();
    Simulation exact;
    Inside::hold(exact, field({{"offset", offset},
                               {"/geometry/blocks/1/mesh_offset", concat("\"", layout, " m\"")}}));
    const CaseResult wanted = exact.run();
    ASSERT_EQ(found.steps.size(), wanted.steps.size());
    double most_slip = 0;
    for (std::size_t s = 0; s < found.steps.size(); ++s) {
      for (std::size_t f = 0; f < found.steps[s].faults.size(); ++f) {
        const FaultMetrics &a = found.steps[s].faults[f], &b = wanted.steps[s].faults[f];
        EXPECT_NEAR(a.chi_bar, b.chi_bar, 5e-3) << offset;
        most_slip = std::max(most_slip, b.max_slip);
      }
    }
    EXPECT_GT(most_slip, 1e-3) << "nothing slips: the test says little";
    EXPECT_TRUE(found.surface);
    families.push_back(Inside::scene(simulation).plan.family);
  }
  EXPECT_EQ(families[0], families[1]) << "of one interval";
  EXPECT_NE(families[1], families[2]);
}

TEST(SurfaceCase, IsExactNextToOffsetsAtWhichLinesMeet) {
  const char* const over = R"({"over": [{"parameter": "offset", "from": "0 m", "to": "200 m"}]})";
  for (const char* offset : {"0 m", "149 m", "200 m"}) {
    const LoadedScene beside = load_scene(field({{"/numerics/surface", over}, {"offset", offset}}));
    const LoadedScene exact = load_scene(field({{"offset", offset}}));
    EXPECT_EQ(beside.identity, exact.identity) << offset;
    EXPECT_EQ(beside.plan.family, exact.plan.family) << offset;
    ASSERT_FALSE(beside.scene.remarks.empty());
    EXPECT_THAT(beside.scene.remarks.front().what, HasSubstr("lines of the mesh meet"));
  }
  // A case beside is read whole when the next one is on a surface again.
  Simulation simulation = on_surface(over);
  simulation.change({{"offset", "149 m"}});
  EXPECT_FALSE(Inside::scene(simulation).scene.numerics.surface.wanted());
  simulation.change({{"offset", "100 m"}});
  EXPECT_TRUE(Inside::scene(simulation).scene.numerics.surface.wanted());
}

constexpr const char* kProbed =
    R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"},
                 {"parameter": "central_dip", "from": "2 deg", "to": "16 deg"}],
        "tolerance": 1e-8,
        "probes": {"tolerance": 5e-3,
                   "cases": [{"friction_angle": "22 deg"},
                             {"friction_angle": "25 deg", "ratio_across": 0.7},
                             {"friction_angle": "27 deg"}]}})";

TEST(SurfaceCase, IsFineEnoughWhenCasesAreAlike) {
  Simulation simulation = on_surface(kProbed);
  const CaseResult found = simulation.run(kSample);
  ASSERT_TRUE(found.surface && found.surface->chi_bar);
  EXPECT_EQ(found.surface->n_cases, 4 * 3) << "three at each of four of eight points";
  EXPECT_EQ(found.surface->chi_tolerance, 5e-3);
  EXPECT_GT(*found.surface->chi_bar, 0);
  EXPECT_LT(*found.surface->chi_bar, 5e-3);
  EXPECT_LT(*found.surface->largest_slip, 5e-2);
  EXPECT_THAT(found.warnings.back(), HasSubstr("in 12 cases there"));
  // Coarser than what the norm of operators asks for.
  Simulation by_norm = on_surface();
  EXPECT_LT(found.surface->n_operators, by_norm.run(kSample).surface->n_operators);
  // A case that nobody has seen.
  Simulation exact;
  Changes unseen = kOther;
  unseen.push_back({"friction_angle", "23.3 deg"});
  Inside::hold(exact, field(unseen));
  const CaseResult wanted = exact.run(), ours = simulation.run(unseen);
  for (std::size_t s = 0; s < wanted.steps.size(); ++s) {
    for (std::size_t f = 0; f < wanted.steps[s].faults.size(); ++f) {
      EXPECT_NEAR(ours.steps[s].faults[f].chi_bar, wanted.steps[s].faults[f].chi_bar, 5e-3);
    }
  }
}

TEST(SurfaceCase, SaysTheSameOfItsCasesFromTheCache) {
  const Cache cache;
  const CaseResult built = on_surface(kProbed, cache.policy()).run(kSample);
  Simulation reader = on_surface(kProbed, cache.policy());
  reader.change(kSample);
  reader.prepare();
  EXPECT_TRUE(Inside::prepared(reader).from_cache);
  const CaseResult read = reader.run(kSample);
  EXPECT_EQ(read.surface, built.surface);
  EXPECT_EQ(bits(read), bits(built));
}

TEST(SurfaceCase, SharesItsSurfaceWhereItDiffersInWhatIsProbed) {
  const auto family = [](Changes changes, const char* probed = kProbed) {
    changes.push_back({"/numerics/surface", probed});
    return load_scene(field(changes)).plan.family;
  };
  EXPECT_EQ(family({}), family({{"friction_angle", "28 deg"}, {"salt_stiffness", "33 GPa"}}));
  EXPECT_EQ(family({}), family({{"ratio_across", "0.71"}, {"/title", "\"another\""}}));
  EXPECT_NE(family({}), family({{"ratio_along", "0.7"}})) << "its cases are others";
  std::string other = kProbed;
  other.replace(other.find("22 deg"), 6, "21 deg");
  EXPECT_NE(family({}), family({}, other.c_str()));
}

TEST(SurfaceCase, NamesProbingCasesThatCannotBe) {
  const auto with = [](const std::string& one) {
    return Changes{{"/numerics/surface",
                    R"({"over": [{"parameter": "salt_stiffness", "from": "20 GPa",
                                  "to": "60 GPa"}], "probes": {"cases": [)" +
                        one + "]}}"}};
  };
  EXPECT_THAT(refusal_of(with(R"({"frction": 1})")), HasSubstr("no place for frction"));
  EXPECT_THAT(refusal_of(with(R"({"salt_stiffness": "30 GPa"})")),
              HasSubstr("the check points choose"));
  EXPECT_THAT(refusal_of(with("3")), HasSubstr("/numerics/surface/probes/cases/0"));
  Simulation simulation;
  JsonDocument document = field(with(R"({"friction_angle": "12 m"})"));
  Inside::hold(simulation, document);
  try {
    simulation.prepare();
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("probing case 0"));
  }
}

TEST(SurfaceCase, ObservesANodeThatMovesWithTheMesh) {
  // Near a fault that leans over, other nodes come nearest to the point as the dip changes: the one
  // of the middle of the range is kept, and is said.
  JsonDocument document = field({{"/numerics/surface", kOver}});
  apply({{"/output/observation_points",
          R"([{"name": "beside_F2", "position": ["200 m", "0 m", "-2400 m"]}])"}},
        document);
  Simulation on_surface, exact;
  Inside::hold(on_surface, document);
  document.value["numerics"].erase("surface");
  std::vector<double> places;
  for (const char* dip : {"3 deg", "15 deg"}) {
    on_surface.change({{"central_dip", dip}});
    const CaseResult found = on_surface.run();
    const Eigen::Vector3d at = Inside::prepared(on_surface).op->observed.rows[0].position;
    places.push_back(at.x());
    apply({{"central_dip", dip},
           {"/output/observation_points/0/position",
            concat("[\"", at.x(), " m\", \"0 m\", \"", at.z(), " m\"]")}},
          document);
    Inside::hold(exact, document);
    const CaseResult wanted = exact.run();
    EXPECT_LT((Inside::prepared(exact).op->observed.rows[0].position - at).norm(), 1e-6);
    const auto of = [](const CaseResult& result) {
      const std::vector<double>& u = result.steps.back().observed;
      return Eigen::Vector3d(u[0], u[1], u[2]);
    };
    EXPECT_LT((of(found) - of(wanted)).norm(), 1e-3 * of(wanted).norm());
  }
  EXPECT_GT(std::abs(places[0] - places[1]), 10) << "the node does not move: the test says little";
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
