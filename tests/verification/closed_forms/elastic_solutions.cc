#include "tests/verification/closed_forms/elastic_solutions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"

namespace faultsim {

using std::numbers::pi;

PlaneTraction plane_traction(const Eigen::Matrix3d& stress, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d traction = stress * normal;
  const double t_n = normal.dot(traction);
  return {t_n, (traction - t_n * normal).norm()};
}

double uniaxial_compressibility(double youngs_modulus, double poisson_ratio) {
  return (1 - 2 * poisson_ratio) * (1 + poisson_ratio) / (youngs_modulus * (1 - poisson_ratio));
}

double horizontal_stress_ratio(double poisson_ratio, double biot) {
  return biot * (1 - 2 * poisson_ratio) / (1 - poisson_ratio);
}

namespace {

/// 2 c_m (1−ν) α Δp h, m.
double geertsma_scale(const GeertsmaDisc& disc) {
  return 2 * uniaxial_compressibility(disc.youngs_modulus, disc.poisson_ratio) *
         (1 - disc.poisson_ratio) * disc.biot * disc.pressure_change * disc.thickness;
}

}  // namespace

double geertsma_surface_displacement(const GeertsmaDisc& disc, double distance) {
  // With κ = Dk the integrand decays as exp(−κ): 40 leaves 4e-18. The step resolves both Bessel
  // functions.
  constexpr double end = 40;
  const double fastest = std::max({disc.radius, distance, disc.depth}) / disc.depth;
  const int n = 2 * static_cast<int>(std::ceil(end * fastest * 50));
  const double step = end / n;
  const auto integrand = [&](double kappa) {
    const double k = kappa / disc.depth;
    return std::exp(-kappa) * std::cyl_bessel_j(1, disc.radius * k) *
           std::cyl_bessel_j(0, distance * k);
  };
  double sum = integrand(0) + integrand(end);
  for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4 : 2) * integrand(i * step);
  const double integral = sum * step / 3 / disc.depth;
  return geertsma_scale(disc) * disc.radius * integral;
}

double geertsma_centre_displacement(const GeertsmaDisc& disc) {
  const double c = disc.depth / disc.radius;
  return geertsma_scale(disc) * (1 - c / std::sqrt(1 + c * c));
}

FaultBlocks blocks_of(const DisplacedReservoir& reservoir) {
  const double a = (reservoir.thickness - reservoir.offset) / 2;
  const double b = (reservoir.thickness + reservoir.offset) / 2;
  return {-b, a, -a, b};
}

FaultStressChange displaced_fault_stress(const DisplacedReservoir& reservoir,
                                         const FaultBlocks& blocks, double y) {
  const double s = std::sin(reservoir.dip), c = std::cos(reservoir.dip);
  const double gamma = horizontal_stress_ratio(reservoir.poisson_ratio, reservoir.biot);
  FaultStressChange sum{0, 0};
  const auto add = [&](double pressure_change, double base, double top, double side) {
    const double amplitude = gamma * pressure_change;
    const double half = y > base && y < top ? 0.5 : 0;
    const double log_term = side * std::log(std::abs((y - top) / (y - base)));
    sum.normal -= amplitude * (s * s * half + s * c / (2 * pi) * log_term);
    sum.shear += amplitude * (s * s / (2 * pi) * log_term - s * c * half);
  };
  add(reservoir.left_pressure_change, blocks.left_base, blocks.left_top, 1);
  add(reservoir.right_pressure_change, blocks.right_base, blocks.right_top, -1);
  return sum;
}

FaultStressChange displaced_fault_stress(const DisplacedReservoir& reservoir, double y) {
  return displaced_fault_stress(reservoir, blocks_of(reservoir), y);
}

double frictionless_slip(const DisplacedReservoir& reservoir, double y) {
  const double a = (reservoir.thickness - reservoir.offset) / 2;
  const double b = (reservoir.thickness + reservoir.offset) / 2;
  const double plateau = reservoir.biot * (1 - 2 * reservoir.poisson_ratio) *
                         std::abs(reservoir.left_pressure_change) * (b - a) /
                         reservoir.shear_modulus;
  return plateau * std::clamp((b - std::abs(y)) / (b - a), 0.0, 1.0);
}

FaultStressChange initial_fault_traction(const SlippingFault& fault, double y) {
  const double s = std::sin(fault.reservoir.dip), c = std::cos(fault.reservoir.dip);
  const double vertical = fault.vertical_stress + fault.vertical_stress_gradient * y;
  const double pore = fault.initial_biot * (fault.pressure + fault.pressure_gradient * y);
  const double horizontal = fault.stress_ratio * (vertical + pore) - pore;
  return {s * s * horizontal + c * c * vertical, s * c * (horizontal - vertical)};
}

namespace {

/// Shear traction, limit and stiffness of the boundary elements; slip = 0.
struct SlipProblem {
  Eigen::VectorXd y, length, shear, limit;
  Eigen::MatrixXd stiffness;  ///< Pa/m: shear traction = shear − stiffness · slip
};

/// Element ends; those of the blocks are among them, so that the peaks there lie between element
/// centres.
std::vector<double> element_ends(const FaultBlocks& blocks, double beyond, double element_height) {
  std::vector<double> pieces = {blocks.left_base, blocks.left_top, blocks.right_base,
                                blocks.right_top};
  std::sort(pieces.begin(), pieces.end());
  if (beyond > 0) {
    pieces.insert(pieces.begin(), pieces.front() - beyond);
    pieces.push_back(pieces.back() + beyond);
  }
  std::vector<double> ends = {pieces.front()};
  for (std::size_t p = 0; p + 1 < pieces.size(); ++p) {
    const double height = pieces[p + 1] - pieces[p];
    const int n = static_cast<int>(std::ceil(height / element_height - 1e-9));
    for (int i = 1; i <= n; ++i) ends.push_back(pieces[p] + height * i / n);
  }
  return ends;
}

SlipProblem slip_problem(const SlippingFault& fault, double element_height) {
  const DisplacedReservoir& reservoir = fault.reservoir;
  const double sine = std::sin(reservoir.dip);
  const FaultBlocks blocks = fault.blocks.value_or(blocks_of(reservoir));
  const std::vector<double> ends = element_ends(blocks, fault.beyond, element_height);
  const auto n = static_cast<Eigen::Index>(ends.size()) - 1;
  SlipProblem problem{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n),
                      Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  const double factor = reservoir.shear_modulus / (2 * pi * (1 - reservoir.poisson_ratio)) * sine;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = (ends[k] + ends[k + 1]) / 2;
    const FaultStressChange initial = initial_fault_traction(fault, y);
    const FaultStressChange change = displaced_fault_stress(reservoir, blocks, y);
    const bool depleted = (y > blocks.left_base && y < blocks.left_top) ||
                          (y > blocks.right_base && y < blocks.right_top);
    const double pressure =
        fault.pressure + fault.pressure_gradient * y + (depleted ? fault.fault_pressure_change : 0);
    problem.y[i] = y;
    problem.length[i] = (ends[k + 1] - ends[k]) / sine;
    problem.shear[i] = initial.shear + change.shear;
    problem.limit[i] = -fault.friction_coefficient *
                       (initial.normal + change.normal + fault.fault_biot * pressure);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto m = static_cast<std::size_t>(j);
      problem.stiffness(i, j) = factor * (1 / (y - ends[m]) - 1 / (y - ends[m + 1]));
    }
  }
  return problem;
}

/// The active set of Coulomb friction with a stiffness per element; positive definite matrices
/// only.
struct SlipSolution {
  bool stable = false;  ///< the set settled, with positive pivots all the way.
  Eigen::VectorXd slip;
};

SlipSolution solve_slip(const SlipProblem& problem) {
  const Eigen::Index n = problem.y.size();
  SlipSolution solution{false, Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd& slip = solution.slip;
  std::vector<int> direction(static_cast<std::size_t>(n), 0);
  // The matrix is an M-matrix, so the slipping set grows from the violated elements and each pass
  // adds or drops elements once; the bound is generous.
  constexpr int max_passes = 1000;
  for (int pass = 0; pass < max_passes; ++pass) {
    bool changed = false;
    const Eigen::VectorXd shear = problem.shear - problem.stiffness * slip;
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < n; ++i) {
      int& d = direction[static_cast<std::size_t>(i)];
      const int before = d;
      if (d == 0 && std::abs(shear[i]) > problem.limit[i] * (1 + 1e-12)) d = shear[i] > 0 ? 1 : -1;
      if (d != 0 && before != 0 && slip[i] * d <= 0) d = 0;
      changed = changed || d != before;
      if (d != 0) active.push_back(i);
    }
    if (!changed) {
      solution.stable = true;
      return solution;
    }
    const auto n_active = static_cast<Eigen::Index>(active.size());
    Eigen::VectorXd excess(n_active);
    Eigen::MatrixXd stiffness(n_active, n_active);
    // Times its length, an element's row is symmetric with the others up to their lengths.
    for (Eigen::Index k = 0; k < n_active; ++k) {
      const Eigen::Index i = active[static_cast<std::size_t>(k)];
      const double limit = direction[static_cast<std::size_t>(i)] * problem.limit[i];
      excess[k] = problem.length[i] * (problem.shear[i] - limit);
      for (Eigen::Index m = 0; m < n_active; ++m) {
        stiffness(k, m) =
            problem.length[i] * problem.stiffness(i, active[static_cast<std::size_t>(m)]);
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> symmetric(0.5 * (stiffness + stiffness.transpose()));
    if (symmetric.info() != Eigen::Success) return solution;
    const Eigen::VectorXd found = stiffness.partialPivLu().solve(excess);
    slip.setZero();
    for (Eigen::Index k = 0; k < excess.size(); ++k)
      slip[active[static_cast<std::size_t>(k)]] = found[k];
  }
  return solution;
}

/// The fault after a share of its pressure change.
SlippingFault after(const SlippingFault& fault, double share) {
  SlippingFault part = fault;
  part.reservoir.left_pressure_change *= share;
  part.reservoir.right_pressure_change *= share;
  part.fault_pressure_change *= share;
  return part;
}

}  // namespace

double boundary_element_onset(const SlippingFault& fault, const WeakeningOnset& weakening,
                              double element_height) {
  const double rate = (fault.friction_coefficient - weakening.dynamic_coefficient) /
                      fault.friction_coefficient / weakening.slip_weakening_distance;
  const auto is_stable = [&](double share) {
    SlipProblem problem = slip_problem(after(fault, share), element_height);
    problem.stiffness.diagonal() -= rate * problem.limit;
    const SlipSolution solution = solve_slip(problem);
    if (solution.stable) {
      const double slip = solution.slip.cwiseAbs().maxCoeff();
      FAULTSIM_DEMAND(slip < weakening.slip_weakening_distance, "slip ", slip, " m before onset");
    }
    return solution.stable;
  };
  if (is_stable(1)) return 1;
  double low = 0, high = 1;
  while (high - low > 1e-8) {
    const double middle = (low + high) / 2;
    (is_stable(middle) ? low : high) = middle;
  }
  return low;
}

SlipProfile boundary_element_slip(const SlippingFault& fault, double element_height) {
  const SlipProblem problem = slip_problem(fault, element_height);
  const Eigen::Index n = problem.y.size();
  const SlipSolution solution = solve_slip(problem);
  FAULTSIM_DEMAND(solution.stable, "boundary elements do not settle");
  const Eigen::VectorXd& slip = solution.slip;
  SlipProfile profile;
  for (Eigen::Index i = 0; i < n; ++i) {
    profile.y.push_back(problem.y[i]);
    profile.slip.push_back(slip[i]);
    profile.integral += std::abs(slip[i]) * problem.length[i];
    if (std::abs(slip[i]) > profile.max_slip) {
      profile.max_slip = std::abs(slip[i]);
      profile.max_slip_y = problem.y[i];
    }
  }
  return profile;
}

double frictional_crack_slip(double youngs_modulus, double poisson_ratio, double load, double angle,
                             double friction_coefficient, double half_length, double s) {
  const double drive =
      load * std::sin(angle) * (std::cos(angle) - std::sin(angle) * friction_coefficient);
  return 4 * (1 - poisson_ratio * poisson_ratio) / youngs_modulus * drive *
         std::sqrt(std::max(0.0, half_length * half_length - s * s));
}

double penny_crack_slip(double shear_modulus, double poisson_ratio, double stress_drop,
                        double radius, double r) {
  return 8 * (1 - poisson_ratio) / (pi * (2 - poisson_ratio)) * stress_drop / shear_modulus *
         std::sqrt(std::max(0.0, radius * radius - r * r));
}

double penny_crack_moment(double poisson_ratio, double stress_drop, double radius) {
  return 16 * (1 - poisson_ratio) / (3 * (2 - poisson_ratio)) * stress_drop * radius * radius *
         radius;
}

}  // namespace faultsim
