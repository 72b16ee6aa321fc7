#include "simulator/common/errors.h"
#include "simulator/flow/eclipse_result.h"

/// In place of eclipse_result.cc where opm-common was not there to build it with.
namespace faultsim {

bool reads_eclipse() { return false; }

FlowField read_eclipse(const std::filesystem::path& path, FlowQuantity) {
  throw InputError(path.string(),
                   "this program was built without opm-common, which reads such files",
                   "install libopm-common-dev and build again, or give a table of cells as CSV");
}

}  // namespace faultsim
