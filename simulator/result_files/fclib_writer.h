#pragma once

#include <filesystem>
#include <string>

#include "simulator/model/frictional_contact.h"

namespace faultsim {

/// What a file says about its problem.
struct FrictionalContactInfo {
  std::string title;
  std::string description;
  std::string math_info;  ///< what is known of existence, uniqueness, W.
};

/// Writes an HDF5 file in the layout of FCLib ("fclib_local": W by compressed columns, all entries;
/// q, mu, spacedim, info) and, if given, the solution; FCLib's readers open it. The units stand as
/// attributes of the vectors and in /faultsim. Replaces an older file; leaves nothing behind when
/// it throws StorageError. @pre sizes agree, everything is finite, (d n)² < 2³¹ (InternalError).
void write_fclib(const std::filesystem::path& path, const FrictionalContactProblem& problem,
                 const FrictionalContactInfo& info, const FrictionalContactSolution* solution);

}  // namespace faultsim
