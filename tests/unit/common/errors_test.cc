#include "simulator/common/errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace faultsim {
namespace {

TEST(Concat, PrintsNumbersSoThatTheyCanBeReadBack) {
  EXPECT_EQ(concat("x = ", 0.1, ", n = ", 3), "x = 0.10000000000000001, n = 3");
}

TEST(WithContext, AddsLinesInsideOutAndKeepsTheType) {
  try {
    with_context([] { return "reading case 'ref-07'"; },
                 [] {
                   with_context([] { return "reading /faults/2"; },
                                [] { throw StorageError("disk full"); });
                 });
    FAIL();
  } catch (const StorageError& error) {
    EXPECT_STREQ(error.what(), "disk full / while reading /faults/2 / while reading case 'ref-07'");
  }
}

TEST(WithContext, ReturnsWhatTheBodyReturns) {
  EXPECT_EQ(with_context([] { return ""; }, [] { return 7; }), 7);
}

TEST(WithContext, LeavesBugsAlone) {
  EXPECT_THROW(with_context([] { return ""; }, [] { FAULTSIM_DEMAND(1 > 2, "n ", 5); }),
               InternalError);
}

TEST(InputError, ListsAllProblemsByLine) {
  const InputError error("f.json", {{"/b", 7, "is wrong", "write 1"},
                                    {"", 0, "is empty", ""},
                                    {"/a", 2, "is old", "remove it"}});
  EXPECT_STREQ(
      error.what(),
      "f.json: is empty\nf.json:2: /a: is old; remove it\nf.json:7: /b: is wrong; write 1");
  EXPECT_EQ(error.problems().size(), 3U);
  EXPECT_EQ(error.source(), "f.json");
}

TEST(Demand, PrintsConditionValuesAndPlace) {
  try {
    const int n = 3;
    FAULTSIM_DEMAND(n == 4, "n = ", n);
    FAIL();
  } catch (const InternalError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("n == 4 does not hold (n = 3) at "));
  }
}

TEST(Demand, NamesTheFileAsTheRepositoryDoes) {
  try {
    throw_internal("x", "", "/home/somebody/build/simulator/mesh/split.cc", 7);
    FAIL();
  } catch (const InternalError& error) {
    EXPECT_STREQ(error.what(), "internal error: x does not hold () at simulator/mesh/split.cc:7");
  }
}

TEST(InputError, SpellsOutControlCharactersAndEndsAtNoNul) {
  const InputError error("a\nb",
                         {{"/\x1b", 1, std::string("has \0 in it", 11), "write\ntwo lines"}});
  EXPECT_STREQ(error.what(), "a\\u000ab:1: /\\u001b: has \\u0000 in it; write\ntwo lines");
}

}  // namespace
}  // namespace faultsim
