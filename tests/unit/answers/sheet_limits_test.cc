// Bands of pressure of a sheet, from limits that a campaign searched.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "campaign/answers/fault_sheet.h"
#include "tests/unit/answers/searched_limits.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;

/// At three offsets, the highest storage pressure from -110 to -10 bar at which a fault does not
/// slide.
std::string storage_spec(const std::string& fault) {
  return R"({"format": 1, "name": "storage", "base": "docs/examples/scenes/rotliegend.json",
    "set": {"/tier": "screening"},
    "design": {"kind": "grid", "parameters": {"offset": ["0 m", "100 m", "200 m"]}},
    "limits": {"top": {
      "parameter": {"pointers": ["/stages/2/pressure_between/1"],
                    "from": "-110 bar", "to": "-10 bar", "count": 5},
      "faults": [")" +
         fault + R"("], "stage": "gas_storage", "tolerance": "2 bar"}}})";
}

class SheetLimits : public ::testing::Test {
 protected:
  using Slides = testing::SlidesAt;

  void SetUp() override {
    std::string name = ::testing::TempDir() + "sheet_limits_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Of the campaign, run until nothing is left to search. The change acts in the eastern region.
  FaultSheet sheet(const std::string& fault, const Slides& slides) const {
    Store store = Store::open_owner(folder_);
    testing::search_limits(store, storage_spec(fault), slides);
    return find_fault_sheets(store, store.campaign(""), {.fault = fault}).at(0);
  }

  std::filesystem::path folder_;
};

constexpr double kStart = 9.81e3 * 2100 + 2.5e6;  // Pa, p0 of the reservoir at 2,100 m

TEST_F(SheetLimits, TheBandIsThatOfTheMostRestrictiveConfiguration) {
  const FaultSheet sheet =
      this->sheet("F2", [](double offset, double change) { return offset < 50 && change > -40e5; });
  const PressureBand& band = sheet.bands.at(0);
  EXPECT_TRUE(band.of_limits);
  EXPECT_EQ(band.way, PressureWay::rises);
  EXPECT_EQ(band.n, 3);
  EXPECT_EQ(band.n_unsafe, 1);
  EXPECT_EQ(band.n_at_once, 0);
  EXPECT_LE(band.safe.value(), kStart - 40e5);
  EXPECT_GE(band.safe.value(), kStart - 42e5 - 1) << "searched to 2 bar";
  EXPECT_GT(band.unsafe.value(), kStart - 40e5);
  EXPECT_LE(band.unsafe.value(), band.safe.value() + 2e5 + 1);
  EXPECT_NEAR(band.safe_change.value(), band.safe.value() - kStart, 1);
  EXPECT_THAT(band_words(band), HasSubstr("in none of 3 configurations up to"));
  EXPECT_THAT(band_words(band), HasSubstr("in 1 of 3 configurations within the range searched"));
  EXPECT_FALSE(sheet.sampling.is_random);
  EXPECT_THAT(share_note(sheet), HasSubstr("chosen by the search for limits"));
  for (std::size_t k = 1; k < sheet.bands.size(); ++k)
    EXPECT_NE(sheet.bands[k].stage, "gas_storage") << "its histories end where the search wants";
}

/// The block that lies 200 m deeper is below the overpressure of the reservoir's depths.
TEST_F(SheetLimits, EachConfigurationStartsFromItsOwnPressure) {
  const FaultSheet sheet = this->sheet(
      "F2", [](double offset, double change) { return offset > 150 && change > -40e5; });
  const PressureBand& band = sheet.bands.at(0);
  EXPECT_LE(band.safe.value(), kStart - 25e5 - 40e5);
  EXPECT_GE(band.safe.value(), kStart - 25e5 - 42e5 - 1);
}

TEST_F(SheetLimits, WhereNoPressureIsSafeThatIsSaid) {
  const FaultSheet sheet = this->sheet("F2", [](double, double) { return true; });
  const PressureBand& band = sheet.bands.at(0);
  EXPECT_EQ(band.n_at_once, 3);
  EXPECT_FALSE(band.safe.has_value());
  EXPECT_THAT(band_words(band), HasSubstr("in 3 of 3 configurations already at the safe end"));
  EXPECT_THAT(headline_of(sheet).at(1), HasSubstr("No safe band in gas storage"));
}

/// F1 touches the western compartment alone, whose pressure does not change by the value.
TEST_F(SheetLimits, APressureThatNoCompartmentBesideTheFaultTakesIsAChange) {
  const FaultSheet sheet =
      this->sheet("F1", [](double offset, double change) { return offset < 50 && change > -40e5; });
  const PressureBand& band = sheet.bands.at(0);
  EXPECT_FALSE(band.safe.has_value());
  EXPECT_LE(band.safe_change.value(), -40e5);
  EXPECT_THAT(band_words(band), HasSubstr("up to a change of -4"));
}

}  // namespace
}  // namespace faultsweep
