#include "campaign/nightly/nightly_sample.h"

#include <map>
#include <nlohmann/json.hpp>

#include "campaign/common/names.h"
#include "campaign/query/parameters.h"

namespace faultsweep {

namespace {

/// Numbers of scenes and families of a store in the submission.
class Numbering {
 public:
  Numbering(const Store& store, const CampaignInfo& campaign, Submission& submission)
      : store_(store), submission_(submission) {
    for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
      progress_.emplace(family.fingerprint, family);
    }
  }
  int scene(std::int64_t id) {
    const auto [place, is_new] =
        scenes_.try_emplace(id, static_cast<int>(submission_.scenes.size()));
    if (is_new) submission_.scenes.push_back(store_.base_scene(id));
    return place->second;
  }
  int family(const std::string& fingerprint) {
    const auto [place, is_new] =
        families_.try_emplace(fingerprint, static_cast<int>(submission_.families.size()));
    if (is_new) {
      const Store::FamilyProgress& known = progress_.at(fingerprint);
      FamilyRecord record;
      record.fingerprint = fingerprint;
      record.operator_seconds = known.build_seconds.value_or(1);
      record.memory_bytes = known.memory_bytes;
      record.n_operators = known.n_operators;
      submission_.families.push_back(record);
    }
    return place->second;
  }

 private:
  const Store& store_;
  Submission& submission_;
  std::map<std::string, Store::FamilyProgress> progress_;
  std::map<std::int64_t, int> scenes_;
  std::map<std::string, int> families_;
};

}  // namespace

NightCase night_case(const StoredCase& stored, const CampaignInfo& campaign) {
  NightCase one;
  one.position = stored.position;
  one.identity = stored.identity;
  one.label = settings_of(stored.parameters, campaign.parameters);
  if (stored.has_result) {
    one.result = stored.result;
  } else {
    one.trouble = "was not run";
  }
  if (!stored.runs.empty()) {
    const StoredRun& run = stored.runs.back();
    one.wall_seconds = run.wall_seconds;
    if (!stored.has_result) one.trouble = concat(run.status, ": ", run.reason);
  }
  return one;
}

NightCampaign stored_night(const Store& store, const CampaignInfo& campaign) {
  NightCampaign night{campaign.name, {}};
  for (long k = 1; k <= campaign.n_cases; ++k) {
    night.cases.push_back(night_case(store.stored_case(campaign.id, std::to_string(k)), campaign));
  }
  return night;
}

StoredSample take_sample(const SampleRequest& request) {
  const Store store = Store::open_reader(request.store);
  const CampaignInfo campaign = store.campaign(request.campaign);
  const std::vector<RankedCase> ranking = store.ranking(campaign.id, {});
  const std::size_t n_parameters = campaign.parameters.size();
  std::vector<std::string> keys;
  for (const RankedCase& one : ranking) {
    std::vector<nlohmann::json> values(n_parameters);
    for (const CaseParameter& value : one.parameters) values.at(value.index) = value_to_json(value);
    keys.push_back(nlohmann::json(values).dump());
  }
  StoredSample sample;
  Submission& submission = sample.submission;
  submission.name = "sample-" + campaign.name;
  submission.source = campaign.source;
  submission.spec_given = submission.spec_resolved = "{}";
  submission.parameters = campaign.parameters;
  submission.rank_by = campaign.rank_by;
  submission.policy = campaign.policy;
  Numbering numbering(store, campaign, submission);
  for (const std::size_t place : sampled_places(keys, request.top, request.sample)) {
    const StoredCase one = store.stored_case(campaign.id, std::to_string(ranking[place].position));
    submission.cases.push_back({one.identity, numbering.family(one.family),
                                numbering.scene(one.scene), one.changes, one.parameters});
    sample.baseline.cases.push_back(night_case(one, campaign));
  }
  return sample;
}

}  // namespace faultsweep
