#pragma once

#include <optional>
#include <string>

#include "campaign/app/commands.h"
#include "campaign/query/ranking.h"

namespace faultsweep {

/// `rank --certify N`: the first cases of a ranking, as far as their operators are interpolated, on
/// exact ones; with a tier, all of them, with the cells of that tier.
struct CertifyRequest {
  RankRequest ranking;
  long n = 0;
  std::optional<int> n_workers;  ///< as for `run`.
  std::string metrics = "chi_bar,max_slip,activated_area";
  std::string tier = {};    ///< "" = the same cells.
  double tolerance = 1e-2;  ///< relative, above which a case counts as other.
};

/// Runs them as campaign NAME-exact, on the cells of their surfaces, and prints how both compare.
faultsim::ExitCode certify(const StoreArguments& common, const CertifyRequest& request);
/// Runs them as campaign NAME-first-TIER, and prints which come first there, and how surely.
faultsim::ExitCode certify_at_tier(const StoreArguments& common, const CertifyRequest& request);

}  // namespace faultsweep
