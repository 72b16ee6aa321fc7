#include "campaign/tradeoff/trade.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"

namespace faultsweep {

namespace {

constexpr double kLeastOrder = 0.5, kLargestOrder = 4;
constexpr double kSameTime = 1e-9;  // relative

bool holds(double order) { return order >= kLeastOrder && order <= kLargestOrder; }

bool same_time(double a, double b) { return std::abs(a - b) <= kSameTime * std::max(a, b); }

const faultsim::StepResult* step_at(const CaseResult& result, double time) {
  for (const faultsim::StepResult& step : result.steps) {
    if (same_time(step.time, time) && faultsim::in_equilibrium(step.outcome)) return &step;
  }
  return nullptr;
}

std::optional<double> chi_at(const CaseResult& result, double time, const std::string& fault) {
  const faultsim::StepResult* step = step_at(result, time);
  if (step == nullptr) return std::nullopt;
  for (std::size_t f = 0; f < result.fault_names.size() && f < step->faults.size(); ++f) {
    if (result.fault_names[f] == fault) return step->faults[f].chi_bar;
  }
  return std::nullopt;
}

/// Load steps and faults that all of them have.
std::vector<ChiHistory::Place> common_places(const std::vector<const CaseResult*>& results) {
  std::vector<ChiHistory::Place> places;
  if (results.empty()) return places;
  for (const faultsim::StepResult& step : results.front()->steps) {
    for (const std::string& fault : results.front()->fault_names) {
      const bool everywhere = std::ranges::all_of(
          results, [&](const auto* one) { return chi_at(*one, step.time, fault).has_value(); });
      if (everywhere) places.push_back({step.time, step.stage, fault, step.step});
    }
  }
  return places;
}

std::vector<double> chi_of(const CaseResult& result, const std::vector<ChiHistory::Place>& places) {
  return mapped(places,
                [&](const auto& place) { return *chi_at(result, place.time, place.fault); });
}

double root_mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return a.empty() ? 0 : std::sqrt(sum / static_cast<double>(a.size()));
}

std::size_t place_of_largest_difference(const std::vector<double>& a,
                                        const std::vector<double>& b) {
  std::size_t place = 0;
  for (std::size_t k = 1; k < a.size(); ++k) {
    if (std::abs(a[k] - b[k]) > std::abs(a[place] - b[place])) place = k;
  }
  return place;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty()) return kUnknown;
  const std::size_t k = place_of_largest_difference(a, b);
  return std::abs(a[k] - b[k]);
}

std::string in_words(const ChiHistory::Place& place) {
  return concat(place.fault, ", ", place.stage, ", step ", place.step);
}

TradeMetrics metrics_of(const CaseResult& result) {
  const faultsim::StageMetrics& whole = result.whole;
  const faultsim::FaultOnset* onset = first_activation(whole);
  const auto change = onset != nullptr ? leading_change(onset->pressures) : std::nullopt;
  return {whole.activated ? change.value_or(0) : kUnknown, whole.activated_area, whole.max_slip,
          whole.moment};
}

/// (value − reference)/reference; nothing to compare where both are 0.
double relative(double value, double reference) {
  if (value == reference) return 0;
  return reference == 0 ? kUnknown : (value - reference) / std::abs(reference);
}

/// Fills one table from what was run.
class TableMaker {
 public:
  TableMaker(const TradeAxis& axis, const std::vector<TradeRun>& runs) {
    table_.axis = axis;
    for (std::size_t k = 0; k < axis.choices.size(); ++k) {
      TradeRow row{axis.choices[k], runs.at(k), {}, {}, kUnknown, false};
      if (row.run.result) row.metrics = metrics_of(*row.run.result);
      table_.rows.push_back(std::move(row));
    }
  }

  TradeTable make() {
    std::vector<const CaseResult*> results;
    for (const TradeRow& row : table_.rows) {
      if (row.run.result) results.push_back(&*row.run.result);
    }
    table_.reference_history.places = common_places(results);
    choose_reference();
    if (!table_.reference.empty()) {
      for (TradeRow& row : table_.rows) compare(row);
    }
    return std::move(table_);
  }

 private:
  const std::vector<ChiHistory::Place>& places() const { return table_.reference_history.places; }
  std::vector<double> chi(const TradeRow& row) const { return chi_of(*row.run.result, places()); }

  void choose_reference() {
    if (table_.axis.converges && extrapolate()) return;
    const TradeRow* last = nullptr;
    for (const TradeRow& row : table_.rows) {
      if (!row.run.result) continue;
      if (table_.axis.reference.empty() || row.choice.name == table_.axis.reference) last = &row;
    }
    if (last == nullptr) return;
    table_.reference = last->choice.name;
    table_.reference_history.chi = chi(*last);
    table_.limits = last->metrics;
  }

  /// From the three finest choices, if each halves the one before.
  bool extrapolate() {
    std::vector<const TradeRow*> refined;
    for (const TradeRow& row : table_.rows) {
      if (row.run.result && row.choice.size > 0) refined.push_back(&row);
    }
    if (refined.size() < 3) return false;
    const TradeRow* f[3] = {refined[refined.size() - 3], refined[refined.size() - 2],
                            refined.back()};
    for (int k = 0; k < 2; ++k) {
      if (std::abs(f[k]->choice.size / f[k + 1]->choice.size - 2) > 1e-6) return false;
    }
    table_.chi = limit_of(chi(*f[0]), chi(*f[1]), chi(*f[2]));
    table_.reference_history.chi = table_.chi.chi;
    table_.chi_uncertainty = table_.chi.uncertainty;
    const auto limit = [&](double TradeMetrics::*member) {
      return limit_of(f[0]->metrics.*member, f[1]->metrics.*member, f[2]->metrics.*member).value;
    };
    table_.limits = {limit(&TradeMetrics::activation_pressure), limit(&TradeMetrics::area),
                     limit(&TradeMetrics::slip), limit(&TradeMetrics::moment)};
    table_.reference = table_.chi.extrapolated
                           ? concat("extrapolated from ", f[0]->choice.name, ", ",
                                    f[1]->choice.name, ", ", f[2]->choice.name)
                           : f[2]->choice.name;
    return true;
  }

  void compare(TradeRow& row) const {
    if (!row.run.result || places().empty()) return;
    const std::vector<double> own = chi(row);
    const std::size_t k = place_of_largest_difference(own, table_.reference_history.chi);
    row.error.chi = std::abs(own[k] - table_.reference_history.chi[k]);
    row.error.where = in_words(places()[k]);
    row.error.activation_flips = std::isnan(row.metrics.activation_pressure) !=
                                 std::isnan(table_.limits.activation_pressure);
    row.error.activation_pressure =
        row.metrics.activation_pressure - table_.limits.activation_pressure;
    row.error.area = relative(row.metrics.area, table_.limits.area);
    row.error.slip = relative(row.metrics.slip, table_.limits.slip);
    row.error.moment = relative(row.metrics.moment, table_.limits.moment);
  }

  TradeTable table_;
};

/// The references of two axes at the places that both have.
struct CommonHistory {
  std::vector<ChiHistory::Place> places;
  std::vector<double> a, b;
};
CommonHistory common_history(const ChiHistory& a, const ChiHistory& b) {
  CommonHistory common;
  for (std::size_t i = 0; i < a.places.size() && i < a.chi.size(); ++i) {
    for (std::size_t k = 0; k < b.places.size() && k < b.chi.size(); ++k) {
      if (!same_time(a.places[i].time, b.places[k].time)) continue;
      if (a.places[i].fault != b.places[k].fault) continue;
      common.places.push_back(a.places[i]);
      common.a.push_back(a.chi[i]);
      common.b.push_back(b.chi[k]);
    }
  }
  return common;
}

bool is_plane_strain(const TradeTable& table) {
  return std::ranges::any_of(table.rows, [](const TradeRow& row) {
    return row.run.result && row.run.result->plane_strain;
  });
}

/// The axis of the dearest meshes that has a reference.
const TradeTable* dearest_meshes(const std::vector<TradeTable>& tables) {
  const TradeTable* dearest = nullptr;
  for (const TradeTable& table : tables) {
    if (table.axis.is_mesh && !table.reference.empty()) dearest = &table;
  }
  return dearest;
}

const TradeTable* mesh_table(const std::vector<TradeTable>& tables, bool plane_strain) {
  for (const TradeTable& table : tables) {
    const bool is_one = table.axis.is_mesh && !table.reference.empty();
    if (is_one && is_plane_strain(table) == plane_strain) return &table;
  }
  return nullptr;
}

ChiHistory history_of(const TradeTable& table, const TradeRow& row) {
  const auto& places = table.reference_history.places;
  return {places, chi_of(*row.run.result, places)};
}

/// From the cells that both axes have, finest last.
std::optional<PlaneStrainCost> compare_dimensions(const TradeTable& plane,
                                                  const TradeTable& space) {
  PlaneStrainCost cost;
  std::vector<double> previous;
  for (const TradeRow& in_space : space.rows) {
    for (const TradeRow& in_plane : plane.rows) {
      const double size = in_space.choice.size;
      if (std::abs(in_plane.choice.size - size) > 1e-6 * size) continue;
      if (!in_plane.run.result || !in_space.run.result) continue;
      const CommonHistory common =
          common_history(history_of(plane, in_plane), history_of(space, in_space));
      if (common.places.empty()) continue;
      const std::size_t k = place_of_largest_difference(common.a, common.b);
      previous = std::move(cost.difference.chi);
      cost.difference = {common.places, {}};
      for (std::size_t i = 0; i < common.a.size(); ++i)
        cost.difference.chi.push_back(common.b[i] - common.a[i]);
      cost.cells = size;
      cost.plane = common.a[k];
      cost.space = common.b[k];
      cost.where = in_words(common.places[k]);
      cost.activation_pressure =
          in_plane.metrics.activation_pressure - in_space.metrics.activation_pressure;
      cost.activation_flips = std::isnan(in_plane.metrics.activation_pressure) !=
                              std::isnan(in_space.metrics.activation_pressure);
      if (previous.size() == common.a.size())
        cost.uncertainty = largest_difference(previous, cost.difference.chi);
    }
  }
  if (std::isnan(cost.cells)) return std::nullopt;
  return cost;
}

MeshReference reference_of_meshes(const Trade& trade) {
  const TradeTable* dearest = dearest_meshes(trade.tables);
  if (dearest == nullptr) return {};
  MeshReference own{concat(dearest->axis.name, ": ", dearest->reference),
                    dearest->reference_history, dearest->chi_uncertainty};
  const TradeTable* plane = mesh_table(trade.tables, true);
  if (!trade.plane_strain || plane == nullptr) return own;
  const double uncertainty = plane->chi_uncertainty + trade.plane_strain->uncertainty;
  if (std::isnan(uncertainty) || own.uncertainty <= uncertainty) return own;
  const CommonHistory common =
      common_history(plane->reference_history, trade.plane_strain->difference);
  MeshReference composed{
      concat("plane strain (", plane->reference, ") plus the difference of 3D at ", "cells of ",
             trade.plane_strain->cells, " m"),
      {common.places, common.a},
      uncertainty};
  for (std::size_t k = 0; k < common.a.size(); ++k) composed.history.chi[k] += common.b[k];
  return composed;
}

void judge_meshes(Trade& trade) {
  std::vector<TradeRow*> meshes;
  for (TradeTable& table : trade.tables) {
    if (!table.axis.is_mesh) continue;
    for (TradeRow& row : table.rows) {
      if (!row.run.result) continue;
      const CommonHistory common = common_history(history_of(table, row), trade.reference.history);
      row.total_chi = largest_difference(common.a, common.b);
      if (!std::isnan(row.total_chi) && !std::isnan(row.seconds())) meshes.push_back(&row);
    }
  }
  for (TradeRow* row : meshes) {
    row->on_front = std::ranges::none_of(meshes, [&](const TradeRow* other) {
      return other != row && other->seconds() <= row->seconds() &&
             other->total_chi <= row->total_chi;
    });
  }
}

}  // namespace

Limit limit_of(double coarse, double middle, double fine) {
  Limit limit;
  limit.order = std::log2(std::abs(coarse - middle) / std::abs(middle - fine));
  const bool monotone = (coarse - middle) * (middle - fine) > 0;
  limit.extrapolated = monotone && holds(limit.order);
  limit.value = fine;
  limit.uncertainty = std::abs(fine - middle);
  if (limit.extrapolated) {
    limit.value = fine + (fine - middle) / (std::exp2(limit.order) - 1);
    limit.uncertainty = std::abs(limit.value - fine);
  }
  return limit;
}

HistoryLimit limit_of(const std::vector<double>& coarse, const std::vector<double>& middle,
                      const std::vector<double>& fine) {
  FAULTSIM_DEMAND(coarse.size() == fine.size() && middle.size() == fine.size(), fine.size());
  HistoryLimit limit;
  limit.order = std::log2(root_mean_square_difference(coarse, middle) /
                          root_mean_square_difference(middle, fine));
  limit.extrapolated = holds(limit.order);
  limit.chi = fine;
  if (!limit.extrapolated) {
    limit.uncertainty = largest_difference(middle, fine);
    return limit;
  }
  const double factor = 1 / (std::exp2(limit.order) - 1);
  for (std::size_t k = 0; k < fine.size(); ++k) limit.chi[k] += factor * (fine[k] - middle[k]);
  limit.uncertainty = largest_difference(limit.chi, fine);
  return limit;
}

Trade make_trade(const std::vector<TradeAxis>& axes,
                 const std::vector<std::vector<TradeRun>>& runs) {
  Trade trade;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    trade.tables.push_back(TableMaker(axes[a], runs.at(a)).make());
  }
  const TradeTable* plane = mesh_table(trade.tables, true);
  const TradeTable* space = mesh_table(trade.tables, false);
  if (plane != nullptr && space != nullptr) trade.plane_strain = compare_dimensions(*plane, *space);
  trade.reference = reference_of_meshes(trade);
  judge_meshes(trade);
  return trade;
}

const TradeRow* recommended(const Trade& trade, double wanted_chi) {
  const TradeRow* best = nullptr;
  for (const TradeTable& table : trade.tables) {
    for (const TradeRow& row : table.rows) {
      if (!(row.total_chi <= wanted_chi)) continue;
      if (best == nullptr || row.seconds() < best->seconds()) best = &row;
    }
  }
  return best;
}

}  // namespace faultsweep
