// A case with creeping salt, condensed and in increments, against an independent solve: the full
// mesh with both-sided displacements and multipliers, in totals. Its own Gauss loop keeps the
// deviator at every point and makes forces and tangent of each time step from it; semismooth Newton
// with a sparse LU. Only mesh, constraints and load vectors of pressure and stress are shared.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <cmath>
#include <optional>

#include "simulator/loading/run_case.h"
#include "simulator/loads/case_loads.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

constexpr double kFriction = 0.5;  // tan φ
/// r of the augmented tractions, Pa/m; changing it ends the cycles of semismooth Newton.
constexpr double kAugmentations[4] = {1e8, 3e7, 3e8, 1e7};

using Vector6 = Eigen::Matrix<double, 6, 1>;  // tensor components xx yy zz xy yz xz
using Corners = Eigen::Matrix<double, 3, 8>;

/// ∇N (3 x 8) and w of a hexahedron at its Gauss points.
struct GaussPoints {
  Corners gradient[8];
  double weight[8];
  Corners mean = Corners::Zero();  // of the gradients over the volume
  explicit GaussPoints(const Corners& x) {
    const int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                            {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
    double volume = 0;
    for (int g = 0; g < 8; ++g) {
      const double place = 1 / std::sqrt(3.0);
      Corners local;
      for (int a = 0; a < 8; ++a) {
        double factor[3];
        for (int c = 0; c < 3; ++c) factor[c] = 1 + sign[a][c] * sign[g][c] * place;
        local(0, a) = sign[a][0] * factor[1] * factor[2] / 8;
        local(1, a) = sign[a][1] * factor[0] * factor[2] / 8;
        local(2, a) = sign[a][2] * factor[0] * factor[1] / 8;
      }
      const Eigen::Matrix3d jacobian = x * local.transpose();  // dx/dξ
      gradient[g] = jacobian.inverse().transpose() * local;
      weight[g] = jacobian.determinant();
      mean += weight[g] * gradient[g];
      volume += weight[g];
    }
    mean /= volume;
  }
};

/// Deviatoric strain of corner displacements: rows xx yy zz xy yz xz, columns 3 a + component.
Eigen::Matrix<double, 6, 24> deviator_operator(const Corners& gradient) {
  Eigen::Matrix<double, 6, 24> d = Eigen::Matrix<double, 6, 24>::Zero();
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d n = gradient.col(a);
    for (int c = 0; c < 3; ++c) {
      for (int row = 0; row < 3; ++row)
        d(row, 3 * a + c) = n[c] * ((row == c ? 1.0 : 0.0) - 1.0 / 3);
    }
    d(3, 3 * a) = d(4, 3 * a + 2) = n[1] / 2;
    d(3, 3 * a + 1) = d(5, 3 * a + 2) = n[0] / 2;
    d(4, 3 * a + 1) = d(5, 3 * a) = n[2] / 2;
  }
  return d;
}

class FullMesh {
 public:
  FullMesh(const BulkProblem& problem, const Eigen::VectorXd& initial)
      : problem_(problem), faults_(problem.mesh.faults), mesh_(problem.mesh), initial_(initial) {
    mesh_.faults.clear();
    mesh_.copies.clear();  // both copies of a node are then ordinary, independent nodes
    dofs_.emplace(mesh_, problem.conditions, static_cast<int>(problem.loads.size()));
    n_ = dofs_->n_unknowns();
    for (const LoadCase& load : problem.loads) {
      Eigen::VectorXd force = Eigen::VectorXd::Zero(n_);
      if (load.region >= 0) force = pressure_load(mesh_, *dofs_, load.region);
      if (!load.stress_groups.empty())
        force = stress_load(mesh_, *dofs_, load.stress_groups, load.stress);
      loads_.push_back(force);
    }
    for (const FaultNode& node : faults_.front().nodes) nodes_.push_back(&node);
    z_ = Eigen::VectorXd::Zero(n_ + 3 * static_cast<int>(nodes_.size()));
    z_.tail(initial.size()) = initial;
    slipped_ = Eigen::VectorXd::Zero(initial.size());
    displacement_.setZero(3, static_cast<Eigen::Index>(mesh_.nodes.size()));
    deviator_.assign(mesh_.cells.size(), Eigen::Matrix<double, 6, 8>::Zero());
    build_jump();
  }

  Eigen::VectorXd jump() const { return jump_ * z_.head(n_); }
  Eigen::VectorXd traction() const { return z_.tail(z_.size() - n_); }

  /// @param pressure  α_f Δp_f n of the fault dofs, Pa.
  bool advance(double duration, const std::vector<double>& factors,
               const Eigen::VectorXd& pressure) {
    for (int iteration = 0; iteration < 80; ++iteration) {
      triplets_.clear();
      residual_.setZero(z_.size());
      augmentation_ = kAugmentations[(iteration / 10) % 4];
      for (std::size_t k = 0; k < factors.size(); ++k) residual_.head(n_) -= factors[k] * loads_[k];
      bulk_rows(duration, factors, false);
      fault_rows(pressure);
      for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) contact_rows(k);
      Eigen::SparseMatrix<double> matrix(z_.size(), z_.size());
      matrix.setFromTriplets(triplets_.begin(), triplets_.end());
      Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
      if (lu.info() != Eigen::Success) return false;
      const Eigen::VectorXd update = lu.solve(residual_);
      z_ -= update;
      if (update.head(n_).cwiseAbs().maxCoeff() < 1e-12 &&
          update.tail(z_.size() - n_).cwiseAbs().maxCoeff() < 1e-3) {
        bulk_rows(duration, factors, true);
        slipped_ = jump();
        return true;
      }
    }
    return false;
  }

 private:
  using JumpIterator = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;

  void build_jump() {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
      const FaultNode& node = *nodes_[static_cast<std::size_t>(k)];
      const Eigen::Vector3d frame[3] = {node.normal, node.strike, node.dip};
      for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) {
          for (const int sign : {1, -1}) {
            for (const auto& term : dofs_->terms(sign > 0 ? node.plus_node : node.minus_node, i)) {
              entries.emplace_back(3 * k + c, term.unknown, sign * frame[c][i] * term.coefficient);
            }
          }
        }
      }
    }
    jump_.resize(3 * static_cast<int>(nodes_.size()), n_);
    jump_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Internal forces and tangent of a Maxwell step; at its end the deviators are kept instead.
  void bulk_rows(double duration, const std::vector<double>& factors, bool keep) {
    const Eigen::Matrix3Xd u = nodal_displacement(mesh_, *dofs_, z_.head(n_), factors);
    for (std::size_t cell = 0; cell < mesh_.cells.size(); ++cell) {
      const auto m = static_cast<std::size_t>(mesh_.material[cell]);
      const double E = problem_.materials[m].youngs_modulus;
      const double nu = problem_.materials[m].poisson_ratio;
      const double G = E / (2 * (1 + nu)), bulk = E / (3 * (1 - 2 * nu));
      const double x = duration * G / problem_.viscosity[m];
      const double decay = std::exp(-x), stiffness = x > 0 ? 2 * G * (1 - decay) / x : 2 * G;
      Corners place, total, increment;
      for (int a = 0; a < 8; ++a) {
        const int node = mesh_.cells[cell][static_cast<std::size_t>(a)];
        place.col(a) = mesh_.nodes[static_cast<std::size_t>(node)];
        total.col(a) = u.col(node);
        increment.col(a) = u.col(node) - displacement_.col(node);
      }
      const GaussPoints points(place);
      const Eigen::Map<const Eigen::Matrix<double, 24, 1>> moved(increment.data());
      const Eigen::Map<const Eigen::Matrix<double, 24, 1>> mean(points.mean.data());
      const double dilatation = points.mean.cwiseProduct(total).sum();
      Eigen::Matrix<double, 24, 1> force = Eigen::Matrix<double, 24, 1>::Zero();
      Eigen::Matrix<double, 24, 24> tangent = Eigen::Matrix<double, 24, 24>::Zero();
      Vector6 twice;
      twice << 1, 1, 1, 2, 2, 2;
      for (int g = 0; g < 8; ++g) {
        const Eigen::Matrix<double, 6, 24> d = deviator_operator(points.gradient[g]);
        const Vector6 s = decay * deviator_[cell].col(g) + stiffness * d * moved;
        if (keep) deviator_[cell].col(g) = s;
        const Eigen::Matrix<double, 24, 6> weighted =
            points.weight[g] * d.transpose() * twice.asDiagonal();
        force += weighted * s + points.weight[g] * bulk * dilatation * mean;
        tangent += stiffness * weighted * d + points.weight[g] * bulk * mean * mean.transpose();
      }
      if (!keep) add_cell(mesh_.cells[cell], force, tangent);
    }
    if (keep) displacement_ = u;
  }

  void add_cell(std::span<const int> cell, const Eigen::Matrix<double, 24, 1>& force,
                const Eigen::Matrix<double, 24, 24>& tangent) {
    for (int i = 0; i < 24; ++i) {
      for (const auto& p : dofs_->terms(cell[static_cast<std::size_t>(i / 3)], i % 3)) {
        residual_[p.unknown] += p.coefficient * force[i];
        for (int j = 0; j < 24; ++j) {
          for (const auto& q : dofs_->terms(cell[static_cast<std::size_t>(j / 3)], j % 3)) {
            triplets_.emplace_back(p.unknown, q.unknown,
                                   p.coefficient * q.coefficient * tangent(i, j));
          }
        }
      }
    }
  }

  void fault_rows(const Eigen::VectorXd& pressure) {
    for (int row = 0; row < jump_.outerSize(); ++row) {
      for (JumpIterator it(jump_, row); it; ++it) {
        const auto column = static_cast<int>(it.col());
        const double entry = it.value() * nodes_[static_cast<std::size_t>(row / 3)]->area;
        triplets_.emplace_back(column, n_ + row, entry);
        residual_[column] += entry * (z_[n_ + row] - pressure[row] - initial_[row]);
      }
    }
  }

  void add_jump_row(int row, int component, double factor) {
    for (JumpIterator it(jump_, component); it; ++it) {
      triplets_.emplace_back(row, static_cast<int>(it.col()), factor * it.value());
    }
  }

  /// Alart–Curnier: closed if −t'_N − r g_N > 0, stuck if |t'_T + r Δg_T| ≤ τ_L.
  void contact_rows(int k) {
    const double r = augmentation_;
    const int base = n_ + 3 * k;
    const Eigen::Vector3d t = z_.segment<3>(base);
    const Eigen::Vector3d g = (jump_ * z_.head(n_)).segment<3>(3 * k);
    const Eigen::Vector2d slip = g.tail<2>() - slipped_.segment<2>(3 * k + 1);
    if (-t[0] - r * g[0] <= 0) {  // open
      for (int c = 0; c < 3; ++c) {
        triplets_.emplace_back(base + c, base + c, 1.0);
        residual_[base + c] = t[c];
      }
      return;
    }
    add_jump_row(base, 3 * k, r);
    residual_[base] = r * g[0];
    const Eigen::Vector2d y = t.tail<2>() + r * slip;
    const double limit = std::max(-t[0], 0.0) * kFriction;
    if (y.norm() <= limit) {  // stick
      for (int c = 0; c < 2; ++c) {
        add_jump_row(base + 1 + c, 3 * k + 1 + c, r);
        residual_[base + 1 + c] = r * slip[c];
      }
      return;
    }
    const Eigen::Vector2d m = y / y.norm();
    const Eigen::Matrix2d turn =
        limit / y.norm() * (Eigen::Matrix2d::Identity() - m * m.transpose());
    for (int c = 0; c < 2; ++c) {
      residual_[base + 1 + c] = t[1 + c] - limit * m[c];
      triplets_.emplace_back(base + 1 + c, base, kFriction * m[c]);
      for (int d = 0; d < 2; ++d) {
        triplets_.emplace_back(base + 1 + c, base + 1 + d, (c == d ? 1.0 : 0.0) - turn(c, d));
        add_jump_row(base + 1 + c, 3 * k + 1 + d, -r * turn(c, d));
      }
    }
  }

  const BulkProblem& problem_;
  std::vector<FaultSurface> faults_;
  Mesh mesh_;
  std::optional<DofMap> dofs_;
  std::vector<Eigen::VectorXd> loads_;
  std::vector<const FaultNode*> nodes_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> jump_;
  Eigen::VectorXd initial_, z_, residual_, slipped_;
  Eigen::Matrix3Xd displacement_;                      // at the start of the step
  std::vector<Eigen::Matrix<double, 6, 8>> deviator_;  // per cell, at the start of the step
  std::vector<Eigen::Triplet<double>> triplets_;
  double augmentation_ = 0;
  int n_ = 0;
};

/// A fault dipping 20° from rock through salt into a depleting block. Stress on a side is there
/// from the start, grows until nodes open, and falls; the top is sheared along strike; the block is
/// injected into again, then everything rests while salt creeps.
const char kScene[] = R"({
  "format": 1,
  "materials": {
    "rock": { "youngs_modulus": "12 GPa", "poisson_ratio": 0.2 },
    "salt": { "youngs_modulus": "40 GPa", "poisson_ratio": 0.3, "viscosity": "1e17 Pa s" },
    "mush": { "youngs_modulus": "8 GPa", "poisson_ratio": 0.25, "viscosity": "4e16 Pa s" }
  },
  "geometry": {
    "kind": "box", "from": ["-300 m", "-250 m", "-400 m"], "to": ["300 m", "250 m", "0 m"],
    "layers": [ { "name": "top", "material": "rock", "top": "0 m" },
                { "name": "salt", "material": "salt", "top": "100 m" },
                { "name": "mush", "material": "mush", "top": "190 m" },
                { "name": "base", "material": "rock", "top": "240 m" } ],
    "boundary": [
      { "sides": ["z-"], "kind": "fixed" },
      { "sides": ["z+"], "kind": "displacement", "components": ["x", "y", "z"], "translation": ["0 m", "1 m", "0 m"],
        "table": { "time": ["0 year", "0.5 year", "1 year", "1.5 year", "2 year"],
                   "factor": [0, 0, 0.03, 0.05, 0.01] } },
      { "sides": ["x-"], "kind": "roller" },
      { "sides": ["x+"], "kind": "stress",
        "stress": [["1 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"]],
        "table": { "time": ["0 year", "0.5 year", "1 year", "1.5 year", "2 year"],
                   "factor": [0.5, 0.5, 3, 14, 4] } }
    ],
    "regions": [ { "name": "gas", "from": ["0 m", "-250 m", "-330 m"], "to": ["300 m", "250 m", "-230 m"] } ]
  },
  "mesh": { "strike": "60 m", "dip": "50 m", "normal": "60 m", "growth": 1.3 },
  "numerics": { "creep": "on", "creep_time_step": "0.25 year", "traction_tolerance": 1e-11 },
  "initial_state": { "kind": "profile",
    "tensor": [["-14.3 MPa", "0.3 MPa", "0.5 MPa"], ["0.3 MPa", "-14.8 MPa", "0 MPa"], ["0.5 MPa", "0 MPa", "-15.8 MPa"]], "pressure": "12 MPa" },
  "friction": { "law": "coefficient", "friction_coefficient": 0.5 },
  "fault_pressure": { "rule": "mean" },
  "faults": [ { "name": "F", "center": ["0 m", "0 m", "-200 m"], "dip_from_vertical": "20 deg",
                "length": "300 m", "width": "260 m", "fault_biot": 0.9 } ],
  "stages": [
    { "name": "depletion", "duration": "0.5 year", "steps": 1, "pressure_change": "-10 MPa" },
    { "name": "pull", "duration": "1 year", "steps": 2, "pressure_change": "-10 MPa" },
    { "name": "injection", "duration": "0.5 year", "steps": 1, "pressure_change": "-4 MPa" },
    { "name": "rest", "duration": "2 year", "steps": 2 }
  ]
})";

/// α_f Δp_f on the normals.
Eigen::VectorXd fault_pressure(const Scene& scene, const StepLoads& loads) {
  Eigen::VectorXd pressure = Eigen::VectorXd::Zero(3 * loads.fault_pressure_change.size());
  for (Eigen::Index k = 0; k < loads.fault_pressure_change.size(); ++k) {
    pressure[3 * k] = scene.faults[0].fault_biot * loads.fault_pressure_change[k];
  }
  return pressure;
}

TEST(CreepFullMesh, EqualsTheCondensedMarchWithStickSlipAndOpenNodes) {
  const Scene scene = read_scene(parse_json(kScene, "test"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  ASSERT_TRUE(problems.empty()) << problems[0].what;
  SilentMonitor monitor;
  const PreparedOperator prepared = prepare_operator(scene, plan, {}, false, monitor);
  ASSERT_TRUE(prepared.bulk);
  std::vector<FaultFields> fields;
  const CaseResult result =
      run_case(scene, prepared, monitor,
               {{[&](const StepResult&, const FaultFields& f) { fields.push_back(f); }}});
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  const Eigen::Index n_dofs = prepared.op->geometry.n_dofs;
  ASSERT_EQ(n_dofs, 3 * fields[0].traction.cols());
  ASSERT_GT(fields[0].traction.cols(), 15);

  const CaseLoads case_loads(scene, *prepared.op);
  const StepLoads start = case_loads.at(0);
  Eigen::VectorXd initial = start.locked;
  for (std::size_t k = 0; k < start.factors.size(); ++k) {
    initial -= start.factors[k] * prepared.op->loads.traction.col(static_cast<Eigen::Index>(k));
  }
  const BulkProblem problem = bulk_problem(scene, plan);
  FullMesh reference(problem, initial);
  bool seen[3] = {false, false, false};
  double last = 0;
  int time_steps = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const double to = result.steps[i].time;
    const int n = i == 0 ? 1 : static_cast<int>(std::lround((to - last) / (0.25 * 31557600)));
    for (int j = 1; j <= n; ++j) {
      const StepLoads loads = case_loads.at(last + (to - last) * j / n);
      ASSERT_TRUE(reference.advance((to - last) / n, loads.factors, fault_pressure(scene, loads)))
          << "load step " << i << ", step of creep " << j;
    }
    last = to;
    time_steps += i == 0 ? 0 : n;
    for (Eigen::Index k = 0; k < fields[i].state.size(); ++k) seen[fields[i].state[k]] = true;
    const Eigen::Map<const Eigen::VectorXd> jump(fields[i].jump.data(), n_dofs);
    const Eigen::Map<const Eigen::VectorXd> traction(fields[i].traction.data(), n_dofs);
    const double slip_scale = std::max(reference.jump().cwiseAbs().maxCoeff(), 1e-6);
    const double traction_scale = reference.traction().cwiseAbs().maxCoeff();
    const double jump_error = (jump - reference.jump()).cwiseAbs().maxCoeff() / slip_scale;
    const double traction_error =
        (traction - reference.traction()).cwiseAbs().maxCoeff() / traction_scale;
    EXPECT_LT(jump_error, 1e-8) << "load step " << i;
    EXPECT_LT(traction_error, 1e-8) << "load step " << i;
    RecordProperty("jump_error_" + std::to_string(i), std::to_string(jump_error * 1e12) + "e-12");
    RecordProperty("traction_error_" + std::to_string(i),
                   std::to_string(traction_error * 1e12) + "e-12");
    EXPECT_EQ(result.steps[i].counts.sub_steps, n) << "friction counts slip by step of creep";
  }
  EXPECT_TRUE(seen[0] && seen[1] && seen[2]) << seen[0] << seen[1] << seen[2];
  EXPECT_EQ(time_steps, 16);
  // Creep did something, and more than a hundred thousand times the tolerance.
  EXPECT_GT(fields.back().creep_traction.cwiseAbs().maxCoeff(), 1e-3 * 10e6);
}

}  // namespace
}  // namespace faultsim
