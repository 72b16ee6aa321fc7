#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "campaign/tradeoff/ladder.h"
#include "simulator/result/result.h"

/// What the choices of a ladder cost, and how far they are from what they converge to.
namespace faultsweep {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A choice as it was run.
struct TradeRun {
  std::optional<faultsim::CaseResult> result;  ///< a history to its end.
  std::string trouble;                         ///< why there is no result.
  double operator_seconds = kUnknown;          ///< measured, of all operators of the case.
  double case_seconds = kUnknown;              ///< measured, without the operator.
  double peak_bytes = kUnknown;                ///< measured, of the process.
};

/// Critical indices χ̄ at load steps and faults that all choices of an axis have.
struct ChiHistory {
  struct Place {
    double time = 0;  ///< s.
    std::string stage, fault;
    int step = 0;  ///< of the coarsest.
  };
  std::vector<Place> places;
  std::vector<double> chi;
};

/// The limit of a sequence f3, f2, f1 whose step is halved each time: order p = log2(|f3 − f2| /
/// |f2 − f1|), limit f1 + (f1 − f2)/(2^p − 1) (Richardson; Roache, J. Fluids Eng. 116 (1994) 405).
/// Where p is not within [0.5, 4] orders do not hold: the limit is f1, uncertain by |f1 − f2|.
struct Limit {
  bool extrapolated = false;
  double order = kUnknown;
  double value = kUnknown;
  double uncertainty = kUnknown;  ///< |value − f1|, or |f1 − f2|.
};
Limit limit_of(double coarse, double middle, double fine);

/// The same for a history as a whole: one order, from root mean squares. @pre equally long.
struct HistoryLimit {
  bool extrapolated = false;
  double order = kUnknown;
  std::vector<double> chi;
  double uncertainty = kUnknown;  ///< largest over the history.
};
HistoryLimit limit_of(const std::vector<double>& coarse, const std::vector<double>& middle,
                      const std::vector<double>& fine);

/// Metrics of the whole history.
struct TradeMetrics {
  double activation_pressure = kUnknown;  ///< Pa, change beside the first fault that slides, there
                                          ///< and then; unknown where none does.
  double area = kUnknown;                 ///< m2, activated (plane strain: m2 per metre).
  double slip = kUnknown;                 ///< m, largest.
  double moment = kUnknown;               ///< N m (plane strain: per metre of strike).
};

/// How far a choice is from the reference of its axis.
struct TradeError {
  double chi = kUnknown;  ///< largest |χ̄ − χ̄_ref| over load steps and faults.
  std::string where;      ///< "F2, cushion_gas_injection, step 11".
  bool activation_flips = false;
  double activation_pressure = kUnknown;  ///< Pa, signed.
  double area = kUnknown, slip = kUnknown,
         moment = kUnknown;  ///< relative to the reference, signed.
};

struct TradeRow {
  TradeChoice choice;
  TradeRun run;
  TradeMetrics metrics;
  TradeError error;
  /// χ̄ against Trade::reference: of axes of meshes only.
  double total_chi = kUnknown;
  bool on_front = false;  ///< no other mesh is as cheap and as accurate.
  double seconds() const { return run.operator_seconds + run.case_seconds; }
};

struct TradeTable {
  TradeAxis axis;
  std::vector<TradeRow> rows;
  std::string reference;  ///< in words: "extrapolated from 10 m, 5 m, 2.5 m".
  ChiHistory reference_history;
  HistoryLimit chi;                   ///< where it was extrapolated.
  TradeMetrics limits;                ///< of the reference.
  double chi_uncertainty = kUnknown;  ///< of the reference.
};

/// What plane strain changes, as plane strain minus 3D with the same cells: errors of the cells
/// cancel for the most part. Areas and moments do not compare.
struct PlaneStrainCost {
  double cells = kUnknown;                    ///< m, the finest that both were run with.
  double plane = kUnknown, space = kUnknown;  ///< χ̄ where they differ most.
  std::string where;
  bool activation_flips = false;
  double activation_pressure = kUnknown;  ///< Pa.
  double uncertainty = kUnknown;  ///< how much the difference changed at the last refinement.
  ChiHistory difference;          ///< 3D minus plane strain.
  double chi() const { return std::abs(plane - space); }
};

/// What all meshes are measured against. In plane strain: its own reference. In 3D the less
/// uncertain of two: the reference in 3D; the limit in plane strain plus (3D minus plane strain) at
/// the finest cells that both have, uncertain by the sum of what each is.
struct MeshReference {
  std::string text;
  ChiHistory history;
  double uncertainty = kUnknown;
};

struct Trade {
  std::vector<TradeTable> tables;
  std::optional<PlaneStrainCost> plane_strain;  ///< of a scene in 3D.
  MeshReference reference;
};

/// Errors of every axis, Pareto front of the meshes. @param runs  per axis and choice.
Trade make_trade(const std::vector<TradeAxis>& axes,
                 const std::vector<std::vector<TradeRun>>& runs);

/// The cheapest mesh whose χ̄ is within the wanted error of the reference; null = none is.
const TradeRow* recommended(const Trade& trade, double wanted_chi);

/// Two ways to model the same cases, as a ranking.
struct RankingTrade {
  std::string choice, reference;
  long n_cases = 0;                  ///< with a full history in both.
  std::optional<double> tau;         ///< Kendall's τ-b of the default order.
  long n_top = 0, n_top_common = 0;  ///< of the first n_top of the one, among those of the other.
  long n_flips = 0;                  ///< activated in one of them only.
  double chi_rms = kUnknown, chi_max = kUnknown;  ///< of the case's largest χ̄.
  double seconds = 0, reference_seconds = 0;      ///< of all cases with their operators.
};

}  // namespace faultsweep
