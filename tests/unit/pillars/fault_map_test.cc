// What became of the pillars of a campaign whose results are made up.
#include "campaign/pillars/fault_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "campaign/query/parameters.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

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
        faultsim::FaultOnset{3, 2075, testing::made_up_pressures(-2.5e6)};
    store_->record_runs(campaign_.id, runs);
    campaign_ = store_->campaign("");
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  FaultMap map_of(const std::string& section_fault, int n_places = 3) const {
    std::ofstream places(folder_ / "places.csv");
    places << "id,fault,section_fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m\n";
    for (int k = 0; k < n_places; ++k)
      places << "P" << k << ",\"North, main\"," << section_fault << "," << 10 * k << "," << 20 + k
             << "," << 30 + k << "," << 5 + k << "," << 2000 + k << "," << 2300 + k << "\n";
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
  CampaignInfo campaign_;
};

TEST_F(FaultMapOfResults, PlacesAreThoseOfTheFile) {
  const FaultMap map = map_of("F1");
  ASSERT_EQ(map.places.size(), 3u);
  const FaultMap::Place& last = map.places[2];
  EXPECT_EQ(last.id, "P2");
  EXPECT_EQ(last.fault, "North, main");
  EXPECT_EQ(last.x, 20);
  EXPECT_EQ(last.y, 22);
  EXPECT_EQ(last.azimuth, 32);
  EXPECT_EQ(last.dip, 7);
  EXPECT_EQ(last.top_depth, 2002);
  EXPECT_EQ(last.base_depth, 2302);
  EXPECT_EQ(map.outcomes, (std::vector<std::string>{"converged", "converged", "waiting"}));
  EXPECT_THROW(map_of("F1", 2), faultsim::InputError);
}

/// Pressures in bar, slips in mm, times in years, of the fault of the section alone.
TEST_F(FaultMapOfResults, ValuesAreOfTheSectionsFaultInTheUnitsOfMaps) {
  struct Expected {
    const char* fault;
    double time, depth, change, absolute, slip;
  };
  // made_up_result(0.9): F1 slips 4 mm and F2 half of it.
  for (const auto& [fault, time, depth, change, absolute, slip] :
       {Expected{"F1", 1, 2000, -10, 190, 4}, Expected{"F2", 3, 2075, -25, 175, 2}}) {
    const FaultMap map = map_of(fault);
    const auto expect_first = [&](const char* name, double expected) {
      const std::vector<double> values = values_of(map, name);
      ASSERT_EQ(values.size(), 3u);
      EXPECT_NEAR(values[0], expected, 1e-9 * std::abs(expected)) << fault << " " << name;
      EXPECT_TRUE(std::isnan(values[2])) << name << " of a pillar without a result";
    };
    expect_first("slides", 1);
    expect_first("first_sliding_time", time);
    expect_first("first_sliding_depth", depth);
    expect_first("first_sliding_pressure_change", change);
    expect_first("first_sliding_pressure", absolute);
    expect_first("max_slip", slip);
    for (const char* name : {"first_sliding_time", "first_sliding_depth", "first_sliding_pressure"})
      EXPECT_TRUE(std::isnan(values_of(map, name)[1])) << name << " where nothing slides";
    EXPECT_EQ(values_of(map, "slides")[1], 0);
  }
}

}  // namespace
}  // namespace faultsweep
