#pragma once

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "campaign/statistics/calibrated_share.h"

/// A cheap and an expensive model of a fault that slides where its critical index exceeds a limit.
namespace faultsweep::testing {

/// Both indices are standard normal numbers; what is asked of the expensive one.
struct TierModel {
  double correlation = 0.9985;  ///< of the two indices.
  double share = 0.5;           ///< that slides at the expensive model, before what follows.
  double turned = 0;            ///< flags of the expensive model that are turned round, anywhere,
  double only_there = 0;        ///< or set, whatever the cheap model says.
  double bias = 0;              ///< by which the limit of the cheap model is too high.
  double open = 0;              ///< indices as near to the limit leave the flag open.

  double limit() const { return boost::math::quantile(boost::math::normal(), 1 - share); }
  /// P that the expensive model's flag is set.
  double truth() const {
    const double p = share + turned * (1 - 2 * share);
    return p + only_there * (1 - p);
  }
};

/// n members at both models, N at the cheap one.
struct TierDraw {
  std::vector<Flag> flags;                    ///< as the expensive model has them, n.
  std::vector<bool> near;                     ///< whether they are open, n.
  std::vector<double> high;                   ///< its index, n.
  std::vector<std::vector<double>> features;  ///< index, slip and flag of the cheap model; N each.

  TierDraw(const TierModel& model, std::size_t n, std::size_t all, std::mt19937_64& random)
      : features(3) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    const double limit = model.limit(), rest = std::sqrt(1 - std::pow(model.correlation, 2));
    for (std::size_t i = 0; i < all; ++i) {
      const double low = normal(random), index = model.correlation * low + rest * normal(random);
      const double beyond = low - limit - model.bias;
      features[0].push_back(low);
      features[1].push_back(std::max(0.0, beyond + 0.3 * uniform(random)));
      features[2].push_back(beyond > 0 ? 1 : 0);
      bool slides = index > limit;
      if (uniform(random) < model.turned) slides = !slides;
      if (uniform(random) < model.only_there) slides = true;
      if (i >= n) continue;
      flags.push_back(slides ? Flag::yes : Flag::no);
      near.push_back(std::abs(index - limit) < model.open);
      high.push_back(index);
    }
  }
  StandardFeatures standard() const { return {features, features[0].size()}; }
};

}  // namespace faultsweep::testing
