#include "simulator/common/version.h"

#include "commit.h"

namespace faultsim {

std::string version_text(const std::string& program) {
  return program + " " FAULTSIM_VERSION " (commit " FAULTSIM_COMMIT ")";
}

}  // namespace faultsim
