#include "campaign/scheduler/fields_choice.h"

#include "campaign/common/names.h"
#include "campaign/store/clock.h"

namespace faultsweep {
namespace {

/// Why the fields of the case are not written; "" = they are.
std::string too_dear(const Store& store, const DecidedCase& one) {
  if (one.seconds > kMostForFields)
    return concat("its run took ", format_duration(one.seconds),
                  ", which a second run would take again");
  const bool cached = !one.creeps && is_cached_operator(store, one.operator_fingerprint);
  if (cached || one.operator_seconds <= kMostForFields) return "";
  return concat(one.creeps ? "operators of creeping salt are not on file"
                           : "its operator is no longer on file",
                ", and building takes ", format_duration(one.operator_seconds));
}

}  // namespace

bool is_cached_operator(const Store& store, const std::string& fingerprint) {
  return !fingerprint.empty() &&
         std::filesystem::is_regular_file(store.folder() / "operators" / (fingerprint + ".h5"));
}

FieldsChoice choose_fields(const Store& store, const CampaignInfo& campaign,
                           const std::vector<std::int64_t>& first) {
  FieldsChoice choice;
  for (const std::int64_t id : first) {
    const DecidedCase one = store.decided_case(campaign.id, id);
    if (one.fields == FieldsState::kept || one.fields == FieldsState::failed) continue;
    const std::string reason = too_dear(store, one);
    if (!reason.empty()) {
      choice.left_out.push_back(concat("the fault fields of case ", one.position,
                                       ", ranked among the first, are not kept: ", reason,
                                       "; \"keep_fields\": \"stages\" keeps those of all cases"));
      continue;
    }
    choice.cases.push_back(id);
    choice.positions.push_back(one.position);
  }
  return choice;
}

}  // namespace faultsweep
