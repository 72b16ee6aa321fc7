#include "campaign/answers/fault_sheet.h"

#include <algorithm>
#include <cmath>

#include "campaign/answers/sheet_parts.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/scene/field_extents.h"

namespace faultsweep {

using faultsim::GeometryKind;
using faultsim::Scene;

namespace {

SheetPlace place_of(const SheetSource& source, const FaultOfSheet& fault) {
  const Scene& base = source.base;
  SheetPlace place;
  place.is_field = base.geometry_kind == GeometryKind::field;
  place.depths = depths_of_fault(base, fault.index);
  const CaseStart start = start_of(base, fault);
  place.dip_from_vertical = start.dip;
  if (place.is_field) {
    place.x = fault_x(base, fault.index, fault.datum);
    place.length = fault_ends(base.field, fault.index).length();
    if (!std::isnan(start.throw_)) place.throw_ = start.throw_;
  } else {
    place.strike = base.box.patches[fault.index].strike;
    place.length = base.box.patches[fault.index].length;
  }
  for (const std::size_t region : fault.regions) {
    SheetPlace::Region one{base.pressure[region].region, depths_of_region(base, region), false};
    one.is_west =
        place.is_field && fault.index > 0 && one.name == base.field.blocks[fault.index - 1].name;
    place.regions.push_back(one);
  }
  for (const CaseStart& one : fault.starts) {
    place.dips.add(one.dip);
    place.throws.add(one.throw_);
  }
  return place;
}

SheetInitial initial_of(const SheetSource& source, const FaultOfSheet& fault) {
  SheetInitial initial;
  initial.base = start_of(source.base, fault).at;
  for (const CaseStart& one : fault.starts) {
    if (!one.is_read) continue;
    initial.normal.add(one.at.normal);
    initial.shear.add(one.at.shear);
    initial.pressure.add(one.at.pressure);
    for (const double p0 : one.region_pressure) initial.region_pressure.add(p0);
  }
  return initial;
}

/// One pass over the cases: levels, events, what became of them.
class WholePass {
 public:
  WholePass(const SheetSource& source, const FaultOfSheet& fault, FaultSheet& sheet)
      : source_(source), fault_(fault), sheet_(sheet) {}

  void run() {
    Selection selection = make_selection(source_.store, source_.campaign, "", fault_.id.name);
    std::vector<std::string> conditions;
    for (const EscalationLevel& level : sheet_.table.levels)
      if (!level.condition.empty()) conditions.push_back(level.condition);
    const VerdictColumns verdicts(source_.store, source_.campaign, selection, conditions);
    Store::TableQuery query = case_query(source_.campaign, selection, "");
    query.columns = verdicts.columns();
    n_conditions_ = conditions.size();
    const auto whole = std::ranges::find(selection.stages, "", &NamedId::name);
    FAULTSIM_DEMAND(whole != selection.stages.end(), source_.campaign.name);
    query.columns.push_back({history_sql("chi_bar", fault_.id.id, whole->id, 0), {}});
    for (const char* metric : {"n_events", "event_moment", "max_slip", "moment"})
      query.columns.push_back({metric_sql(metric, true), {}});
    query.columns.push_back({metric_sql("plane_strain"), {}});
    for (const EscalationLevel& level : sheet_.table.levels)
      sheet_.levels.push_back({level, {}, {}});
    source_.store.for_each_case(source_.campaign.id, query,
                                [&](const CaseRow& row) { add(row, verdicts); });
    for (LevelShare& level : sheet_.levels)
      level.bounds = bounds_of(level.counts, source_.sampling, sheet_.confidence);
    find_events();
  }

 private:
  /// What is kept of the cases of one kind, per metre of strike or in total.
  struct Kind {
    SheetEvents events;
    double largest = 0, largest_resolved = 0;  ///< N m, of events.
    long position = 0, position_resolved = 0;
    bool is_there = false;
  };

  void add(const CaseRow& row, const VerdictColumns& verdicts) {
    count(row);
    std::vector<Held> conditions;
    std::size_t c = 0;
    for (const LevelShare& level : sheet_.levels)
      conditions.push_back(level.level.condition.empty() ? Held::yes : verdicts.held(row, c++));
    const std::vector<Held> held = levels_held(conditions);
    for (int k = 0; k < source_.sample.count(row.position); ++k)
      for (std::size_t l = 0; l < held.size(); ++l) sheet_.levels[l].counts.add(held[l]);
    if (!row.rank_class) return;
    const double chi = metric(row, 0);
    sheet_.initial.chi_bar.add(chi);
    sheet_.initial.n_chi_bar += std::isnan(chi) ? 0 : 1;
    add_events(row);
  }

  void count(const CaseRow& row) {
    SheetCounts& counts = sheet_.counts;
    ++counts.n_cases;
    counts.n_complete += row.complete() ? 1 : 0;
    counts.n_unresolved += row.complete() && *row.rank_class == 1 ? 1 : 0;
    counts.n_early += row.rank_class && !row.complete() ? 1 : 0;
    if (row.rank_class) return;
    (row.state == "failed" ? counts.n_failed : counts.n_waiting) += 1;
  }

  double metric(const CaseRow& row, std::size_t k) const {
    return number_of(row.metrics[n_conditions_ + k]);
  }

  void add_events(const CaseRow& row) {
    const bool plane_strain = metric(row, 5) > 0;
    Kind& kind = kinds_[plane_strain ? 1 : 0];
    kind.is_there = true;
    kind.events.plane_strain = plane_strain;
    ++kind.events.n_cases;
    kind.events.n_early += row.complete() ? 0 : 1;
    if (metric(row, 3) > kind.events.slip) {
      kind.events.slip = metric(row, 3);
      kind.events.moment = metric(row, 4);
      kind.events.slip_case = row.position;
    }
    if (!(metric(row, 1) > 0)) return;
    ++kind.events.n_with;
    const double moment = metric(row, 2);
    if (kind.position == 0 || moment > kind.largest)
      kind.largest = moment, kind.position = row.position;
    if (row.outcome == "unresolved_event") return;
    if (kind.position_resolved == 0 || moment > kind.largest_resolved)
      kind.largest_resolved = moment, kind.position_resolved = row.position;
  }

  std::optional<SheetEvent> event_in(long position, bool plane_strain) const {
    if (position == 0) return std::nullopt;
    const StoredCase one = source_.store.stored_case(source_.campaign.id, std::to_string(position));
    std::optional<SheetEvent> largest;
    for (const faultsim::SlipEvent& event : one.result.events) {
      if (event.fault != fault_.id.name) continue;
      if (!largest || event.moment > largest->event.moment)
        largest = SheetEvent{position, plane_strain, event};
    }
    return largest;
  }

  void find_events() {
    for (Kind& kind : kinds_) {
      if (!kind.is_there) continue;
      const bool plane_strain = kind.events.plane_strain;
      kind.events.largest = event_in(kind.position, plane_strain);
      kind.events.largest_resolved = event_in(kind.position_resolved, plane_strain);
      sheet_.events.push_back(kind.events);
    }
  }

  const SheetSource& source_;
  const FaultOfSheet& fault_;
  FaultSheet& sheet_;
  std::size_t n_conditions_ = 0;
  Kind kinds_[2];
};

/// Limits where they were searched, and of stages in which none was the histories.
void add_bands_and_stages(const SheetSource& source, const FaultOfSheet& fault, FaultSheet& sheet) {
  sheet.bands = bands_of_limits(source, fault);
  std::vector<std::string> searched;
  for (const PressureBand& band : sheet.bands) searched.push_back(band.stage);
  for (const std::string& stage : stages_of_sheet(source)) {
    const std::vector<StageRow> rows = read_stage_rows(source, fault, stage);
    sheet.stages.push_back(sliding_in(source, fault, stage, rows));
    if (contains(searched, stage) || contains(searched, "")) continue;
    append(sheet.bands, bands_of_stage(source, fault, stage, rows));
  }
  sheet.stages.push_back(sliding_in(source, fault, "", read_stage_rows(source, fault, "")));
}

std::string title_of(const Store& store, const CampaignInfo& campaign) {
  const json spec = json::parse(store.spec_copies(campaign.id).given, nullptr, false);
  return spec.is_object() && spec.contains("title") && spec["title"].is_string()
             ? spec["title"].get<std::string>()
             : "";
}

FaultSheet sheet_of(const SheetSource& source, const FaultOfSheet& fault) {
  FaultSheet sheet;
  sheet.campaign = source.campaign;
  sheet.title = title_of(source.store, source.campaign);
  sheet.fault = fault.id.name;
  sheet.fault_index = fault.index;
  sheet.base = source.base;
  sheet.datum = fault.datum;
  sheet.confidence = source.request.confidence;
  sheet.sampling = source.sampling;
  sheet.table = source.request.levels;
  sheet.place = place_of(source, fault);
  sheet.initial = initial_of(source, fault);
  sheet.counts.n_unread = std::ranges::count(fault.starts, false, &CaseStart::is_read);
  WholePass(source, fault, sheet).run();
  add_bands_and_stages(source, fault, sheet);
  sheet.errors = model_errors(source, sheet.counts);
  sheet.provenance = provenance_of(source, sheet);
  return sheet;
}

}  // namespace

std::vector<FaultSheet> find_fault_sheets(const Store& store, const CampaignInfo& campaign,
                                          const SheetRequest& request) {
  const SheetSource source = read_sheet_source(store, campaign, request);
  std::vector<FaultSheet> sheets;
  for (const FaultOfSheet& fault : source.faults) sheets.push_back(sheet_of(source, fault));
  return sheets;
}

}  // namespace faultsweep
