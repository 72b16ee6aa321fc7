#include "campaign/answers/cell_errors.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/render/shown.h"
#include "simulator/reading/read_scene.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

namespace {

std::string mesh_sentence(const std::string& tier_name, const faultsim::Scene& base) {
  const faultsim::Tier* tier = faultsim::find_tier(tier_name);
  const std::string cells =
      faultsim::cells_text(base.mesh, base.numerics.plane_strain == faultsim::Switch::on);
  return tier != nullptr
             ? concat("Mesh: tier ", tier->name, " (", cells,
                      "), whose cells were measured in plane strain: ", tier->errors, ".")
             : concat("Mesh: base scene, ", cells,
                      "; no tier states its error, faultsweep tradeoff measures it.");
}

/// "" for nothing. @param bars  of one tier and one reference.
std::string measured_sentence(const std::vector<ErrorBar>& bars) {
  std::string text;
  for (const ErrorBar& bar : bars) {
    if (bar.metric != "chi_bar" && bar.metric != "max_slip") continue;
    const bool is_slip = bar.metric == "max_slip";
    const ShownUnit unit = is_slip ? ShownUnit{"mm", 1e-3, "m"} : plain();
    text += text.empty() ? concat("Measured at tier ", bar.tier,
                                  " on cases of this campaign, against tier ", bar.reference, ": ")
                         : std::string("; ");
    text += concat(is_slip ? "largest slip" : "χ̄", " off by ", in_unit(bar.rms, unit, 2), " rms, ",
                   in_unit(bar.largest, unit, 2), " at most (", bar.n_cases, " cases)");
  }
  return text.empty() ? text : text + ".";
}

}  // namespace

CellErrors cell_errors(const Store& store, const CampaignInfo& campaign,
                       const faultsim::Scene& base) {
  const std::string own = common_tier(store, campaign);
  CellErrors errors{mesh_sentence(own, base), "", "", {}};
  std::vector<ErrorBar> rest = store.error_bars(campaign.name);  // by tier
  while (!rest.empty()) {
    const auto end = std::ranges::find_if(rest, [&](const ErrorBar& bar) {
      return bar.tier != rest.front().tier || bar.reference != rest.front().reference;
    });
    const std::vector<ErrorBar> bars(rest.begin(), end);
    const std::string sentence = measured_sentence(bars);
    if (bars.front().tier == own) {
      errors.measured += concat(errors.measured.empty() ? "" : " ", sentence);
    } else if (!sentence.empty()) {
      errors.elsewhere.push_back(sentence);
    }
    rest.erase(rest.begin(), end);
  }
  const StatedErrors stated = stated_errors_of(store, campaign);
  if (const auto chi = stated.find("chi_bar"); chi != stated.end()) {
    errors.undecided = concat("A condition on χ̄ counts as undecided where χ̄ is within ",
                              in_unit(chi->second, plain(), 2), " of the limit in it.");
  }
  return errors;
}

CellErrors cell_errors(const Store& store, const CampaignInfo& campaign) {
  const BaseScene base = store.base_scene(store.stored_case(campaign.id, "1").scene);
  return cell_errors(store, campaign,
                     faultsim::read_scene({base.source, json::parse(base.document), {}}));
}

}  // namespace faultsweep
