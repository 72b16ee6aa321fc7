#include "campaign/tradeoff/ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace faultsweep {
namespace {

using nlohmann::json;

Expansion grid() {
  const std::string text =
      R"({"format": 1, "name": "test", "base": "docs/examples/scenes/rotliegend.json",
    "set": {"/tier": "custom", "/mesh": {"strike": "200 m", "dip": "50 m", "normal": "50 m"},
            "/numerics/plane_strain": "on"},
    "design": {"kind": "grid", "parameters": {
      "offset": ["0 m", "100 m"], "friction_angle": ["20 deg", "24 deg", "28 deg", "32 deg"],
      "ratio_across": [0.6, 0.74]}}})";
  return expand(parse_campaign(text, FAULTSIM_SOURCE_DIR "/test.json"));
}

/// The sampled cases of the groups that were added.
std::map<std::string, json> sampled(long n_cases) {
  const Expansion campaign = grid();
  json spec = {{"design", {{"groups", json::array()}}}};
  add_sample(campaign, campaign.spec.groups[0].scene, n_cases, {"screening", "standard"}, spec);
  std::map<std::string, json> all;
  for (const json& group : spec["design"]["groups"]) {
    all[group["name"]] = group["design"]["parameters"]["choice"]["variants"];
  }
  return all;
}

TEST(Sample, IsTheSameAtEachTierAndHasItsMesh) {
  const auto all = sampled(6);
  const json& coarse = all.at(sample_group("screening"));
  const json& fine = all.at(sample_group("standard"));
  ASSERT_EQ(coarse.size(), 6u);
  for (const auto& [name, changes] : coarse.items()) {
    EXPECT_EQ(changes.at("/tier"), "screening");
    EXPECT_EQ(changes.at("/mesh"), json::object());
    EXPECT_FALSE(changes.at("/numerics").contains("plane_strain"));
    json as_fine = changes;
    as_fine["/tier"] = "standard";
    EXPECT_EQ(fine.at(name), as_fine);
  }
}

TEST(Sample, ReachesEveryLevelOfAGrid) {
  const auto all = sampled(6);
  std::map<std::string, std::set<std::string>> levels;  // other than the base's own
  for (const auto& [name, changes] : all.at(sample_group("screening")).items()) {
    for (const auto& [pointer, value] : changes.items()) levels[pointer].insert(value.dump());
  }
  EXPECT_EQ(levels["/friction"].size(), 4u);
  EXPECT_EQ(levels["/geometry"].size(), 1u);
  EXPECT_EQ(levels["/initial_state"].size(), 1u);
}

TEST(Sample, OfMoreCasesThanThereAreHasThemAll) {
  EXPECT_EQ(sampled(1000).at(sample_group("standard")).size(), 16u);
}

}  // namespace
}  // namespace faultsweep
