#include "simulator/common/words.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace faultsim {

enum class Season { spring, summer, winter };
constexpr auto words(Season) { return std::array{"spring", "summer", "winter"}; }

namespace {

TEST(Words, OfEveryEnumeratorAndBack) {
  const auto all = enumerators<Season>();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], Season::spring);
  EXPECT_EQ(all[1], Season::summer);
  EXPECT_EQ(all[2], Season::winter);
  EXPECT_STREQ(to_string(Season::spring), "spring");
  EXPECT_STREQ(to_string(Season::winter), "winter");
  for (const Season season : all) EXPECT_EQ(named<Season>(to_string(season)), season);
}

TEST(Words, UnknownOnesNameNothing) {
  for (const char* word : {"", "Spring", "spring ", "sprin", "autumn"})
    EXPECT_EQ(named<Season>(word), std::nullopt) << word;
}

TEST(Words, AnEnumeratorWithoutAWordIsABug) {
  EXPECT_THROW(to_string(static_cast<Season>(3)), std::logic_error);
}

TEST(Words, AFileWithAnUnknownOneIsRefused) {
  EXPECT_EQ(stored_word<Season>("summer", "season"), Season::summer);
  try {
    stored_word<Season>("autumn", "season");
    FAIL() << "taken";
  } catch (const StorageError& error) {
    EXPECT_STREQ(error.what(), "unknown season \"autumn\"");
  }
}

}  // namespace
}  // namespace faultsim
