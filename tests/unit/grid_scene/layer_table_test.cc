#include "simulator/grid_scene/layer_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/common/errors.h"

namespace faultsim::grid_scene {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kHead = "name, top [m], density [kg/m3], youngs_modulus [GPa], poisson_ratio\n";

RockLayers read(const std::string& rows) {
  return read_layers(kHead + rows, "layers.csv", 1500, 1800, 5000);
}

TEST(LayerTable, HasLayersAboveAndBelowTheReservoir) {
  const RockLayers layers = read(
      "sand, 0, 2000, 5, 0.3\nsalt, 900, 2100, 35, 0.3\nreservoir, 0, 2400, 11, 0.15\n"
      "shale, 0, 2500, 20, 0.25\nbase, 2500, 2600, 30, 0.2\n");
  ASSERT_EQ(layers.all.size(), 5u);
  EXPECT_EQ(layers.reservoir, 2u);
  EXPECT_EQ(layers.all[1].name, "salt");
  EXPECT_EQ(layers.all[1].top, 900);
  EXPECT_EQ(layers.all[1].youngs_modulus, 35e9);
  EXPECT_EQ(layers.all[4].density, 2600);
  EXPECT_EQ(layers.all[4].poisson_ratio, 0.2);
}

TEST(LayerTable, IsRefusedWithAllThatIsWrong) {
  const auto refused = [](const std::string& rows, const std::string& what) {
    EXPECT_THAT([&] { read(rows); }, ThrowsMessage<InputError>(HasSubstr(what)));
  };
  const std::string sand = "sand, 0, 2000, 5, 0.3\n", reservoir = "reservoir, 0, 2400, 11, 0.15\n",
                    below = "below, 0, 2600, 30, 0.2\n";
  refused(sand + below, "no layer is called reservoir, with others above and below");
  refused(reservoir + below, "no layer is called reservoir, with others above and below");
  refused(sand + reservoir, "no layer is called reservoir, with others above and below");
  refused("sand, 10, 2000, 5, 0.3\n" + reservoir + below, "begins below the surface");
  refused(sand + "salt, 1600, 2100, 35, 0.3\n" + reservoir + below,
          "\"salt\" begins at 1600 m, where the reservoir is: it reaches up to 1500 m");
  refused(sand + "salt, 0, 2100, 35, 0.3\n" + reservoir + below, "does not begin below the layer");
  refused(sand + reservoir + below + "base, 1700, 2600, 30, 0.2\n",
          "there is room from 1800 to 5000 m");
  refused(sand + sand + reservoir + below, "is not a unique name");
  refused("sand, 0, 2000, 5, 0.7\n" + reservoir + below, "0 to 0.4999");
  EXPECT_THAT([] { read_layers("name, top [m]\nsand, 0\n", "layers.csv", 1, 2, 3); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("there is no column density"),
                                                       HasSubstr("no column poisson_ratio"))));
}

}  // namespace
}  // namespace faultsim::grid_scene
