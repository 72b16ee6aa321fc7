#include "campaign/statistics/calibrated_share.h"

#include <algorithm>

#include "campaign/common/names.h"

namespace faultsweep {
namespace {

PredictedShare share_of(std::span<const Flag> flags, const StandardFeatures& features,
                        Flag least_that_holds) {
  const std::vector holds =
      mapped(flags, [&](Flag one) { return one >= least_that_holds ? 1.0 : 0.0; });
  return {holds, cross_fitted(features, holds, Dependence::logistic)};
}

}  // namespace

Estimate CalibratedShare::estimate(double confidence) const {
  Estimate found = as_computed.estimate(confidence);
  found.bounds.low = std::min(found.bounds.low, least.estimate(confidence).bounds.low);
  found.bounds.high = std::max(found.bounds.high, most.estimate(confidence).bounds.high);
  return found;
}

Estimate CalibratedShare::direct(double confidence) const {
  Estimate found = as_computed.direct(confidence);
  found.bounds.low = least.direct(confidence).bounds.low;
  found.bounds.high = most.direct(confidence).bounds.high;
  return found;
}

double CalibratedShare::by_number(double confidence) const {
  return half_width(as_computed.estimate(confidence));
}

double CalibratedShare::by_undecided(double confidence) const {
  return 0.5 * (most.estimate(confidence).value - least.estimate(confidence).value);
}

CalibratedShare calibrated_share(std::span<const Flag> flags, const StandardFeatures& features) {
  const PredictedShare as_computed = share_of(flags, features, Flag::undecided_yes);
  const auto is_open = [](Flag one) {
    return one == Flag::undecided_no || one == Flag::undecided_yes;
  };
  const auto n_undecided = static_cast<std::size_t>(std::ranges::count_if(flags, is_open));
  if (n_undecided == 0) return {as_computed, as_computed, as_computed, 0};
  return {as_computed, share_of(flags, features, Flag::yes),
          share_of(flags, features, Flag::undecided_no), n_undecided};
}

}  // namespace faultsweep
