#pragma once

#include <optional>
#include <vector>

#include "campaign/common/names.h"

/// How far a value may go before something happens: a search by coarse scan and bisection, as pure
/// functions of the points that are known. Numbers only: a point is safe where the condition is
/// false and unsafe where it is true.
namespace faultsweep {

enum class PointState {
  safe,
  unsafe,
  unknown,  ///< its case failed, ended early, or was excluded.
};

/// A value that was tried.
struct SearchPoint {
  double value = 0;
  PointState state = PointState::unknown;
  bool resolved = true;  ///< its state does not depend on cells and stated errors.
  long position = 0;     ///< of its case in the campaign, from 1; 0 = it has none.
};

/// Two known points of different state with no known one between them: the change is in there.
struct Crossing {
  SearchPoint before, after;  ///< in the direction of the search.
  int n_unknown = 0;          ///< points between them that were tried in vain.
  bool narrow = false;        ///< as wide as the tolerance or less.
  double width() const;
  bool is_limit() const { return before.state == PointState::safe; }
};

/// What the points say.
enum class LimitVerdict {
  unknown,            ///< no point is known, or that of the safe end is not.
  safe_throughout,    ///< every known point is safe.
  unsafe_throughout,  ///< every known point is unsafe.
  limit,              ///< safe up to one crossing and unsafe behind it.
  non_monotone,       ///< unsafe at the safe end, or safe again behind unsafe values.
};
constexpr auto words(LimitVerdict) {
  return std::array{"not known", "safe throughout", "unsafe throughout", "limit", "non-monotone"};
}

struct LimitFinding {
  LimitVerdict verdict = LimitVerdict::unknown;
  std::vector<SearchPoint> points;  ///< in the direction of the search.
  std::vector<Crossing> crossings;  ///< in the direction of the search.
  int n_unknown = 0;                ///< of the points.
  /// The crossing that ends the safe values at the safe end; none where there are no such, or no
  /// end of them.
  const Crossing* limit() const;
  /// The last known point with a resolved state that only safe ones with resolved states precede,
  /// and the first unsafe one with a resolved state behind the limit. They are those of limit()
  /// unless the cells leave open on which side of the limit a point is.
  std::optional<SearchPoint> surely_safe, surely_unsafe;
};

/// @param points     distinct values, in any order.
/// @param ascending  whether the values grow from the safe end to the other.
/// @param tolerance  > 0.
LimitFinding judge(std::vector<SearchPoint> points, bool ascending, double tolerance);

/// Unknown points in a crossing after which it is given up.
inline constexpr int kMostUnknown = 4;

/// The values to try next, in the direction of the search: one in each crossing that is not narrow.
/// It is the middle on a grid of spacing `tolerance` through `origin`, so that values are round and
/// searches share them; of a crossing with unknown points the middle of its widest gap. Empty where
/// nothing is left to do. The width of a crossing without unknown points halves, up to the grid.
std::vector<double> next_values(const LimitFinding& finding, double origin, double tolerance);

}  // namespace faultsweep
