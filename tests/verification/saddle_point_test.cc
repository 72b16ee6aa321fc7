// The condensed and the coupled path against an independent solve: both-sided displacements and
// multipliers in one saddle-point system, semismooth Newton on it with a sparse LU, no condensation
// anywhere.

#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "simulator/condensation/condensation.h"
#include "simulator/contact/contact.h"
#include "simulator/coupled/coupled_contact.h"
#include "simulator/mesh/mesh_spec.h"
#include "tests/unit/condensation/junction_problem.h"

namespace faultsim {
namespace {

constexpr double kFriction = 0.5;  // tan φ
/// r of the augmented tractions, Pa/m, around G/h. The solution does not depend on it; changing it
/// every ten iterations ends the cycles that plain semismooth Newton falls into.
constexpr double kAugmentations[4] = {1e8, 3e7, 3e8, 1e7};

/// A block with an inner fault dipping 20° from the vertical, a depleting region on its plus side,
/// and a top that is pulled up and sheared along strike.
BulkProblem make_problem() {
  BoxMeshSpec spec{};
  spec.from = {-300, -250, -400};
  spec.to = {300, 250, 0};
  spec.layer_materials = {0};
  spec.fault_names = {"F"};
  spec.patches.push_back({{0, 0, -200}, 0.0, 20 * M_PI / 180, 300, 260});
  PressureRegion region{};
  region.from = {0, -250, -250};
  region.to = {300, 250, -150};
  spec.regions.push_back(region);
  spec.sizes = {60, 50, 60, 1.3, 1e4, 0};
  spec.plane_strain = false;
  BulkProblem problem;
  problem.mesh = make_mesh(spec);
  problem.materials = {{12e9, 0.2}};
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d pull = none;
  pull(0, 0) = 1;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  problem.conditions = {{Side::z_min, {true, true, true}, zero, none, -1},
                        {Side::z_max, {true, true, true}, {0, 1, 0}, none, 1},
                        {Side::x_min, {true, false, false}, zero, none, -1}};
  LoadCase pressure, shear, tension;
  pressure.region = 0;
  shear.displacement = true;
  tension.stress_groups = {Side::x_max};
  tension.stress = pull;
  problem.loads = {pressure, shear, tension};
  return problem;
}

/// Load factors of the steps: depletion, shear, pull until nodes open, then everything back by
/// half.
const std::vector<std::vector<double>> kSteps = {
    {-10e6, 0, 0}, {-10e6, 0.03, 3e6}, {-10e6, 0.05, 9.0e6}, {-4e6, 0.01, 4e6}};

/// A linear form of displacements: Σ factor u of mesh nodes.
using Form = std::vector<std::pair<int, double>>;

/// What jumps, by fault node, and what must vanish.
struct Kinematics {
  std::vector<Form> jumps;
  std::vector<Form> ties;
};

/// Two copies of each node, whose difference is the jump.
Kinematics of_pairs(const Mesh& mesh) {
  Kinematics kinematics;
  for (const FaultSurface& fault : mesh.faults)
    for (const FaultNode& node : fault.nodes)
      kinematics.jumps.push_back({{node.plus_node, 1}, {node.minus_node, -1}});
  return kinematics;
}

/// The full system. Unknowns z = (x, t', λ): displacements of all copies of nodes, effective
/// tractions, and what holds the ties.
class SaddlePoint {
 public:
  SaddlePoint(const BulkProblem& problem, const Kinematics& kinematics)
      : kinematics_(kinematics), faults_(problem.mesh.faults), mesh_(problem.mesh) {
    mesh_.faults.clear();
    mesh_.copies.clear();  // both copies of a node are then ordinary, independent nodes
    dofs_.emplace(mesh_, problem.conditions, static_cast<int>(problem.loads.size()));
    stiffness_ = assemble_stiffness(mesh_, problem.materials, *dofs_, problem.mean_dilatation);
    for (std::size_t k = 0; k < problem.loads.size(); ++k) {
      const LoadCase& load = problem.loads[k];
      if (load.region >= 0) loads_.push_back(pressure_load(mesh_, *dofs_, load.region));
      if (!load.stress_groups.empty())
        loads_.push_back(stress_load(mesh_, *dofs_, load.stress_groups, load.stress));
      if (load.displacement) {
        loads_.push_back(displacement_load(mesh_, problem.materials, *dofs_, static_cast<int>(k),
                                           problem.mean_dilatation));
      }
    }
    for (const FaultSurface& fault : faults_)
      for (const FaultNode& node : fault.nodes) nodes_.push_back(&node);
    n_ = dofs_->n_unknowns();
    n_traction_ = 3 * static_cast<int>(nodes_.size());
    build_jump();
    build_ties();
    z_ = Eigen::VectorXd::Zero(n_ + n_traction_ + ties_.rows());
    previous_ = Eigen::VectorXd::Zero(n_traction_);
  }

  Eigen::VectorXd jump() const { return jump_ * z_.head(n_); }
  Eigen::VectorXd traction() const { return z_.segment(n_, n_traction_); }

  /// One load step; returns the number of Newton iterations, −1 if it did not converge.
  int solve_step(const std::vector<double>& factors, const Eigen::VectorXd& initial) {
    if (traction().isZero()) z_.segment(n_, n_traction_) = initial;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(n_);
    for (std::size_t k = 0; k < factors.size(); ++k) force += factors[k] * loads_[k];
    for (int iteration = 0; iteration < 80; ++iteration) {
      triplets_.clear();
      residual_.setZero(z_.size());
      augmentation_ = kAugmentations[(iteration / 10) % 4];
      bulk_rows(force, initial);
      tie_rows();
      for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) contact_rows(k);
      // Rows in N over K's scale and in Pa over MPa: the update decides.
      Eigen::SparseMatrix<double> matrix(z_.size(), z_.size());
      matrix.setFromTriplets(triplets_.begin(), triplets_.end());
      Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
      if (lu.info() != Eigen::Success) return -1;
      const Eigen::VectorXd update = lu.solve(residual_);
      z_ -= update;
      const double du = update.head(n_).cwiseAbs().maxCoeff();
      const double dt = update.segment(n_, n_traction_).cwiseAbs().maxCoeff();
      if (du < 1e-12 && dt < 1e-3) {  // of 0.05 m and 10 MPa
        previous_ = jump();
        return iteration + 1;
      }
    }
    return -1;
  }

 private:
  using JumpIterator = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;

  void build_jump() {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
      const Eigen::Vector3d frame[3] = {nodes_[static_cast<std::size_t>(k)]->normal,
                                        nodes_[static_cast<std::size_t>(k)]->strike,
                                        nodes_[static_cast<std::size_t>(k)]->dip};
      for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) {
          for (const auto& [node, factor] : kinematics_.jumps[static_cast<std::size_t>(k)]) {
            for (const auto& term : dofs_->terms(node, i))
              entries.emplace_back(3 * k + c, term.unknown,
                                   factor * frame[c][i] * term.coefficient);
          }
        }
      }
    }
    jump_.resize(n_traction_, n_);
    jump_.setFromTriplets(entries.begin(), entries.end());
  }

  void build_ties() {
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0;
    for (const Form& tie : kinematics_.ties) {
      for (int i = 0; i < 3; ++i, ++row) {
        for (const auto& [node, factor] : tie) {
          for (const auto& term : dofs_->terms(node, i))
            entries.emplace_back(row, term.unknown, kTieScale * factor * term.coefficient);
        }
      }
    }
    ties_.resize(row, n_);
    ties_.setFromTriplets(entries.begin(), entries.end());
  }

  void tie_rows() {
    const int first = n_ + n_traction_;
    residual_.tail(ties_.rows()) = ties_ * z_.head(n_);
    residual_.head(n_) += ties_.transpose() * z_.tail(ties_.rows());
    for (int row = 0; row < ties_.outerSize(); ++row) {
      for (JumpIterator it(ties_, row); it; ++it) {
        triplets_.emplace_back(first + row, static_cast<int>(it.col()), it.value());
        triplets_.emplace_back(static_cast<int>(it.col()), first + row, it.value());
      }
    }
  }

  void bulk_rows(const Eigen::VectorXd& force, const Eigen::VectorXd& initial) {
    for (int column = 0; column < stiffness_.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator it(stiffness_, column); it; ++it) {
        const auto row = static_cast<int>(it.row());
        triplets_.emplace_back(row, column, it.value());
        if (row != column) triplets_.emplace_back(column, row, it.value());
      }
    }
    residual_.head(n_) = stiffness_.selfadjointView<Eigen::Lower>() * z_.head(n_) - force;
    for (int row = 0; row < jump_.outerSize(); ++row) {
      for (JumpIterator it(jump_, row); it; ++it) {
        const auto column = static_cast<int>(it.col());
        const double entry = it.value() * nodes_[static_cast<std::size_t>(row / 3)]->area;
        triplets_.emplace_back(column, n_ + row, entry);
        residual_[column] += entry * (z_[n_ + row] - initial[row]);
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
    const Eigen::Vector2d slip = g.tail<2>() - previous_.segment<2>(3 * k + 1);
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

  static constexpr double kTieScale = 1e9;  // N/m, of K's entries
  Kinematics kinematics_;
  std::vector<FaultSurface> faults_;
  Mesh mesh_;
  std::optional<DofMap> dofs_;
  SparseMatrix stiffness_;
  std::vector<Eigen::VectorXd> loads_;
  std::vector<const FaultNode*> nodes_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> jump_, ties_;
  Eigen::VectorXd z_, residual_, previous_;
  std::vector<Eigen::Triplet<double>> triplets_;
  double augmentation_ = 0;
  int n_ = 0, n_traction_ = 0;
};

void expect_equal(const BulkProblem& problem, const Kinematics& kinematics,
                  const std::vector<std::vector<double>>& load_steps) {
  SilentMonitor monitor;
  CondensedBulk bulk(problem, monitor);
  const FaultOperator op = bulk.condense();
  const int n_nodes = static_cast<int>(op.geometry.nodes.size());
  ASSERT_EQ(op.geometry.n_dofs, 3 * n_nodes);
  ASSERT_GT(n_nodes, 15);

  Eigen::VectorXd initial(3 * n_nodes);  // compression that grows with depth, with some shear
  for (int k = 0; k < n_nodes; ++k) {
    const double depth = -op.geometry.nodes[static_cast<std::size_t>(k)].position.z();
    initial.segment<3>(3 * k) =
        (0.5e6 + 3e4 * std::max(depth - 70, 0.0)) * Eigen::Vector3d(-1, 0.05, 0.2);
  }
  std::vector<int> dofs;  // of the operator, node by node as the reference counts
  for (const auto& node : op.geometry.nodes)
    dofs.insert(dofs.end(), node.dof.begin(), node.dof.end());
  Eigen::VectorXd locked(3 * n_nodes);
  locked(dofs) = initial;

  ContactLaws laws;
  CoulombLaw law;
  law.static_friction_angle = law.dynamic_friction_angle = std::atan(kFriction);
  laws.assign(n_nodes, law);
  ContactOptions options;
  options.traction_tolerance = 1e-11;
  ContactSolver solver(op, laws, options);
  ContactState state = initial_state(op);
  SaddlePoint reference(problem, kinematics);
  const TwoSidedBulk two_sided(problem);
  const CoupledContact coupled(
      two_sided, laws,
      {.solver = {LeadingKind::exact, SchurKind::bds}, .traction_tolerance = 1e-11});
  ContactState coupled_state = initial_state(op);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(two_sided.n_displacements());

  Eigen::VectorXd before = Eigen::VectorXd::Zero(3 * n_nodes);
  bool seen[3] = {false, false, false};
  bool seen_together = false;
  ASSERT_EQ(solver.solve_step(before, locked, state).outcome, Outcome::converged);
  ASSERT_TRUE(coupled.advance({{0, 0, 0}, locked}, coupled_state, u).converged);
  before = locked;
  for (const std::vector<double>& factors : load_steps) {
    Eigen::VectorXd after = locked;
    for (int k = 0; k < 3; ++k)
      after += factors[static_cast<std::size_t>(k)] * op.loads.traction.col(k);
    const ContactReport report = solver.solve_step(before, after, state);
    ASSERT_EQ(report.outcome, Outcome::converged) << report.reason;
    before = after;
    const CoupledStepReport step = coupled.advance({factors, locked}, coupled_state, u);
    ASSERT_TRUE(step.converged) << step.reason;
    ASSERT_GT(reference.solve_step(factors, initial), 0);
    bool here[3] = {false, false, false};
    for (const FaultState s : state.state)
      seen[static_cast<int>(s)] = here[static_cast<int>(s)] = true;
    seen_together = seen_together || (here[0] && here[1] && here[2]);

    const double slip_scale = std::max(reference.jump().cwiseAbs().maxCoeff(), 1e-6);
    const double traction_scale = reference.traction().cwiseAbs().maxCoeff();
    for (const ContactState* path : {&state, &coupled_state}) {
      EXPECT_LT((path->jump(dofs) - reference.jump()).cwiseAbs().maxCoeff(), 1e-8 * slip_scale);
      EXPECT_LT((path->traction(dofs) - reference.traction()).cwiseAbs().maxCoeff(),
                1e-8 * traction_scale);
    }
  }
  EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
  EXPECT_TRUE(seen_together) << "no step has stick, slip and open nodes at once";
}

TEST(SaddlePoint, EqualsBothPathsWithStickSlipAndOpenNodes) {
  const BulkProblem problem = make_problem();
  expect_equal(problem, of_pairs(problem.mesh), kSteps);
}

/// By what cells have which copies and where they lie: nothing of the mesh's own shares.
class FromCells {
 public:
  explicit FromCells(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const int node : mesh.cells.corners(cell)) centre += at(node) / 4;
      for (const int node : mesh.cells[cell]) {
        copies_[key(at(node))].insert(node);
        centre_[node] = centre;
      }
    }
  }

  Kinematics kinematics() const {
    Kinematics all;
    for (std::size_t f = 0; f < 2; ++f)
      for (const FaultNode& node : mesh_.faults[f].nodes) all.jumps.push_back(jump(f, node));
    std::set<int> tied;
    for (std::size_t cell = 0; cell < mesh_.cells.size(); ++cell)
      for (std::size_t side = 0; side < 6; ++side) add_tie(cell, side, tied, all.ties);
    return all;
  }

 private:
  using Key = std::tuple<double, double, double>;
  const Eigen::Vector3d& at(int node) const { return mesh_.nodes[static_cast<std::size_t>(node)]; }
  static Key key(const Eigen::Vector3d& x) { return {x.x(), x.y(), x.z()}; }
  bool beyond_a(int copy) const { return centre_.at(copy).x() > at(copy).x(); }
  bool beyond_b(int copy) const { return centre_.at(copy).y() > at(copy).y(); }

  /// A jumps by the mean over its area beyond it less what is before it; B between its sides.
  Form jump(std::size_t fault, const FaultNode& node) const {
    const std::set<int>& copies = copies_.at(key(at(node.minus_node)));
    double area[2] = {0, 0};  // of A's triangles at smaller and at larger y
    for (const FaultFace& face : mesh_.faults[0].faces) {
      double y = 0;
      bool touches = false;
      for (std::size_t v = 0; v < 3; ++v) {
        const Eigen::Vector3d& x = mesh_.faults[0].points[static_cast<std::size_t>(face.points[v])];
        y += x.y() / 3;
        touches = touches || x == at(node.minus_node);
      }
      if (touches) area[y > at(node.minus_node).y()] += face.area;
    }
    Form form;
    for (const int copy : copies) {
      const bool is_split_by_b = copies.size() == 3;
      if (fault == 1) {
        if (is_split_by_b && !beyond_a(copy)) continue;
        form.emplace_back(copy, beyond_b(copy) ? 1 : -1);
      } else if (!beyond_a(copy)) {
        form.emplace_back(copy, -1);
      } else {
        form.emplace_back(copy, is_split_by_b ? area[beyond_b(copy)] / (area[0] + area[1]) : 1);
      }
    }
    return form;
  }

  /// A copy of a middle differs from the first one as the ends that its cell has differ on average.
  void add_tie(std::size_t cell, std::size_t side, std::set<int>& tied,
               std::vector<Form>& ties) const {
    const auto nodes = mesh_.cells[cell];
    const int middle = nodes[4 + side], first = *copies_.at(key(at(middle))).begin();
    if (middle == first || !tied.insert(middle).second) return;
    Form form = {{middle, 1}, {first, -1}};
    for (std::size_t other = 0; other < mesh_.cells.size(); ++other) {
      const auto theirs = mesh_.cells[other];
      for (std::size_t k = 0; k < 6; ++k) {
        if (theirs[4 + k] != first) continue;
        for (const std::size_t end : kTetrahedronSides[k]) form.emplace_back(theirs[end], 0.5);
        for (const std::size_t end : kTetrahedronSides[side]) form.emplace_back(nodes[end], -0.5);
        ties.push_back(form);
        return;
      }
    }
  }

  const Mesh& mesh_;
  std::map<Key, std::set<int>> copies_;
  std::map<int, Eigen::Vector3d> centre_;  // of a cell that has the copy
};

TEST(SaddlePoint, EqualsBothPathsOnTetrahedraWithAJunction) {
  const BulkProblem problem = test::junction_problem();
  expect_equal(problem, FromCells(problem.mesh).kinematics(),
               {{-10e6, 0, 0}, {-10e6, 2e6, 2e6}, {-10e6, 4e6, 6e6}, {-4e6, 1e6, 3e6}});
}

}  // namespace
}  // namespace faultsim
