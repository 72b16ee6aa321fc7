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

TEST(Fingerprint, OfPiecesIsThatOfTheWhole) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += static_cast<char>(i * i % 251);
  for (const std::size_t n : {1UL, 7UL, 1000UL, 3000UL}) {
    FingerprintOfPieces print;
    EXPECT_EQ(print.text(), fingerprint(""));
    for (std::size_t at = 0; at < text.size(); at += n)
      print.add(std::string_view(text).substr(at, n));
    EXPECT_EQ(print.text(), fingerprint(text)) << n;
  }
}

}  // namespace
}  // namespace faultsim
