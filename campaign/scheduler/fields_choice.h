#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaign/store/store.h"

namespace faultsweep {

/// Whose fields a campaign that keeps those of the cases shown first is to add.
struct FieldsChoice {
  std::vector<std::int64_t> cases;    ///< ids.
  std::vector<long> positions;        ///< of them.
  std::vector<std::string> left_out;  ///< sentences: of which case they are not, and why.
};

/// What fields that nobody asked for may take of a case, s: longer builds and runs are left out.
inline constexpr double kMostForFields = 60;

/// Of the cases shown first those whose fields are neither there nor have failed before and come
/// cheaply: their operators are on file or built within kMostForFields, and so is the case run.
FieldsChoice choose_fields(const Store& store, const CampaignInfo& campaign,
                           const std::vector<std::int64_t>& first);

/// Whether an operator of that fingerprint ("" = not known) lies in the store's cache.
bool is_cached_operator(const Store& store, const std::string& fingerprint);

}  // namespace faultsweep
