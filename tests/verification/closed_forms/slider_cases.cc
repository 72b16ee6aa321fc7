// V7: friction by hand: spring and slider as scenes, and two tiny problems with known solutions.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"
#include "simulator/contact/contact.h"
#include "simulator/laws/friction_law.h"
#include "tests/verification/closed_forms/friction_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

constexpr double kTolerance = 1e-8;
const char kScene[] = "v7_slider.json";

/// Settings that drive the top by u_1, u_2, … in one load step each, in the direction at `azimuth`
/// (rad from x to y).
Settings driven_by(const std::vector<double>& u, double azimuth = 0) {
  std::string times = "\"0 year\"", factors = "0";
  for (std::size_t i = 0; i < u.size(); ++i) {
    times += concat(",\"", i + 1, " year\"");
    factors += concat(",", u[i]);
  }
  return {{"/geometry/boundary/1/table", "{\"time\":[" + times + "],\"factor\":[" + factors + "]}"},
          {"/geometry/boundary/1/translation",
           concat("[\"", std::cos(azimuth), " m\",\"", std::sin(azimuth), " m\",\"0 m\"]")},
          {"/stages/0/duration", concat(u.size(), " year")},
          {"/stages/0/steps", concat(u.size())}};
}

Settings with_friction(Settings settings, const std::string& friction) {
  settings.push_back({"/friction", friction});
  return settings;
}

/// The slider that a scene describes: N from the initial stress, k = G/2H; the box is as long as
/// both blocks are high across the fault and shorter along it.
Slider slider_of(const Scene& scene) {
  const Material& rock = scene.materials.front();
  double height = 0;
  for (std::size_t i = 0; i < 3; ++i)
    height = std::max(height, (scene.box.to[i] - scene.box.from[i]) / 2);
  const CoulombLaw& friction = scene.faults.front().friction;
  return {rock.youngs_modulus / (2 * (1 + rock.poisson_ratio)) / (2 * height),
          -scene.initial.tensor.value()[8],
          friction.static_friction_angle,
          friction.dynamic_friction_angle,
          friction.slip_weakening_distance > 0 ? friction.slip_weakening_distance : 1,
          friction.weakening == WeakeningLaw::angle};
}

/// Global slip (the driven block, on the side of larger coordinates, relative to the held one) and
/// shear traction at a step.
Eigen::Vector3d in_plane(const SceneRun& run, const Eigen::Matrix3Xd& field) {
  const OperatorNode& node = run.geometry().nodes.front();
  const double sign = node.normal.sum() > 0 ? 1 : -1;
  return sign * (field(1, 0) * node.strike + field(2, 0) * node.dip);
}

void compare_path(const SceneRun& run, const std::vector<double>& u, VerifyReport& report) {
  const Slider slider = slider_of(run.scene);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double expected = slider_slip(slider, u[i]);
    const FaultFields& fields = run.fields.at(i + 1);
    report.compare(concat("slip at u = ", short_number(u[i])), "m", expected,
                   in_plane(run, fields.jump).x(), kTolerance, 1);
    const double shear = slider.stiffness * (u[i] - expected);
    report.compare(concat("τ at u = ", short_number(u[i])), "MPa", shear / 1e6,
                   in_plane(run, fields.traction).x() / 1e6, kTolerance);
  }
}

const char kAngleLaw[] =
    R"({"law":"angle","friction_angle":"30 deg","dynamic_friction_angle":"10 deg","slip_weakening_distance":"1.6 m"})";

VerifyCase linear_case() {
  return {"V7-linear",
          "spring and slider, the coefficient weakens, stable",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const std::vector<double> u = {1.2, 1.3, 1.4, 1.5, 1.6, 1.8};
            compare_path(runner.run(kScene, driven_by(u)), u, report);
          }};
}

VerifyCase angle_case() {
  return {"V7-angle",
          "spring and slider, the angle weakens, stable",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const std::vector<double> u = {1.154, 1.2, 1.5, 1.7, 1.9, 2.1};
            compare_path(runner.run(kScene, with_friction(driven_by(u), kAngleLaw)), u, report);
            const SceneRun bracket =
                runner.run(kScene, with_friction(driven_by({1.15470053, 1.15470055}), kAngleLaw));
            report.holds("sticks at u = 1.15470053",
                         in_plane(bracket, bracket.fields[1].jump).norm() == 0);
            report.holds("slips at u = 1.15470055",
                         in_plane(bracket, bracket.fields[2].jump).norm() > 0);
          }};
}

/// Adds that a run ends `unstable` at exactly this step, with no slip before.
void expect_instability(const SceneRun& run, int step, const std::string& what,
                        VerifyReport& report) {
  report.holds(what + ": outcome unstable", run.result.outcome == Outcome::unstable);
  report.compare(what + ": step of the instability", "", step, run.result.failed_step.value_or(-1),
                 0);
  const auto last = static_cast<std::size_t>(step - 1);
  const bool there = run.fields.size() == last + 1;
  report.holds(what + ": history kept up to the step before", there);
  if (there)
    report.bound(what + ": slip before", "m", in_plane(run, run.fields[last].jump).norm(), 1e-12);
}

/// The jump by hand: at u = 1.2 from slip 0, τ 12 to slip 0.4, τ 8, in one event.
void expect_hand_jump(const SceneRun& run, int step, VerifyReport& report) {
  const auto& events = run.result.events;
  report.compare("number of events", "", 1, static_cast<double>(events.size()), 0);
  if (events.size() != 1) return;
  const SlipEvent& event = events.front();
  report.compare("step of the event", "", step, event.step, 0);
  report.compare("slip of the event", "m", 0.4, event.max_slip, kTolerance);
  report.compare("stress drop", "MPa", 4, event.stress_drop / 1e6, kTolerance);
  report.compare("energy released per area", "MPa m", 4,
                 event.energy_released / event.slipped_area / 1e6, kTolerance);
  report.compare("energy dissipated per area", "MPa m", 3.6,
                 event.energy_dissipated / event.slipped_area / 1e6, 1e-3);
  report.holds("its evidence holds", event.evidence_holds);
}

VerifyCase unstable_case() {
  return {"V7-unstable",
          "spring and slider, weakening faster than the spring: one event",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const std::vector<double> u = {0.4, 0.8, 1.1, 1.199, 1.21, 1.3};
            Settings settings = driven_by(u);
            settings.push_back({"/friction/slip_weakening_distance", "0.2 m"});
            settings.push_back({"/numerics/onset_tolerance", "1e-8"});
            const SceneRun run = runner.run(kScene, settings);
            expect_hand_jump(run, 5, report);
            for (std::size_t i = 0; i < u.size(); ++i) {
              const double expected = u[i] > 1.2 ? u[i] - 0.8 : 0;
              report.compare(concat("slip at u = ", short_number(u[i])), "m", expected,
                             in_plane(run, run.fields.at(i + 1).jump).x(), kTolerance, 1);
            }
            settings.push_back({"/numerics/follow_events", "false"});
            expect_instability(runner.run(kScene, settings, false), 5, "not followed", report);
          }};
}

VerifyCase critical_case() {
  return {"V7-critical",
          "the slip-weakening distance at which the slider loses its stability",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            Settings settings = with_friction(driven_by({1.1, 1.1548, 1.156}), kAngleLaw);
            const SceneRun stable = runner.run(kScene, settings);
            const Slider slider = slider_of(stable.scene);
            const int dof = stable.geometry().nodes.front().dof[1];
            const double h_over_a = stable.op->h()(dof, dof) / stable.op->geometry.dof_area[dof];
            report.compare("H/A of the slider = k", "MPa/m", slider.stiffness / 1e6, h_over_a / 1e6,
                           kTolerance);
            const double critical = slider_critical_distance(slider);
            report.compare("critical distance N sec²φ_s Δφ/k", "m", 0.93084227, critical,
                           kTolerance, 1);
            for (const double factor : {1.01, 0.99}) {
              settings.push_back(
                  {"/friction/slip_weakening_distance", concat(critical * factor, " m")});
              const SceneRun run = runner.run(kScene, settings, false);
              const std::size_t expected = factor > 1 ? 0 : 1;
              report.holds(concat("d_c ", short_number(factor), " times critical: ", expected,
                                  expected == 1 ? " event" : " events"),
                           run.result.events.size() == expected);
            }
            // The eigenvalue H/A − W of the patch changes sign there.
            const NodeLaw law(CoulombLaw{.static_friction_angle = slider.static_friction_angle,
                                         .dynamic_friction_angle = slider.dynamic_friction_angle,
                                         .slip_weakening_distance = critical});
            const double rate = -law.strength(-slider.normal_stress, {0, 0}, 0, {}).d_measure;
            report.compare("H/A − W at the critical distance (error of k)", "MPa/m", 0,
                           (h_over_a - rate) / 1e6, kTolerance, slider.stiffness / 1e6);
          }};
}

VerifyCase reversal_case() {
  return {"V7-reversal",
          "spring and slider, load reversed twice, constant friction",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const std::vector<double> u = {1.1, 1.2, 2, 1, -0.39, -0.4, -1, -2, 0, 0.4, 2};
            const SceneRun run = runner.run(
                kScene,
                with_friction(driven_by(u), R"({"law":"coefficient","friction_coefficient":0.6})"));
            const Slider slider = slider_of(run.scene);
            const SliderPath path = slider_path(slider, u);
            double dissipated = 0, before = 0;
            for (std::size_t i = 0; i < u.size(); ++i) {
              const double slip = in_plane(run, run.fields.at(i + 1).jump).x();
              const double shear = in_plane(run, run.fields.at(i + 1).traction).x();
              report.compare(concat("slip at u = ", short_number(u[i]), " (step ", i + 1, ")"), "m",
                             path.slip[i], slip, kTolerance, 1);
              report.compare(concat("τ at u = ", short_number(u[i]), " (step ", i + 1, ")"), "MPa",
                             slider.stiffness * (u[i] - path.slip[i]) / 1e6, shear / 1e6,
                             kTolerance, 12);
              if (i > 2) dissipated += shear * (slip - before);
              before = slip;
            }
            report.compare("dissipated in the cycle from u = 2 to −2 and back", "MJ/m²", 38.4,
                           dissipated / 1e6, kTolerance);
          }};
}

VerifyCase oblique_case() {
  return {"V7-oblique",
          "spring and slider, load oblique in the fault plane",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            for (const double degrees : {30.0, 90.0, 200.0}) {
              const SceneRun run = runner.run(kScene, driven_by({1.3, 1.5}, degrees * kDegree));
              const Eigen::Vector3d slip = in_plane(run, run.fields.back().jump);
              const std::string place = concat("load at ", short_number(degrees), "°: ");
              report.compare(place + "|slip|", "m", slider_slip(slider_of(run.scene), 1.5),
                             slip.norm(), kTolerance);
              const Eigen::Vector3d direction(std::cos(degrees * kDegree),
                                              std::sin(degrees * kDegree), 0);
              report.bound(place + "slip across the load's direction", "m",
                           (slip - slip.dot(direction) * direction).norm(), kTolerance);
              const Eigen::Vector3d shear = in_plane(run, run.fields.back().traction) / 1e6;
              report.compare(place + "τ along it", "MPa", 9, shear.dot(direction), kTolerance);
            }
          }};
}

/// A contact problem u = W r + q as a fault operator: H = W⁻¹, A = 1, locked traction W⁻¹ q, r =
/// −t'. Stresses are scaled to 10 MPa, the level that the solver is made for.
struct TinyProblem {
  static constexpr double scale = 1e7;  ///< Pa per unit of r
  Eigen::MatrixXd w;
  Eigen::VectorXd q;
  double mu;

  /// r of the solution by ContactSolver.
  Eigen::VectorXd solve() const {
    const Eigen::Index n = q.size();
    FaultOperator op;
    op.geometry.n_dofs = static_cast<int>(n);
    for (int first = 0; first < n; first += 3) {
      OperatorNode node;
      node.position = Eigen::Vector3d(first, 0, 0);
      node.normal = Eigen::Vector3d::UnitX();
      node.strike = -Eigen::Vector3d::UnitY();
      node.dip = -Eigen::Vector3d::UnitZ();
      node.area = 1;
      node.dof = {first, first + 1, first + 2};
      op.geometry.nodes.push_back(node);
    }
    op.geometry.dof_area = Eigen::VectorXd::Ones(n);
    const Eigen::MatrixXd inverse = w.inverse();
    op.compliance = std::make_shared<DenseCompliance>(scale * inverse);
    const ContactLaws laws(op.geometry.nodes.size(), {.static_friction_angle = std::atan(mu),
                                                      .dynamic_friction_angle = std::atan(mu)});
    ContactOptions options;
    options.traction_tolerance = 1e-13;
    ContactSolver solver(op, laws, options);
    ContactState state = initial_state(op);
    const ContactReport report =
        solver.solve_step(Eigen::VectorXd::Zero(n), scale * (inverse * q), state);
    if (report.outcome != Outcome::converged) throw Error("contact solve: " + report.reason);
    return -state.traction / scale;
  }
};

VerifyCase tiny_case() {
  return {
      "V7-tiny",
      "tiny contact problems u = W r + q of contact-mechanics libraries",
      {},
      false,
      [](SceneRunner&, VerifyReport& report) {
        TinyProblem one;
        one.w.resize(3, 3);
        one.w << 15, -1, -2, -1, 14, 1, -2, 1, 16;
        one.q.resize(3);
        one.q << -1, 2, 3;
        one.mu = 0.1;
        const Eigen::VectorXd r = one.solve();
        report.compare("one contact: |r|", "", 0.0660233441967, r.norm(), 1e-10);
        report.compare("one contact: |u|", "", 3.35274260167, (one.w * r + one.q).norm(), 1e-10);
        report.compare("one contact: r_n", "", 0.0656956828977, r[0], 1e-10);
        report.bound("one contact: cone residual", "", cone_residual(one.w, one.q, one.mu, r),
                     1e-10);
        TinyProblem three{Eigen::MatrixXd::Identity(9, 9), Eigen::VectorXd(9), 0.1};
        three.q << -1, 1, 3, -1, 1, 3, -1, 1, 3;
        const Eigen::VectorXd s = three.solve();
        for (Eigen::Index k = 0; k < 9; k += 3)
          report.compare(concat("three contacts: r_n of contact ", k / 3 + 1), "", 1, s[k], 1e-10);
        report.compare("three contacts: |u|", "", 5.30402049429, (three.w * s + three.q).norm(),
                       1e-10);
        report.bound("three contacts: cone residual", "",
                     cone_residual(three.w, three.q, three.mu, s), 1e-10);
      }};
}

/// The angle-law path in a changed scene that is driven along `direction`: whole vectors.
void compare_turned(SceneRunner& runner, const std::string& what, const Settings& changes,
                    const Eigen::Vector3d& direction, VerifyReport& report) {
  const std::vector<double> u = {1.1, 1.3, 1.5, 1.7, 1.9, 2.1};
  Settings settings = with_friction(driven_by(u), kAngleLaw);
  settings.push_back(
      {"/geometry/boundary/1/translation",
       concat("[\"", direction.x(), " m\",\"", direction.y(), " m\",\"", direction.z(), " m\"]")});
  settings.insert(settings.end(), changes.begin(), changes.end());
  const SceneRun run = runner.run(kScene, settings);
  const Slider slider = slider_of(run.scene);
  double slip = 0, shear = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double expected = slider_slip(slider, u[i]);
    const double strength = slider.stiffness * (u[i] - expected);
    const FaultFields& fields = run.fields.at(i + 1);
    slip = std::max(slip, (in_plane(run, fields.jump) - expected * direction).norm());
    shear =
        std::max(shear, (in_plane(run, fields.traction) - strength * direction).norm() / strength);
  }
  report.bound(what + ": slip vector, worst step", "m", slip, kTolerance);
  report.bound(what + ": τ vector, worst step", "relative", shear, kTolerance);
}

/// The same body with its fault across x or y.
Settings on_its_side(bool across_x) {
  const auto swap = [&](const char* x, const char* y) { return std::string(across_x ? x : y); };
  return {
      {"/geometry/from", swap(R"(["-1 m","0 m","0 m"])", R"(["0 m","-1 m","0 m"])")},
      {"/geometry/boundary/0/sides", swap(R"(["x-"])", R"(["y-"])")},
      {"/geometry/boundary/1/sides", swap(R"(["x+"])", R"(["y+"])")},
      {"/geometry/boundary/2/sides", swap(R"(["y-","y+","z-","z+"])", R"(["x-","x+","z-","z+"])")},
      {"/faults/0/center", swap(R"(["0 m","0.5 m","0.5 m"])", R"(["0.5 m","0 m","0.5 m"])")},
      {"/faults/0/strike", swap("0 deg", "90 deg")},
      {"/faults/0/dip_from_vertical", "0 deg"}};
}

/// The slider on its side, its fault reversed and its fault's axes turned: the same path.
VerifyCase turned_case() {
  return {"V7-turned",
          "spring and slider on its side, reversed, and with the fault's axes turned",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            compare_turned(runner, "driven along −x", {}, {-1, 0, 0}, report);
            compare_turned(runner, "fault's strike 37°", {{"/faults/0/strike", "37 deg"}},
                           {1, 0, 0}, report);
            compare_turned(
                runner, "strike + 180°, dip −90°: the same plane",
                {{"/faults/0/strike", "180 deg"}, {"/faults/0/dip_from_vertical", "-90 deg"}},
                {1, 0, 0}, report);
            compare_turned(runner, "fault across x, driven along y and up", on_its_side(true),
                           {0, 0.6, 0.8}, report);
            compare_turned(runner, "fault across y, driven along x and down", on_its_side(false),
                           {0.6, 0, -0.8}, report);
          }};
}

VerifyCase nucleation_case() {
  return {"V7-nucleation",
          "nucleation length of Uenishi and Rice",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            // 1.157773883699 G*/W with all digits, G* = G/(1−ν) and G.
            const double rate = 36e6 * 0.32 / 0.02;
            report.compare("h_n, mode II", "m", 15.370772557278,
                           nucleation_length(6500e6 / (1 - 0.15), rate), kTolerance);
            report.compare("h_n, mode III", "m", 13.065156673687, nucleation_length(6500e6, rate),
                           kTolerance);
            // The slider: cells of 1 m, W = N Δμ/d_c = 5 MPa/m, G 20 MPa; mode III is the shorter.
            const SceneRun run = runner.run(kScene, driven_by({1.3}));
            report.compare("longest cell edge / h_n, of a run", "", 0.215931628377,
                           run.result.max_nucleation_ratio, kTolerance);
          }};
}

}  // namespace

std::vector<VerifyCase> slider_cases() {
  return {linear_case(),  angle_case(),  unstable_case(), critical_case(),  reversal_case(),
          oblique_case(), turned_case(), tiny_case(),     nucleation_case()};
}

}  // namespace faultsim
