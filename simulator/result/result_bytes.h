#pragma once

#include <string>
#include <string_view>

#include "simulator/result/result.h"

/// A result as bytes, for processes that were built from the same sources and run on like machines:
/// numbers as they are in memory, in the order of result_fields.h, behind the fingerprints of that
/// list and of the bytes.
namespace faultsim {

/// Fingerprint of the list of fields: programs that differ in it cannot read each other's results.
const std::string& result_layout();
std::string result_to_bytes(const CaseResult& result);
/// Throws StorageError saying why where the bytes are not as they were written: cut off, changed,
/// or of a program with other fields. Quick: 0.1 ns a byte.
void require_sound_result(std::string_view bytes);
/// Reads it back, checking that as well, and that every number is one. Throws StorageError.
CaseResult result_from_bytes(std::string_view bytes);

}  // namespace faultsim
