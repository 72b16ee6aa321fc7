#pragma once

#include <string>

namespace faultsim {

/// "PROGRAM VERSION (commit ABBREVIATED)", with "-dirty" where tracked files differ from it and
/// "unknown" where there was no git. For people: no result, identity or fingerprint has it.
std::string version_text(const std::string& program);

}  // namespace faultsim
