// V1: a uniform stress must be reproduced exactly on closed faults, however the mesh lies.
#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

constexpr double kExact = 1e-10;
const char kScene[] = "v1_patch_test.json";

Eigen::Matrix3d boundary_stress(const Scene& scene) {
  for (const BoundaryCondition& condition : scene.box.boundary) {
    if (condition.kind == BoundaryKind::stress) {
      return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
          condition.stress.data());
    }
  }
  FAULTSIM_DEMAND(false, "no face of ", kScene, " carries a stress");
}

/// Largest difference of a node's traction, in its own frame, from σ n; relative to |σ n|.
double worst_traction(const SceneRun& run, const Eigen::Matrix3d& stress) {
  double worst = 0;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const OperatorNode& node = run.geometry().nodes[k];
    const Eigen::Vector3d traction = stress * node.normal;
    const Eigen::Vector3d expected(node.normal.dot(traction), node.strike.dot(traction),
                                   node.dip.dot(traction));
    const Eigen::Vector3d computed = run.fields.back().traction.col(static_cast<Eigen::Index>(k));
    worst = std::max(worst, (computed - expected).norm() / expected.norm());
  }
  return worst;
}

/// Compares a run with the stress that it was given: every node, then the table's figures at the
/// node that differs most from them.
void check_patch(const SceneRun& run, const std::string& what, VerifyReport& report) {
  const Eigen::Matrix3d stress = boundary_stress(run.scene);
  const FaultFields& fields = run.fields.back();
  FAULTSIM_DEMAND(!run.geometry().nodes.empty(), "no fault nodes in ", kScene);
  report.bound(what + ": traction vector, worst node", "relative", worst_traction(run, stress),
               kExact);
  report.bound(what + ": jump, worst node", "m", fields.jump.cwiseAbs().maxCoeff(), 0);
  for (const OperatorFault& fault : run.geometry().faults) {
    const std::string place = what + (run.geometry().faults.size() > 1 ? ", " + fault.name : "");
    const auto first = static_cast<std::size_t>(fault.first_node);
    const PlaneTraction exact = plane_traction(stress, run.geometry().nodes[first].normal);
    const double strength =
        -exact.normal * std::tan(run.scene.faults.front().friction.static_friction_angle);
    double normal = exact.normal, shear = exact.shear_norm, chi = exact.shear_norm / strength;
    const auto keep_worst = [](double& worst, double value, double expected) {
      if (std::abs(value - expected) > std::abs(worst - expected)) worst = value;
    };
    for (int i = fault.first_node; i < fault.first_node + fault.n_nodes; ++i) {
      keep_worst(normal, fields.traction(0, i), exact.normal);
      keep_worst(shear, fields.traction.col(i).tail<2>().norm(), exact.shear_norm);
      keep_worst(chi, fields.critical_index[i], exact.shear_norm / strength);
    }
    report.compare(place + ": t_N", "MPa", exact.normal / 1e6, normal / 1e6, kExact);
    report.compare(place + ": |t_T|", "MPa", exact.shear_norm / 1e6, shear / 1e6, kExact);
    report.compare(place + ": χ", "", exact.shear_norm / strength, chi, kExact);
  }
}

VerifyCase dip_case(int dip) {
  // The table's normal (S, 0, −C) belongs to a fault that dips west: dip_from_vertical < 0.
  const std::string from_vertical = concat(dip - 90, " deg");
  return {
      concat("V1-dip", dip),
      concat("patch test, dip ", dip, "° from the horizontal"),
      {kScene},
      false,
      [=](SceneRunner& runner, VerifyReport& report) {
        const SceneRun run = runner.run(kScene, {{"/faults/0/dip_from_vertical", from_vertical}});
        const Eigen::Vector3d normal(std::sin(dip * kDegree), 0, -std::cos(dip * kDegree));
        const Eigen::Vector3d found = run.geometry().nodes.front().normal;
        report.bound("normal of the fault, ±(S, 0, −C)", "",
                     std::min((found - normal).norm(), (found + normal).norm()), 1e-12);
        check_patch(run, concat("dip ", dip), report);
      }};
}

VerifyCase swapped_case() {
  return {"V1-swapped",
          "patch test with plus and minus side swapped by the strike",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            check_patch(runner.run(kScene, {{"/faults/0/dip_from_vertical", "-25 deg"}}),
                        "as given", report);
            check_patch(runner.run(kScene, {{"/faults/0/dip_from_vertical", "25 deg"},
                                            {"/faults/0/strike", "180 deg"}}),
                        "strike + 180°, same plane", report);
          }};
}

VerifyCase rotated_case() {
  return {
      "V1-rotated",
      "patch test turned by 90° about the vertical: same figures",
      {kScene},
      false,
      [](SceneRunner& runner, VerifyReport& report) {
        // x → y, y → −x: σ_xx and σ_yy change places, σ_xy its sign, σ_xz → σ_yz, σ_yz → −σ_xz.
        const SceneRun plain = runner.run(kScene, {{"/faults/0/dip_from_vertical", "-25 deg"}});
        const SceneRun turned = runner.run(
            kScene,
            {{"/faults/0/dip_from_vertical", "25 deg"},
             {"/faults/0/strike", "90 deg"},
             {"/geometry/boundary/0/stress",
              R"([["-25 MPa","-3 MPa","-1 MPa"],["-3 MPa","-20 MPa","2 MPa"],["-1 MPa","2 MPa","-30 MPa"]])"}});
        check_patch(turned, "turned", report);
        const auto figures = [](const SceneRun& run) {
          const auto column = run.fields.back().traction.col(0);
          return std::array<double, 2>{column[0] / 1e6, column.tail<2>().norm() / 1e6};
        };
        report.compare("t_N as before turning", "MPa", figures(plain)[0], figures(turned)[0],
                       kExact);
        report.compare("|t_T| as before turning", "MPa", figures(plain)[1], figures(turned)[1],
                       kExact);
      }};
}

VerifyCase refined_case() {
  return {
      "V1-refined",
      "patch test on finer, graded and elliptic patches: nothing changes",
      {kScene},
      false,
      [](SceneRunner& runner, VerifyReport& report) {
        const Setting dip = {"/faults/0/dip_from_vertical", "-25 deg"};
        check_patch(runner.run(kScene, {dip, {"/mesh/dip", "50 m"}}), "50 m down dip", report);
        check_patch(runner.run(kScene, {dip, {"/mesh/normal", "25 m"}, {"/mesh/strike", "70 m"}}),
                    "graded", report);
        check_patch(runner.run(kScene, {dip, {"/faults/0/shape", "ellipse"}}), "ellipse", report);
      }};
}

VerifyCase several_case() {
  return {"V1-several",
          "patch test with several faults",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const Settings parallel = {{"/faults", R"([
              {"name":"F1","center":["-250 m","0 m","0 m"],"dip_from_vertical":"-25 deg","length":"500 m","width":"400 m"},
              {"name":"F2","center":["0 m","0 m","0 m"],"dip_from_vertical":"-25 deg","length":"600 m","width":"500 m"},
              {"name":"F3","center":["250 m","0 m","100 m"],"dip_from_vertical":"-25 deg","length":"400 m","width":"400 m"}])"}};
            check_patch(runner.run(kScene, parallel), "parallel", report);
            const Settings different = {{"/faults", R"([
              {"name":"F1","center":["-300 m","0 m","0 m"],"dip_from_vertical":"20 deg","length":"500 m","width":"300 m"},
              {"name":"F2","center":["0 m","0 m","0 m"],"dip_from_vertical":"0 deg","length":"600 m","width":"500 m"},
              {"name":"F3","center":["300 m","0 m","0 m"],"dip_from_vertical":"-20 deg","length":"400 m","width":"300 m"}])"}};
            check_patch(runner.run(kScene, different), "different dips", report);
          }};
}

VerifyCase oriented_case() {
  return {"V1-oriented",
          "patch test with a strike off the axes and with a horizontal fault",
          {kScene},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            check_patch(
                runner.run(kScene, {{"/faults/0/strike", "20 deg"}, {"/faults/0/width", "400 m"}}),
                "strike 20°, vertical", report);
            check_patch(runner.run(kScene, {{"/faults/0/strike", "15 deg"},
                                            {"/faults/0/dip_from_vertical", "-20 deg"},
                                            {"/faults/0/width", "400 m"}}),
                        "strike 15°, dip 70°", report);
            check_patch(runner.run(kScene, {{"/faults/0/dip_from_vertical", "90 deg"}}),
                        "horizontal", report);
          }};
}

}  // namespace

std::vector<VerifyCase> patch_cases() {
  return {dip_case(90),   dip_case(65),   dip_case(45),   swapped_case(),
          rotated_case(), refined_case(), several_case(), oriented_case()};
}

}  // namespace faultsim
