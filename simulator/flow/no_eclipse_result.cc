#include "simulator/common/errors.h"
#include "simulator/flow/eclipse_grid.h"
#include "simulator/flow/eclipse_result.h"

/// In place of eclipse_result.cc and eclipse_grid.cc where opm-common was not there to build them
/// with.
namespace faultsim {
namespace {

constexpr const char* kNoOpmCommon =
    "this program was built without opm-common, which reads such files";

}  // namespace

bool reads_eclipse() { return false; }

FlowField read_eclipse(const std::filesystem::path& path, FlowQuantity) {
  throw InputError(path.string(), kNoOpmCommon,
                   "install libopm-common-dev and build again, or give a table of cells as CSV");
}

EclipseGrid read_eclipse_grid(const std::filesystem::path& path) {
  throw InputError(path.string(), kNoOpmCommon, "install libopm-common-dev and build again");
}

}  // namespace faultsim
