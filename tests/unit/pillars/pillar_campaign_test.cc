#include "campaign/pillars/pillar_campaign.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "simulator/common/units.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {
namespace {

using Role = PillarRole;

faultsim::JsonDocument section() {
  return faultsim::read_json_file(std::string(FAULTSIM_SOURCE_DIR) +
                                  "/docs/examples/pillars/section.json");
}

PillarTable table_of(const std::map<Role, std::vector<double>>& numbers) {
  PillarTable table;
  table.source = "t.csv";
  table.numbers = numbers;
  const std::size_t n = numbers.begin()->second.size();
  for (std::size_t i = 0; i < n; ++i) {
    table.lines.push_back(static_cast<long>(i) + 2);
    table.ids.push_back("P" + std::to_string(i));
    table.faults.emplace_back("F");
  }
  table.numbers[Role::x].resize(n, 1000);
  table.numbers[Role::y].resize(n, 2000);
  return table;
}

/// Line `n` of a text, from 0.
std::string line(const std::string& text, int n) {
  std::istringstream stream(text);
  std::string one;
  for (int i = 0; i <= n; ++i) std::getline(stream, one);
  return one;
}

PillarCampaign campaign_of(const PillarTable& table,
                           const std::optional<RegionalStress>& stress = {}) {
  return make_pillar_campaign(table, section(), "section.json", "test", stress);
}

TEST(PillarCampaign, RefusesAKeyThatTwoColumnsGive) {
  const auto refusal = [](const std::vector<std::string>& names) {
    PillarTable table = table_of({{Role::dip, {10}}});
    for (const std::string& name : names) table.parameters.push_back({name, "deg", {20}, name});
    try {
      campaign_of(table);
    } catch (const faultsim::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({"friction_angle"}), "");
  EXPECT_EQ(refusal({"friction_angle", "/friction/friction_angle"}),
            "t.csv: two columns give /friction/friction_angle; keep one of the two");
  EXPECT_EQ(refusal({"/faults/1/dip_from_vertical"}),
            "t.csv: two columns give /faults/1/dip_from_vertical; keep one of the two");
}

TEST(PillarCampaign, KeepsWhatTheTableRefused) {
  PillarTable table = table_of({{Role::dip, {10}}});
  table.refused.push_back({"X",
                           "G",
                           1,
                           {{Role::y, 5}},
                           {{"THROW", 1, "\"nan\" is not a number", "write a number"},
                            {"X_RD", 1, "is empty", "write a number"}}});
  const PillarCampaign campaign = campaign_of(table);
  EXPECT_EQ(campaign.n_cases, 1U);
  ASSERT_EQ(campaign.refused.size(), 1U);
  EXPECT_EQ(campaign.refused[0].id, "X");
  EXPECT_EQ(campaign.refused[0].line, 1);
  ASSERT_EQ(campaign.refused[0].problems.size(), 2U);
  EXPECT_EQ(campaign.refused[0].problems[1].pointer, "X_RD");
  // In the order of the table, with what is known of it and why it is no case.
  EXPECT_EQ(line(campaign.places, 1), "X,G,,,5,,,,,,\"\"\"nan\"\" is not a number\"");
  EXPECT_EQ(line(campaign.places, 2).substr(0, 5), "P0,F,");
  EXPECT_EQ(nlohmann::json::parse(campaign.spec)["title"],
            "Pillars of t.csv; 1 of 2 are refused and not among the cases");
}

TEST(PillarCampaign, PutsEachPillarIntoTheSection) {
  const PillarCampaign campaign = campaign_of(table_of({{Role::depth, {2100, 2250.5}},
                                                        {Role::offset, {50, 100}},
                                                        {Role::thickness_foot, {180, 190}},
                                                        {Role::thickness_hanging, {150, 260}},
                                                        {Role::dip_from_horizontal, {76.7, 95}}}));
  EXPECT_EQ(campaign.n_cases, 2u);
  EXPECT_TRUE(campaign.refused.empty());
  EXPECT_EQ(
      line(campaign.samples, 0),
      "pillar, /geometry/layers/2/top [m], /geometry/layers/3/top [m], /geometry/pivot_depth [m], "
      "/geometry/blocks/1/offset [m], /geometry/blocks/0/thickness [m], "
      "/geometry/blocks/1/thickness [m], /faults/1/dip_from_vertical [deg]");
  EXPECT_EQ(line(campaign.samples, 1), "P0, 2100, 2300, 2200, 50, 180, 150, 13.3");
  EXPECT_EQ(line(campaign.samples, 2), "P1, 2250.5, 2450.5, 2350.5, 100, 190, 260, -5");
  // The panel reaches from the shallower top to the deeper base: 2250.5 to 2250.5 + 100 + 260.
  EXPECT_EQ(line(campaign.places, 2), "P1,F,pillar,1000,2000,0,-5,2250.5,2610.5,,");
  const auto spec = nlohmann::json::parse(campaign.spec);
  EXPECT_EQ(spec["base"], "section.json");
  EXPECT_EQ(spec["design"]["kind"], "places");
  EXPECT_EQ(spec["design"]["file"], "samples.csv");
  EXPECT_EQ(spec["design"]["names"], "pillar");
  EXPECT_EQ(spec["name"], "test");
  EXPECT_EQ(spec["set"]["/numerics/activation_tolerance"], "0.1 bar");
  EXPECT_EQ(spec["set"]["/numerics/plane_strain"], "on");
}

TEST(PillarCampaign, RatiosFollowTheStrikeInTheRegionalStress) {
  const RegionalStress stress{160, 0.83, 0.72};
  const PillarCampaign campaign =
      campaign_of(table_of({{Role::azimuth, {160, 70, 115, 340}}}), stress);
  EXPECT_EQ(line(campaign.samples, 0),
            "pillar, /initial_state/ratio_across, /initial_state/ratio_along");
  const auto ratios = [&](int pillar) {
    std::istringstream stream(line(campaign.samples, pillar + 1).substr(3));  // "P0,"
    double across = 0, along = 0;
    char comma = 0;
    stream >> across >> comma >> along;
    return std::pair(across, along);
  };
  EXPECT_NEAR(ratios(0).first, 0.72, 1e-12);  // strikes along the largest stress
  EXPECT_NEAR(ratios(0).second, 0.83, 1e-12);
  EXPECT_NEAR(ratios(1).first, 0.83, 1e-12);  // across it
  EXPECT_NEAR(ratios(1).second, 0.72, 1e-12);
  EXPECT_NEAR(ratios(2).first, 0.775, 1e-12);  // at 45 degrees
  EXPECT_NEAR(ratios(2).second, 0.775, 1e-12);
  EXPECT_NEAR(ratios(3).first, 0.72, 1e-12);  // the other way round is the same
  EXPECT_NEAR(campaign.largest_shear_left_out, 0.055, 1e-12);
  EXPECT_THROW(campaign_of(table_of({{Role::offset, {1}}}), stress), faultsim::InputError);
}

TEST(PillarCampaign, LeavesOutWhatCannotBeModelledInTheWordsOfTheScene) {
  PillarTable table = table_of({{Role::depth, {1400, 2100, 2100, 2100}},
                                {Role::dip, {0, 50, 0, 0}},
                                {Role::offset, {0, 0, 2700, 10}}});
  table.headings = {{Role::depth, "TOP"}, {Role::dip, "DIP"}, {Role::offset, "THROW"}};
  const PillarCampaign campaign = campaign_of(table);
  EXPECT_EQ(campaign.n_cases, 1u);
  ASSERT_EQ(campaign.refused.size(), 3u);
  EXPECT_EQ(campaign.refused[0].id, "P0");
  const auto problem = [&](std::size_t k) { return campaign.refused[k].problems.at(0); };
  EXPECT_NE(problem(0).what.find("is not below that of \"salt\""), std::string::npos)
      << problem(0).what;
  // By the column, as the table calls it.
  EXPECT_EQ(problem(0).pointer, "TOP");
  EXPECT_EQ(problem(1).pointer, "DIP");
  EXPECT_EQ(problem(2).pointer, "THROW");
  EXPECT_EQ(campaign.refused[2].line, 4);
  EXPECT_EQ(problem(2).line, 4);
  EXPECT_EQ(line(campaign.places, 1).substr(0, 3), "P0,");
  EXPECT_NE(line(campaign.places, 1).find("is not below that of"), std::string::npos);
  EXPECT_EQ(line(campaign.places, 4).substr(0, 3), "P3,");
  EXPECT_EQ(line(campaign.samples, 1).substr(0, 3), "P3,");
}

TEST(PillarCampaign, OtherColumnsAreParametersOfTheScene) {
  PillarTable table = table_of({{Role::offset, {10, 20}}});
  table.parameters = {{"friction_angle", "deg", {20, 25}, "PHI"}};
  EXPECT_EQ(line(campaign_of(table).samples, 2), "P1, 20, 25");
  EXPECT_NE(line(campaign_of(table).samples, 0).find("friction_angle [deg]"), std::string::npos);
  table.parameters = {{"frictoin_angle", "deg", {20, 25}, "PHI"}};
  EXPECT_THROW(campaign_of(table), faultsim::InputError);
  table.parameters.clear();
  table.numbers.erase(Role::offset);
  EXPECT_THROW(campaign_of(table), faultsim::InputError);  // nothing differs
}

TEST(PillarCampaign, NeedsAFieldOfTwoBlocks) {
  const auto box = faultsim::parse_json(faultsim::starter_scene("box"), "box.json");
  EXPECT_THROW(make_pillar_campaign(table_of({{Role::offset, {10}}}), box, "box.json", "x", {}),
               faultsim::InputError);
}

/// A section whose pressures come from a flow result on a map: 200 km east, 500 km north.
class PillarsInAField : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "pillars_XXXXXX";
    folder_ = mkdtemp(name.data());
    std::ofstream(folder_ / "p.csv")
        << "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 2000-01-01 [bar]\n"
           "200000, 500000, 2500, 9000, 9000, 2000, 250, 150\n";
    base_ = section();
    base_.source = (folder_ / "section.json").string();
    base_.value["pressure_field"] = {{"file", "p.csv"}};
    base_.value["stages"] = {{{"name", "production"}, {"until", "2000-01-01"}}};
    base_.value.erase("compartments");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  PillarCampaign of(const std::map<Role, std::vector<double>>& numbers) const {
    return make_pillar_campaign(table_of(numbers), base_, "section.json", "test", {});
  }
  /// origin x, y in m and azimuth in deg: the last three columns.
  static std::array<double, 3> placement(const PillarCampaign& campaign, int pillar) {
    std::istringstream stream(line(campaign.samples, pillar + 1));
    std::vector<double> values;
    std::string cell;
    std::getline(stream, cell, ',');  // its name
    while (std::getline(stream, cell, ',')) values.push_back(std::stod(cell));
    const std::size_t n = values.size();
    return {values[n - 3], values[n - 2], values[n - 1]};
  }

  std::filesystem::path folder_;
  faultsim::JsonDocument base_;
};

TEST_F(PillarsInAField, TakeItWhereTheyAre) {
  const PillarCampaign campaign = of({{Role::x, {199000, 200000, 201000}},
                                      {Role::y, {500000, 501000, 500500}},
                                      {Role::azimuth, {0, 90, 30}},
                                      {Role::dip, {0, 0, 45}}});
  EXPECT_EQ(campaign.n_cases, 3u);
  EXPECT_NE(line(campaign.samples, 0)
                .find("/pressure_field/origin/0 [m], /pressure_field/origin/1 [m], "
                      "/pressure_field/azimuth [deg]"),
            std::string::npos);
  EXPECT_EQ(placement(campaign, 0), (std::array<double, 3>{199000, 500000, 0}));
  EXPECT_EQ(placement(campaign, 1), (std::array<double, 3>{200000, 501000, 90}));
  // The dipping fault lies 100 m west of x = 0 at the top, 100 m above the pivot: the section's
  // origin is as far to the right of its strike.
  const auto [x, y, azimuth] = placement(campaign, 2);
  EXPECT_NEAR(x, 201000 + 100 * std::cos(30 * faultsim::kDegree), 1e-6);
  EXPECT_NEAR(y, 500500 - 100 * std::sin(30 * faultsim::kDegree), 1e-6);
  EXPECT_NEAR(azimuth, 30, 1e-12);
  const auto spec = nlohmann::json::parse(campaign.spec);
  EXPECT_EQ(spec["set"]["/pressure_field/origin"], (nlohmann::json{"0 m", "0 m"}));
}

TEST_F(PillarsInAField, MayHaveAMapOfTheirOwn) {
  base_.value["pressure_field"]["origin"] = {"200 km", "500 km"};
  base_.value["pressure_field"]["azimuth"] = "90 deg";
  const PillarCampaign campaign = of({{Role::x, {100}}, {Role::y, {1000}}, {Role::azimuth, {20}}});
  ASSERT_EQ(campaign.n_cases, 1u);
  // Their north is the field's east, their east its south.
  const auto [x, y, azimuth] = placement(campaign, 0);
  EXPECT_NEAR(x, 201000, 1e-6);
  EXPECT_NEAR(y, 499900, 1e-6);
  EXPECT_NEAR(azimuth, 110, 1e-9);
}

TEST_F(PillarsInAField, AreRefusedOutsideOfIt) {
  PillarTable table =
      table_of({{Role::x, {200000, 300000}}, {Role::y, {500000, 500000}}, {Role::azimuth, {0, 0}}});
  table.headings = {{Role::x, "X_RD"}, {Role::y, "Y_RD"}};
  const PillarCampaign campaign = make_pillar_campaign(table, base_, "section.json", "test", {});
  EXPECT_EQ(campaign.n_cases, 1u);
  ASSERT_EQ(campaign.refused.size(), 1u);
  EXPECT_EQ(campaign.refused[0].id, "P1");
  EXPECT_EQ(campaign.refused[0].problems[0].pointer, "X_RD, Y_RD");
  EXPECT_EQ(campaign.refused[0].problems[0].cure.find("leave the pillar out, or"), 0u);
  EXPECT_NE(campaign.refused[0].problems[0].what.find("no flow cell lies in a compartment"),
            std::string::npos);
}

/// Temperatures too, from a map of their own.
TEST_F(PillarsInAField, TakeTemperaturesWhereTheyAre) {
  std::ofstream(folder_ / "t.csv")
      << "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [degC], 2000-01-01 [degC]\n"
         "1000, 2000, 2500, 9000, 9000, 2000, 90, 80\n";
  base_.value["temperature_field"] = {{"file", "t.csv"}, {"origin", {"-199 km", "-498 km"}}};
  base_.value["materials"]["reservoir"]["thermal_expansion"] = "1e-5 1/K";
  const PillarCampaign campaign =
      of({{Role::x, {200000}}, {Role::y, {500000}}, {Role::azimuth, {0}}});
  ASSERT_EQ(campaign.n_cases, 1u) << campaign.refused.at(0).problems.at(0).what;
  EXPECT_NE(line(campaign.samples, 0).find("/temperature_field/origin/0 [m]"), std::string::npos);
  EXPECT_EQ(placement(campaign, 0), (std::array<double, 3>{1000, 2000, 0}));
  const auto spec = nlohmann::json::parse(campaign.spec);
  EXPECT_EQ(spec["set"]["/temperature_field/origin"], (nlohmann::json{"0 m", "0 m"}));
}

/// A history of its own, which ends at a date; the map knows when it began.
TEST_F(PillarsInAField, EndAtDatesOfTheirOwn) {
  PillarTable table = table_of({{Role::x, {200000, 200000, 200000}},
                                {Role::y, {500000, 500000, 500000}},
                                {Role::azimuth, {0, 0, 0}}});
  table.until = {"1995-01-01", "2000-01-01", "1985-01-01"};
  table.headings[Role::until] = "LAST";
  const PillarCampaign campaign = make_pillar_campaign(table, base_, "section.json", "test", {});
  EXPECT_EQ(campaign.n_cases, 2u);
  EXPECT_EQ(line(campaign.samples, 0).substr(0, 31), "pillar, /stages/0/until [date],");
  EXPECT_EQ(line(campaign.samples, 1).substr(0, 15), "P0, 1995-01-01,");
  ASSERT_EQ(campaign.refused.size(), 1u);
  EXPECT_EQ(campaign.refused[0].problems[0].pointer, "LAST");
  EXPECT_EQ(line(campaign.places, 1), "P0,F,pillar,200000,500000,0,0,2000,2200,1990-01-01,");
  base_.value["stages"] = {{{"name", "production"}, {"duration", "10 year"}}};
  EXPECT_THROW(make_pillar_campaign(table, base_, "section.json", "test", {}),
               faultsim::InputError);
}

TEST_F(PillarsInAField, NeedTheirStrike) {
  EXPECT_THROW(of({{Role::x, {200000}}, {Role::y, {500000}}}), faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
