#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "campaign/expansion/expansion.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/expansion/long_way.h"

/// Designs whose rows are the lines of a file: samples of others, and places with names.
namespace faultsweep {
namespace {

/// A campaign of the lines of a file in a folder of its own.
class SamplesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "samples_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  Expansion expand_lines(const std::string& lines, const std::string& more = "") {
    std::ofstream(folder_ / "lines.csv") << lines;
    const std::string text =
        R"({"format": 1, "name": "test", "base": ")" FAULTSIM_SOURCE_DIR
        R"(/docs/examples/scenes/rotliegend.json", )" +
        (more.empty() ? std::string(R"("set": {"/tier": "screening"}, )") : more) +
        R"("design": {"kind": )" + kind_ + R"(, "file": "lines.csv"}})";
    return expand(parse_campaign(text, (folder_ / "test.json").string()));
  }
  std::filesystem::path folder_;
  std::string kind_ = R"("samples")";  ///< of the design, and its other keys.
};

TEST_F(SamplesTest, AreTheLinesOfTheFile) {
  const Expansion expansion = expand_lines(
      "\xEF\xBB\xBF"
      "# drawn elsewhere\nfriction_angle [deg], cohesion[bar] ,biot\r\n"
      "18.25,3,0.9\r\n\n21,1.5e0,1\n18.25, 3, 0.9\n");
  ASSERT_EQ(expansion.cases.size(), 2u) << "the third line is the first once more";
  EXPECT_EQ(values_of(expansion, 0), "friction_angle=18.25 deg cohesion=3 bar biot=0.9");
  EXPECT_EQ(values_of(expansion, 1), "friction_angle=21 deg cohesion=1.5 bar biot=1");
  EXPECT_EQ(parameters_of(expansion, expansion.cases[0])[1].si, 3e5);
  EXPECT_EQ(expansion.n_merged, 1);
  expect_true_identities(expansion, 1);
}

TEST_F(SamplesTest, BelongToTheCampaign) {
  const std::string first = expand_lines("biot\n0.9\n").spec.resolved();
  EXPECT_NE(expand_lines("biot\n0.8\n").spec.resolved(), first);
  EXPECT_EQ(expand_lines("biot\n0.9\n").spec.resolved(), first);
}

/// More than are read one by one of other designs; each line must be sound by itself.
TEST_F(SamplesTest, AreAllChecked) {
  std::string lines = "friction_angle [deg],cohesion [MPa]\n";
  for (int k = 0; k < 400; ++k)
    lines += std::to_string(15 + 0.01 * k) + (k == 333 ? ",-1\n" : ",0.5\n");
  try {
    expand_lines(lines);
    FAIL() << "a negative cohesion was taken";
  } catch (const faultsim::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("cohesion = -1 MPa"));
    EXPECT_EQ(error.problems().size(), 1u) << error.what();
  }
}

/// Lines of places have names, which change nothing; places that are one case have theirs together.
TEST_F(SamplesTest, PlacesHaveNames) {
  kind_ = R"("places", "names": "pillar")";
  const Expansion expansion =
      expand_lines("friction_angle [deg], pillar\n18, \"A, 1\"\n20, B\n18, C\n");
  ASSERT_EQ(expansion.cases.size(), 2u);
  EXPECT_EQ(values_of(expansion, 0), "pillar=A, 1, C friction_angle=18 deg");
  EXPECT_EQ(values_of(expansion, 1), "pillar=B friction_angle=20 deg");
  EXPECT_FALSE(parameters_of(expansion, expansion.cases[0])[0].si);
  EXPECT_FALSE(changes_of(expansion, expansion.cases[0]).dump().find("friction_angle") ==
               std::string::npos);
  EXPECT_EQ(changes_of(expansion, expansion.cases[0]).size(), 1u);
  const auto resolved = nlohmann::json::parse(expansion.spec.resolved());
  EXPECT_EQ(resolved["groups"][0]["names"], "pillar");
  EXPECT_EQ(resolved["groups"][0]["kind"], "places");
  kind_ = R"("samples")";
  const Expansion plain = expand_lines("friction_angle [deg]\n18\n20\n18\n");
  EXPECT_EQ(plain.cases[0].identity, expansion.cases[0].identity);
}

TEST_F(SamplesTest, NamesOfPlacesAreThereAndDiffer) {
  kind_ = R"("places")";
  const auto refusal = [&](const std::string& lines) {
    try {
      expand_lines(lines);
    } catch (const faultsim::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal("biot\n1\n"), ::testing::HasSubstr("there is no column \"place\""));
  EXPECT_THAT(refusal("place, biot\nA, 1\nA, 0.9\n"),
              ::testing::HasSubstr("line 3: \"A\" is used by an earlier line"));
  EXPECT_THAT(refusal("place, biot\n, 1\n"), ::testing::HasSubstr("the name is empty"));
}

/// Dates are words to choose from.
TEST_F(SamplesTest, PlacesMayHaveDates) {
  kind_ = R"("places")";
  const std::string stages =
      R"("set": {"/tier": "screening", "/start_date": "1990-01-01", "/stages": [
        {"name": "down", "until": "2000-01-01", "steps": 1, "pressure_change": "-10 bar"}]}, )";
  const Expansion expansion = expand_lines(
      "place, /stages/0/until [date], biot\nA, 1995-01-01, 1\nB, 1994-01-01, 1\n"
      "C, 1995-01-01, 0.9\n",
      stages);
  ASSERT_EQ(expansion.cases.size(), 3u);
  EXPECT_EQ(values_of(expansion, 0), "place=A /stages/0/until=1995-01-01 biot=1");
  EXPECT_EQ(values_of(expansion, 1), "place=B /stages/0/until=1994-01-01 biot=1");
  EXPECT_EQ(scene_of(expansion, expansion.cases[2])["stages"][0]["until"], "1995-01-01");
  EXPECT_THROW(expand_lines("place, /stages/0/until [date]\nA, 1.1.1995\n", stages),
               faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
