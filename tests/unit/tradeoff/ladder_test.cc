#include "campaign/tradeoff/ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "campaign/expansion/expansion.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;

faultsim::JsonDocument example(const std::string& name) {
  return faultsim::read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/" + name + ".json");
}

const TradeAxis& axis(const std::vector<TradeAxis>& ladder, const std::string& name) {
  const auto found = std::find_if(ladder.begin(), ladder.end(),
                                  [&](const TradeAxis& one) { return one.name == name; });
  EXPECT_NE(found, ladder.end()) << name;
  return *found;
}

std::string family(const faultsim::JsonDocument& scene) {
  std::vector<faultsim::Problem> problems;
  return faultsim::make_plan(faultsim::read_scene(scene), problems).family;
}

TEST(Ladder, OfTheReferenceSceneNamesItsTiers) {
  const auto ladder = make_ladder(example("scenes/rotliegend"), {600, 20e9});
  const TradeAxis& space = axis(ladder, "cells, 3D");
  EXPECT_EQ(space.choices[2].name, "100 x 0.5 to 15 x 0.5 m (standard)");
  EXPECT_EQ(space.choices[2].left_out, "");
  EXPECT_EQ(space.choices[3].name, "75 x 0.5 to 10 x 0.5 m (reference)");
  EXPECT_EQ(space.choices[3].left_out, "") << "it fits 20 GB";
  EXPECT_EQ(axis(ladder, "cells, plane strain").choices[3].name, "2.5 to 10 m (screening)");
  // The choice that is named after the tier has the tier's operator.
  faultsim::JsonDocument choice = example("scenes/rotliegend");
  for (const Change& change : space.choices[2].changes) {
    ASSERT_TRUE(faultsim::put_value(choice.value, change.pointer, change.value));
  }
  EXPECT_EQ(family(choice), family(example("scenes/rotliegend")));
  EXPECT_TRUE(std::none_of(ladder.begin(), ladder.end(),
                           [](const TradeAxis& one) { return one.name == "salt steps"; }));
}

TEST(Ladder, SaltHasStepsFromALoadStepDown) {
  const auto ladder = make_ladder(example("scenes/rotliegend-salt"), {300, 20e9});
  const TradeAxis& salt = axis(ladder, "salt steps");
  EXPECT_EQ(salt.choices[2].name, "1 year");
  for (std::size_t k = 2; k + 1 < salt.choices.size(); ++k) {
    EXPECT_DOUBLE_EQ(salt.choices[k].size / salt.choices[k + 1].size, 2);
  }
}

TEST(Ladder, ABoxHasNeitherTiersNorExtents) {
  const auto ladder = make_ladder(example("verification/v6_penny_crack"), {1e6, 0});
  EXPECT_EQ(axis(ladder, "cells, 3D").choices.size(), 4u);
  for (const TradeAxis& one : ladder) {
    EXPECT_THAT(one.name, ::testing::Not(HasSubstr("of the model")));
    for (const TradeChoice& choice : one.choices) {
      EXPECT_THAT(choice.name, ::testing::Not(HasSubstr("standard")));
    }
  }
}

TEST(Ladder, IsAValidCampaignWithACasePerChoice) {
  const auto scene = example("scenes/rotliegend-salt");
  const auto ladder = make_ladder(scene, {8, 0});
  const Expansion expansion =
      expand(parse_campaign(ladder_spec("trade", scene, ladder).dump(), scene.source));
  std::size_t n_choices = 0;
  for (const TradeAxis& one : ladder) {
    n_choices += static_cast<std::size_t>(
        std::count_if(one.choices.begin(), one.choices.end(),
                      [](const TradeChoice& choice) { return choice.left_out.empty(); }));
  }
  EXPECT_EQ(static_cast<std::size_t>(expansion.n_designed), n_choices);
  EXPECT_GT(expansion.n_merged, 5);  // "as given" is the same case on every axis
}

TEST(Ladder, OfAWrongSceneIsAnError) {
  faultsim::JsonDocument scene = example("scenes/rotliegend");
  scene.value["geometry"]["width"] = "20";
  EXPECT_THROW(make_ladder(scene, {}), faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
