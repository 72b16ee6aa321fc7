#include "campaign/common/names.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

bool fields_are_there(const std::filesystem::path& folder) {
  std::error_code error;  // what cannot be looked at is as good as gone
  return std::filesystem::exists(folder / "faults.h5", error) &&
         std::filesystem::exists(folder / "faults.xmf", error);
}

long Store::requeue_missing_fields(const CampaignInfo& campaign) {
  if (campaign.keep_fields == KeepFields::none) return 0;
  const bool of_shown = campaign.keep_fields == KeepFields::shown;
  const std::string missing = to_string(of_shown ? FieldsState::none : FieldsState::wanted);
  Transaction transaction(*connection_);
  if (of_shown)
    connection_->run(
        "UPDATE campaign_cases SET fields = 'none' WHERE campaign_id = ? AND fields = 'wanted'",
        campaign.id);
  long n_lost = 0;
  for (const long position : connection_->rows<long>(
           "SELECT position FROM campaign_cases WHERE campaign_id = ? AND fields = 'kept'",
           campaign.id)) {
    if (fields_are_there(fields_folder(campaign.name, position))) continue;
    connection_->run("UPDATE campaign_cases SET fields = ? WHERE campaign_id = ? AND position = ?",
                     missing, campaign.id, position);
    ++n_lost;
  }
  transaction.commit();
  return n_lost;
}

DecidedCase Store::decided_case(std::int64_t campaign, std::int64_t case_id) const {
  const auto [position, fields, seconds, operator_seconds, fingerprint, n_operators] =
      connection_->row<std::tuple<long, std::string, double, double, std::string, int>>(
          "SELECT cc.position, cc.fields, coalesce(r.wall_s, 0),"
          " CASE WHEN f.n_operators = 1 THEN coalesce(o.build_s, f.predicted_operator_s)"
          " ELSE f.predicted_operator_s END, coalesce(f.operator, ''), f.n_operators"
          " FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
          " JOIN families f ON f.id = c.family_id LEFT JOIN runs r ON r.id = c.run_id"
          " LEFT JOIN operators o ON o.fingerprint = f.operator"
          " WHERE cc.campaign_id = ? AND cc.case_id = ?",
          campaign, case_id);
  return {position,    stored_word<FieldsState>(fields, "state of fields"),
          seconds,     operator_seconds,
          fingerprint, n_operators > 1};
}

void Store::want_fields(std::int64_t campaign, const std::vector<std::int64_t>& cases) {
  Transaction transaction(*connection_);
  connection_->run(
      "UPDATE campaign_cases SET fields = 'none' WHERE campaign_id = ? AND fields = 'wanted'",
      campaign);
  for (const std::int64_t id : cases) {
    connection_->run(
        "UPDATE campaign_cases SET fields = 'wanted' WHERE campaign_id = ? AND case_id = ?",
        campaign, id);
  }
  transaction.commit();
}

}  // namespace faultsweep
