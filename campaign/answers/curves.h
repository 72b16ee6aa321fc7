#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/statistics/intervals.h"

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

/// How often a fault has begun to slide by then.
struct CurvePoint {
  double at = 0;        ///< on the axis.
  long n_holds = 0;     ///< rows whose fault has.
  long n_unknown = 0;   ///< rows whose history ends before, with the fault at rest.
  double estimate = 0;  ///< of those known; NaN where none is.
  Interval bounds;      ///< Clopper & Pearson's; unknown rows may be either.
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
/// Onsets are those at ends of load steps: a fault began somewhere within the step.
///
/// Steps, times and the way of the pressure are those of the first full history. Against pressure a
/// case counts from the pressure at which its fault began to slide, in the direction in which the
/// stage's pressure first goes away from where it was; a case whose pressure does not go as far and
/// whose fault rests is one that does not slide. Bounds hold for each point, not for the curve.
/// Throws InputError where no case was selected, or none has a full history.
Curves probability_curves(const Store& store, const CampaignInfo& campaign,
                          const CurveRequest& request);

std::string curves_to_text(const Curves& curves);
/// Columns: fault, stage, step or time_s or pressure_change_pa, ...; a row for each point.
std::string curves_to_csv(const Curves& curves);
nlohmann::json curves_to_json(const Curves& curves);

}  // namespace faultsweep
