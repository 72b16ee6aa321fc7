// Likelihoods of what was seen, given what a case did.
#include "campaign/answers/seen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/query/parameters.h"

namespace faultsweep {
namespace {

constexpr double kYear = 31557600;
double below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

Selection two_faults() {
  Selection selection;
  selection.faults = {{7, "F1"}, {8, "Fault 2"}};
  selection.stages = {{1, ""}, {2, "gas_storage"}};
  return selection;
}

CampaignInfo with_strength() {
  CampaignInfo campaign;
  campaign.parameters = {{"strength", faultsim::Dimension::number, false}};
  return campaign;
}

SeenStatement read(const std::string& text) {
  return read_seen({text}, with_strength(), two_faults()).at(0);
}

TEST(Seen, SlidingHasATimeWithAnError) {
  CaseHistory history;
  history.onsets = {{7, 3, 6 * kYear, -1e6}};
  const SeenStatement before = read("F1 slid before 8 yr +- 1 yr");
  EXPECT_NEAR(likelihood(before, history, 0), below(2), 1e-12);
  EXPECT_NEAR(likelihood(read("F1 did not slide before 8 yr ± 1 yr"), history, 0), 1 - below(2),
              1e-12);
  EXPECT_EQ(likelihood(before, {}, 0), 0) << "it never slides";
  EXPECT_EQ(likelihood(read("Fault 2 did not slide before 8 yr"), history, 0), 1) << "another";
  EXPECT_EQ(likelihood(read("F1 slid before 5 yr"), history, 0), 0);
  EXPECT_EQ(likelihood(read("F1 slid before 6 yr"), history, 0), 1) << "by then";
  EXPECT_TRUE(read("F1 slid before 6 yr").is_exact());
}

TEST(Seen, NamesOfFaultsMayStandInQuotes) {
  EXPECT_EQ(read("\"Fault 2\" slid before 8 yr").fault, 8);
  EXPECT_EQ(read("no event of Mw 3 on 'Fault 2'").fault, 8);
  EXPECT_EQ(read("\"F1\" did not slide before 8 yr").fault, 7);
  EXPECT_THROW(read("\"Fault 3\" slid before 8 yr"), faultsim::InputError);
  EXPECT_THROW(read("\"Fault 2 slid before 8 yr"), faultsim::InputError);
}

/// Of 50,000 letters the calls within calls of std::regex_match ended the program.
TEST(Seen, AStatementWithoutEndIsRefused) {
  try {
    read("F1 slid before " + std::string(50000, '8') + " yr");
    ADD_FAILURE() << "it was read";
  } catch (const faultsim::InputError& wrong) {
    EXPECT_THAT(wrong.what(), ::testing::HasSubstr("has 50018 characters; write at most 2000"));
    EXPECT_LT(std::string(wrong.what()).size(), 300u);
  }
  EXPECT_THROW(read(std::string(50000, 'x') + "±"), faultsim::InputError);
  EXPECT_NO_THROW(read("F1.slides" + std::string(1900, ' ') + "or chi_bar > 0.1"));
}

TEST(Seen, EventsHaveAMagnitudeAndAPressure) {
  CaseHistory history;
  history.events = {{1, 8, 0, -1e7, 3.2}, {1, 8, 0, -1.3e7, 2.9}, {1, 7, 0, -1e7, 5.0}};
  const std::string where = " on Fault 2 between -80 bar and -120 bar";
  EXPECT_EQ(likelihood(read("event of Mw 3" + where), history, 0), 1);
  EXPECT_EQ(likelihood(read("event of Mw 3.5" + where), history, 0), 0);
  EXPECT_EQ(likelihood(read("no event of Mw 3.5 on Fault 2"), history, 0), 1);
  const auto in_range = [](double p) { return below((p + 120) / 5) + below((-80 - p) / 5) - 1; };
  const double none =
      (1 - below(0.2 / 0.1) * in_range(-100)) * (1 - below(-0.1 / 0.1) * in_range(-130));
  const SeenStatement vague = read("event of Mw 3 +- 0.1" + where + " +- 5 bar");
  EXPECT_NEAR(likelihood(vague, history, 0), 1 - none, 1e-12);
  EXPECT_NEAR(likelihood(read("no event of Mw 3 +- 0.1" + where + " +- 5 bar"), history, 0), none,
              1e-12);
}

TEST(Seen, MetricsAreNormalAndConditionsMayBeWrong) {
  const SeenStatement slip = read("F1.max_slip in gas_storage = 20 mm +- 5 mm");
  EXPECT_NEAR(likelihood(slip, {}, 0.025), std::exp(-0.5), 1e-12);
  EXPECT_EQ(likelihood(slip, {}, std::nan("")), 0);
  const SeenStatement slides = read("F1.slides in gas_storage, wrong 0.1");
  EXPECT_EQ(likelihood(slides, {}, 1), 0.9);
  EXPECT_EQ(likelihood(slides, {}, 0), 0.1);
  EXPECT_EQ(likelihood(read("chi_bar > 0.5 and strength < 2"), {}, 1), 1);
}

TEST(Seen, OfAHistoryThatEndsEarlyWhatItDidIsKnown) {
  const auto range_is = [](const std::string& text, const CaseHistory& history, double least,
                           double most) {
    const WeightRange range = likelihood_range(read(text), history);
    EXPECT_NEAR(range.least, least, 1e-12) << text;
    EXPECT_NEAR(range.most, most, 1e-12) << text;
  };
  CaseHistory history;
  history.onsets = {{7, 3, 6 * kYear, -1e6}};
  history.events = {{1, 8, 0, -1e7, 3.2}};
  range_is("F1 slid before 8 yr +- 1 yr", history, below(2), below(2));
  range_is("F1 did not slide before 8 yr +- 1 yr", history, 1 - below(2), 1 - below(2));
  range_is("Fault 2 slid before 8 yr", history, 0, 1);
  range_is("event of Mw 3 +- 0.1 on Fault 2", history, below(2), 1);
  range_is("no event of Mw 3 +- 0.1 on Fault 2", history, 0, 1 - below(2));
  range_is("no event of Mw 3 on F1", history, 0, 1);
  range_is("max_slip = 20 mm +- 5 mm", history, 0, 1);
  range_is("slides, wrong 0.1", history, 0.1, 0.9);
}

TEST(Seen, AllThatIsWrongIsSaidAtOnce) {
  try {
    read_seen({"F3 slid before 8 yr", "F1 slid before 8 bar", "event of Mw 3 mm on F1",
               "max_slp = 20 mm +- 5 mm", "max_slip = 20 +- 5 mm", "slids", "slides, wrong 0.7",
               "max_slip = 20 mm +- 0 mm"},
              with_strength(), two_faults());
    FAIL();
  } catch (const faultsim::InputError& error) {
    EXPECT_GE(error.problems().size(), 8u) << error.what();
    for (const char* text : {"there is no fault F3", "8 bar", "3 mm", "max_slp", "slids",
                             "says nothing", "no case has exactly"})
      EXPECT_THAT(error.what(), ::testing::HasSubstr(text));
  }
}

}  // namespace
}  // namespace faultsweep
