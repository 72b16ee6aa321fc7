#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/tradeoff/trade.h"
#include "simulator/figure/log_chart.h"

namespace faultsweep {

/// All that `faultsweep tradeoff` found.
struct TradeReport {
  std::string title;   ///< of the scene.
  std::string source;  ///< its file.
  double wanted_chi = 0.02;
  Trade trade;
  std::vector<RankingTrade> rankings;
};

/// One sentence per question: plane strain, each tier in the ranking, steps of salt, and so on.
std::vector<std::string> trade_answers(const TradeReport& report);

std::string trade_to_text(const TradeReport& report, std::size_t width);  ///< for a screen.
std::string trade_to_markdown(const TradeReport& report);  ///< for a file beside the figures.
nlohmann::json trade_to_json(const TradeReport& report);   ///< SI; null where unknown.

/// Errors of χ̄ against cost and against size; without series where nothing has both.
struct TradeFigures {
  faultsim::figure::LogChart pareto, convergence;
};
/// @param trade  as trade_to_json has it, and the store keeps it.
TradeFigures trade_figures(const nlohmann::json& trade);

}  // namespace faultsweep
