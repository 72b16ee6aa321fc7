#include "tests/unit/statistics/tiers_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "campaign/statistics/calibrated_quantile.h"
#include "campaign/statistics/calibrated_share.h"
#include "campaign/statistics/control_variate.h"
#include "tests/unit/statistics/coverage_table.h"
#include "tests/unit/statistics/tier_models.h"

namespace faultsweep::testing {
namespace {

/// y = u + 0.1 u² and a cheap model of it.
void study_tiered_means(int repeats) {
  heading("Mean from two tiers (`tiered_mean`), 1000 cheap runs",
          "scatter of the cheap model | pairs");
  for (const double scatter : {0.05, 0.3, 2.0}) {
    for (const long n : {20L, kFewestPairsForTiers, 100L}) {
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      std::normal_distribution<double> normal;
      Tally tally;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<double> high, low;
        for (int i = 0; i < 1000; ++i) {
          const double u = normal(random);
          if (i < n) high.push_back(u + 0.1 * u * u);
          low.push_back(0.8 * u + 3 + scatter * normal(random));
        }
        tally.add(tiered_mean({high, low}, kConfidence).estimate.bounds, 0.1);
      }
      char text[40];
      std::snprintf(text, sizeof text, "%g", scatter);
      tally.print(text, sized(n, kFewestPairsForTiers));
    }
  }
}

constexpr std::size_t kCheapRuns = 1000;

std::string text_of(const char* before, double number) {
  char text[80];
  std::snprintf(text, sizeof text, "%s%g", before, number);
  return text;
}

struct NamedModel {
  std::string name;
  TierModel model;
};

std::vector<NamedModel> models_of_shares() {
  std::vector<NamedModel> all;
  for (const double correlation : {0.9985, 0.9, 0.0}) {
    for (const double share : {0.02, 0.1, 0.3, 0.5, 0.98}) {
      all.push_back({text_of("correlation ", correlation) + text_of(", share ", share),
                     {.correlation = correlation, .share = share}});
    }
  }
  all.push_back({"0.9985, share 0.3, 3 % turned round", {.share = 0.3, .turned = 0.03}});
  all.push_back({"0.9985, share 0.5, 10 % turned round", {.share = 0.5, .turned = 0.1}});
  all.push_back({"0.9985, share 0.5, 2 % more", {.share = 0.5, .only_there = 0.02}});
  all.push_back({"0.9985, share 0.3, 5 % more", {.share = 0.3, .only_there = 0.05}});
  all.push_back({"0.9985, share 0.05, 5 % more", {.share = 0.05, .only_there = 0.05}});
  all.push_back({"0.9985, share 0.3, cheap limit 0.2 too high", {.share = 0.3, .bias = 0.2}});
  all.push_back({"the same at both, share 0.02", {.correlation = 1, .share = 0.02}});
  all.push_back({"the same at both, share 0.3", {.correlation = 1, .share = 0.3}});
  return all;
}

void study_calibrated_shares(int repeats) {
  heading_beside_alone("Probability from two tiers (`calibrated_share`), 1000 cheap runs",
                       "models | pairs");
  for (const auto& [name, model] : models_of_shares()) {
    for (const long n : {20L, kFewestPairsForTiers, 100L, 200L}) {
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      Tally tally;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        const TierDraw draw(model, static_cast<std::size_t>(n), kCheapRuns, random);
        const CalibratedShare found = calibrated_share(draw.flags, draw.standard());
        tally.add(found.estimate(kConfidence).bounds, model.truth(),
                  found.as_computed.direct(kConfidence).bounds);
      }
      tally.print(name, sized(n, kFewestPairsForTiers));
    }
  }
}

/// Mean squared errors of the value, over that of the mean of the flags.
void study_variance_left(int repeats) {
  constexpr std::size_t kMany = 10'000;
  std::printf(
      "\n### What is left of the variance of a flag (`calibrated_share`), %zu cheap runs\n\n"
      "| models | pairs | from the cheap flag, %% | from its index and slip too, %% |\n"
      "|---|---|---|---|\n",
      kMany);
  const NamedModel models[] = {
      {"correlation 0.9985, share 0.1", {.share = 0.1}},
      {"correlation 0.9985, share 0.5", {.share = 0.5}},
      {"correlation 0.9985, share 0.3, cheap limit 0.2 too high", {.share = 0.3, .bias = 0.2}},
      {"correlation 0.9, share 0.3", {.correlation = 0.9, .share = 0.3}}};
  for (const auto& [name, model] : models) {
    for (const std::size_t n : {50u, 100u, 200u}) {
      std::mt19937_64 random(n);
      double by_flag = 0, by_all = 0, alone = 0;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        const TierDraw draw(model, n, kMany, random);
        const std::vector<std::vector<double>> flag = {draw.features[2]};
        const auto squared = [&, truth = model.truth()](const Estimate& e) {
          return std::pow(e.value - truth, 2);
        };
        const CalibratedShare all = calibrated_share(draw.flags, draw.standard());
        by_all += squared(all.estimate(kConfidence)), alone += squared(all.direct(kConfidence));
        by_flag += squared(calibrated_share(draw.flags, {flag, kMany}).estimate(kConfidence));
      }
      std::printf("| %s | %zu | %.0f | %.0f |\n", name.c_str(), n, 100 * by_flag / alone,
                  100 * by_all / alone);
    }
  }
}

/// An adversary makes all open flags come out as one value, whatever they are.
void study_undecided_shares(int repeats) {
  heading("Probability from two tiers with undecided flags (`calibrated_share`)",
          "share, undecided within | pairs");
  for (const double share : {0.1, 0.5}) {
    for (const double open : {0.05, 0.3}) {
      const TierModel model{.share = share, .open = open};
      for (const long n : {kFewestPairsForTiers, 200L}) {
        std::mt19937_64 random(static_cast<std::uint64_t>(n));
        for (const Flag came_out : {Flag::undecided_no, Flag::undecided_yes}) {
          Tally tally;
          for (int repeat = 0; repeat < repeats; ++repeat) {
            TierDraw draw(model, static_cast<std::size_t>(n), kCheapRuns, random);
            for (std::size_t i = 0; i < draw.flags.size(); ++i)
              if (draw.near[i]) draw.flags[i] = came_out;
            tally.add(calibrated_share(draw.flags, draw.standard()).estimate(kConfidence).bounds,
                      model.truth());
          }
          tally.print(text_of("", share) + text_of(", ", open) +
                          (came_out == Flag::undecided_no ? ", all as no" : ", all as yes"),
                      std::to_string(n));
        }
      }
    }
  }
}

/// Of the index, or of what of it is beyond 0.5: nothing in 69 % of the cases.
void study_calibrated_quantiles(int repeats) {
  heading_beside_alone("Quantiles from two tiers (`calibrated_quantile`), 1000 cheap runs",
                       "correlation, quantile | pairs");
  constexpr double kFrom = 0.5;
  const auto beyond = [](double x) { return std::max(0.0, x - kFrom); };
  for (const bool is_beyond : {false, true}) {
    for (const double correlation : {0.9985, 0.9, 0.0}) {
      for (const double q : {0.1, 0.5, 0.9}) {
        if (is_beyond && q < 0.9) continue;
        for (const long n : {kFewestPairsForTiers, 100L, 200L}) {
          std::mt19937_64 random(static_cast<std::uint64_t>(n));
          const double normal_truth = boost::math::quantile(boost::math::normal(), q);
          Tally tally;
          for (int repeat = 0; repeat < repeats; ++repeat) {
            TierDraw draw({.correlation = correlation}, static_cast<std::size_t>(n), kCheapRuns,
                          random);
            draw.features.resize(1);
            if (is_beyond) {
              for (double& one : draw.high) one = beyond(one);
              draw.features.push_back(draw.features[0]);
              for (double& one : draw.features[1]) one = beyond(one);
            }
            const CalibratedDistribution found(draw.high, draw.standard());
            const auto ends = [](const QuantileBounds& b) {
              return Interval{b.low.value_or(-kInfinity), b.high.value_or(kInfinity)};
            };
            tally.add(ends(found.quantile(q, kConfidence).bounds),
                      is_beyond ? beyond(normal_truth) : normal_truth,
                      ends(found.direct(q, kConfidence)));
          }
          tally.print(text_of("", correlation) + text_of(", ", q) +
                          (is_beyond ? " of what is beyond a limit" : ""),
                      std::to_string(n));
        }
      }
    }
  }
}

}  // namespace

void study_tiers(int repeats) {
  study_tiered_means(repeats);
  study_calibrated_shares(repeats);
  study_variance_left(std::max(1, repeats / 4));
  study_undecided_shares(repeats);
  study_calibrated_quantiles(repeats);
}

}  // namespace faultsweep::testing
