#include "simulator/linalg/blas_kernel.h"

#include <gtest/gtest.h>

#include <set>

namespace faultsim {
namespace {

using Names = std::set<std::string>;

std::string chosen(const std::string& taken, VectorSet processor, const Names& library) {
  return wider_kernel(taken, processor,
                      [&](const std::string& name) { return library.count(name) > 0; })
      .value_or("");
}
const Names kDebian12 = {"Prescott", "Nehalem",  "Sandybridge", "Haswell",
                         "Zen",      "SkylakeX", "Cooperlake"};

TEST(WiderKernel, IsTheWidestThatLibraryAndProcessorHave) {
  EXPECT_EQ(chosen("Prescott", VectorSet::avx512, kDebian12), "SkylakeX");
  EXPECT_EQ(chosen("Prescott", VectorSet::avx2, kDebian12), "Haswell");
  EXPECT_EQ(chosen("Prescott", VectorSet::avx, kDebian12), "Sandybridge");
  EXPECT_EQ(chosen("Haswell", VectorSet::avx512, kDebian12), "SkylakeX");
  EXPECT_EQ(chosen("Prescott", VectorSet::avx512, {"Prescott", "Haswell"}), "Haswell");
}

TEST(WiderKernel, LeavesAChoiceThatIsAsWide) {
  EXPECT_EQ(chosen("Prescott", VectorSet::sse, kDebian12), "");
  EXPECT_EQ(chosen("Zen", VectorSet::avx2, kDebian12), "");
  EXPECT_EQ(chosen("Cooperlake", VectorSet::avx512, kDebian12), "");
  EXPECT_EQ(chosen("Prescott", VectorSet::avx512, {"Prescott"}), "");
}

TEST(WiderKernel, LeavesAKernelThatItDoesNotKnow) {
  EXPECT_EQ(chosen("GraniteRapids", VectorSet::avx512, kDebian12), "");
}

TEST(VectorSet, OfKernelsIgnoresTheCase) {
  EXPECT_EQ(vector_set_of_kernel("skylakex"), VectorSet::avx512);
  EXPECT_EQ(vector_set_of_kernel("HASWELL"), VectorSet::avx2);
  EXPECT_FALSE(vector_set_of_kernel("").has_value());
}

}  // namespace
}  // namespace faultsim
