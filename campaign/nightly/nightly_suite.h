#pragma once

#include <string>
#include <vector>

#include "campaign/nightly/agreement.h"

namespace faultsweep {

/// Cases of a stored campaign; its results are their baseline.
struct SampleRequest {
  std::string store, campaign;
  long top = 10;     ///< of the default ranking.
  long sample = 10;  ///< of the others.
  bool same_environment = true;
};

/// The suite of `faultsweep nightly`; meaning of each key: schemas/nightly.schema.json.
struct NightlySuite {
  std::string name, source;
  std::vector<std::string> campaigns;  ///< spec files, from the current folder.
  std::vector<std::string> verification;
  std::vector<SampleRequest> samples;
  Tolerances tolerances;
  bool is_empty() const { return campaigns.empty() && verification.empty() && samples.empty(); }
};

/// Throws InputError with all problems of the file.
NightlySuite read_nightly_suite(const std::string& path);

/// Which places of a ranking of n cases a sample takes, ascending from 0: the first `top`, and of
/// the rest one from each of `sample` parts of equal size, chosen by their keys (texts of their
/// own) alone.
std::vector<std::size_t> sampled_places(const std::vector<std::string>& keys, long top,
                                        long sample);

}  // namespace faultsweep
