#include "simulator/coupled/held_responses.h"

#include <cmath>
#include <utility>

namespace faultsim {

void HeldResponses::add_nearest(const Eigen::VectorXd& load, Eigen::VectorXd& u,
                                Eigen::VectorXd& traction) const {
  for (const Response& one : kept_) {
    const double share = dot(one.load, load);
    u += share * one.u;
    traction += share * one.traction;
  }
}

void HeldResponses::keep(Response response) {
  constexpr std::size_t kMost = 8;
  constexpr double kNew = 1e-3;  // of a load
  if (kept_.size() == kMost) return;
  const double whole = std::sqrt(dot(response.load, response.load));
  for (const Response& one : kept_) {
    const double share = dot(one.load, response.load);
    response.load -= share * one.load;
    response.u -= share * one.u;
    response.traction -= share * one.traction;
  }
  const double rest = std::sqrt(dot(response.load, response.load));
  if (!(rest > kNew * whole)) return;
  response.load /= rest;
  response.u /= rest;
  response.traction /= rest;
  kept_.push_back(std::move(response));
}

}  // namespace faultsim
