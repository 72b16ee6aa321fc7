#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulator/common/units.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// A load step: when it ends, and of which stage it is.
struct StepEnd {
  std::size_t stage = 0;  ///< index into Scene::stages.
  double time = 0;        ///< s, since the start of the history.
  double length = 0;      ///< s, of the step; of equal steps exactly duration / n_steps.
  bool added = false;     ///< ends at a turning point, not where the stage divides its time.
};

/// Where a load turns from falling to rising or back: a local extreme of its history; or a report
/// of a flow result, which turns somewhere.
struct TurningPoint {
  std::string load;  ///< "the pressure of west", "the table of boundary 2".
  double from = 0;   ///< s; the extreme is held from here
  double to = 0;     ///< to here; equal for a peak.
  double value = 0;  ///< Pa, or a factor.
  Dimension dimension = Dimension::pressure;  ///< of value; of factors of tables: number.
  bool is_report = false;                     ///< has no value.
};

/// A turning point nearer to a step than this share of the step that it lies in is met by it: dates
/// miss the years of stages by a day. What is missed is at most that share of the step's change.
inline constexpr double kMetShare = 0.01;

/// The turning points within the stages of everything that acts: reports of a flow result,
/// histories of regions after scale and lag, tables of prescribed fault pressures and of
/// boundaries. In order of `from`.
std::vector<TurningPoint> turning_points(const Scene& scene);

/// When the last stage ends, s.
double end_time(const Scene& scene);

/// All load steps after step 0, in order of time: each stage's equal steps, cut at the turning
/// points that they do not meet (unless /numerics/turning_points is "report"). A plateau is met by
/// any step within it, else cut where it begins.
std::vector<StepEnd> step_ends(const Scene& scene);

/// The turning points that no step meets: empty unless /numerics/turning_points is "report".
std::vector<TurningPoint> skipped_turning_points(const Scene& scene);

/// "the pressure of west reaches -118 bar at 3.25 year".
std::string turning_point_text(const TurningPoint& point);

}  // namespace faultsim
