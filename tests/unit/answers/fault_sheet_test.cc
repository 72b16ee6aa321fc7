// The sheet of a fault against counting by hand, over five made-up cases (sheet_fixture.h).
#include "campaign/answers/fault_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/render/render.h"
#include "tests/unit/answers/renderings.h"
#include "tests/unit/answers/sheet_fixture.h"

namespace faultsweep {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::kSheetStart, testing::kSheetYear, testing::SheetFixture;
using ::testing::Not;

class FaultSheets : public ::testing::Test {
 protected:
  void submit(const std::string& kind = "grid") {
    f_.add_five();
    f_.submit_as(kind);
  }
  static const PressureBand& band(const FaultSheet& sheet, const std::string& stage,
                                  PressureWay way) {
    for (const PressureBand& one : sheet.bands)
      if (one.stage == stage && one.way == way) return one;
    throw std::out_of_range(stage);
  }
  static const StageSliding& stage(const FaultSheet& sheet, const std::string& name) {
    for (const StageSliding& one : sheet.stages)
      if (one.stage == name) return one;
    throw std::out_of_range(name);
  }
  SheetFixture f_;
};

TEST_F(FaultSheets, TheDatumIsTheMiddleOfTheReservoirsBesideTheFault) {
  submit();
  const FaultSheet sheet = f_.sheet();
  EXPECT_EQ(sheet.datum, 2100);
  EXPECT_NEAR(sheet.initial.base.pressure, kSheetStart, 1);
  EXPECT_NEAR(f_.sheet({.datum = 2000}).initial.region_pressure.low, 9.81e3 * 2000 + 2.5e6, 1);
  EXPECT_EQ(sheet.place.throws.low, 0);
  EXPECT_EQ(sheet.place.throws.high, 100);
  EXPECT_NEAR(sheet.initial.chi_bar.low, 0.3, 1e-12);
  EXPECT_EQ(sheet.initial.n_chi_bar, 5);
  EXPECT_THAT(place_words(sheet),
              Contains(HasSubstr("offset across it (east below west) 0 to 100 m")));
  EXPECT_THAT(place_words(sheet), Contains(HasSubstr("2,000 to 2,200 m")));
}

TEST_F(FaultSheets, AFaultIsAsLongAsItSays) {
  f_.set("/faults/1/y_to", "1800 m");
  submit();
  EXPECT_EQ(f_.sheet().place.length, 1200 + 1800);
}

/// Case 2 slides within step 3 (-100 to -150 bar), case 3 within step 4.
TEST_F(FaultSheets, ABandEndsWithTheLoadStepInWhichTheFirstCaseSlides) {
  submit();
  const FaultSheet sheet = f_.sheet();
  const PressureBand& falls = band(sheet, "primary_production", PressureWay::falls);
  EXPECT_FALSE(falls.of_limits);
  EXPECT_NEAR(falls.safe.value(), kSheetStart - 100e5, 1);
  EXPECT_NEAR(falls.unsafe.value(), kSheetStart - 150e5, 1);
  EXPECT_NEAR(falls.safe_change.value(), -100e5, 1);
  EXPECT_EQ(falls.unsafe_case, 2);
  EXPECT_EQ(falls.n, 5);
  EXPECT_EQ(falls.n_unsafe, 2);
  EXPECT_EQ(falls.n_undecided, 1);
  EXPECT_EQ(falls.n_unknown, 1);
  EXPECT_NEAR(falls.reached.low, kSheetStart - 200e5, 1);
  EXPECT_NEAR(falls.begin.value(), kSheetStart, 1);
  const std::string words = band_words(falls);
  EXPECT_THAT(words, HasSubstr("no case slides down to 131 bar; by 81 bar, one load step later"));
  EXPECT_THAT(words, HasSubstr("the first (case 2; 2 of 5 cases slide) does"));
  EXPECT_THAT(words, HasSubstr("Left open: 1 undecided by cells, 1 without a full history."));
}

TEST_F(FaultSheets, EachWayOfAPressureHasABandOfItsOwn) {
  submit();
  const FaultSheet sheet = f_.sheet();
  const PressureBand& up = band(sheet, "gas_storage", PressureWay::rises);
  EXPECT_NEAR(up.safe.value(), kSheetStart - 100e5, 1);
  EXPECT_NEAR(up.unsafe.value(), kSheetStart - 80e5, 1);
  EXPECT_EQ(up.unsafe_case, 3);
  EXPECT_NEAR(up.begin.value(), kSheetStart - 100e5, 1) << "the lowest in this stage";
  const PressureBand& down = band(sheet, "gas_storage", PressureWay::falls);
  EXPECT_EQ(down.n_unsafe, 0);
  EXPECT_FALSE(down.unsafe.has_value());
  EXPECT_NEAR(down.safe.value(), kSheetStart - 100e5, 1) << "as far as all full histories go";
  EXPECT_THAT(band_words(down), HasSubstr("no limit was found"));
  const PressureBand& injection = band(sheet, "cushion_gas_injection", PressureWay::rises);
  EXPECT_NEAR(injection.safe.value(), kSheetStart - 80e5, 1);
  EXPECT_NEAR(injection.begin.value(), kSheetStart - 200e5, 1) << "the end of production";
  EXPECT_EQ(sheet.bands.size(), 4U);
}

TEST_F(FaultSheets, SlidingIsCountedWithWhatIsOpen) {
  submit();
  const FaultSheet sheet = f_.sheet();
  const StageSliding& production = stage(sheet, "primary_production");
  EXPECT_EQ(production.counts.n, 5);
  EXPECT_EQ(production.counts.n_yes, 2);
  EXPECT_EQ(production.counts.n_undecided, 1);
  EXPECT_EQ(production.counts.n_unknown, 1);
  EXPECT_EQ(production.bounds.low, 0.4);
  EXPECT_EQ(production.bounds.high, 0.8);
  EXPECT_EQ(stage(sheet, "gas_storage").counts.n_yes, 1);
  EXPECT_EQ(stage(sheet, "").counts.n_yes, 2);
  EXPECT_EQ(sheet.stages.back().stage, "") << "the whole history is last";
  EXPECT_EQ(sheet.stages.front().stage, "primary_production");
  ASSERT_TRUE(production.first.has_value());
  EXPECT_EQ(production.first->position, 2);
  EXPECT_NEAR(production.first->time_before, 2 * kSheetYear, 1);
  EXPECT_NEAR(production.first->time, 3 * kSheetYear, 1);
  EXPECT_NEAR(production.first->pressure_before, kSheetStart - 100e5, 1);
  EXPECT_EQ(production.half->position, 2);
  EXPECT_EQ(production.last->position, 3);
  EXPECT_FALSE(stage(sheet, "cushion_gas_injection").first.has_value());
}

TEST_F(FaultSheets, AShareIsAProbabilityOfASampleOnly) {
  submit();
  EXPECT_THAT(render_text(to_answer({f_.sheet()})), Not(HasSubstr("probability at each")));
  SheetFixture sample("sample");
  sample.add_five();
  sample.submit_as("monte-carlo");
  const FaultSheet sheet = sample.sheet();
  EXPECT_THAT(render_text(to_answer({sheet})), HasSubstr("probability at each"));
  const Interval bounds = proportion_bounds(2, 2, 5, 0.95);
  EXPECT_EQ(sheet.stages.front().bounds.low, bounds.low);
  EXPECT_EQ(sheet.stages.front().bounds.high, bounds.high);
}

TEST_F(FaultSheets, LevelsCountEachCaseOnce) {
  submit();
  const FaultSheet sheet = f_.sheet();
  ASSERT_EQ(sheet.levels.size(), 3U);
  const auto counts = [&](std::size_t l) { return sheet.levels[l].counts; };
  EXPECT_EQ(counts(2).n_yes, 2) << "red";
  EXPECT_EQ(counts(2).n_undecided, 1);
  EXPECT_EQ(counts(1).n_yes, 0) << "amber";
  EXPECT_EQ(counts(1).n_undecided, 1);
  EXPECT_EQ(counts(1).n_holds, 1) << "as computed, case 4 does not slide and has χ̄ of 0.9";
  EXPECT_EQ(counts(0).n_yes, 1) << "green";
  for (std::size_t l = 0; l < 3; ++l) EXPECT_EQ(counts(l).n_unknown, 1) << l;
  long n = 0;
  for (std::size_t l = 0; l < 3; ++l) n += counts(l).n_holds;
  EXPECT_EQ(n, 4) << "each with a full history at one level";
}

/// χ̄ is within 0.011 at `screening`, which the made-up cases have.
TEST_F(FaultSheets, AValueWithinTheErrorOfItsCellsLeavesALevelOpen) {
  f_.add(SheetFixture::quiet(0.805));
  f_.add(SheetFixture::quiet(0.795));
  f_.add(SheetFixture::quiet(0.815));
  f_.submit_as("grid");
  const FaultSheet sheet = f_.sheet();
  const ShareCounts &green = sheet.levels[0].counts, &amber = sheet.levels[1].counts;
  EXPECT_EQ(amber.n_yes, 1) << "0.815 is certain";
  EXPECT_EQ(amber.n_undecided, 2);
  EXPECT_EQ(amber.n_holds, 2) << "as computed, 0.805 too";
  EXPECT_EQ(green.n_yes, 0);
  EXPECT_EQ(green.n_holds, 1);
  EXPECT_THAT(render_text(to_answer({sheet})),
              HasSubstr("A condition on χ̄ counts as undecided where χ̄ is within 0.011 of the "
                        "limit in it."));
}

TEST_F(FaultSheets, ConditionsOfLevelsAreOfTheSheetsFault) {
  submit();
  SheetRequest request;
  request.levels.levels = {{"green", "go on", "", LevelColour::green},
                           {"red", "stop", "slides in gas_storage", LevelColour::red}};
  EXPECT_EQ(f_.sheet(request).levels[1].counts.n_yes, 1);
  request.fault = "F1";
  EXPECT_EQ(f_.sheet(request).levels[1].counts.n_yes, 0);
  request.levels.levels[1].condition = "F2.slides";
  EXPECT_EQ(f_.sheet(request).levels[1].counts.n_yes, 2) << "another fault by its name";
  request.levels.levels[1].condition = "slids";
  EXPECT_THROW(f_.sheet(request), faultsim::InputError);
}

TEST_F(FaultSheets, TheLargestEventSaysWhetherItIsResolved) {
  submit();
  const FaultSheet sheet = f_.sheet();
  ASSERT_EQ(sheet.events.size(), 1U);
  const SheetEvents& events = sheet.events[0];
  EXPECT_EQ(events.n_with, 2);
  EXPECT_EQ(events.n_cases, 5);
  EXPECT_EQ(events.largest.value().position, 2);
  EXPECT_EQ(events.largest->event.moment, 5e13);
  EXPECT_EQ(events.largest_resolved.value().position, 3);
  EXPECT_EQ(events.slip_case, 2);
  EXPECT_EQ(events.slip, 0.004);
  EXPECT_THAT(event_words(sheet), Contains(HasSubstr("not resolved")));
  EXPECT_THAT(event_words(f_.sheet({.fault = "F1"})),
              Contains(HasSubstr("No slip event begins on F1 in 5 cases, of which 1 end early")));
}

TEST_F(FaultSheets, AllRenderingsSayTheSame) {
  submit();
  const FaultSheet sheet = f_.sheet();
  testing::expect_same_renderings(to_answer({sheet}));
  const auto all = find_fault_sheets(*f_.store_, f_.campaign_, {});
  ASSERT_EQ(all.size(), 2U) << "F3 has no results";
  const Answer answer = to_answer(all);
  testing::expect_same_renderings(answer);
  const auto json = render_json(answer);
  EXPECT_EQ(json.at("levels").size(), 6U);
  EXPECT_EQ(json.at("says").at(1).at("fault"), "F2");
  EXPECT_EQ(render_text(to_answer({sheet})), render_text(to_answer({f_.sheet()}))) << "same bits";
}

TEST_F(FaultSheets, ProvenanceNamesNoPlaceOfThisMachine) {
  submit();
  SheetRequest request;
  request.program = "faultsweep 1";
  request.datum = 2000;
  const std::string text = render_text(to_answer({f_.sheet(request)}), 100000);
  EXPECT_THAT(text, HasSubstr("spec spec.json"));
  EXPECT_THAT(text,
              HasSubstr("faultsweep sheet sweep --fault F2 --datum \"2000 m\" -o sheet.html"));
  EXPECT_THAT(text, Not(HasSubstr("somebody")));
  EXPECT_THAT(text, HasSubstr("tier screening"));
  EXPECT_THAT(text, HasSubstr("4 of 5 cases have a full history"));
}

TEST_F(FaultSheets, WhatIsNotThereIsSaid) {
  submit();
  try {
    f_.sheet({.fault = "F7"});
    FAIL();
  } catch (const faultsim::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("F7"));
  }
  SheetFixture nothing("nothing");
  nothing.add(SheetFixture::quiet(0.5));
  nothing.runs_.clear();
  nothing.submit_as("grid");
  try {
    find_fault_sheets(*nothing.store_, nothing.campaign_, {});
    FAIL();
  } catch (const faultsim::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no case has a result"));
  }
  SheetFixture early("early");
  faultsim::CaseResult ends = SheetFixture::quiet(0.4);
  ends.outcome = faultsim::Outcome::unconverged;
  early.add(ends);
  early.submit_as("grid");
  const FaultSheet sheet = early.sheet();
  EXPECT_THAT(band_words(sheet.bands.at(0)), HasSubstr("no case has a full history"));
  EXPECT_THAT(headline_of(sheet).front(), HasSubstr("not known"));
}

}  // namespace
}  // namespace faultsweep
