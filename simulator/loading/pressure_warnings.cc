#include "simulator/loading/pressure_warnings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "simulator/common/errors.h"
#include "simulator/loads/history.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/initial_state.h"

namespace faultsim {
namespace {

constexpr double kRounding = 1;  // Pa: "back to the initial pressure" is written in decimal units

std::string bar(double pascal) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f bar", pascal / 1e5);
  return text;
}
std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f m", value);
  return text;
}

/// The highest pressure change over the load steps, and when.
struct Peak {
  double change = 0;  ///< Pa.
  const LoadStep* step = nullptr;
  void see(double value, const LoadStep& when) {
    if (step != nullptr && value <= change) return;
    change = value;
    step = &when;
  }
};

/// Least compressive principal total stress of the initial state, as a pressure, Pa.
double least_stress(const Scene& scene, double depth, DepthSide side) {
  const StressAtDepth at = initial_state(scene, -depth, side);
  const Eigen::Matrix3d sigma =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at.sigma.data());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sigma, Eigen::EigenvaluesOnly);
  return -solver.eigenvalues()[2];
}

DepthInterval depths_of_region(const Scene& scene, std::size_t region) {
  if (scene.geometry_kind == GeometryKind::field) {
    return reservoir_range(scene.field, scene.field.blocks[region]);
  }
  const PressureRegion& box = scene.box.regions[region];
  const bool disc = box.shape == RegionShape::disc;
  const double top = disc ? box.center[2] + 0.5 * box.thickness : box.to[2];
  const double bottom = disc ? box.center[2] - 0.5 * box.thickness : box.from[2];
  return {-std::min(top, scene.box.to[2]), -std::max(bottom, scene.box.from[2])};
}

/// Where a prescribed pressure acts: its window, or the regions beside the fault of a field; of a
/// box without a window all regions.
DepthInterval depths_of_fault(const Scene& scene, std::size_t fault) {
  const FaultPressure& law = scene.faults[fault].pressure;
  if (law.depth_window) return {(*law.depth_window)[0], (*law.depth_window)[1]};
  std::vector<std::size_t> regions;
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  for (std::size_t r = 0; r < scene.pressure.size(); ++r) {
    if (!is_field || r == fault || r + 1 == fault) regions.push_back(r);
  }
  if (regions.empty()) return {0, 0};
  DepthInterval all = depths_of_region(scene, regions.front());
  for (const std::size_t r : regions) {
    all.unite(depths_of_region(scene, r));
  }
  return all;
}

class PressureWarnings {
 public:
  explicit PressureWarnings(const Scene& scene) : scene_(scene), steps_(load_steps(scene)) {}

  std::vector<std::string> all() {
    std::vector<Peak> regions(scene_.pressure.size());
    for (const LoadStep& step : steps_) {
      const std::vector<double> changes = pressure_changes(scene_, step.time);
      for (std::size_t r = 0; r < changes.size(); ++r) regions[r].see(changes[r], step);
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const DepthInterval depths = depths_of_region(scene_, r);
      const auto initial = [&](double depth) { return initial_region_pressure(scene_, r, depth); };
      judge("the pressure of " + scene_.pressure[r].region, regions[r], depths, initial);
    }
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) prescribed(f);
    return std::move(texts_);
  }

 private:
  void prescribed(std::size_t fault) {
    const FaultPressure& law = scene_.faults[fault].pressure;
    if (law.rule != FaultPressureRule::prescribed) return;
    Peak peak;
    for (const LoadStep& step : steps_)
      peak.see(prescribed_pressure_change(scene_, law, step.time), step);
    const DepthInterval depths = depths_of_fault(scene_, fault);
    const auto initial = [&](double depth) {
      return initial_state(scene_, -depth, side_of(depth, depths)).pressure;
    };
    judge("the prescribed pressure of fault " + scene_.faults[fault].name, peak, depths, initial);
  }

  static DepthSide side_of(double depth, const DepthInterval& range) {
    return depth == range.top ? DepthSide::below : DepthSide::above;
  }

  template <typename Initial>
  void judge(const std::string& of, const Peak& peak, const DepthInterval& depths,
             const Initial& initial) {
    if (peak.step == nullptr || peak.change <= kRounding) return;
    const std::string when = concat("load step ", peak.step->step, " (", peak.step->stage, ")");
    texts_.push_back(
        concat(of, " rises to ", bar(peak.change), " above the initial one in ", when));
    double worst = 0, place = 0, strength = 0;
    for (const double depth : {depths.top, depths.bottom}) {
      const double least = least_stress(scene_, depth, side_of(depth, depths));
      const double excess = initial(depth) + peak.change - least;
      if (excess <= worst) continue;
      worst = excess;
      place = depth;
      strength = least;
    }
    if (worst <= kRounding) return;
    texts_.push_back(concat(of, " reaches ", bar(initial(place) + peak.change), " at ",
                            metres(place), " depth in ", when,
                            ", above the least total principal stress of ", bar(strength),
                            " there before production: rock would fracture, which is not "
                            "modelled"));
  }

  const Scene& scene_;
  std::vector<LoadStep> steps_;
  std::vector<std::string> texts_;
};

}  // namespace

std::vector<std::string> pressure_warnings(const Scene& scene) {
  return PressureWarnings(scene).all();
}

}  // namespace faultsim
