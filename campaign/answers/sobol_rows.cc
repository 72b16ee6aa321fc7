#include "campaign/answers/sobol_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "campaign/answers/designs.h"
#include "campaign/query/table_output.h"

namespace faultsweep {
namespace {

/// Of an output on the rows of one base sample; they are in the order A, AB_1 .. AB_D, (BA_1 ..
/// BA_D,) B. Rows BA repeat what A and AB tell with the blocks' parts exchanged: not used.
void add_base_sample(const std::vector<double>& rows, PickFreezeValues& values) {
  if (std::ranges::any_of(rows, [](double one) { return !std::isfinite(one); })) return;
  values.a.push_back(rows.front());
  values.b.push_back(rows.back());
  for (std::size_t p = 0; p < values.ab.size(); ++p) values.ab[p].push_back(rows[p + 1]);
}

}  // namespace

std::optional<SobolRows> read_sobol_rows(const Store& store, const CampaignInfo& campaign,
                                         const SampledCases& request,
                                         const std::vector<ScopedMetric>& outputs) {
  const std::vector<nlohmann::json> designs = designs_of(store, campaign);
  if (designs.size() != 1 || designs[0].at("kind") != "sobol" || !request.where.empty()) return {};
  SobolRows found;
  for (const nlohmann::json& one : designs[0].at("parameters"))
    found.parameters.push_back(one.at("name"));
  found.outputs.resize(outputs.size());
  for (PickFreezeValues& one : found.outputs) one.ab.resize(found.parameters.size());

  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  Store::TableQuery query = case_query(campaign, selection, "", outputs);
  query.by_design_row = true;
  const auto n_rows = static_cast<std::size_t>(rows_per_base_sample(designs[0]));
  std::vector<std::vector<double>> rows(outputs.size());  // of the base sample at hand
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    for (std::size_t m = 0; m < rows.size(); ++m) {
      rows[m].push_back(row.complete() ? number_of(row.metrics[m])
                                       : std::numeric_limits<double>::quiet_NaN());
      if (rows[m].size() < n_rows) continue;
      add_base_sample(rows[m], found.outputs[m]);
      rows[m].clear();
      found.n_base_samples += m == 0 ? 1 : 0;
    }
  });
  return found;
}

}  // namespace faultsweep
