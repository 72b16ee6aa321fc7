// The result of a flow simulator in a scene: which reports are taken, what becomes of dates, and
// what it cannot stand beside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/reading/changed_scene.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

using Changes = std::vector<std::pair<std::string, std::string>>;

constexpr double kDay = 86400;
const std::string kCells = "x [m], y [m], depth [m], dx [m], dy [m], dz [m]";

class FlowLoads : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "flow_load_XXXXXX";
    folder_ = mkdtemp(name.data());
    document_ = rotliegend();
    document_.source = (folder_ / "scene.json").string();
    document_.value["stages"] = {
        {{"name", "production"}, {"until", "1994-01-01"}, {"steps", 1}},
    };
    document_.value.erase("compartments");
    document_.value["pressure_field"] = {{"file", "p.csv"}};
    write("p.csv", kCells +
                       ", 1990-01-01 [bar], 1991-01-01 [bar], 1992-01-01 [bar], 1993-01-01 [bar], "
                       "1994-01-01 [bar]\n"
                       "0, 0, 3000, 9000, 9000, 900, 350, 300, 250, 240, 260\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Scene scene(const Changes& changes = {}) const {
    JsonDocument document = document_;
    for (const auto& [pointer, text] : changes) set_value(document, pointer, text);
    return read_scene(document);
  }
  std::string refusal(const Changes& changes = {}) const {
    try {
      scene(changes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  JsonDocument document_;
};

TEST_F(FlowLoads, MakeLoadStepsOfTheReportsThatAreNotOnALine) {
  const Scene read = scene();
  EXPECT_THAT(read.pressure_field.reports, ElementsAre(0, 2, 3, 4));
  EXPECT_THAT(read.pressure_field.time, ElementsAre(0, 730 * kDay, 1096 * kDay, 1461 * kDay));
  EXPECT_EQ(read.stages[0].duration, 1461 * kDay);
  std::vector<double> ends;
  for (const StepEnd& step : step_ends(read)) ends.push_back(step.time);
  EXPECT_THAT(ends, ElementsAre(730 * kDay, 1096 * kDay, 1461 * kDay));
  EXPECT_THAT(scene({{"/pressure_field/tolerance", "30 bar"}}).pressure_field.reports,
              ElementsAre(0, 3, 4));
  for (const PressureHistory& history : read.pressure) EXPECT_TRUE(history.time.empty());
}

TEST_F(FlowLoads, CountFromTheirReferenceOrTheStartOfTheScene) {
  const Scene late = scene({{"/pressure_field/reference", "1992-01-01"}});
  EXPECT_THAT(late.pressure_field.reports, ElementsAre(2, 3, 4));
  EXPECT_EQ(late.pressure_field.time[0], 0);
  EXPECT_EQ(late.stages[0].duration, 731 * kDay);
  const Scene early = scene({{"/start_date", "1989-01-01"}});
  EXPECT_EQ(early.pressure_field.time[0], 365 * kDay);
  EXPECT_EQ(early.stages[0].duration, (365 + 1461) * kDay);
  EXPECT_THAT(
      refusal({{"/start_date", "1990-06-01"}}),
      AllOf(
          HasSubstr("/start_date: time 0, 1990-06-01, lies after the reference of pressure_field"),
          HasSubstr("1990-01-01")));
  EXPECT_THAT(refusal({{"/pressure_field/reference", "1990-06-01"}}),
              AllOf(HasSubstr("there is no report on"), HasSubstr("1990-01-01, 1991-01-01")));
}

TEST_F(FlowLoads, EndWithTheStagesOrTheSceneSaysWhatIsMeant) {
  const Changes too_long = {{"/stages/0/until", "1996-01-01"}};
  EXPECT_THAT(refusal(too_long), AllOf(HasSubstr("its reports end at"), HasSubstr("1994-01-01")));
  Changes held = too_long;
  held.emplace_back("/pressure_field/end", "hold");
  EXPECT_THAT(scene(held).pressure_field.reports, ElementsAre(0, 2, 3, 4));
  const Changes too_short = {{"/stages/0/until", "1992-06-01"}};
  EXPECT_THAT(refusal(too_short), HasSubstr("its reports go on to"));
  Changes cut = too_short;
  cut.emplace_back("/pressure_field/end", "cut");
  EXPECT_THAT(scene(cut).pressure_field.reports, ElementsAre(0, 2, 3));
}

TEST_F(FlowLoads, StandBesideNoOtherPressures) {
  EXPECT_THAT(refusal({{"/stages/0/pressure_change", "-20 bar"}}),
              HasSubstr("/stages/0/pressure_change: the pressures are those of /pressure_field"));
  EXPECT_THAT(refusal({{"/compartments/west/scale", "0.5"}}), HasSubstr("/compartments/west"));
  EXPECT_THAT(refusal({{"/pressure_csv", "q.csv"}}), HasSubstr("/pressure_csv: the pressures are"));
}

TEST_F(FlowLoads, AreRefusedWithTheLineOfTheirFile) {
  write("p.csv", kCells + ", 1990-01-01 [bar]\n0, 0, 3000, 9, 9, 9, nan\n0, 0, 300, 9, 9, 9, -5\n");
  EXPECT_THAT(
      refusal(),
      AllOf(HasSubstr("p.csv line 2: \"nan\" in column 7 \"1990-01-01\" is not a number"),
            HasSubstr("p.csv line 3: \"-5\" in column 7 \"1990-01-01 [bar]\" is not within 0 to")));
  EXPECT_THAT(refusal({{"/pressure_field/file", "none.csv"}}), HasSubstr("none.csv"));
}

TEST_F(FlowLoads, AreDoubtedWhereTheUnitLooksWrong) {
  write("p.csv",
        kCells + ", 1990-01-01 [bar], 1994-01-01 [bar]\n0, 0, 3000, 9, 9, 9, 5000, 4000\n");
  const Scene read = scene();
  ASSERT_FALSE(read.remarks.empty());
  EXPECT_THAT(remark_text(read.remarks[0]), HasSubstr("psi read as bar"));
}

TEST_F(FlowLoads, AreTakenAtASectionInPlaneStrain) {
  const Scene plain = scene({{"/numerics/plane_strain", "on"}});
  EXPECT_EQ(plain.pressure_field.y, 0);
  const Scene north = scene({{"/numerics/plane_strain", "on"}, {"/pressure_field/y", "1 km"}});
  EXPECT_EQ(north.pressure_field.y, 1000);
  EXPECT_NE(case_identity(north), case_identity(plain));
  const Scene idle = scene({{"/pressure_field/y", "1 km"}});
  EXPECT_EQ(idle.pressure_field.y, 0);
  ASSERT_FALSE(idle.remarks.empty());
  EXPECT_EQ(remark_text(idle.remarks[0]),
            "/pressure_field/y has no effect: it is for plane strain");
}

/// Cells over both blocks, of which the west one has two: 300 and 320 bar over halves of its
/// depths.
TEST_F(FlowLoads, GiveBlocksTheirInitialPressuresOnRequest) {
  document_.value["initial_state"].erase("overpressure");
  write("p.csv",
        kCells +
            ", 1990-01-01 [bar], 1994-01-01 [bar]\n-1500, 0, 2025, 3000, 9000, 150, 300, "
            "200\n-1500, 0, 2150, 3000, 9000, 100, 320, 210\n500, 0, 2100, 1000, 9000, 900, "
            "250, 200\n");
  const Changes from_report = {{"/initial_state/pressure_from", "first_report"}};
  const Scene own = scene(), read = scene(from_report);
  for (const Block& block : own.field.blocks) EXPECT_FALSE(block.overpressure);
  // Their shares are those within the block, 2000 to 2200 m, not those of the cells.
  EXPECT_NEAR(initial_region_pressure(read, 0, 2100), 310e5, 1);
  EXPECT_NEAR(initial_region_pressure(read, 1, 2100), 250e5, 1);
  // Horizontal stress goes with the mean: blocks are alike in volume but for the faults' dips.
  EXPECT_NEAR(initial_state(read, -2100).pressure, 280e5, 1e5);
  const double pore = initial_state(read, -2100).pressure - initial_state(own, -2100).pressure;
  EXPECT_NEAR(initial_state(read, -2100).sigma[0],
              initial_state(own, -2100).sigma[0] + (own.initial.ratio_across - 1) * pore, 1);
  EXPECT_EQ(initial_state(read, -2100).sigma[8], initial_state(own, -2100).sigma[8]);
  const std::vector<InitialRegion> regions = initial_regions(read);
  EXPECT_EQ(regions[1].source, "report of 1990-01-01");
  EXPECT_NEAR(regions[1].pressure, 250e5, 1);
  EXPECT_EQ(initial_regions(own)[1].source, "");
  EXPECT_NE(case_identity(read), case_identity(own));
  EXPECT_EQ(case_identity(scene({{"/initial_state/pressure_from", "given"}})), case_identity(own));
  Changes later = from_report;
  later.emplace_back("/pressure_field/reference", "1994-01-01");
  later.emplace_back("/stages/0/until", "1995-01-01");
  later.emplace_back("/pressure_field/end", "hold");
  EXPECT_NEAR(initial_region_pressure(scene(later), 1, 2100), 200e5, 1);
}

TEST_F(FlowLoads, GiveNoInitialPressuresThatAreGiven) {
  const Changes from_report = {{"/initial_state/pressure_from", "first_report"}};
  EXPECT_THAT(refusal(from_report),
              HasSubstr("/initial_state/overpressure: contradicts the initial pressures that"));
  document_.value["initial_state"].erase("overpressure");
  Changes own = from_report;
  own.emplace_back("/geometry/blocks/1/overpressure", "5 bar");
  EXPECT_THAT(refusal(own), HasSubstr("/geometry/blocks/1/overpressure: contradicts"));
  write("p.csv", kCells +
                     ", 1990-01-01 [bar], 1994-01-01 [bar]\n-1500, 0, 2100, 3000, 9000, 900, "
                     "300, 200\n");
  EXPECT_THAT(refusal(from_report), HasSubstr("the flow result covers no part of east"));
  document_.value.erase("pressure_field");
  document_.value["start_date"] = "1990-01-01";
  EXPECT_THAT(refusal(from_report),
              HasSubstr("/initial_state/pressure_from: there is no \"pressure_field\""));
}

/// A scene at hand that becomes one of a report, other friction, ratios, fluid and dips with it,
/// and back.
TEST_F(FlowLoads, GiveInitialPressuresToScenesThatChange) {
  document_.value["initial_state"].erase("overpressure");
  write("p.csv", kCells +
                     ", 1990-01-01 [bar], 1994-01-01 [bar]\n-1500, 0, 2100, 3000, 9000, 900, "
                     "300, 200\n500, 0, 2100, 1000, 9000, 900, 250, 200\n");
  const PlacedValue from = {"/initial_state/pressure_from", "first_report"};
  const std::string dip = "/faults/1/dip_from_vertical", cohesion = "/friction/cohesion",
                    ratio = "/initial_state/ratio_across", density = "/initial_state/water_density",
                    overpressure = "/initial_state/overpressure";
  ChangedScene changed;
  changed.document = document_;
  for (const std::vector<PlacedValue>& values : {std::vector<PlacedValue>{},
                                                 {from},
                                                 {from, {cohesion, "1 MPa"}},
                                                 {from, {ratio, 0.8}},
                                                 {from, {ratio, 0.8}, {density, "1100 kg/m3"}},
                                                 {from, {ratio, 0.8}, {dip, "30 deg"}},
                                                 {from},
                                                 {}}) {
    std::vector<Problem> problems;
    ASSERT_TRUE(change_scene(document_, values, Relations::checked, changed, problems).empty());
    EXPECT_THAT(problems, testing::IsEmpty());
    JsonDocument document = document_;
    for (const PlacedValue& one : values) put_value(document.value, one.pointer, one.value);
    EXPECT_EQ(changed.canonical.text(), canonical_scene(read_scene(document)));
  }
  std::vector<Problem> problems;
  change_scene(document_, {from, {overpressure, "5 bar"}}, Relations::checked, changed, problems);
  ASSERT_EQ(problems.size(), 1);
  EXPECT_EQ(problems[0].pointer, overpressure);
}

TEST_F(FlowLoads, SayWhatWasMadeOfTheirFile) {
  write("p.csv",
        "x [m], y [m], 1990-01-01 [bar], 1994-01-01 [bar]\n-1000, 0, 300, 200\n1000, 0, "
        "300, 200\n-1000, 2000, 300, 200\n1000, 2000, 300, 200\n");
  const Scene read = scene();
  ASSERT_FALSE(read.remarks.empty());
  EXPECT_EQ(remark_text(read.remarks[0]),
            "/pressure_field has no depth: its values hold at all depths");
}

TEST_F(FlowLoads, OfTemperatureAreIdleInRockThatDoesNotExpand) {
  document_.value.erase("pressure_field");
  document_.value["temperature_field"] = {{"file", "t.csv"}};
  write("t.csv", kCells + ", 1990-01-01 [degC], 1994-01-01 [degC]\n0, 0, 3000, 9, 9, 9, 90, 60\n");
  const auto said = [&](const Changes& changes) {
    std::string all;
    for (const Remark& one : scene(changes).remarks) all += remark_text(one) + "\n";
    return all;
  };
  const std::string idle =
      "/temperature_field has no effect: the regions are made of \"reservoir\", which has no "
      "thermal_expansion";
  EXPECT_THAT(said({}), HasSubstr(idle));
  EXPECT_THAT(said({{"/materials/reservoir/thermal_expansion", "1e-5 1/K"}}),
              testing::Not(HasSubstr(idle)));
}

TEST_F(FlowLoads, LieWhereNumbersSayThatCampaignsMayVary) {
  document_.value["pressure_field"]["origin"] = {"0 m", "0 m"};
  const std::vector<ParameterInfo> all = parameters(document_);
  for (const char* key : {"origin/0", "origin/1", "azimuth", "y"}) {
    const std::string pointer = std::string("/pressure_field/") + key;
    const auto one = std::find_if(all.begin(), all.end(),
                                  [&](const auto& row) { return row.pointer == pointer; });
    ASSERT_NE(one, all.end()) << pointer;
    EXPECT_FALSE(one->is_text) << pointer;
    EXPECT_FALSE(one->new_family) << pointer;
  }
}

TEST_F(FlowLoads, AreToldByTheirContent) {
  const Scene one = scene();
  std::filesystem::copy_file(folder_ / "p.csv", folder_ / "q.csv");
  EXPECT_EQ(case_identity(scene({{"/pressure_field/file", "q.csv"}})), case_identity(one));
  EXPECT_NE(case_identity(scene({{"/pressure_field/outside", "unchanged"}})), case_identity(one));
  EXPECT_NE(case_identity(scene({{"/pressure_field/tolerance", "30 bar"}})), case_identity(one));
  write("q.csv", kCells + ", 1990-01-01 [bar], 1994-01-01 [bar]\n0, 0, 3000, 9, 9, 9, 300, 200\n");
  EXPECT_NE(case_identity(scene({{"/pressure_field/file", "q.csv"}})), case_identity(one));
}

TEST_F(FlowLoads, TravelAsPlaceAndFingerprint) {
  embed_tables(document_);
  const auto& place = document_.value["fields"]["p.csv"];
  EXPECT_EQ(place["path"], (folder_ / "p.csv").string());
  document_.source = "/elsewhere/scene.json";
  EXPECT_EQ(refusal(), "accepted");
  write("p.csv", kCells + ", 1990-01-01 [bar], 1994-01-01 [bar]\n0, 0, 3000, 9, 9, 9, 300, 200\n");
  EXPECT_THAT(refusal(), HasSubstr("the file has changed"));
}

TEST_F(FlowLoads, AreRefusedInAFolderThatNoMessageCanShow) {
  std::filesystem::create_directory(folder_ / "two\nlines");
  document_.source = (folder_ / "two\nlines" / "scene.json").string();
  std::filesystem::copy_file(folder_ / "p.csv", folder_ / "two\nlines" / "p.csv");
  embed_tables(document_);
  EXPECT_FALSE(document_.value.contains("fields"));
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("/pressure_field/file: the file lies in a folder whose name contains "
                              "\"\\u000a\""),
                    HasSubstr("; rename the folder")));
}

TEST_F(FlowLoads, AreWhereStagesMayEndAtDates) {
  document_.value.erase("pressure_field");
  EXPECT_THAT(refusal(), HasSubstr("nothing says which date is time 0"));
  EXPECT_EQ(scene({{"/start_date", "1993-01-01"}}).stages[0].duration, 365 * kDay);
  EXPECT_THAT(refusal({{"/start_date", "1995-01-01"}}),
              HasSubstr("the stage ends before it begins"));
  EXPECT_THAT(refusal({{"/start_date", "1993-01-01"}, {"/stages/0/duration", "1 year"}}),
              HasSubstr("the stage has a duration too"));
}

}  // namespace
}  // namespace faultsim
