#include "campaign/app/certify.h"

#include <algorithm>

#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/reports/compare.h"
#include "campaign/scheduler/starter.h"

namespace faultsweep {

namespace {

constexpr const char* kCure =
    "run the interpolated cases with exact operators in a campaign of their own";

/// The spec of the campaign on its stored scene, which has its surfaces.
ordered_json spec_of(const Store& store, const CampaignInfo& campaign) {
  const Store::SpecCopies copies = store.spec_copies(campaign.id);
  ordered_json spec = ordered_json::parse(copies.given);
  const ordered_json groups = ordered_json::parse(copies.resolved).at("groups");
  if (groups.size() != 1 || spec.contains("rounds") || spec.contains("limits")) {
    throw InputError("--certify", {{"", 0, "the campaign has groups, rounds or limits", kCure}});
  }
  spec["base"] = groups.at(0).at("scene");
  for (const char* key : {"set", "operators"}) spec.erase(key);
  return spec;
}

/// The rows of the design that cases are, by their positions.
std::vector<long> rows_of(const ordered_json& spec, const std::string& source,
                          const std::vector<long>& positions) {
  const Expansion all = expand(parse_campaign(spec.dump(), source));
  std::vector<long> rows;
  for (const long position : positions) {
    const auto& cases = all.case_of_row.front();
    const auto found = std::ranges::find(cases, static_cast<int>(position - 1));
    FAULTSIM_DEMAND(found != cases.end(), "case ", position, " is of no row");
    rows.push_back(found - cases.begin());
  }
  return rows;
}

}  // namespace

ExitCode certify(const StoreArguments& common, const CertifyRequest& request) {
  ordered_json spec;
  CampaignInfo campaign;
  std::string source;
  {
    const Store store = Store::open_reader(common.store);
    campaign = store.campaign(common.campaign);
    RankRequest asked = request.ranking;
    asked.top = request.n;
    asked.skip.reset();
    std::vector<long> positions;
    for (const RankedCase& one : make_ranking(store, campaign, asked).rows) {
      if (one.interpolated) positions.push_back(one.position);
    }
    if (positions.empty()) {
      throw InputError("--certify", {{"", 0,
                                      concat("none of the first ", request.n, " cases of ",
                                             campaign.name, " has an interpolated operator"),
                                      "leave --certify out: they are exact already"}});
    }
    spec = spec_of(store, campaign);
    // What relative paths in the scene start from, as far as it is still the campaign's.
    const BaseScene first = store.base_scene(store.stored_case(campaign.id, "1").scene);
    source = json::parse(first.document) == json(spec["base"]) ? first.source : campaign.source;
    const std::vector<long> rows = rows_of(spec, source, positions);
    spec["operators"] = {{"exact_rows", rows}};
    spec["name"] = campaign.name + "-exact";
  }
  const Submission submission =
      without_shown_fields(make_submission(expand(parse_campaign(spec.dump(), source))));
  const SubmittedRun run = submit_and_run(
      submission,
      {.store = common.store, .n_workers = request.n_workers, .simulator = simulator_binary()});
  if (!has_results(run.status)) return run.status;
  const Store store = Store::open_reader(common.store);
  CompareRequest compared;
  compared.tolerance = request.tolerance;
  compared.metrics = request.metrics;
  const Comparison found = compare_campaigns(store, store.campaign(run.campaign), store,
                                             store.campaign(campaign.name), compared);
  print_answer(to_answer(found), common);
  return run.status;
}

}  // namespace faultsweep
