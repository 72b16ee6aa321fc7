#include "campaign/answers/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using faultsim::StepResult;
using nlohmann::json;

namespace {

constexpr double kYearOfCurves = 31557600;  // s, 365.25 d
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where the points of a stage's curves lie, and which way they go.
struct Ticks {
  std::vector<double> at;
  bool falls = false;
};

/// What a row says of a fault: from where on it slides, and from where on that is not known.
struct Row {
  double from = kNever, unknown_from = kNever;  ///< signed: the way always goes up.
};

/// Of the region that changes most within the stage, at the steps; the first value is that before.
std::vector<double> pressure_way(const std::vector<StepResult>& steps, const std::string& stage) {
  std::vector<double> way;
  double widest = -1;
  for (std::size_t region = 0; region < steps.front().pressure_change.size(); ++region) {
    std::vector<double> one;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (!stage.empty() && steps[k].stage != stage) continue;
      if (one.empty() && k > 0) one.push_back(steps[k - 1].pressure_change[region]);
      one.push_back(steps[k].pressure_change[region]);
    }
    if (one.empty()) continue;
    const auto [low, high] = std::minmax_element(one.begin(), one.end());
    if (*high - *low > widest) widest = *high - *low, way = one;
  }
  return way;
}

/// 1, 2 or 5 times a power of ten: at most 25 of them in the width.
double even_distance(double width) {
  constexpr double kMostTicks = 25;
  const double least = std::max(width / kMostTicks, 1.0);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - 1e-12)) return factor * power;
  return 10 * power;
}

/// Even values that span the way and the onsets, the way's beginning first.
Ticks pressure_ticks(const std::vector<double>& way, const std::vector<double>& onsets) {
  Ticks ticks;
  const auto turn = std::find_if(way.begin(), way.end(), [&](double p) { return p != way[0]; });
  ticks.falls = turn != way.end() && *turn < way[0];
  const double sign = ticks.falls ? -1 : 1;
  double from = sign * way[0], to = from;
  for (const double p : way) to = std::max(to, sign * p);
  for (const double p : onsets) from = std::min(from, sign * p), to = std::max(to, sign * p);
  const double distance = even_distance(to - from);
  const double first = std::floor(from / distance), last = std::ceil(to / distance);
  for (double k = first; k <= last; ++k) ticks.at.push_back(sign * k * distance + 0.0);
  return ticks;
}

Ticks step_ticks(const std::vector<StepResult>& steps, const std::string& stage, CurveAxis axis) {
  Ticks ticks;
  for (const StepResult& one : steps) {
    if (!stage.empty() && one.stage != stage) continue;
    ticks.at.push_back(axis == CurveAxis::step ? one.step : one.time);
  }
  return ticks;
}

double place_of(const CaseOnsets::Onset& onset, CurveAxis axis) {
  if (axis == CurveAxis::step) return onset.step;
  return axis == CurveAxis::time ? onset.time : onset.change;
}

/// A history that ends early says nothing of a fault at rest behind its end. Against pressure it
/// says nothing at all: how far the pressure was is another question for each region.
Row row_of(const CaseOnsets& one, const CaseOnsets::Onset* onset, CurveAxis axis, double sign) {
  if (onset != nullptr) return {sign * place_of(*onset, axis), kNever};
  if (one.complete()) return {};
  if (!one.rank_class || axis == CurveAxis::pressure) return {kNever, -kNever};
  return {kNever, std::nextafter(axis == CurveAxis::step ? one.last_step : one.end, kNever)};
}

Curve curve_of(std::vector<double> from, std::vector<double> unknown_from, const Ticks& ticks,
               double confidence) {
  Curve curve;
  curve.falls = ticks.falls;
  std::sort(from.begin(), from.end());
  std::sort(unknown_from.begin(), unknown_from.end());
  const auto n = static_cast<long>(from.size());
  const auto count = [](const std::vector<double>& values, double at) {
    return std::upper_bound(values.begin(), values.end(), at) - values.begin();
  };
  for (const double at : ticks.at) {
    const double place = ticks.falls ? -at : at;
    CurvePoint point{at, count(from, place), count(unknown_from, place), 0, {}};
    point.estimate = static_cast<double>(point.n_holds) / static_cast<double>(n - point.n_unknown);
    point.bounds = proportion_bounds(point.n_holds, point.n_unknown, n, confidence);
    curve.points.push_back(point);
  }
  return curve;
}

/// The cases of a stage, each as often as it is a row of the sample.
struct StageRows {
  std::vector<CaseOnsets> cases;
  std::vector<int> counts;
  long n = 0;
};

StageRows read_stage(const Store& store, const CampaignInfo& campaign,
                     const Store::TableQuery& query) {
  StageRows rows;
  const SampleRows sample(store, campaign);
  store.for_each_onset(campaign.id, query, [&](const CaseOnsets& one) {
    const int count = sample.count(one.position);
    if (count == 0) return;
    rows.cases.push_back(one);
    rows.counts.push_back(count);
    rows.n += count;
  });
  return rows;
}

/// The first history to its end: its steps are the axis.
std::vector<StepResult> reference_steps(const Store& store, const CampaignInfo& campaign,
                                        const StageRows& rows) {
  if (rows.n == 0) {
    throw InputError("probability",
                     {{"", 0, "no case was selected", "ask for others with --where"}});
  }
  const auto found = std::find_if(rows.cases.begin(), rows.cases.end(),
                                  [](const CaseOnsets& one) { return one.complete(); });
  if (found == rows.cases.end()) {
    throw InputError("probability", {{"", 0, "no case has a history to its end",
                                      concat("run it: faultsweep run ", campaign.name)}});
  }
  return store.stored_case(campaign.id, std::to_string(found->position)).result.steps;
}

/// The stages of a history, in its order.
std::vector<std::string> stages_of(const std::vector<StepResult>& steps) {
  std::vector<std::string> stages;
  for (const StepResult& one : steps) {
    if (one.step > 0 && (stages.empty() || stages.back() != one.stage)) stages.push_back(one.stage);
  }
  return stages;
}

/// A stage that has metrics, as all are read anyway; "" = there is none.
std::string any_stage(const Selection& selection) {
  for (const NamedId& one : selection.stages)
    if (!one.name.empty()) return one.name;
  return "";
}

Curve fault_curve(const StageRows& rows, const NamedId& fault, const Ticks& ticks,
                  const CurveRequest& request) {
  std::vector<double> from, unknown_from;
  for (std::size_t k = 0; k < rows.cases.size(); ++k) {
    const std::vector<CaseOnsets::Onset>& onsets = rows.cases[k].onsets;
    const auto found = std::find_if(onsets.begin(), onsets.end(),
                                    [&](const auto& one) { return one.fault == fault.id; });
    const Row row = row_of(rows.cases[k], found == onsets.end() ? nullptr : &*found, request.axis,
                           ticks.falls ? -1 : 1);
    from.insert(from.end(), static_cast<std::size_t>(rows.counts[k]), row.from);
    unknown_from.insert(unknown_from.end(), static_cast<std::size_t>(rows.counts[k]),
                        row.unknown_from);
  }
  Curve curve = curve_of(std::move(from), std::move(unknown_from), ticks, request.confidence);
  curve.fault = fault.name;
  return curve;
}

Ticks ticks_of(const std::vector<StepResult>& steps, const std::string& stage,
               const StageRows& rows, CurveAxis axis) {
  if (axis != CurveAxis::pressure) return step_ticks(steps, stage, axis);
  std::vector<double> onsets;
  for (const CaseOnsets& one : rows.cases)
    for (const CaseOnsets::Onset& onset : one.onsets) onsets.push_back(onset.change);
  const std::vector<double> way = pressure_way(steps, stage);
  return way.empty() ? Ticks{} : pressure_ticks(way, onsets);
}

}  // namespace

Curves probability_curves(const Store& store, const CampaignInfo& campaign,
                          const CurveRequest& request) {
  const Selection selection = make_selection(store, campaign, request.stage, "");
  Curves found{campaign, request, sampling_of(store, campaign), 0, {}};
  const bool each_stage = request.axis == CurveAxis::pressure && request.stage.empty();
  Store::TableQuery query;
  query.where = parse_condition(request.where, campaign, selection);
  query.stage = each_stage ? any_stage(selection) : request.stage;
  const std::string read_first = query.stage;
  const StageRows first = read_stage(store, campaign, query);
  found.n_rows = first.n;
  const std::vector<StepResult> steps = reference_steps(store, campaign, first);
  for (const std::string& stage : each_stage ? stages_of(steps) : std::vector{request.stage}) {
    query.stage = stage;
    const StageRows others = stage == read_first ? StageRows{} : read_stage(store, campaign, query);
    const StageRows& rows = stage == read_first ? first : others;
    const Ticks ticks = ticks_of(steps, stage, rows, request.axis);
    for (const NamedId& fault : selection.faults) {
      found.curves.push_back(fault_curve(rows, fault, ticks, request));
      found.curves.back().stage = stage;
    }
  }
  return found;
}

namespace {

std::string column_of(CurveAxis axis) {
  if (axis == CurveAxis::step) return "step";
  return axis == CurveAxis::time ? "time_s" : "pressure_change_pa";
}

std::string percent_of(double share) {
  return std::isfinite(share) ? format_number(100 * share, 3) : "not known";
}

std::string place_text(double at, CurveAxis axis) {
  if (axis == CurveAxis::time) return format_number(at / kYearOfCurves);
  return axis == CurveAxis::pressure ? format_number(at / kBar, 6) : format_number(at, 9);
}

/// The curves of one stage side by side.
std::string stage_to_text(const Curves& curves, std::size_t from, std::size_t to) {
  const CurveAxis axis = curves.request.axis;
  std::vector<std::string> header = {axis == CurveAxis::step   ? "step"
                                     : axis == CurveAxis::time ? "time/a"
                                                               : "change/bar"};
  bool any_unknown = false;
  for (std::size_t c = from; c < to; ++c) {
    const Curve& curve = curves.curves[c];
    header.insert(header.end(), {curve.fault + "/%", "from", "to"});
    for (const CurvePoint& point : curve.points) any_unknown |= point.n_unknown > 0;
    if (any_unknown) header.emplace_back("not known");
  }
  TextTable table(header);
  for (std::size_t k = 0; k < curves.curves[from].points.size(); ++k) {
    std::vector<std::string> row = {place_text(curves.curves[from].points[k].at, axis)};
    for (std::size_t c = from; c < to; ++c) {
      const CurvePoint& point = curves.curves[c].points[k];
      row.insert(row.end(), {percent_of(point.estimate), percent_of(point.bounds.low),
                             percent_of(point.bounds.high)});
      if (row.size() < header.size() && header[row.size()] == "not known")
        row.push_back(point.n_unknown > 0 ? std::to_string(point.n_unknown) : "");
    }
    table.add_row(row);
  }
  const std::string& stage = curves.curves[from].stage;
  return concat(stage.empty() ? "" : concat("in ", stage, "\n"), table.text(), "\n");
}

}  // namespace

std::string curves_to_text(const Curves& curves) {
  const std::string what = curves.sampling.is_random ? "Probability" : "Share";
  std::string text = concat(what, " that a fault has begun to slide by then",
                            curves.request.axis == CurveAxis::pressure
                                ? ",\nor by the time that the stage's pressure has come so far"
                                : "",
                            ".\n\n");
  for (std::size_t from = 0; from < curves.curves.size();) {
    std::size_t to = from;
    while (to < curves.curves.size() && curves.curves[to].stage == curves.curves[from].stage) ++to;
    text += stage_to_text(curves, from, to);
    from = to;
  }
  text += concat(curves.n_rows, " cases. Bounds hold each point with a confidence of ",
                 format_number(100 * curves.request.confidence, 4),
                 " %;\na history that ends early may go on either way. A fault that slides at the "
                 "end of a load "
                 "step\nbegan somewhere within it.\n");
  if (!curves.sampling.remark.empty()) text += curves.sampling.remark + "\n";
  return text;
}

std::string curves_to_csv(const Curves& curves) {
  std::string text = concat("fault,stage,", column_of(curves.request.axis),
                            ",estimate,low,high,holds,rows,unknown\n");
  for (const Curve& curve : curves.curves) {
    for (const CurvePoint& point : curve.points) {
      text += concat(csv_name(curve.fault), ",", csv_name(curve.stage), ",", exact_number(point.at),
                     ",", std::isfinite(point.estimate) ? exact_number(point.estimate) : "", ",",
                     exact_number(point.bounds.low), ",", exact_number(point.bounds.high), ",",
                     point.n_holds, ",", curves.n_rows, ",", point.n_unknown, "\n");
    }
  }
  return text;
}

json curves_to_json(const Curves& curves) {
  json list = json::array();
  for (const Curve& curve : curves.curves) {
    json points = json::array();
    for (const CurvePoint& point : curve.points) {
      points.push_back({{column_of(curves.request.axis), point.at},
                        {"estimate", std::isfinite(point.estimate) ? json(point.estimate) : json()},
                        {"low", point.bounds.low},
                        {"high", point.bounds.high},
                        {"holds", point.n_holds},
                        {"unknown", point.n_unknown}});
    }
    list.push_back({{"fault", curve.fault}, {"stage", curve.stage}, {"points", points}});
  }
  return {{"campaign", curves.campaign.name},
          {"against", column_of(curves.request.axis)},
          {"confidence", curves.request.confidence},
          {"is_probability", curves.sampling.is_random},
          {"remark", curves.sampling.remark},
          {"rows", curves.n_rows},
          {"curves", list}};
}

}  // namespace faultsweep
