// Closed forms on quadratic tetrahedra: the meshes of scenes, each hexahedron as six of them.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "simulator/condensation/condensation.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/reading/read_scene.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/in_tetrahedra.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using Settings = std::vector<std::pair<std::string, std::string>>;

/// The bulk of a scene on tetrahedra, in 3D with u_y = 0 in front and behind.
std::shared_ptr<BulkProblem> in_tetrahedra(const Settings& settings, bool is_mirrored) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/verification/v4_displaced_fault.json");
  for (const auto& [pointer, value] : settings) set_value(document, pointer, value);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  BulkProblem hexahedra = bulk_problem(scene, plan);
  const Mesh mesh = cut(test::InTetrahedra(hexahedra.mesh, is_mirrored).body(), "");
  auto problem = std::make_shared<BulkProblem>(std::move(hexahedra));
  problem->mesh = mesh;
  for (const Side side : {Side::y_min, Side::y_max})
    problem->conditions.push_back(
        {side, {false, true, false}, Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1});
  return problem;
}

/// ∫ N_v f(z) dA of a facet, by 2 n² points.
template <typename Function>
Eigen::Vector3d hat_integrals(const FaultSurface& fault, const FaultFace& face, int n,
                              const Function& f) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * n; ++j) {
      // The square folded onto the triangle; no point lies on a line through its corners.
      double s = (i + 0.5) / n, t = (j + 0.5) / (2 * n);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      const Eigen::Vector3d hat(1 - s - t, s, t);
      double z = 0;
      for (int v = 0; v < 3; ++v)
        z += hat[v] *
             fault.points[static_cast<std::size_t>(face.points[static_cast<std::size_t>(v)])].z();
      sum += f(z) * hat;
      ++weight;
    }
  }
  return face.area / weight * sum;
}

struct Errors {
  double largest = 0, l1 = 0;  ///< of max |Δ| over the nodes; away from corners, and of all.
};

/// Diagonals lie such that cells sheared along the fault are not flat.
std::shared_ptr<BulkProblem> displaced_fault(double cell, double dip_from_vertical) {
  const std::string size = concat(cell, " m");
  return in_tetrahedra({{"/geometry/from", "[\"-9 km\", \"0 m\", \"-9 km\"]"},
                        {"/geometry/to", concat("[\"9 km\", \"", size, "\", \"9 km\"]")},
                        {"/faults/0/dip_from_vertical", concat(dip_from_vertical, " deg")},
                        {"/faults/0/length", "100 m"},
                        {"/geometry/regions/0/to", "[\"0 m\", \"100 m\", \"75 m\"]"},
                        {"/geometry/regions/1/to", "[\"100 km\", \"100 m\", \"150 m\"]"},
                        {"/mesh/dip", size},
                        {"/mesh/normal", size}},
                       dip_from_vertical < 0);
}

/// Area times the exact changes of normal and shear traction, by node.
std::vector<Eigen::Vector2d> exact_forces(const FaultSurface& fault,
                                          const DisplacedReservoir& reservoir) {
  std::vector<Eigen::Vector2d> exact(fault.nodes.size(), Eigen::Vector2d::Zero());
  for (const FaultFace& face : fault.faces) {
    const auto add = [&](int component, const auto& f) {
      const Eigen::Vector3d part = hat_integrals(fault, face, 40, f);
      for (std::size_t v = 0; v < 3; ++v)
        if (face.nodes[v] >= 0)
          exact[static_cast<std::size_t>(face.nodes[v])][component] += part[static_cast<int>(v)];
    };
    add(0, [&](double z) { return displaced_fault_stress(reservoir, z).normal; });
    add(1, [&](double z) { return displaced_fault_stress(reservoir, z).shear; });
  }
  return exact;
}

/// Nodes at one height, in front and behind together as in plane strain.
struct Band {
  double area = 0;
  Eigen::Vector2d computed = Eigen::Vector2d::Zero(), exact = Eigen::Vector2d::Zero();  ///< forces.
};

std::map<long, Band> bands_of(const FaultOperator& op, const std::vector<Eigen::Vector2d>& exact,
                              double dip) {
  const Vector3d normal(std::sin(dip), 0, -std::cos(dip)), up(std::cos(dip), 0, std::sin(dip));
  const Eigen::VectorXd load = 0.9 * -25e6 * (op.loads.traction.col(0) + op.loads.traction.col(1));
  std::map<long, Band> bands;  // by height, mm
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const double sign = node.normal.dot(normal) > 0 ? 1 : -1;
    Vector3d along = load[node.dof[2]] * node.dip;
    if (node.dof[1] >= 0) along += load[node.dof[1]] * node.strike;
    Band& band = bands[std::lround(1e3 * node.position.z())];
    band.area += node.area;
    band.computed += node.area * Eigen::Vector2d(load[node.dof[0]], sign * along.dot(up));
    band.exact += exact[k];
  }
  return bands;
}

/// Hat means of the changes of traction on the stuck fault, against those of the closed form.
Errors errors_of(double cell, double dip_from_vertical, bool mean_dilatation) {
  const auto problem = displaced_fault(cell, dip_from_vertical);
  problem->mean_dilatation = mean_dilatation;
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(problem, monitor).condense();
  const double dip = std::numbers::pi / 2 + dip_from_vertical * std::numbers::pi / 180;
  const DisplacedReservoir reservoir{14.95e9 / 2.3, 0.15, 0.9, 225, 75, dip, -25e6, -25e6};
  Errors errors;
  double scale = 0, area = 0;
  for (const auto& [height, band] :
       bands_of(op, exact_forces(problem->mesh.faults.front(), reservoir), dip)) {
    const double z = std::abs(1e-3 * static_cast<double>(height));
    const Eigen::Vector2d off = (band.computed - band.exact).cwiseAbs();
    scale = std::max(scale, band.exact.cwiseAbs().maxCoeff() / band.area);
    errors.l1 += off.mean();
    area += band.area;
    if (std::min(std::abs(z - 75), std::abs(z - 150)) > 10 + 1e-6)
      errors.largest = std::max(errors.largest, off.maxCoeff() / band.area);
  }
  errors.largest /= scale;
  errors.l1 /= area * scale;
  return errors;
}

/// At 60° and vertical; the tractions jump and are infinite at corners, so L1 is of first order.
TEST(Tetrahedra, AStuckDisplacedFaultHasTheHatMeansOfTheClosedForm) {
  for (const double dip : {-30.0, 0.0}) {
    const Errors coarse = errors_of(20, dip, true), fine = errors_of(10, dip, true);
    EXPECT_LT(fine.largest, 0.002) << dip;
    EXPECT_LT(fine.l1, 0.001) << dip;
    EXPECT_LT(fine.l1, 0.6 * coarse.l1) << dip;
    EXPECT_LT(fine.largest, 0.3 * coarse.largest) << dip;
  }
}

TEST(Tetrahedra, PlainQuadraticCellsMeetItToo) {
  const Errors errors = errors_of(10, -30, false);
  EXPECT_LT(errors.largest, 0.002);
  EXPECT_LT(errors.l1, 0.001);
}

}  // namespace
}  // namespace faultsim
