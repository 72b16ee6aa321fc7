#include "simulator/common/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace faultsim {
namespace {

TEST(Formatted, AsPrintf) {
  EXPECT_EQ(formatted("%.1f GB of %d", 2.25, 24), "2.2 GB of 24");
  EXPECT_EQ(formatted("100 %%"), "100 %");
  EXPECT_EQ(formatted("%s", ""), "");
}

TEST(Formatted, OfAnyLength) {
  const std::string all(5000, 'x');
  EXPECT_EQ(formatted("%s|%d", all.c_str(), 7), all + "|7");
}

TEST(Joined, SeparatesAndDoesNotEndWithTheSeparator) {
  EXPECT_EQ(joined(std::vector<std::string>{"F1", "F2", "F3"}, ", "), "F1, F2, F3");
  EXPECT_EQ(joined(std::vector<std::string>{"F1"}, ", "), "F1");
  EXPECT_EQ(joined(std::vector<std::string>(), ", "), "");
}

TEST(Joined, AnEmptyFirstItemIsAnItem) {
  EXPECT_EQ(joined(std::vector<std::string>{"", "F2", ""}, ","), ",F2,");
}

TEST(Joined, NumbersAndProjections) {
  EXPECT_EQ(joined(std::vector<int>{1, 2, 3}, " + "), "1 + 2 + 3");
  EXPECT_EQ(joined(std::vector<int>{1, 2}, " and ",
                   [](int n) { return std::string(static_cast<std::size_t>(n), '*'); }),
            "* and **");
}

}  // namespace
}  // namespace faultsim
