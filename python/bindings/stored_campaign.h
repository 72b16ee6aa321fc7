#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "campaign/store/store.h"
#include "python/bindings/kept_result.h"

namespace faultsim::python {

/// A campaign of a store that is open for reading. Every question sees the store as it is then, but
/// for the counts, which are those of the last refresh().
struct StoredCampaign {
  /// @param name  "" = the newest. Throws StorageError, or InputError that lists the names.
  StoredCampaign(const std::string& folder, const std::string& name);

  faultsweep::Store store;
  faultsweep::CampaignInfo info;

  void refresh();
  /// "cases", "done", "waiting", "failed", "complete" and how many.
  std::vector<std::pair<std::string, long>> counts() const;
  /// By position from 1, or by the beginning of its identity. Throws InputError.
  faultsweep::StoredCase case_named(const std::string& name) const;

  /// A parameter of a case: name, value in SI (none: words), text as given.
  using Parameter = std::tuple<std::string, std::optional<double>, std::string>;
  /// What is known of a case without its history: position, identity, state, whether it has a
  /// result, where its fields are or would be, parameters.
  using Summary =
      std::tuple<long, std::string, std::string, bool, std::string, std::vector<Parameter>>;
  Summary summary(const std::string& name) const;
  /// The result as stored, without fields; null where there is none.
  std::shared_ptr<KeptResult> result_of(const std::string& name) const;
  /// A chart of it as SVG, as of `faultsweep plot`. Throws InputError.
  std::string draw_case(const std::string& name, const std::string& chart, const std::string& fault,
                        std::optional<int> step, const std::string& show) const;
};

}  // namespace faultsim::python
