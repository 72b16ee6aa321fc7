// Open MPI never frees some of what it takes when it starts, and unloads the modules that took it,
// so that no suppression by name finds them. Under the leak sanitizer it is started unwatched.

#include <gtest/gtest.h>

#include "simulator/coupled/start_hypre.h"

extern "C" {
void __lsan_disable() __attribute__((weak));
void __lsan_enable() __attribute__((weak));
}

namespace faultsim {
namespace {

class UnwatchedStart final : public testing::Environment {
 public:
  void SetUp() override {
    if (__lsan_disable != nullptr) __lsan_disable();
    start_hypre();
    if (__lsan_enable != nullptr) __lsan_enable();
  }
};

const testing::Environment* const environment =
    testing::AddGlobalTestEnvironment(new UnwatchedStart);

TEST(Hypre, StartsOnce) {
  start_hypre();
  start_hypre();
  EXPECT_NE(environment, nullptr);
}

}  // namespace
}  // namespace faultsim
