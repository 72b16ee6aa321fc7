#include "simulator/operators/memory.h"

#include <gtest/gtest.h>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

Plan plan_of(double bytes) {
  Plan plan;
  plan.memory_bytes = bytes;
  plan.n_unknowns = 391320;
  plan.n_jump = 2880;
  return plan;
}

TEST(DemandMemory, SaysWhatIsNeededWhatThereIsAndTheCure) {
  EXPECT_NO_THROW(require_memory(plan_of(8e9), 8e9));
  EXPECT_NO_THROW(require_memory(plan_of(8e9), std::nullopt));
  try {
    require_memory(plan_of(8.04e9), 7.5e9);
    FAIL() << "accepted";
  } catch (const ResourceError& error) {
    const std::string text = error.what();
    for (const char* part : {"8.0 GB", "7.5 GB", "391320", "2880", "coarser tier", "plane strain",
                             "or go without an operator (faultsim run --path automatic)"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
  }
  Plan plane = plan_of(8e9);
  plane.plane_strain = true;
  try {
    require_memory(plane, 1e9, false);
    FAIL() << "accepted";
  } catch (const ResourceError& error) {
    EXPECT_NE(std::string(error.what()).find("larger cells"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find("plane strain"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find("without an operator"), std::string::npos);
  }
}

}  // namespace
}  // namespace faultsim
