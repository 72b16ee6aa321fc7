#include "campaign/app/certify.h"

#include <algorithm>

#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/reports/compare.h"
#include "campaign/reports/tier_certificate.h"
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

/// The spec that runs these cases again, on exact operators.
struct Rerun {
  ordered_json spec;
  std::string source;

  Rerun(const Store& store, const CampaignInfo& campaign, const std::vector<long>& positions)
      : spec(spec_of(store, campaign)) {
    // What relative paths in the scene start from, as far as it is still the campaign's.
    const BaseScene first = store.base_scene(store.stored_case(campaign.id, "1").scene);
    source = json::parse(first.document) == json(spec["base"]) ? first.source : campaign.source;
    const std::vector<long> rows = rows_of(spec, source, positions);
    spec["operators"] = {{"exact_rows", rows}};
  }
};

SubmittedRun run_again(const Expansion& expansion, const StoreArguments& common,
                       const CertifyRequest& request) {
  return submit_and_run(
      without_shown_fields(make_submission(expansion)),
      {.store = common.store, .n_workers = request.n_workers, .simulator = simulator_binary()});
}

/// The other tier, if the cases can be run at it.
void require_other_tier(const std::string& own, const std::string& wanted) {
  if (own.empty())
    throw InputError("--tier", "the campaign has several tiers, or sizes of cells of its own",
                     "run the campaign at the other tier, and compare both");
  if (own == wanted)
    throw InputError("--tier", concat("the campaign has the tier ", own),
                     "name another one, or leave --tier out: exact operators on the same cells");
}

/// The first cases that have interpolated operators.
std::vector<long> interpolated_cases(const Store& store, const CampaignInfo& campaign,
                                     const CertifyRequest& request) {
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
  return positions;
}

/// All cases, by one number.
Ranking whole_ranking(const Store& store, const CampaignInfo& campaign, RankRequest asked) {
  asked.top = 0;
  asked.skip.reset();
  Ranking ranking = make_ranking(store, campaign, asked);
  if (ranking.by_default)
    throw InputError("--tier", "the campaign's own order is by several numbers in turn",
                     "name the number to rank by: --by chi_bar");
  return ranking;
}

std::vector<long> first_cases(const Ranking& ranking, long n) {
  std::vector<long> positions;
  for (const RankedCase* row : with_full_histories(ranking))
    if (std::ssize(positions) < n) positions.push_back(row->position);
  if (positions.empty())
    throw InputError("--certify",
                     concat("no case of ", ranking.campaign.name, " has a full history"),
                     "`faultsweep status` says why");
  return positions;
}

}  // namespace

ExitCode certify(const StoreArguments& common, const CertifyRequest& request) {
  CampaignInfo campaign;
  std::optional<Rerun> rerun;
  {
    const Store store = Store::open_reader(common.store);
    campaign = store.campaign(common.campaign);
    rerun.emplace(store, campaign, interpolated_cases(store, campaign, request));
  }
  rerun->spec["name"] = campaign.name + "-exact";
  const SubmittedRun run =
      run_again(expand(parse_campaign(rerun->spec.dump(), rerun->source)), common, request);
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

ExitCode certify_at_tier(const StoreArguments& common, const CertifyRequest& request) {
  std::string own_tier;
  Ranking before;
  std::optional<Rerun> rerun;
  {
    const Store store = Store::open_reader(common.store);
    const CampaignInfo campaign = store.campaign(common.campaign);
    own_tier = common_tier(store, campaign);
    require_other_tier(own_tier, request.tier);
    before = whole_ranking(store, campaign, request.ranking);
    rerun.emplace(store, campaign, first_cases(before, request.n));
  }
  rerun->spec["name"] = concat(before.campaign.name, "-first-", request.tier);
  rerun->spec["set"] = {{"/tier", request.tier}};
  const Expansion expansion = expand(parse_campaign(rerun->spec.dump(), rerun->source));
  const SubmittedRun run = run_again(expansion, common, request);
  if (!has_results(run.status)) return run.status;
  const Store store = Store::open_reader(common.store);
  RankRequest all = request.ranking;
  all.where.clear();  // these cases are chosen
  const Ranking after = whole_ranking(store, store.campaign(run.campaign), all);
  std::vector<long> positions;
  for (const int k : expansion.case_of_row.front()) positions.push_back(k + 1);
  TierCertificate found = tier_certificate(before, positions, after);
  found.tier_before = own_tier;
  found.tier_after = request.tier;
  print_answer(to_answer(found, before), common);
  return run.status;
}

}  // namespace faultsweep
