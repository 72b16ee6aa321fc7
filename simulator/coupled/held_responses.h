#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/coupled/ranks.h"

namespace faultsim {

/// How a body moves while its faults rest: what the load steps before say of the next one. The
/// response is linear then, and loads of a history have few shapes (a pressure per compartment), so
/// that after as many steps a further one is known before it is solved. Kept over orthonormal
/// loads; dots are added up in the order of the ranks, so that all have the same bits.
class HeldResponses {
 public:
  struct Response {
    Eigen::VectorXd load;      ///< own rows of the forces that are put on, N,
    Eigen::VectorXd u;         ///< of the displacements that they cause, m,
    Eigen::VectorXd traction;  ///< and the change of t' over all fault dofs, Pa.
  };

  /// @pre ranks outlive it.
  explicit HeldResponses(const Ranks& ranks) : ranks_(ranks) {}

  /// Adds the response to that part of `load` which is a combination of those kept. Collective.
  void add_nearest(const Eigen::VectorXd& load, Eigen::VectorXd& u,
                   Eigen::VectorXd& traction) const;
  /// Keeps what is new in a response, unless that is a small part of it: what is left of two that
  /// are nearly the same is their errors. Collective.
  void keep(Response response);

 private:
  double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return ranks_.sum(a.dot(b));
  }

  const Ranks& ranks_;
  std::vector<Response> kept_;
};

}  // namespace faultsim
