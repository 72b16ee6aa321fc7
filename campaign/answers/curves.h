#pragma once

#include <string>
#include <vector>

#include "campaign/answers/shares.h"
#include "campaign/render/answer.h"

namespace faultsweep {

/// What the probability of sliding is drawn against.
enum class CurveAxis {
  step,      ///< number of the load step.
  time,      ///< s, on the clock of the load history.
  pressure,  ///< Pa, change Δp since the start, on the side of the fault that changed more.
};

struct CurveRequest {
  CurveAxis axis = CurveAxis::step;
  std::string where = {};  ///< of which cases; "" = all.
  std::string stage = {};  ///< slip since its start; "" = since the start. Pressure: each stage.
  double confidence = 0.95;
};

/// How often a fault has begun to slide by then. A fault that slides at the end of a load step
/// began somewhere within it: by a place inside of the step it has for certain only if it had
/// before.
struct CurvePoint {
  double at = 0;       ///< on the axis.
  ShareCounts counts;  ///< as computed, onsets are at ends of steps. Undecided are those that are
                       ///< within their step, or of which the cells do not resolve that they slide.
  Interval bounds;     ///< see bounds_of.
};

struct Curve {
  std::string fault, stage;  ///< stage "" = the whole history.
  bool falls = false;        ///< against a pressure that falls: the points go down.
  std::vector<CurvePoint> points;
};

struct Curves {
  CampaignInfo campaign;
  CurveRequest request;
  Sampling sampling;
  long n_rows = 0;
  std::vector<Curve> curves;
};

/// P(fault has begun to slide by then) of each fault, at each load step, at the times of the load
/// steps, or on the way of a stage's pressure, from the onsets that the store keeps for each case:
/// 10^5 cases take about half a second.
///
/// Steps, times and the way of the pressure are those of the first full history. Against pressure a
/// case counts from the pressure at which its fault began to slide, in the direction in which the
/// stage's pressure first goes away from where it was; a case whose pressure does not go as far and
/// whose fault rests is one that does not slide. Bounds hold for each point, not for the curve.
/// Throws InputError where no case was selected, or none has a full history.
Curves probability_curves(const Store& store, const CampaignInfo& campaign,
                          const CurveRequest& request);

/// Table `curves`: a row for each point; on the screen a table for each stage, faults side by side.
Answer to_answer(const Curves& curves);

}  // namespace faultsweep
