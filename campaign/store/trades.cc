#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

void Store::record_trade(const TradeRecord& trade) {
  Connection& db = *connection_;
  Transaction transaction(db);
  db.run(
      "INSERT INTO tradeoffs (at, source, campaign, program_version, report)"
      " VALUES (?, ?, ?, ?, ?)",
      trade.at, trade.source, trade.campaign, trade.program_version, trade.report);
  const std::int64_t id = db.last_insert_id();
  for (const ErrorBar& bar : trade.error_bars) {
    db.run(
        "INSERT OR REPLACE INTO error_bars (campaign, tier, metric, reference, n_cases, rms,"
        " largest, tradeoff_id) VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
        bar.campaign, bar.tier, bar.metric, bar.reference, bar.n_cases, bar.rms, bar.largest, id);
  }
  transaction.commit();
}

std::vector<ErrorBar> Store::error_bars(const std::string& campaign) const {
  using Text = std::string;
  return connection_->rows<ErrorBar, Text, Text, Text, Text, long, double, double, std::int64_t>(
      "SELECT campaign, tier, metric, reference, n_cases, rms, largest, tradeoff_id FROM error_bars"
      " WHERE campaign = ? ORDER BY tier, metric",
      campaign);
}

std::vector<TradeRecord> Store::trades() const {
  using Text = std::string;
  std::vector<TradeRecord> all;
  for (const auto& [id, at, source, campaign, version, report] :
       connection_->rows<std::tuple<std::int64_t, double, Text, Text, Text, Text>>(
           "SELECT id, at, source, campaign, program_version, report FROM tradeoffs"
           " ORDER BY id DESC"))
    all.push_back({at, source, campaign, version, report, {}, id});
  return all;
}

}  // namespace faultsweep
