#include "simulator/common/ranges.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace faultsim {
namespace {

struct Fault {
  std::string name;
  int nodes = 0;
};
const std::vector<Fault> kFaults{{"F1", 4}, {"F2", 7}, {"F3", 5}};

TEST(Contains, WhatIsAnywhereInARange) {
  const std::vector<int> numbers{3, 1, 2};
  for (const int number : numbers) EXPECT_TRUE(contains(numbers, number));
  EXPECT_FALSE(contains(numbers, 4));
  EXPECT_FALSE(contains(std::vector<int>(), 0));
}

TEST(Contains, SeenThroughAProjection) {
  EXPECT_TRUE(contains(kFaults, "F3", &Fault::name));
  EXPECT_FALSE(contains(kFaults, "F", &Fault::name));
  EXPECT_TRUE(contains(kFaults, 12, [](const Fault& fault) { return fault.nodes + 5; }));
}

TEST(Mapped, EveryItemInOrder) {
  EXPECT_EQ(mapped(kFaults, &Fault::name), (std::vector<std::string>{"F1", "F2", "F3"}));
  EXPECT_EQ(mapped(kFaults, [](const Fault& fault) { return 0.5 * fault.nodes; }),
            (std::vector<double>{2, 3.5, 2.5}));
  EXPECT_TRUE(mapped(std::vector<Fault>(), &Fault::nodes).empty());
}

TEST(Mapped, OwnsWhatReferencesGive) {
  std::vector<int> numbers{1, 2};
  auto copies = mapped(numbers, [](int& number) -> int& { return number; });
  numbers[0] = 9;
  EXPECT_EQ(copies, (std::vector<int>{1, 2}));
  const std::map<std::string, int> counts{{"b", 2}, {"a", 1}};
  EXPECT_EQ(mapped(counts, [](const auto& pair) { return pair.second; }), (std::vector<int>{1, 2}));
}

}  // namespace
}  // namespace faultsim
