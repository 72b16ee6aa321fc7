#include "campaign/answers/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where the points of a stage's curves lie, and which way they go.
struct Ticks {
  std::vector<double> at;
  bool falls = false;
};

/// From where on a fault of a row slides, on the way, which always goes up: as computed, for
/// certain, possibly, and possibly behind the end of its history.
struct Row {
  double computed = kNever, certain = kNever, possible = kNever, unknown = kNever;
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
    const auto [low, high] = std::ranges::minmax_element(one);
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
  const auto turn = std::ranges::find_if(way, [&](double p) { return p != way[0]; });
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

/// Behind this place the fault may have begun; steps are counted, not divided.
double place_before(const CaseOnsets::Onset& onset, CurveAxis axis, double sign) {
  if (axis == CurveAxis::step) return std::nextafter(onset.step, -kNever);
  if (axis == CurveAxis::time) return onset.began;
  if (std::isnan(onset.change_before)) return -kNever;
  // A pressure that came back within the step passed this place only behind it.
  return std::min(sign * onset.change_before, std::nextafter(sign * onset.change, -kNever));
}

/// A history that ends early says nothing of a fault at rest behind its end. Against pressure it
/// says nothing at all: how far the pressure was is another question for each region.
Row row_of(const CaseOnsets& one, std::int64_t fault, CurveAxis axis, double sign) {
  const auto found = std::ranges::find(one.onsets, fault, &CaseOnsets::Onset::fault);
  Row row;
  if (found != one.onsets.end()) {
    row.computed = row.certain = sign * place_of(*found, axis);
    row.possible = std::nextafter(place_before(*found, axis, sign), kNever);
  } else if (!one.complete()) {
    row.unknown = !one.rank_class || axis == CurveAxis::pressure
                      ? -kNever
                      : std::nextafter(axis == CurveAxis::step ? one.last_step : one.end, kNever);
  }
  const bool is_resolved = !contains(one.unresolved, fault);
  if (!is_resolved) row.certain = kNever, row.possible = -kNever;
  return row;
}

/// The rows of a fault, each kind of place in ascending order.
struct Onsets {
  std::vector<double> computed, certain, possible, unknown;
  void add(const Row& row, int count) {
    const auto n = static_cast<std::size_t>(count);
    computed.insert(computed.end(), n, row.computed);
    certain.insert(certain.end(), n, row.certain);
    possible.insert(possible.end(), n, row.possible);
    unknown.insert(unknown.end(), n, row.unknown);
  }
  void sort() {
    for (auto* places : {&computed, &certain, &possible, &unknown}) std::ranges::sort(*places);
  }
};

Curve curve_of(Onsets onsets, const Ticks& ticks, const Sampling& sampling, double confidence) {
  Curve curve;
  curve.falls = ticks.falls;
  onsets.sort();
  const auto count = [](const std::vector<double>& values, double at) {
    return static_cast<long>(std::ranges::upper_bound(values, at) - values.begin());
  };
  for (const double at : ticks.at) {
    const double place = ticks.falls ? -at : at;
    CurvePoint point{at, {}, {}};
    ShareCounts& c = point.counts;
    c.n = static_cast<long>(onsets.computed.size());
    c.n_yes = count(onsets.certain, place);
    c.n_undecided = count(onsets.possible, place) - c.n_yes;
    c.n_holds = count(onsets.computed, place);
    c.n_unknown = count(onsets.unknown, place);
    point.bounds = bounds_of(c, sampling, confidence);
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
  if (rows.n == 0)
    throw InputError("probability", "no case was selected", "select others with --where");
  const auto found =
      std::ranges::find_if(rows.cases, [](const CaseOnsets& one) { return one.complete(); });
  if (found == rows.cases.end())
    refuse_unrun("probability", "no case has a full history", campaign);
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
                  const Curves& curves) {
  Onsets onsets;
  const double sign = ticks.falls ? -1 : 1;
  for (std::size_t k = 0; k < rows.cases.size(); ++k)
    onsets.add(row_of(rows.cases[k], fault.id, curves.request.axis, sign), rows.counts[k]);
  Curve curve = curve_of(std::move(onsets), ticks, curves.sampling, curves.request.confidence);
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

/// The axis as a column.
AnswerColumn axis_column(CurveAxis axis) {
  switch (axis) {
    case CurveAxis::step:
      return {"step", "step", {}, 9, Need::always};
    case CurveAxis::time:
      return {"time_s", "time", shown_unit(Dimension::time), 4, Need::always};
    default:
      return {"pressure_change_pa", "Δp", shown_unit(Dimension::pressure), 6, Need::always};
  }
}

/// Every point in a row: for files.
AnswerTable long_table(const Curves& curves) {
  AnswerTable table{"curves",
                    "",
                    {{"fault", "fault"},
                     {"stage", "stage"},
                     axis_column(curves.request.axis),
                     {"estimate", "share", percent()},
                     {"low", "from", percent()},
                     {"high", "to", percent()},
                     {"holds", "true in"},
                     {"rows", "of"},
                     {"undecided", "undecided"},
                     {"unknown", "no full history"}}};
  table.on_screen = false;
  for (const Curve& curve : curves.curves) {
    for (const CurvePoint& point : curve.points) {
      const ShareCounts& c = point.counts;
      table.rows.push_back({curve.fault, curve.stage, point.at, c.estimate(), point.bounds.low,
                            point.bounds.high, c.n_holds, c.n, c.n_undecided, c.n_unknown});
    }
  }
  return table;
}

/// The curves of one stage side by side: for a screen.
AnswerTable stage_table(const Curves& curves, std::size_t from, std::size_t to) {
  const std::string& stage = curves.curves[from].stage;
  AnswerTable table{"stage " + stage,
                    stage.empty() ? "" : concat("in ", stage),
                    {axis_column(curves.request.axis)}};
  table.in_files = false;
  for (std::size_t c = from; c < to; ++c) {
    const std::string& fault = curves.curves[c].fault;
    for (const char* what : {"", " from", " to"})
      table.columns.push_back({fault + what, fault + what, percent(), 3, Need::wanted});
    table.columns.push_back({fault + " open", fault + " undecided, unknown", {}, 4, Need::extra});
  }
  for (std::size_t k = 0; k < curves.curves[from].points.size(); ++k) {
    std::vector<AnswerCell> row = {curves.curves[from].points[k].at};
    for (std::size_t c = from; c < to; ++c) {
      const CurvePoint& point = curves.curves[c].points[k];
      const long n_open = point.counts.n_undecided + point.counts.n_unknown;
      append(row, {point.counts.estimate(), point.bounds.low, point.bounds.high, n_open});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// "F2: 26.6 % (...) by the end".
std::string last_point(const Curves& curves) {
  const Curve* most = nullptr;
  for (const Curve& one : curves.curves) {
    if (one.points.empty()) continue;
    const bool is_more = most == nullptr || one.points.back().counts.estimate() >
                                                most->points.back().counts.estimate();
    if (is_more) most = &one;
  }
  if (most == nullptr) return "No load step was selected.";
  return concat(
      "Most often ", most->fault, most->stage.empty() ? "" : " in " + most->stage, ": ",
      share_sentence(most->points.back().counts, curves.sampling, curves.request.confidence),
      " by the last point.");
}

}  // namespace

Curves probability_curves(const Store& store, const CampaignInfo& campaign,
                          const CurveRequest& request) {
  const Selection selection = make_selection(store, campaign, request.stage, "");
  Curves found{
      campaign, request, sampling_of(store, campaign, {request.where, request.stage}), 0, {}};
  const bool each_stage = request.axis == CurveAxis::pressure && request.stage.empty();
  Store::TableQuery query = case_query(campaign, selection, request.where);
  if (each_stage) query.stage = any_stage(selection);
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
      found.curves.push_back(fault_curve(rows, fault, ticks, found));
      found.curves.back().stage = stage;
    }
  }
  return found;
}

namespace {

/// Faults against step or time; nothing against pressure, where each stage goes its own way.
std::optional<faultsim::figure::HistoryChart> chart_of(const Curves& curves) {
  if (curves.request.axis == CurveAxis::pressure || curves.curves.empty()) return std::nullopt;
  const AnswerColumn axis = axis_column(curves.request.axis);
  faultsim::figure::HistoryChart chart;
  chart.title = concat("How likely each fault has begun to slide: ", curves.campaign.name);
  if (!curves.sampling.is_random)
    chart.title = concat("In how many cases each fault has begun to slide: ", curves.campaign.name);
  chart.remark =
      concat("thin lines: ", curves.sampling.is_random
                                 ? concat("bounds of ", confidence_text(curves.request.confidence))
                                 : std::string("undecided cases counted as no and as yes"));
  chart.time_label = curves.request.axis == CurveAxis::time ? "time, years" : "load step";
  for (const CurvePoint& point : curves.curves.front().points)
    chart.time.push_back(point.at / axis.unit.size);
  constexpr double kPercent = 100;
  faultsim::figure::HistoryPanel panel{"share, %", {}, {}, {0, kPercent}, 240, 0.05};
  for (const Curve& curve : curves.curves) {
    faultsim::figure::Curve line{curve.fault, panel.curves.size(), {}};
    for (const CurvePoint& point : curve.points) {
      line.values.push_back(kPercent * point.counts.estimate());
      line.low.push_back(kPercent * point.bounds.low);
      line.high.push_back(kPercent * point.bounds.high);
    }
    panel.curves.push_back(std::move(line));
  }
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

Answer to_answer(const Curves& curves) {
  Answer answer;
  answer.headline = {last_point(curves)};
  const AnswerColumn axis = axis_column(curves.request.axis);
  answer.facts = {
      {"campaign", curves.campaign.name},        {"against", axis.key},
      {"confidence", curves.request.confidence}, {"is_probability", curves.sampling.is_random},
      {"remark", curves.sampling.remark},        {"rows", curves.n_rows}};
  answer.add(long_table(curves));
  if (auto chart = chart_of(curves)) answer.blocks.emplace_back(AnswerChart(std::move(*chart)));
  for (std::size_t from = 0; from < curves.curves.size();) {
    std::size_t to = from;
    while (to < curves.curves.size() && curves.curves[to].stage == curves.curves[from].stage) ++to;
    answer.add(stage_table(curves, from, to));
    from = to;
  }
  answer.note(concat(
      curves.sampling.is_random ? "Probability" : "Share of the cases",
      " that a fault has begun to slide by then",
      curves.request.axis == CurveAxis::pressure
          ? ", or by the time that the stage's pressure has changed this far"
          : "",
      ", of ", grouped(curves.n_rows),
      " cases. A fault that slides at the end of a load step began to "
      "slide somewhere within it: from counts it at the step's end, to at its beginning",
      curves.sampling.is_random ? concat(", and they contain each point with a confidence of ",
                                         confidence_text(curves.request.confidence))
                                : "",
      "; what the cells leave undecided, and a history that ends early, may be either."));
  answer.note_if(curves.sampling.remark);
  answer.note_if(curves.sampling.approximation);
  return answer;
}

}  // namespace faultsweep
