#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "simulator/model/operator_basis.h"
#include "simulator/result/result.h"

namespace faultsim {

/// A surface of operators and how far it is off the exact ones.
struct StoredSurface {
  std::shared_ptr<const OperatorBasis> basis;
  CaseSurface accuracy;
};

/// Writes folder/FINGERPRINT.h5, beside the operators and as one of them for listing and pruning
/// (operator_cache.h). Complete or not at all; throws StorageError (disk full, ...).
void write_surface(const StoredSurface& surface, const std::filesystem::path& folder);

/// Opens the file if it is there and sound; H of the centre and its directions are mapped
/// read-only, so processes share their pages. As with operators, what is damaged is moved aside
/// with a note in `remark` and counts as absent.
std::optional<StoredSurface> read_surface_file(const std::filesystem::path& folder,
                                               const std::string& fingerprint,
                                               std::string* remark = nullptr);

}  // namespace faultsim
