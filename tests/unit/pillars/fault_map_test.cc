// What became of the pillars of a campaign whose results are made up.
#include "campaign/pillars/fault_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "campaign/pillars/map_frames.h"
#include "campaign/query/parameters.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Three pillars: of the first F1 slides at the end of year 1 and F2 at that of year 3, at other
/// pressures; of the second nothing slides; the third has no result.
class FaultMapOfResults : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "fault_map_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    Submission s;
    s.name = "pillars";
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1000, 100, 1, 1}};
    s.parameters = {{"depth", faultsim::Dimension::length, false}};
    for (int k = 0; k < 3; ++k) {
      s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {{0, 2000.0 + k, "2000 m"}}});
      s.design_rows.push_back({0, k + 1, k + 1});
    }
    s.spec_resolved = R"({"groups": [{"kind": "samples", "parameters": [{"name": "depth"}]}]})";
    store_->submit(s);
    campaign_ = store_->campaign("");
    std::vector<RunRecord> runs(2);
    for (int k = 0; k < 2; ++k) {
      runs[k].case_id = k + 1;
      runs[k].status = RunStatus::completed;
      runs[k].result = testing::made_up_result(k == 0 ? 0.9 : 0.3);
    }
    faultsim::CaseResult& first = *runs[0].result;
    first.plane_strain = true;
    runs[1].result->plane_strain = true;
    first.whole.faults[1].activation =
        faultsim::FaultOnset{3, 2075, testing::made_up_pressures(-2.5e6), 0.25, 0.5, -2.4e6};
    result_ = first;
    store_->record_runs(campaign_.id, runs);
    campaign_ = store_->campaign("");
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  FaultMap map_of(const std::string& section_fault, int n_places = 3,
                  const std::string& start_date = "") const {
    std::ofstream places(folder_ / "places.csv");
    places << "id,fault,section_fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m,"
              "start_date,refused\n"
              "R,,,5,,,,,,,\"y is \"\"nan\"\"\"\n";
    for (int k = 0; k < n_places; ++k)
      places << "P" << k << ",\"North, main\"," << section_fault << "," << 10 * k << "," << 20 + k
             << "," << 30 + k << "," << 5 + k << "," << 2000 + k << "," << 2300 + k << ","
             << start_date << ",\n";
    places.close();
    return make_fault_map(*store_, campaign_, folder_ / "places.csv");
  }
  static std::vector<double> values_of(const FaultMap& map, const std::string& name) {
    for (const FaultMap::Property& one : map.properties)
      if (one.name == name) return one.values;
    ADD_FAILURE() << "no " << name;
    return {};
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  faultsim::CaseResult result_;  ///< of the first case.
  CampaignInfo campaign_;
};

TEST_F(FaultMapOfResults, PlacesAreThoseOfTheFile) {
  const FaultMap map = map_of("F1");
  ASSERT_EQ(map.places.size(), 4u);
  const FaultMap::Place& last = map.places[3];
  EXPECT_EQ(last.id, "P2");
  EXPECT_EQ(last.fault, "North, main");
  EXPECT_EQ(last.x, 20);
  EXPECT_EQ(last.y, 22);
  EXPECT_EQ(last.azimuth, 32);
  EXPECT_EQ(last.dip, 7);
  EXPECT_EQ(last.top_depth, 2002);
  EXPECT_EQ(last.base_depth, 2302);
  EXPECT_EQ(last.position, 3);
  EXPECT_EQ(map.outcomes,
            (std::vector<std::string>{"refused", "converged", "converged", "waiting"}));
  EXPECT_EQ(map.places[0].id, "R");
  EXPECT_EQ(map.places[0].x, 5);
  EXPECT_FALSE(map.places[0].has_panel());
  EXPECT_TRUE(map.places[1].has_panel());
  EXPECT_EQ(values_of(map, "refused"), (std::vector<double>{1, 0, 0, 0}));
  EXPECT_THROW(map_of("F1", 2), faultsim::InputError);
}

/// Pressures in bar, slips in mm, times in years, of the fault of the section alone.
TEST_F(FaultMapOfResults, ValuesAreOfTheSectionsFaultInTheUnitsOfMaps) {
  struct Expected {
    const char* fault;
    double time, depth, change, absolute, slip, before;
  };
  // made_up_result(0.9): F1 slips 4 mm and F2 half of it.
  // The onset of F2 was searched within its step: half of it had gone by.
  for (const auto& [fault, time, depth, change, absolute, slip, before] :
       {Expected{"F1", 1, 2000, -10, 190, 4, kNothing},
        Expected{"F2", 2.5, 2075, -25, 175, 2, -24}}) {
    const FaultMap map = map_of(fault);
    const auto expect_first = [&](const char* name, double expected) {
      const std::vector<double> values = values_of(map, name);
      ASSERT_EQ(values.size(), 4u);
      EXPECT_TRUE(std::isnan(values[0])) << name << " of a refused pillar";
      EXPECT_NEAR(values[1], expected, 1e-9 * std::abs(expected)) << fault << " " << name;
      EXPECT_TRUE(std::isnan(values[3])) << name << " of a pillar without a result";
    };
    expect_first("slides", 1);
    expect_first("first_sliding_time", time);
    expect_first("first_sliding_depth", depth);
    expect_first("first_sliding_pressure_change", change);
    expect_first("first_sliding_pressure", absolute);
    expect_first("max_slip", slip);
    if (!std::isnan(before)) {
      expect_first("not_yet_at_pressure_change", before);
    } else {
      EXPECT_TRUE(std::isnan(values_of(map, "not_yet_at_pressure_change")[1]));
    }
    for (const char* name : {"first_sliding_time", "first_sliding_depth", "first_sliding_pressure"})
      EXPECT_TRUE(std::isnan(values_of(map, name)[2])) << name << " where nothing slides";
    EXPECT_EQ(values_of(map, "slides")[2], 0);
  }
}

/// The first case slides at the end of year 1, its second fault half way in year 3.
TEST_F(FaultMapOfResults, DatesFollowFromTheStart) {
  EXPECT_EQ(map_of("F1").first_dates, std::vector<std::string>(4));
  EXPECT_EQ(map_of("F1", 3, "1990-01-01").first_dates,
            (std::vector<std::string>{"", "1991-01-01", "", ""}));
  EXPECT_EQ(map_of("F2", 3, "1990-01-01").first_dates[1], "1992-07-02");
}

TEST_F(FaultMapOfResults, HasAFrameForEachYear) {
  const FaultMap map = map_of("F2");
  const std::vector<MapFrame> frames = make_map_frames(*store_, map);
  const std::vector<faultsim::StepResult>& steps = result_.steps;
  ASSERT_EQ(frames.size(), steps.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].year, static_cast<double>(k));
    const auto value = [&](std::size_t property, std::size_t place) {
      return frames[k].properties.at(property).values.at(place);
    };
    EXPECT_EQ(frames[k].properties[0].name, "slides");
    EXPECT_EQ(value(0, 1), k >= 3 ? 1 : 0) << k;
    EXPECT_EQ(value(0, 2), 0) << k;
    EXPECT_EQ(value(1, 1), steps[k].faults[1].chi_bar) << k;
    EXPECT_NEAR(value(2, 1), 1e3 * steps[k].faults[1].max_slip, 1e-12) << k;
    EXPECT_NEAR(value(3, 1), steps[k].pressure_change[0] / 1e5, 1e-12) << k;
    for (const std::size_t nothing : {0, 3}) EXPECT_TRUE(std::isnan(value(1, nothing)));
  }
  EXPECT_EQ(frames_to_pvd({{0, "map_0000.vtu"}, {0.5, "map_0001.vtu"}}),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
            "byte_order=\"LittleEndian\">\n<Collection>\n"
            "<DataSet timestep=\"0\" part=\"0\" file=\"map_0000.vtu\"/>\n"
            "<DataSet timestep=\"0.5\" part=\"0\" file=\"map_0001.vtu\"/>\n"
            "</Collection>\n</VTKFile>\n");
}

/// With dates years are those of the calendar; a history is known from its beginning to its end.
TEST_F(FaultMapOfResults, FramesOfDatesAreYearsOfTheCalendar) {
  const FaultMap map = map_of("F1", 3, "1990-07-01");
  const std::vector<MapFrame> frames = make_map_frames(*store_, map);
  ASSERT_GE(frames.size(), 3u);
  EXPECT_NEAR(frames[0].year, 1990 + 181.0 / 365, 1e-9);
  EXPECT_EQ(frames[1].year, 1991);
  EXPECT_EQ(frames[2].year, 1992);
  // On 1 January 1991 half a year has gone by: the last load step by then is the first one.
  EXPECT_EQ(frames[1].properties[1].values[1], result_.steps[0].faults[0].chi_bar);
  EXPECT_EQ(frames[2].properties[1].values[1], result_.steps[1].faults[0].chi_bar);
}

}  // namespace
}  // namespace faultsweep
