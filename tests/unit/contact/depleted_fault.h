#pragma once

#include <cmath>
#include <vector>

#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {

/// A case of many steps, made up but with the features of a real one.
struct DepletedFault {
  FaultOperator op;
  ContactLaws laws;
  std::vector<Eigen::VectorXd> locked;  ///< step 0 first.
};

/// A vertical fault in a displaced reservoir: depletion makes shear peaks at the corners of the two
/// compartments; 25 steps of production, cushion gas and storage cycles.
inline DepletedFault depleted_fault(int n_nodes, int n_shear, bool weakening) {
  const Eigen::VectorXd area = Eigen::VectorXd::Constant(n_nodes, 10);
  DepletedFault fault{make_operator(n_nodes, n_shear, area), {}, {}};
  set_h(fault.op, half_space_matrix(fault.op, 6e9, 0.1));
  // Weakening stays slow enough to be stable.
  const double dynamic = std::atan(weakening ? 0.5 : 0.6);
  fault.laws = same_law(fault.op, {WeakeningLaw::coefficient, 0, std::atan(0.6), dynamic, 10.0});
  const int stride = 1 + n_shear;
  const double centre = 0.5 * n_nodes;
  const auto locked = [&](double depletion) {
    Eigen::VectorXd t(fault.op.geometry.n_dofs);
    for (int k = 0; k < n_nodes; ++k) {
      const double y = (k - centre) / (0.5 * n_nodes) * 400 + 0.37;  // off the corners
      const double normal = -22e6 - 12e3 * (y + 400) * 0.5;
      // Corners at ±75 and ±225 m; log peaks of the inclusion's shear, and compression inside.
      const double peaks = std::log(std::abs((y - 75) * (y + 75) / ((y - 225) * (y + 225))));
      const double inside = std::abs(y) < 225 ? 1.0 : 0.0;
      t[k * stride] = normal + depletion * (-1.5e6 * inside + 0.2e6 * peaks);
      if (n_shear == 2) t[k * stride + 1] = 1e6 * depletion * inside;
      t[k * stride + n_shear] = 4e6 - depletion * 2.0e6 * peaks;
    }
    return t;
  };
  fault.locked.push_back(locked(0));
  for (int i = 1; i <= 10; ++i) fault.locked.push_back(locked(0.4 * i));     // to 4
  for (int i = 1; i <= 5; ++i) fault.locked.push_back(locked(4 - 0.5 * i));  // to 1.5
  for (const double d : {0.5, -0.5, -1.5, -0.5, 0.5, 1.5, 0.0, -1.5, 1.5}) {
    fault.locked.push_back(locked(d));
  }
  return fault;
}

}  // namespace faultsim
