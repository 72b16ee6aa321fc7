#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// The result of a flow simulator as it was read.
struct FieldFile {
  std::shared_ptr<const FlowField> field;
  std::string fingerprint;  ///< of the bytes that were read.
};

/// Reads a flow result by the kind of its file: EGRID and restart files (eclipse_result.h), else a
/// table of cells (flow_csv.h). Files may be larger than the memory: of restarts the one array of
/// each report is read, tables above 1 GB are read where they lie. What was read last is kept, up
/// to some 1 GB, and given again while the file's size and time stay what they were: the cases of
/// an ensemble take turns among a few files. Safe to call from several threads, which take turns.
/// @throws InputError with all that is wrong with the file.
FieldFile read_field_file(const std::filesystem::path& path, FlowQuantity quantity);

}  // namespace faultsim
