#pragma once

#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/answers/seen.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/weighted.h"

namespace faultsweep {

struct PosteriorRequest {
  std::vector<std::string> seen = {};        ///< statements: answers/seen.h.
  std::vector<std::string> conditions = {};  ///< as of `rank --where`; none = sliding, as of
                                             ///< `probability`.
  std::string where = {};                    ///< of which cases; "" = all.
  double confidence = 0.95;
};

/// A number before and after what was seen.
struct Update {
  std::string label;
  Estimate before, after;
};

/// Three quantiles of a parameter before and after, in its unit.
struct ParameterUpdate {
  std::string name, unit;
  std::vector<QuantileBounds> before, after;  ///< per kPosteriorQuantiles.
};
inline constexpr double kPosteriorQuantiles[] = {0.05, 0.5, 0.95};

struct Posterior {
  CampaignInfo campaign;
  PosteriorRequest request;
  Sampling sampling;
  std::vector<SeenStatement> seen;
  std::vector<double> agreement;  ///< per statement: mean of its likelihood over the cases.
  long n_rows = 0;                ///< with a history to its end.
  long n_unknown = 0;             ///< without.
  double effective_size = 0;      ///< of the n_rows, by their weights.
  long n_undecided = 0;           ///< of the n_rows: of which something that was seen, or is asked,
                                  ///< is open by the cells.
  std::vector<ParameterUpdate> parameters;  ///< those that are numbers and vary.
  std::vector<Update> words;                ///< "rule = mean": P of each word of the others.
  std::vector<Update> probabilities;
};

/// Weights each case by the likelihood of what was seen, the product over the statements: their
/// errors are taken to be independent. Cases are the prior: what is said is right as far as they
/// are a sample of it. Cases without a history to their end have their parameters, but their
/// likelihoods and conditions may be anything that what is known of them allows: estimates are of
/// the others, bounds reach over all of it, as those of `probability` do. What the cells leave open
/// (seen.h, likelihood_by_cells) counts in estimates as computed, and widens bounds likewise.
/// Where the cases are no sample (Sampling::is_random), bounds are by what is open alone. Throws
/// InputError where a statement or condition cannot be read, and where the effective sample size is
/// below kFewestEffective: then a few cases would speak for all.
Posterior find_posterior(const Store& store, const CampaignInfo& campaign,
                         const PosteriorRequest& request);
inline constexpr double kFewestEffective = 50;

/// Tables `seen`, `parameters`, `words`, `probabilities`.
Answer to_answer(const Posterior& posterior);

}  // namespace faultsweep
