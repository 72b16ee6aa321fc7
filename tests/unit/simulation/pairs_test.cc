#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "simulator/loading/run_case.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

/// What may be combined, held against another way to the same answer.
namespace faultsim {
namespace {

/// A folder of one's own, gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "pairs_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// Two blocks, three faults, coarse, in plane strain unless changed.
Simulation field(const Changes& changes) {
  JsonDocument document = parse_json(starter_scene("field"), "field.json");
  apply({{"/tier", "custom"},
         {"/numerics", R"({"plane_strain": "on"})"},
         {"/mesh", R"({"strike": "1000 m", "dip": "50 m", "normal": "300 m", "growth": 2})"},
         {"friction_angle", "20 deg"},
         {"/compartments", "{}"},
         {"/start_date", "1990-01-01"}},
        document);
  apply(changes, document);
  embed_tables(document);
  Simulation simulation;
  Inside::hold(simulation, std::move(document));
  return simulation;
}

/// One flow cell around the whole model, whose value goes from one to the other in ten years.
std::string uniform(const std::string& unit, double from, double to) {
  return concat("x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [", unit,
                "], 2000-01-01 [", unit, "]\n0, 0, 2500, 40000, 40000, 5000, ", from, ", ", to,
                "\n");
}

/// Flow cells whose pressures fall more to the east and with depth.
std::string tilted() {
  std::string text =
      "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 1996-01-01 [bar], "
      "2000-01-01 [bar]\n";
  for (int x = -5; x <= 5; ++x) {
    for (int z = 0; z < 10; ++z)
      text += concat(x * 500, ", 0, ", 1850 + 100 * z, ", 500, 40000, 100, 300, ",
                     200 - 8 * x - 3 * z, ", ", 150 - 12 * x + 4 * z, "\n");
  }
  return text;
}

const Change kCreeps{"/materials/salt/viscosity", "2e18 Pa s"};

struct History {
  CaseResult result;
  std::vector<FaultFields> fields;
  std::vector<Eigen::Matrix3Xd> displaced;  ///< empty unless asked for.
};

History run(Simulation simulation, bool displaced = false) {
  History history;
  RunWatch watch;
  watch.step = [&](const StepResult&, const FaultFields& f) { history.fields.push_back(f); };
  if (displaced) {
    watch.displaced = [&](const StepResult&, const Eigen::Matrix3Xd& u) {
      history.displaced.push_back(u);
    };
  }
  history.result = simulation.run({}, watch);
  EXPECT_EQ(history.result.outcome, Outcome::converged) << history.result.reason;
  return history;
}

/// To a tolerance relative to the largest value of the history.
void expect_same(const History& a, const History& b, double tolerance) {
  ASSERT_EQ(a.fields.size(), b.fields.size());
  const FaultFields& last = b.fields.back();
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    SCOPED_TRACE(concat("load step ", i));
    const FaultFields &x = a.fields[i], &y = b.fields[i];
    EXPECT_LT((x.traction - y.traction).norm(), tolerance * last.traction.norm());
    EXPECT_LT((x.jump - y.jump).norm(), tolerance * last.jump.norm());
    EXPECT_LT((x.fault_pressure_change - y.fault_pressure_change).norm(),
              tolerance * (1 + last.fault_pressure_change.norm()));
    const StepResult &p = a.result.steps[i], &q = b.result.steps[i];
    for (std::size_t row = 0; row < q.observed.size(); ++row)
      EXPECT_NEAR(p.observed[row], q.observed[row], tolerance);
  }
  ASSERT_EQ(a.displaced.size(), b.displaced.size());
  for (std::size_t i = 0; i < a.displaced.size(); ++i)
    EXPECT_LT((a.displaced[i] - b.displaced[i]).norm(), tolerance * b.displaced.back().norm());
}

const Change kDepleted{"/stages", R"([{"name": "production", "until": "2000-01-01", "steps": 4,
                                        "pressure_change": "-200 bar"}])"};
const Change kStill{"/stages", R"([{"name": "production", "until": "2000-01-01", "steps": 4}])"};

/// The scene by compartments, and by a field of the same pressures.
std::pair<Changes, Changes> both_ways(const Folder& folder, const Changes& changes) {
  const std::string file = folder.write("pressures.csv", uniform("bar", 300, 100));
  Changes by_compartment = {kDepleted};
  Changes by_field = {kStill, {"/pressure_field", concat(R"({"file": ")", file, R"("})")}};
  for (Changes* all : {&by_compartment, &by_field})
    all->insert(all->end(), changes.begin(), changes.end());
  return {by_compartment, by_field};
}

TEST(FieldAndCreep, AUniformFieldIsCompartments) {
  const Folder folder;
  const auto [compartments, by_field] = both_ways(folder, {kCreeps});
  const History expected = run(field(compartments), true);
  const History found = run(field(by_field), true);
  expect_same(found, expected, 1e-12);
  EXPECT_GT(expected.fields.back().jump.cwiseAbs().maxCoeff(), 1e-3) << "faults slide";
  EXPECT_GT(expected.fields.back().creep_traction.cwiseAbs().maxCoeff(), 1e5) << "salt creeps";
  EXPECT_EQ(found.displaced.size(), 2U);
}

TEST(FieldAndDisplacement, AUniformFieldIsCompartments) {
  const Folder folder;
  const auto [compartments, by_field] = both_ways(folder, {});
  expect_same(run(field(by_field), true), run(field(compartments), true), 1e-12);
}

/// Asking for displacements changes nothing else.
TEST(FieldAndDisplacement, LeavesTheCaseAsItIs) {
  const Folder folder;
  const Changes by_field = both_ways(folder, {}).second;
  const History without = run(field(by_field)), with = run(field(by_field), true);
  for (std::size_t i = 0; i < with.fields.size(); ++i) {
    EXPECT_EQ(with.fields[i].traction, without.fields[i].traction);
    EXPECT_EQ(with.fields[i].jump, without.fields[i].jump);
  }
}

/// A temperature by a field, by compartments and as the pressure that does the same: 3 K α_T ΔT =
/// b Δp, as no fault takes any pressure.
TEST(TemperatureAndCreep, IsThePressureOfItsStress) {
  const Folder folder;
  const std::string file = folder.write("temperatures.csv", uniform("degC", 90, 60));
  const Change dry{"/fault_pressure", R"({"rule": "none"})"};
  const Change expands{"/materials/reservoir/thermal_expansion", "1.2e-5 1/K"};
  const Changes by_stage = {
      kCreeps,
      dry,
      expands,
      {"/stages", R"([{"name": "production", "until": "2000-01-01", "steps": 4,
                       "temperature_change": "-30 K"}])"}};
  const Changes by_field = {kCreeps,
                            dry,
                            expands,
                            kStill,
                            {"/temperature_field", concat(R"({"file": ")", file, R"("})")}};
  const double pressure = 11e9 / (1 - 2 * 0.15) * 1.2e-5 * 30;  // Pa, with b = 1
  const Changes by_pressure = {
      kCreeps,
      dry,
      {"/stages", concat(R"([{"name": "production", "until": "2000-01-01", "steps": 4,
                              "pressure_change": "-)",
                         pressure, R"( Pa"}])")}};
  const History expected = run(field(by_pressure));
  expect_same(run(field(by_stage)), expected, 1e-9);
  expect_same(run(field(by_field)), expected, 1e-9);
  EXPECT_GT(expected.fields.back().creep_traction.cwiseAbs().maxCoeff(), 1e5);
}

/// The largest locked traction of the rock by a field at its end: what the surface interpolates.
TEST(FieldAndSurface, IsOffTheExactLoadsByNoMoreThanIsSaid) {
  const Folder folder;
  const std::string file = folder.write("p.csv", tilted());
  const std::string warm = folder.write("t.csv", uniform("degC", 90, 70));
  const Change surface{"/numerics/surface", R"({"over": [
      {"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"},
      {"parameter": "central_dip", "from": "2 deg", "to": "16 deg"}], "tolerance": 1e-3})"};
  const Changes base = {kStill,
                        {"/materials/reservoir/thermal_expansion", "1.2e-5 1/K"},
                        {"/pressure_field", concat(R"({"file": ")", file, R"("})")},
                        {"/temperature_field", concat(R"({"file": ")", warm, R"("})")}};
  Changes with_surface = base;
  with_surface.push_back(surface);
  Simulation interpolated = field(with_surface), exact = field(base);
  const auto locked = [](Simulation& simulation) {
    simulation.prepare();
    const LoadedScene& loaded = Inside::scene(simulation);
    const CaseLoads loads(loaded.scene, *Inside::prepared(simulation).op,
                          Inside::prepared(simulation).loads);
    return std::pair(loads.at(0), loads.at(315532800));
  };
  for (const Changes& sample : {Changes{{"salt_stiffness", "33 GPa"}, {"central_dip", "5.5 deg"}},
                                Changes{{"salt_stiffness", "71 GPa"},
                                        {"central_dip", "14 deg"},
                                        {"/materials/reservoir/biot", "0.7"},
                                        {"/fault_pressure/rule", "max"}}}) {
    interpolated.change(sample);
    exact.change(sample);
    const auto [a0, a] = locked(interpolated);
    const auto [b0, b] = locked(exact);
    const double stated = Inside::prepared(interpolated).surface->traction;
    EXPECT_LE(stated, 1e-3);
    const Eigen::VectorXd found = a.locked - a0.locked, expected = b.locked - b0.locked;
    EXPECT_LT((found - expected).norm(), 2 * stated * expected.norm());
    EXPECT_GT((found - expected).norm(), 0) << "it is interpolated";
    EXPECT_LT((a.fault_pressure_change - b.fault_pressure_change).norm(), 1e-3);
    EXPECT_LT((a.observed - b.observed).norm(), 1e-3 * b.observed.norm());
    const CaseResult on_surface = interpolated.run(), of_exact = exact.run();
    EXPECT_EQ(*on_surface.field_coverage, *of_exact.field_coverage);
    for (std::size_t f = 0; f < 3; ++f)
      EXPECT_NEAR(on_surface.steps.back().faults[f].chi_bar,
                  of_exact.steps.back().faults[f].chi_bar, 2e-3);
  }
}

/// Events of faults that weaken: when they come depends on the weakening at which they lose their
/// stability, how large they are on slip.
TEST(WeakeningAndSurface, EventsAreOffTheExactOnesByWhatIsSaid) {
  const Changes base = {kDepleted,
                        {"friction_angle", "22 deg"},
                        {"/friction/dynamic_friction_angle", "10 deg"},
                        {"/friction/slip_weakening_distance", "2 cm"}};
  Changes with_surface = base;
  with_surface.push_back({"/numerics/surface", R"({"over": [
      {"parameter": "salt_stiffness", "from": "20 GPa", "to": "80 GPa"},
      {"parameter": "central_dip", "from": "2 deg", "to": "16 deg"}], "tolerance": 1e-3})"});
  Simulation interpolated = field(with_surface), exact = field(base);
  int n_events = 0;
  for (const Changes& sample : {Changes{{"salt_stiffness", "33 GPa"}, {"central_dip", "5.5 deg"}},
                                Changes{{"salt_stiffness", "71 GPa"}, {"central_dip", "14 deg"}}}) {
    const CaseResult a = interpolated.run(sample), b = exact.run(sample);
    ASSERT_TRUE(a.surface && a.surface->stability);
    const double off = std::max(*a.surface->stability, a.surface->slip);
    EXPECT_GT(off, 0);
    EXPECT_LT(off, 5e-3);
    ASSERT_EQ(a.events.size(), b.events.size());
    for (std::size_t i = 0; i < b.events.size(); ++i) {
      ++n_events;
      EXPECT_EQ(a.events[i].step, b.events[i].step);
      EXPECT_NEAR(a.events[i].time, b.events[i].time, off * b.events[i].time);
      EXPECT_NEAR(a.events[i].moment, b.events[i].moment, 5 * off * b.events[i].moment);
    }
  }
  EXPECT_GT(n_events, 1);
}

/// What was kept for one family serves no other.
TEST(FieldAndFamily, AreLookedAtTogether) {
  const Folder folder;
  const Changes by_field = both_ways(folder, {}).second;
  const Change soft{"salt_stiffness", "20 GPa"};
  Simulation changed = field(by_field);
  changed.run();
  changed.change({soft});
  Changes fresh = by_field;
  fresh.push_back(soft);
  const CaseResult a = changed.run(), b = field(fresh).run();
  EXPECT_EQ(a.steps.back().faults[1].chi_bar, b.steps.back().faults[1].chi_bar);
  EXPECT_EQ(a.steps.back().observed, b.steps.back().observed);
}

/// A change of the regional stress leads to where it might have begun.
TEST(RegionalStress, IsTheInitialStateThatItLeadsTo) {
  const auto tensor = [](double across) {
    return concat(R"([["-)", across, R"( MPa", "0 MPa", "1 MPa"], ["0 MPa", "-35 MPa", "0 MPa"],
                     ["1 MPa", "0 MPa", "-45 MPa"]])");
  };
  const auto scene = [&](double across, const std::string& change) {
    JsonDocument document = parse_json(starter_scene("box"), "box.json");
    apply({{"/mesh", R"({"strike": "250 m", "dip": "100 m", "normal": "100 m",
                        "fine_margin": "0 m"})"},
           {"/initial_state",
            concat(R"({"kind": "profile", "pressure": "20 MPa", "tensor": )", tensor(across), "}")},
           {"/friction", R"({"cohesion": "50 MPa", "friction_angle": "30 deg"})"},
           {"/stages", concat(R"([{"name": "plates", "duration": "2 year", "steps": 2)", change,
                              R"(}, {"name": "rest", "duration": "1 year"}])")}},
          document);
    Simulation simulation;
    Inside::hold(simulation, std::move(document));
    return simulation;
  };
  const History moved = run(
      scene(30, R"(, "stress_change": [["-4 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"],
                                 ["0 MPa", "0 MPa", "0 MPa"]])"));
  const History half = run(scene(32, "")), end = run(scene(34, ""));
  ASSERT_EQ(moved.fields.size(), 4U);
  const double size = end.fields[0].traction.norm();
  EXPECT_LT((moved.fields[1].traction - half.fields[0].traction).norm(), 1e-12 * size);
  EXPECT_LT((moved.fields[2].traction - end.fields[0].traction).norm(), 1e-12 * size);
  EXPECT_LT((moved.fields[3].traction - end.fields[0].traction).norm(), 1e-12 * size);
  EXPECT_GT((moved.fields[2].traction - moved.fields[0].traction).norm(), 1e-3 * size);
}

TEST(RegionalStress, IsRefusedWhereItIsNotSymmetricOrRelaxes) {
  const auto refusal = [](const Changes& changes) {
    try {
      field(changes).prepare();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Change pushed{"/stages/0/stress_change",
                      R"([["-4 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"],
                          ["0 MPa", "0 MPa", "0 MPa"]])"};
  EXPECT_EQ(refusal({pushed}), "");
  EXPECT_THAT(refusal({{"/stages/0/stress_change",
                        R"([["-4 MPa", "1 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"],
                            ["0 MPa", "0 MPa", "0 MPa"]])"}}),
              testing::HasSubstr("/stages/0/stress_change: the stress tensor is not symmetric"));
  EXPECT_THAT(refusal({pushed, kCreeps, {"/numerics/creep", "on"}}),
              testing::HasSubstr("acts on elastic rock only"));
}

/// Flow cells of 1 km along y about y = 0 whose pressures fall more in the middle.
/// @param lopsided  bar, that one of them falls more on one side.
std::string bulging(double lopsided) {
  std::string text =
      "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 2000-01-01 [bar]\n";
  for (const int y : {-2, -1, 0, 1, 2}) {
    for (const int x : {-1, 1}) {
      text += concat(x * 1500, ", ", y * 1000, ", 2500, 3000, 1000, 5000, 300, ",
                     120 + 20 * std::abs(y) + 10 * x - (y == 1 && x == 1 ? lopsided : 0), "\n");
    }
  }
  return text;
}

/// A 3D scene under a flow result, temperature and pressure alike.
Changes in_three_dimensions(const Folder& folder, double lopsided) {
  const std::string file = folder.write("p.csv", bulging(lopsided));
  const std::string warm = folder.write("t.csv", uniform("degC", 90, 70));
  return {kStill,
          {"/numerics", R"({"traction_tolerance": 1e-12})"},
          {"/mesh", R"({"strike": "600 m", "dip": "80 m", "normal": "150 m", "growth": 2})"},
          {"/materials/reservoir/thermal_expansion", "1.2e-5 1/K"},
          {"/pressure_field", concat(R"({"file": ")", file, R"("})")},
          {"/temperature_field", concat(R"({"file": ")", warm, R"("})")}};
}

TEST(FieldAndHalfDomain, OfASymmetricFieldIsTheWholeBody) {
  const Folder folder;
  Simulation half = field(in_three_dimensions(folder, 0)),
             whole = field(in_three_dimensions(folder, 0));
  whole.change({{"/numerics/half_domain", "off"}});
  ASSERT_TRUE(Inside::scene(half).plan.half_domain && !Inside::scene(whole).plan.half_domain);
  std::vector<FaultFields> a, b;
  RunWatch watch_half, watch_whole;
  watch_half.step = [&](const StepResult&, const FaultFields& f) { a.push_back(f); };
  watch_whole.step = [&](const StepResult&, const FaultFields& f) { b.push_back(f); };
  const CaseResult of_half = half.run({}, watch_half), of_whole = whole.run({}, watch_whole);
  ASSERT_EQ(a.size(), b.size());
  const std::vector<FaultPoint> here = half.points(), there = whole.points();
  const double traction = b.back().traction.norm(), jump = b.back().jump.norm();
  EXPECT_GT(jump, 1e-2);
  std::size_t n_found = 0;
  for (std::size_t k = 0; k < there.size(); ++k) {
    for (std::size_t j = 0; j < here.size(); ++j) {
      if ((there[k].position - here[j].position).norm() > 1e-6) continue;
      ++n_found;
      const auto p = static_cast<Eigen::Index>(j), q = static_cast<Eigen::Index>(k);
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_LT((a[i].traction.col(p) - b[i].traction.col(q)).norm(), 1e-10 * traction);
        EXPECT_LT((a[i].jump.col(p) - b[i].jump.col(q)).norm(), 1e-10 * jump);
        EXPECT_NEAR(a[i].fault_pressure_change[p], b[i].fault_pressure_change[q], 1e-3);
      }
    }
  }
  EXPECT_EQ(n_found, here.size());
  const auto &x = of_half.steps.back(), &y = of_whole.steps.back();
  for (std::size_t row = 0; row < y.observed.size(); ++row)
    EXPECT_NEAR(x.observed[row], y.observed[row], 1e-10);
  for (std::size_t r = 0; r < y.pressure_change.size(); ++r)
    EXPECT_NEAR(x.pressure_change[r], y.pressure_change[r], 1e-3);
  EXPECT_DOUBLE_EQ(*of_half.field_coverage, *of_whole.field_coverage);
}

TEST(FieldAndHalfDomain, OfALopsidedFieldTakesAllOfTheBody) {
  const Folder folder;
  const Simulation simulation = field(in_three_dimensions(folder, 30));
  EXPECT_FALSE(Inside::scene(simulation).plan.half_domain);
  EXPECT_THAT(simulation.plan_text(),
              testing::HasSubstr("it differs from its mirror image by up to 10 %"));
  Changes asked = in_three_dimensions(folder, 30);
  asked.push_back({"/numerics/half_domain", "on"});
  try {
    field(asked);
    FAIL() << "half of a lopsided field was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("half of the domain is asked for, but"));
  }
}

}  // namespace
}  // namespace faultsim
