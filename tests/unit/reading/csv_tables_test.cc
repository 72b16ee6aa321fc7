// A scene's CSV tables: what they may hold, and that they travel with the scene.
#include "simulator/reading/csv_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulator/common/dates.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

class CsvTables : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "csv_tables_XXXXXX";
    folder_ = mkdtemp(name.data());
    document_ = rotliegend();
    document_.source = (folder_ / "scene.json").string();
    document_.value["stages"] = {{{"name", "production"}, {"duration", "4 year"}, {"steps", 4}}};
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// The scene with p.csv and these changes.
  Scene scene(const std::vector<std::pair<std::string, std::string>>& changes = {}) const {
    JsonDocument document = document_;
    document.value["pressure_csv"] = "p.csv";
    for (const auto& [pointer, text] : changes) set_value(document, pointer, text);
    return read_scene(document);
  }
  std::string refusal(const std::vector<std::pair<std::string, std::string>>& changes = {}) const {
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

TEST_F(CsvTables, MayHaveDatesAndAUnitPerColumn) {
  write("p.csv",
        "date, west [bar], east [MPa]\n1990-01-01, 0, 0\n1992-01-01, -50, -4\n"
        "1993-12-31T12:00:00Z, -100, -9\n");
  const Scene read = scene();
  EXPECT_EQ(read.pressure[0].time,
            (std::vector<double>{0, 730 * kDay, (730 + 366 + 364 + 0.5) * kDay}));
  EXPECT_EQ(read.pressure[0].pressure_change, (std::vector<double>{0, -5e6, -10e6}));
  EXPECT_EQ(read.pressure[1].pressure_change, (std::vector<double>{0, -4e6, -9e6}));
}

TEST_F(CsvTables, CountFromTheStartDateOfTheScene) {
  write("p.csv", "date, west [bar]\n1990-01-11, -1\n1994-01-01, -100\n");
  EXPECT_EQ(scene({{"/start_date", "1990-01-01"}}).pressure[0].time[0], 10 * kDay);
  EXPECT_THAT(refusal(), testing::HasSubstr("p.csv line 2: the change at time 0 is -1"));
  EXPECT_THAT(refusal({{"/start_date", "1990-13-01"}}),
              testing::HasSubstr("/start_date: \"1990-13-01\" is not a date"));
}

TEST_F(CsvTables, MustAgreeOnTheDateOfTimeZero) {
  write("p.csv", "date, west [bar]\n1990-01-01, 0\n1994-01-01, -100\n");
  write("q.csv", "date, east [bar]\n1990-01-02, 0\n1994-01-02, -100\n");
  EXPECT_THAT(refusal({{"/compartments/east/csv", "q.csv"}}),
              testing::HasSubstr("q.csv begins at a different date from the tables before"));
  EXPECT_EQ(scene({{"/compartments/east/csv", "q.csv"}, {"/start_date", "1990-01-01"}})
                .pressure[1]
                .time[0],
            kDay);
}

TEST_F(CsvTables, MayHoldAbsolutePressuresAtADatum) {
  const Scene plain = read_scene(document_);
  const auto start = [&](double depth) {
    return nlohmann::json(initial_region_pressure(plain, 0, depth) / 1e5).dump();
  };
  write("p.csv",
        "time [year], west [bar] absolute\n0, " + start(region_top(plain, 0)) + "\n4, 200\n");
  const Scene at_top = scene();
  EXPECT_EQ(at_top.pressure[0].pressure_change[0], 0);
  EXPECT_NEAR(at_top.pressure[0].pressure_change[1],
              200e5 - initial_region_pressure(plain, 0, region_top(plain, 0)), 1);
  EXPECT_THAT(refusal({{"/compartments/west/datum", "2050 m"}}),
              testing::HasSubstr("\"west\" begins at"));
  write("p.csv", "time [year], west [bar] absolute\n0, " + start(2050) + "\n4, 200\n");
  EXPECT_NEAR(scene({{"/compartments/west/datum", "2050 m"}}).pressure[0].pressure_change[1],
              200e5 - initial_region_pressure(plain, 0, 2050), 1);
}

TEST_F(CsvTables, MeetABlocksOwnInitialPressure) {
  const Scene plain = read_scene(document_);
  const double hydrostatic = 1000 * 9.81 * region_top(plain, 0);
  const std::string start = nlohmann::json((hydrostatic + 60e5) / 1e5).dump();
  write("p.csv", "time [year], west [bar] absolute\n0, " + start + "\n4, 200\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("its initial pressure at"));
  const Scene own = scene({{"/geometry/blocks/0/overpressure", "60 bar"}});
  EXPECT_NEAR(own.pressure[0].pressure_change[1], 200e5 - hydrostatic - 60e5, 1);
}

TEST_F(CsvTables, ThatEndBeforeOrAfterTheStagesAreRefusedUnlessTheSceneSaysSo) {
  write("p.csv", "time [year], west [bar]\n0, 0\n3, -100\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("p.csv ends at 3 year, the stages at 4 year"));
  EXPECT_THAT(refusal({{"/pressure_csv_end", "cut"}}), testing::HasSubstr("p.csv ends at 3 year"));
  EXPECT_EQ(pressure_change_at(scene({{"/pressure_csv_end", "hold"}}).pressure[0], 4 * kYear),
            -10e6);
  write("p.csv", "time [year], west [bar]\n0, 0\n5, -100\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("p.csv goes on to 5 year, the stages end at 4 year"));
  EXPECT_THAT(refusal({{"/pressure_csv_end", "hold"}}), testing::HasSubstr("goes on to 5 year"));
  EXPECT_EQ(pressure_change_at(scene({{"/pressure_csv_end", "cut"}}).pressure[0], 4 * kYear), -8e6);
  write("p.csv", "date, west [bar]\n1990-01-01, 0\n1994-01-01, -100\n");
  EXPECT_NO_THROW(scene()) << "a day from 4 years of 365.25";
}

TEST_F(CsvTables, GoWithTheSceneOnceEmbedded) {
  write("p.csv", "# measured\ntime [year],\twest [bar]\r\n0, 0\n4, -100\n");
  document_.value["pressure_csv"] = "p.csv";
  const std::string identity = case_identity(read_scene(document_));
  embed_tables(document_);
  EXPECT_EQ(document_.value["tables"]["p.csv"],
            (nlohmann::json{"# measured", "time [year], west [bar]", "0, 0", "4, -100"}));
  write("p.csv", "time [year], west [bar]\n0, 0\n4, -10\n");
  document_.source = "/another/folder/scene.json";
  EXPECT_EQ(case_identity(read_scene(document_)), identity);
  std::filesystem::remove(folder_ / "p.csv");
  EXPECT_EQ(case_identity(read_scene(document_)), identity);
}

TEST_F(CsvTables, SayTheSameOnceEmbedded) {
  document_.value["pressure_csv"] = "p.csv";
  document_.value["geometry"]["blocks"][0]["name"] = "S\u00fcd";
  for (const char* text : {"# \xFF\x01\rtime [year]\tS\u00fcd [bar]\r0\t0\r4\t-100\r",
                           "time [year]; S\u00fcd [bar]\n0;\t0\n4; -100\n",
                           "\xEF\xBB\xBFtime [year],\"S\u00fcd [bar]\"\r\n0,\"0\"\r\n4,-100\r\n"}) {
    write("p.csv", text);
    JsonDocument embedded = document_;
    embed_tables(embedded);
    const nlohmann::json& lines = embedded.value["tables"]["p.csv"];
    ASSERT_TRUE(lines.is_array()) << text;
    EXPECT_NO_THROW(lines.dump());
    EXPECT_EQ(read_scene(embedded).pressure[0].pressure_change, (std::vector<double>{0, -10e6}));
    EXPECT_EQ(read_scene(document_).pressure[0].pressure_change, (std::vector<double>{0, -10e6}));
  }
}

TEST_F(CsvTables, ThatAreRefusedAreNotEmbedded) {
  document_.value["pressure_csv"] = "p.csv";
  for (const std::string& odd : {std::string(1, '\0'), std::string("\xFF"), std::string("\x1b")}) {
    write("p.csv", "time [year], west [bar]\n0, 0\n4, -1" + odd + "00\n");
    embed_tables(document_);
    EXPECT_FALSE(document_.value.contains("tables"));
    EXPECT_THAT(refusal(), testing::HasSubstr("/pressure_csv: p.csv line 3: contains \"\\"));
  }
}

TEST_F(CsvTables, SayAllThatIsWrong) {
  write("p.csv", "time [year], west [bar]\n0, 1\n1, 1e9\n1, 0x10\n-1, nan\n3, 1; 2\n4, -1 bar\n");
  const std::string said = refusal();
  for (const char* part :
       {"line 2: the change at time 0 is 1",
        "line 3: \"1e9\" in column 2 \"west [bar]\" is not within",
        "line 4: time 1 does not come after", "line 4: \"0x10\"", "line 5: \"-1\"",
        "line 5: \"nan\"", "line 6: \"1; 2\"", "line 7: \"-1 bar\""})
    EXPECT_THAT(said, testing::HasSubstr(part));
}

TEST_F(CsvTables, ThatCannotBeReadAreNamed) {
  embed_tables(document_);
  EXPECT_FALSE(document_.value.contains("tables"));
  document_.value["pressure_csv"] = "no.csv";
  embed_tables(document_);
  EXPECT_FALSE(document_.value.contains("tables"));
  EXPECT_THAT(refusal({{"/pressure_csv", "no.csv"}}),
              testing::HasSubstr("/pressure_csv: no.csv: the file cannot be read"));
}

TEST(Dates, AreIso8601) {
  EXPECT_EQ(parse_date("1970-01-01"), 0);
  EXPECT_EQ(parse_date("1970-01-02T01:02:03Z"), 86400 + 3723);
  EXPECT_EQ(parse_date("2000-02-29 06:00"), (30 * 365 + 7 + 31 + 28) * kDay + 6 * 3600);
  for (const char* no : {"", "1990", "1990-1-1", "1900-02-29", "1990-00-01", "1990-01-01T25:00",
                         "01-01-1990", "1990-01-01x", "1990-01-01T01", "1990/01/01"}) {
    EXPECT_FALSE(parse_date(no)) << no;
  }
}

}  // namespace
}  // namespace faultsim
