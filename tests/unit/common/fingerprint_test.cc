#include "simulator/common/fingerprint.h"

#include <gtest/gtest.h>

namespace faultsim {
namespace {

TEST(Fingerprint, IsXxh3With128Bits) {
  // The published value of the empty input: a changed algorithm would orphan every stored case.
  EXPECT_EQ(fingerprint(""), "99aa06d3014798d86001c324468d497f");
}

TEST(Fingerprint, DependsOnEveryByteAndNothingElse) {
  const std::string text = "abc";
  EXPECT_EQ(fingerprint(text), fingerprint(text.data(), 3));
  EXPECT_NE(fingerprint("abc"), fingerprint("abd"));
  EXPECT_NE(fingerprint(std::string_view("abc\0", 4)), fingerprint("abc"));
  EXPECT_EQ(fingerprint(std::string(100000, 'x')).size(), 32U);
}

}  // namespace
}  // namespace faultsim
