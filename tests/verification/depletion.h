#pragma once

#include "simulator/elasticity/bulk_problem.h"

namespace faultsim::test {

/// Rollers all round but on the top, and one load: b Δp = 1 Pa in region 0.
inline void deplete(BulkProblem& problem) {
  for (const Side side : {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min}) {
    std::array<bool, 3> held = {false, false, false};
    held[static_cast<std::size_t>(side) / 2] = true;
    problem.conditions.push_back(
        {side, held, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1});
  }
  LoadCase load;
  load.key = {LoadKey::Kind::pressure, 0, 0};
  load.region = 0;
  problem.loads = {load};
}

}  // namespace faultsim::test
