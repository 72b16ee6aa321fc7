#pragma once

#include <Eigen/Core>

namespace faultsim {

/// The locked effective traction t_L of a load step, n_dofs, Pa: linear in the load factor λ from
/// `before` (λ = 0) to `after` (λ = 1). Refers to both.
struct LoadPath {
  const Eigen::VectorXd& before;
  const Eigen::VectorXd& after;

  Eigen::VectorXd at(double factor) const {
    return factor == 1 ? after : before + factor * (after - before);
  }
  /// From one load factor to another; an expression in both vectors.
  auto change(double from, double to) const { return (to - from) * (after - before); }
};

}  // namespace faultsim
