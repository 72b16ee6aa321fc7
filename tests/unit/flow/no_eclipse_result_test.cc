// In place of eclipse_result_test.cc and eclipse_grid_test.cc where opm-common was not there to
// build with: what such a program says of these files, and that the rest was not tested.
#include <gmock/gmock.h>

#include "simulator/common/errors.h"
#include "simulator/flow/eclipse_grid.h"
#include "simulator/flow/eclipse_result.h"

namespace faultsim {
namespace {

TEST(EclipseResult, IsRefusedWithACureWithoutOpmCommon) {
  EXPECT_FALSE(reads_eclipse());
  EXPECT_THAT([] { read_eclipse("CASE.EGRID", FlowQuantity::pressure); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("install libopm-common-dev")));
}

TEST(EclipseGridFile, IsRefusedWithACureWithoutOpmCommon) {
  EXPECT_THAT([] { read_eclipse_grid("CASE.EGRID"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("install libopm-common-dev")));
}

TEST(EclipseResult, IsRead) { GTEST_SKIP() << "built without opm-common (libopm-common-dev)"; }

}  // namespace
}  // namespace faultsim
