#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

void Store::record_trade(const TradeRecord& trade) {
  Connection& db = *connection_;
  Transaction transaction(db);
  db.prepared(
        "INSERT INTO tradeoffs (at, source, campaign, program_version, report)"
        " VALUES (?, ?, ?, ?, ?)")
      .bind(trade.at, trade.source, trade.campaign, trade.program_version, trade.report)
      .run();
  const std::int64_t id = db.last_insert_id();
  for (const ErrorBar& bar : trade.error_bars) {
    db.prepared(
          "INSERT OR REPLACE INTO error_bars (campaign, tier, metric, reference, n_cases, rms,"
          " largest, tradeoff_id) VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(bar.campaign, bar.tier, bar.metric, bar.reference, bar.n_cases, bar.rms, bar.largest,
              id)
        .run();
  }
  transaction.commit();
}

std::vector<ErrorBar> Store::error_bars(const std::string& campaign) const {
  std::vector<ErrorBar> all;
  Statement rows = connection_->prepared(
      "SELECT campaign, tier, metric, reference, n_cases, rms, largest FROM error_bars"
      " WHERE campaign = ? ORDER BY tier, metric");
  rows.bind(campaign);
  while (rows.step()) {
    ErrorBar& bar = all.emplace_back();
    rows.read(bar.campaign, bar.tier, bar.metric, bar.reference, bar.n_cases, bar.rms, bar.largest);
  }
  return all;
}

}  // namespace faultsweep
