#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "simulator/model/fault_operator.h"
#include "simulator/model/influence.h"

namespace faultsim {

/// Writes an influence block with the faults and observation points that its numbers belong to, as
/// schemas/result_layout.md says. Complete or not at all; throws StorageError (disk full, ...).
/// @pre op is the block's operator.
void write_influence(const InfluenceBlock& block, const FaultOperator& op,
                     const std::filesystem::path& path);

/// Opens the file if it is there and holds the block of that fingerprint; P is mapped read-only. As
/// with operators (operator_cache.h), what is damaged is moved aside with a note in `remark` and
/// counts as absent.
std::optional<InfluenceBlock> read_influence(const std::filesystem::path& path,
                                             const std::string& fingerprint,
                                             std::string* remark = nullptr);

}  // namespace faultsim
