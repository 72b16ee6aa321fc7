#pragma once

#include <Eigen/Core>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/loads/initial_traction.h"
#include "simulator/loads/load_source.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Changes of the regional stress, as of plates or of a neighbour's production: uniform, like the
/// initial stress that they add to, whatever the rock. Δσ(t) is that of the stages at their ends,
/// linear within; the closed faults carry Δσ n more.
class RegionalStress final : public LoadSource {
 public:
  /// @pre both outlive this. Throws InputError where symmetry or plane strain removes a component
  /// that it has on a fault.
  RegionalStress(const Scene& scene, const FaultGeometry& faults) : scene_(scene), faults_(faults) {
    for (std::size_t s = 0; s < scene.stages.size(); ++s) {
      if (scene.stages[s].stress_change) require_carried(s);
    }
  }

  void add(double time, StepLoads& loads) const override {
    const Eigen::Matrix3d stress = change_at(time);
    if (stress.isZero(0)) return;
    for (const OperatorNode& node : faults_.nodes) {
      const Eigen::Vector3d local = local_traction(stress, node);
      for (std::size_t c = 0; c < 3; ++c)
        if (node.dof[c] >= 0) loads.locked[node.dof[c]] += local[static_cast<Eigen::Index>(c)];
    }
  }

 private:
  using Tensor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  Eigen::Matrix3d change_at(double time) const {
    Eigen::Matrix3d before = Eigen::Matrix3d::Zero();
    double start = 0;
    for (const Stage& stage : scene_.stages) {
      Eigen::Matrix3d after = before;
      if (stage.stress_change) after = Eigen::Map<const Tensor>(stage.stress_change->data());
      if (time < start + stage.duration)
        return before + (time - start) / stage.duration * (after - before);
      before = after;
      start += stage.duration;
    }
    return before;
  }

  void require_carried(std::size_t stage) const {
    const Eigen::Matrix3d stress =
        Eigen::Map<const Tensor>(scene_.stages[stage].stress_change->data());
    for (const OperatorNode& node : faults_.nodes) {
      const Eigen::Vector3d local = local_traction(stress, node);
      for (std::size_t c = 0; c < 3; ++c) {
        if (node.dof[c] >= 0 ||
            std::abs(local[static_cast<Eigen::Index>(c)]) <= 1e-9 * stress.norm())
          continue;
        throw InputError(
            "scene",
            {{concat("/stages/", stage, "/stress_change"), 0,
              "it has a shear component on a fault that symmetry or plane strain removes",
              "align it with the axes, or switch the reduction off (/numerics/half_domain, "
              "/numerics/plane_strain)"}});
      }
    }
  }

  const Scene& scene_;
  const FaultGeometry& faults_;
};

}  // namespace faultsim
