#include <algorithm>
#include <cmath>

#include "campaign/answers/sheet_parts.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"

namespace faultsweep {

namespace {

/// Where in a row's columns stands what.
constexpr std::size_t kVerdict = 0, kAbsolute = 1, kChange = 2, kDepth = 3, kPressures = 4;

/// p0 at the datum of the region whose pressure is given where the fault slides: absolute there,
/// less the change, referred to the datum along the fluid's gradient. Where no region touches the
/// place, that of the fluid in the fault.
double onset_start(const CaseRow& row, const CaseStart& start, double datum) {
  const double absolute = number_of(row.metrics[kAbsolute]);
  if (std::isnan(absolute)) return start.is_read ? start.at.pressure : kNotKnown;
  return absolute - number_of(row.metrics[kChange]) -
         start.gradient * (number_of(row.metrics[kDepth]) - datum);
}

StageRow stage_row(const CaseRow& row, const SheetSource& source, const FaultOfSheet& fault,
                   const VerdictColumns& verdicts) {
  StageRow one;
  one.position = row.position;
  one.count = source.sample.count(row.position);
  one.is_complete = row.complete();
  one.slides = verdicts.held(row, 0, kVerdict);
  const CaseStart& start = fault.starts.at(static_cast<std::size_t>(row.position - 1));
  one.onset_p0 = onset_start(row, start, fault.datum);
  for (std::size_t r = 0; r < fault.regions.size(); ++r) {
    one.change.push_back({number_of(row.metrics[kPressures + 2 * r]),
                          number_of(row.metrics[kPressures + 2 * r + 1])});
  }
  return one;
}

StageSliding::Moment moment_of(const StageRow& row) {
  const CaseOnsets::Onset& onset = *row.onset;
  return {row.position, onset.began, onset.time, row.onset_p0 + onset.change_before,
          row.onset_p0 + onset.change};
}

}  // namespace

void CaseRange::add(double value) {
  if (std::isnan(value)) return;
  low = is_known() ? std::min(low, value) : value;
  high = std::isnan(high) ? value : std::max(high, value);
}

std::vector<std::string> stages_of_sheet(const SheetSource& source) {
  std::vector<std::string> stages;
  for (const faultsim::StepResult& step : source.steps)
    if (step.step > 0 && !contains(stages, step.stage)) stages.push_back(step.stage);
  if (!source.steps.empty()) return stages;
  for (const NamedId& one : source.selection.stages)
    if (!one.name.empty()) stages.push_back(one.name);
  return stages;
}

std::vector<StageRow> read_stage_rows(const SheetSource& source, const FaultOfSheet& fault,
                                      const std::string& stage) {
  Selection selection = make_selection(source.store, source.campaign, stage, fault.id.name);
  const VerdictColumns verdicts(source.store, source.campaign, selection, {"slides"});
  Store::TableQuery query = case_query(source.campaign, selection, "");
  query.columns = verdicts.columns();
  for (const char* metric :
       {"activation_pressure_absolute", "activation_pressure_change", "activation_depth"})
    query.columns.push_back({metric_sql(metric, true), {}});
  for (const std::size_t region : fault.regions)
    for (const bool largest : {false, true})
      query.columns.push_back({stage_pressure_sql(region, largest), {}});
  std::vector<StageRow> rows;
  source.store.for_each_case(source.campaign.id, query, [&](const CaseRow& row) {
    rows.push_back(stage_row(row, source, fault, verdicts));
  });
  source.store.for_each_onset(source.campaign.id, query, [&](const CaseOnsets& one) {
    const auto found = std::ranges::find(one.onsets, fault.id.id, &CaseOnsets::Onset::fault);
    if (found == one.onsets.end()) return;
    const auto row = std::ranges::lower_bound(rows, one.position, {}, &StageRow::position);
    row->onset = *found;
  });
  return rows;
}

StageSliding sliding_in(const SheetSource& source, const FaultOfSheet&, const std::string& stage,
                        const std::vector<StageRow>& rows) {
  StageSliding found;
  found.stage = stage;
  std::vector<const StageRow*> sliding;
  for (const StageRow& row : rows) {
    for (int k = 0; k < row.count; ++k) found.counts.add(row.slides);
    if (row.onset) sliding.push_back(&row);
  }
  found.bounds = bounds_of(found.counts, source.sampling, source.request.confidence);
  if (sliding.empty()) return found;
  std::ranges::stable_sort(sliding, {}, [](const StageRow* row) { return row->onset->time; });
  found.first = moment_of(*sliding.front());
  found.half = moment_of(*sliding[(sliding.size() - 1) / 2]);
  found.last = moment_of(*sliding.back());
  return found;
}

}  // namespace faultsweep
