#include "python/bindings/stored_campaign.h"

#include "campaign/figures/campaign_figures.h"
#include "python/bindings/case_drawing.h"

namespace faultsim::python {

using faultsweep::Store;
using faultsweep::StoredCase;

StoredCampaign::StoredCampaign(const std::string& folder, const std::string& name)
    : store(Store::open_reader(folder)), info(store.campaign(name)) {}

void StoredCampaign::refresh() { info = store.campaign(info.name); }

std::vector<std::pair<std::string, long>> StoredCampaign::counts() const {
  return {{"cases", info.n_cases},
          {"done", info.n_done},
          {"waiting", info.n_waiting},
          {"failed", info.n_failed},
          {"complete", info.n_complete()}};
}

StoredCase StoredCampaign::case_named(const std::string& name) const {
  return store.stored_case(info.id, name);
}

StoredCampaign::Summary StoredCampaign::summary(const std::string& name) const {
  const StoredCase one = case_named(name);
  std::vector<Parameter> parameters;
  for (const faultsweep::CaseParameter& given : one.parameters)
    parameters.emplace_back(info.parameters[static_cast<std::size_t>(given.index)].name, given.si,
                            given.text);
  return {one.position,         one.identity, one.state, one.has_result, one.fields_folder.string(),
          std::move(parameters)};
}

std::shared_ptr<KeptResult> StoredCampaign::result_of(const std::string& name) const {
  std::optional<CaseResult> result = store.stored_result(case_named(name).id);
  if (!result) return nullptr;
  auto kept = std::make_shared<KeptResult>();
  kept->result = std::move(*result);
  return kept;
}

std::string StoredCampaign::draw_case(const std::string& name, const std::string& chart,
                                      const std::string& fault, std::optional<int> step,
                                      const std::string& show) const {
  const faultsweep::StoredPicture drawn(store, info, case_named(name));
  return drawn_case(drawn.picture(), chart, fault, step, show);
}

}  // namespace faultsim::python
