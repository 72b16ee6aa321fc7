#include <algorithm>
#include <map>
#include <utility>

#include "campaign/answers/sheet_parts.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/rounds/answers_of.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/changed_scene.h"

namespace faultsweep {

using faultsim::GeometryKind;
using faultsim::Scene;

namespace {

/// Scenes of cases, one at a time: a base scene is read once, and of a case what it changes.
class CaseScenes {
 public:
  CaseScenes(const Store& store, const CampaignInfo& campaign)
      : store_(store), campaign_(campaign) {}

  /// The scene before what the campaign varies. Throws InputError where it cannot be read.
  Scene base_of(std::int64_t case_id) {
    return faultsim::read_scene(base(store_.case_input(campaign_.id, case_id).scene).document);
  }

  /// Until the next one; null where it cannot be read.
  const Scene* scene(std::int64_t case_id) {
    const CaseInput input = store_.case_input(campaign_.id, case_id);
    Base& its = base(input.scene);
    std::vector<faultsim::PlacedValue> values;
    const json changes = json::parse(input.changes, nullptr, false);
    if (!changes.is_object()) return nullptr;
    for (const auto& [pointer, value] : changes.items()) values.push_back({pointer, value});
    std::vector<Problem> problems;
    const std::vector<std::string> placeless = faultsim::change_scene(
        its.document, std::move(values), faultsim::Relations::trusted, its.changed, problems);
    return placeless.empty() && problems.empty() ? &its.changed.scene : nullptr;
  }

 private:
  struct Base {
    faultsim::JsonDocument document;
    faultsim::ChangedScene changed;
  };
  Base& base(std::int64_t scene) {
    const auto found = bases_.find(scene);
    if (found != bases_.end()) return found->second;
    const BaseScene stored = store_.base_scene(scene);
    Base one{{stored.source, json::parse(stored.document), {}}, {}};
    one.changed.document = one.document;
    return bases_.emplace(scene, std::move(one)).first->second;
  }

  const Store& store_;
  const CampaignInfo& campaign_;
  std::map<std::int64_t, Base> bases_;
};

/// The middle of the reservoirs beside the fault, or of a box's patch.
double middle_of(const Scene& scene, std::size_t fault) {
  if (scene.geometry_kind == GeometryKind::box) return -scene.box.patches[fault].center[2];
  faultsim::DepthInterval all = {1, 0};  // empty
  for (const faultsim::Block& block : blocks_beside(scene.field, fault)) {
    const faultsim::DepthInterval one = reservoir_range(scene.field, block);
    if (all.top > all.bottom) all = one;
    all.unite(one);
  }
  return 0.5 * (all.top + all.bottom);
}

/// The faults of the base scene that have results and are asked for.
std::vector<FaultOfSheet> faults_of(const SheetSource& source) {
  std::vector<FaultOfSheet> faults;
  const Scene& base = source.base;
  for (std::size_t f = 0; f < base.faults.size(); ++f) {
    const std::string& name = base.faults[f].name;
    const auto known = std::ranges::find(source.selection.faults, name, &NamedId::name);
    if (known == source.selection.faults.end()) continue;
    if (!source.request.fault.empty() && name != source.request.fault) continue;
    FaultOfSheet one{
        *known, f, source.request.datum.value_or(middle_of(base, f)), regions_beside(base, f), {}};
    faults.push_back(std::move(one));
  }
  if (faults.empty()) {
    throw InputError(
        "--fault",
        concat("the base scene has no fault \"", source.request.fault, "\" with results"),
        concat("it has ", joined(base.faults, ", ", &faultsim::Fault::name)));
  }
  return faults;
}

/// Of every case what its scene says of each fault.
void read_starts(SheetSource& source, CaseScenes& scenes,
                 const std::vector<std::int64_t>& case_ids) {
  for (const std::int64_t id : case_ids) {
    const Scene* scene = scenes.scene(id);
    for (FaultOfSheet& fault : source.faults) {
      const bool fits = scene != nullptr && fault.index < scene->faults.size() &&
                        scene->pressure.size() == source.base.pressure.size();
      fault.starts.push_back(fits ? start_of(*scene, fault) : CaseStart{});
    }
  }
}

}  // namespace

CaseStart start_of(const Scene& scene, const FaultOfSheet& fault) {
  CaseStart start;
  start.is_read = true;
  start.at = initial_on_fault(scene, fault.index, fault.datum);
  for (const std::size_t region : fault.regions)
    start.region_pressure.push_back(initial_region_pressure(scene, region, fault.datum));
  if (!fault.regions.empty()) {
    start.gradient = initial_region_pressure(scene, fault.regions.front(), fault.datum + 1) -
                     start.region_pressure.front();
  }
  if (scene.geometry_kind == GeometryKind::box) {
    start.dip = scene.box.patches[fault.index].dip_from_vertical;
    return start;
  }
  start.dip = scene.faults[fault.index].dip_from_vertical;
  const auto beside = blocks_beside(scene.field, fault.index);
  if (beside.size() == 2) {
    start.throw_ =
        reservoir_range(scene.field, beside[1]).top - reservoir_range(scene.field, beside[0]).top;
  }
  return start;
}

SheetSource read_sheet_source(const Store& store, const CampaignInfo& campaign,
                              const SheetRequest& request) {
  SheetSource source{store,
                     campaign,
                     request,
                     make_selection(store, campaign, "", request.fault),
                     {},
                     sampling_of(store, campaign),
                     SampleRows(store, campaign),
                     {},
                     {},
                     {}};
  source.selection.fault.reset();
  if (source.selection.faults.empty()) refuse_unrun("sheet", "no case has a result", campaign);
  std::vector<std::int64_t> case_ids;
  long first_full = 0;
  store.for_each_case(campaign.id, {}, [&](const CaseRow& row) {
    case_ids.push_back(row.id);
    if (first_full == 0 && row.complete()) first_full = row.position;
  });
  CaseScenes scenes(store, campaign);
  source.base = scenes.base_of(case_ids.front());
  if (first_full > 0)
    source.steps = store.stored_case(campaign.id, std::to_string(first_full)).result.steps;
  const std::optional<StoredRounds> rounds = stored_rounds(store, campaign);
  if (rounds && rounds->spec.contains("limits")) source.limits = make_limit_table(store, campaign);
  source.faults = faults_of(source);
  read_starts(source, scenes, case_ids);
  return source;
}

}  // namespace faultsweep
