#pragma once

#include <memory>

#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// How the pillars of the body between lines lean, and where its faults are at a height, as the
/// builder of bodies will have them: along the faults, and between as smooth as can be.
class ModelPillars {
 public:
  /// Of lines that do not fit together pillars are vertical: no body is built of them.
  /// @param lines  must outlive it.
  explicit ModelPillars(const ModelLines& lines);
  ~ModelPillars();
  ModelPillars(const ModelPillars&) = delete;
  ModelPillars& operator=(const ModelPillars&) = delete;

  /// Where the pillar through a point is at another height, m.
  Eigen::Vector2d at(const Eigen::Vector3d& point, double z) const;
  /// The line of a fault of the model at a height, m. Between the points of a trace that bends, and
  /// where dips change, it is not that of ModelFault::at, which moves the points of the trace only.
  Polyline fault_line(std::size_t fault, double z) const;

 private:
  struct Body;
  const ModelLines& lines_;
  std::unique_ptr<const Body> body_;
};

}  // namespace faultsim::grid_scene
