#include "campaign/answers/limit_table.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "simulator/documents/json_document.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/answers/searched_limits.h"

/// What stored results come to: bands, their order, pressures at the datum.
namespace faultsweep {
namespace {

/// At three offsets, the highest storage pressure from −110 to −10 bar at which F1 does not slide.
constexpr const char* kHighestStorage = R"({
  "format": 1, "name": "storage", "base": "docs/examples/scenes/rotliegend.json",
  "set": {"/tier": "screening"},
  "design": {"kind": "grid", "parameters": {"offset": ["0 m", "100 m", "200 m"]}},
  "limits": {"top": {
    "parameter": {"pointers": ["/stages/2/pressure_between/1"],
                  "from": "-110 bar", "to": "-10 bar", "count": 5},
    "faults": ["F1"], "stage": "gas_storage", "tolerance": "2 bar"}}})";

class StoredLimits : public ::testing::Test {
 protected:
  using Slides = testing::SlidesAt;

  void SetUp() override {
    std::string name = ::testing::TempDir() + "limits_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Of the campaign, run until nothing is left to search. The change acts in the second region.
  LimitTable found(const Slides& slides) const {
    Store store = Store::open_owner(folder_);
    testing::search_limits(store, kHighestStorage, slides);
    return make_limit_table(store, store.campaign(""));
  }

  std::filesystem::path folder_;
};

/// The band is from the safe end of the range to the last safe value, whose pressure at the datum
/// of the region that changes by it is that of the beginning and the change.
TEST_F(StoredLimits, ALimitHasItsBandAndItsPressure) {
  const LimitTable table =
      found([](double offset, double change) { return offset < 50 && change > -40e5; });
  const LimitRow &limited = table.rows.at(0), &never = table.rows.at(1);
  const Crossing* limit = limited.cells[0]->finding.limit();
  ASSERT_NE(limit, nullptr) << "the narrowest band is not first";
  const double safe = limit->before.value;
  EXPECT_NEAR(limited.width.value(), safe + 110, 1e-9);
  EXPECT_FALSE(limited.is_open);
  EXPECT_NEAR(never.width.value(), 100, 1e-9) << "all of the range";
  EXPECT_TRUE(never.is_open);
  EXPECT_FALSE(never.cells[0]->datum);
  const faultsim::Scene scene = faultsim::read_scene(
      faultsim::read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json"));
  const DatumPressure& datum = limited.cells[0]->datum.value();
  EXPECT_EQ(datum.region, scene.pressure[1].region);
  EXPECT_EQ(datum.depth, faultsim::region_top(scene, 1));
  EXPECT_NEAR(datum.absolute, faultsim::initial_region_pressure(scene, 1, datum.depth) + 1e5 * safe,
              1);
}

/// A fault that slides everywhere has no band: its last safe value is before the range.
TEST_F(StoredLimits, WhatSlidesEverywhereHasNoBand) {
  const LimitTable table = found([](double, double) { return true; });
  ASSERT_EQ(table.rows.size(), 3u);
  for (const LimitRow& row : table.rows) {
    EXPECT_EQ(row.cells[0]->finding.verdict, LimitVerdict::unsafe_throughout);
    EXPECT_EQ(row.width.value(), 0);
    EXPECT_FALSE(row.is_open);
  }
}

/// Of faults that never slide, slide above a pressure and always slide the last has least room.
TEST_F(StoredLimits, TheNarrowestBandComesFirst) {
  const LimitTable table = found(
      [](double offset, double change) { return offset > 150 || (offset > 50 && change > -40e5); });
  ASSERT_EQ(table.rows.size(), 3u);
  const struct {
    const char* offset;
    LimitVerdict verdict;
    double least, most;  // of the width, bar: the limit is searched to 2 bar
    bool is_open;
  } expected[] = {{"200 m", LimitVerdict::unsafe_throughout, 0, 0, false},
                  {"100 m", LimitVerdict::limit, 68, 70, false},
                  {"0 m", LimitVerdict::safe_throughout, 100, 100, true}};
  for (std::size_t k = 0; k < 3; ++k) {
    const LimitRow& row = table.rows[k];
    EXPECT_EQ(row.settings, std::vector<std::string>{expected[k].offset});
    EXPECT_EQ(row.cells.at(0)->finding.verdict, expected[k].verdict);
    EXPECT_GE(row.width.value(), expected[k].least - 1e-9);
    EXPECT_LE(row.width.value(), expected[k].most + 1e-9);
    EXPECT_EQ(row.is_open, expected[k].is_open);
  }
}

}  // namespace
}  // namespace faultsweep
