// Which charts a case has, what they show where nothing is said, and where things lie in a field.
#include "simulator/case_figures/case_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/figure/palette.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

TEST(CriticalMoment, IsThatOfTheLargestAreaAmongStepsAtTheirStrength) {
  const CriticalMoment critical = critical_moment(small_result());
  EXPECT_EQ(critical.fault, 1U);
  EXPECT_EQ(critical.step, 2U);
}

TEST(FieldSection, PutsBlocksAndFaultsWhereTheSceneHasThem) {
  Scene scene = field_scene();
  scene.faults[1].dip_from_vertical = 0.5;
  const figure::Section section = field_section(scene);
  ASSERT_EQ(section.faults.size(), 3U);
  // F2 lies between blocks from 2000 to 2200 and from 2150 to 2350 m, and goes 150 m beyond both.
  const auto& f2 = section.faults[1].points;
  EXPECT_DOUBLE_EQ(f2.front().y, 1850);
  EXPECT_DOUBLE_EQ(f2.back().y, 2500);
  EXPECT_NEAR(f2.front().x, -250 * std::tan(0.5), 1e-9);  // above the pivot at 2100 m: to the west
  const auto bands = compartments_beside(scene, 1);
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_EQ(bands[0].name, "west");
  EXPECT_FALSE(bands[0].on_plus_side);
  EXPECT_DOUBLE_EQ(bands[1].top, 2150);
  ASSERT_EQ(compartments_beside(scene, 2).size(), 1U);
  EXPECT_FALSE(compartments_beside(scene, 2).front().on_plus_side);
}

TEST(FieldSection, HasLayersToTheNextOneAndBlocksBetweenTheirFaults) {
  const Scene scene = field_scene();
  const figure::Section section = field_section(scene);
  const std::size_t n_layers = scene.field.layers.size();
  ASSERT_EQ(section.rocks.size(), n_layers + scene.field.blocks.size());
  for (std::size_t k = 0; k < n_layers; ++k) {
    EXPECT_EQ(section.rocks[k].top, scene.field.layers[k].top_depth);
    EXPECT_EQ(section.rocks[k].base,
              k + 1 < n_layers ? scene.field.layers[k + 1].top_depth : scene.field.depth);
  }
  for (std::size_t b = 0; b < scene.field.blocks.size(); ++b) {
    const figure::Section::Rock& rock = section.rocks[n_layers + b];
    const DepthInterval range = reservoir_range(scene.field, scene.field.blocks[b]);
    EXPECT_TRUE(rock.is_reservoir);
    EXPECT_EQ(rock.top, range.top);
    EXPECT_EQ(rock.base, range.bottom);
    EXPECT_EQ(rock.from, fault_x(scene, b, range.top));
    EXPECT_EQ(rock.to, fault_x(scene, b + 1, range.top));
    EXPECT_EQ(rock.from_base, fault_x(scene, b, range.bottom));
    EXPECT_EQ(rock.to_base, fault_x(scene, b + 1, range.bottom));
  }
  EXPECT_GE(section.top, 0);
  EXPECT_LE(section.base, scene.field.depth);
}

TEST(CompartmentsBeside, AreThoseOfTheBlocksOnTheirSides) {
  const Scene scene = field_scene();
  for (std::size_t fault = 0; fault < 3; ++fault) {
    for (const figure::DepthBand& band : compartments_beside(scene, fault)) {
      const std::size_t block = band.name == scene.field.blocks[0].name ? 0 : 1;
      EXPECT_EQ(band.on_plus_side, block == fault) << "fault " << fault << " has the block of its "
                                                   << "number on its plus side";
      const DepthInterval range = reservoir_range(scene.field, scene.field.blocks[block]);
      EXPECT_EQ(band.top, range.top);
      EXPECT_EQ(band.base, range.bottom);
    }
  }
}

TEST(DrawCase, DrawsWhatTheHistoryHoldsWithoutFields) {
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  for (const CaseChart chart :
       {CaseChart::history, CaseChart::thickness, CaseChart::slip, CaseChart::section}) {
    const std::string svg = draw_case(picture, {chart, {}, {}, true});
    EXPECT_EQ(figure::xml_problem(svg), "");
    EXPECT_EQ(svg, draw_case(picture, {chart, {}, {}, true}));
    EXPECT_THAT(svg, HasSubstr("a &lt;small&gt; case"));
  }
  EXPECT_THAT(draw_case(picture, {CaseChart::section, {}, 1, false}),
              HasSubstr("west, Δp −100 bar"));
  EXPECT_THAT(draw_case(picture, {CaseChart::history, {}, {}, false}), HasSubstr(">gas storage<"));
}

TEST(DrawCase, RefusesWhatIsNotThereAndSaysWhatIs) {
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  EXPECT_THAT(message_of(picture, {CaseChart::profiles, {}, {}, false}),
              HasSubstr("fields on the faults, which were not kept"));
  EXPECT_THAT(message_of(picture, {CaseChart::history, "F9", {}, false}),
              HasSubstr("\"F9\" is not a fault of the case; choose one of F1, F2, F3"));
  EXPECT_THAT(message_of(picture, {CaseChart::section, {}, 7, false}),
              HasSubstr("no load step 7; choose 0 to 2"));
  CaseResult empty;
  EXPECT_THAT(message_of({empty, scene, nullptr, {}}, {CaseChart::history, {}, {}, false}),
              HasSubstr("no faults or no load step"));
  Scene box = scene;
  box.geometry_kind = GeometryKind::box;
  EXPECT_THAT(message_of({result, box, nullptr, {}}, {CaseChart::section, {}, {}, false}),
              HasSubstr("this scene is a box"));
}

TEST(RequireDrawsOriginal, RefusesChartsThatAreTheSameWithoutIt) {
  for (const CaseChartInfo& info : case_charts()) {
    const bool has_curves = info.chart != CaseChart::section && info.chart != CaseChart::fault_map;
    EXPECT_EQ(info.draws_original, has_curves) << info.name;
    if (has_curves) {
      EXPECT_NO_THROW(require_draws_original(info));
      continue;
    }
    try {
      require_draws_original(info);
      ADD_FAILURE() << info.name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--before"));
      EXPECT_THAT(error.what(), HasSubstr("history, thickness, slip, profiles, stress-path"));
    }
  }
}

TEST(StepLooks, HaveAColourPerFaultAndTheWordsOfTheStep) {
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::vector<StepLook> looks = step_looks({result, scene, nullptr, {}});
  ASSERT_EQ(looks.size(), 3U);
  EXPECT_EQ(looks[1].says, "load step 1, primary production, 5 years");
  ASSERT_EQ(looks[1].chi.size(), 3U);
  EXPECT_NE(looks[1].chi[0], looks[1].chi[1]);
  EXPECT_EQ(looks[0].chi_colours.at(std::stoul(looks[1].chi[0], nullptr, 36)),
            figure::chi_colour(result.steps[1].faults[0].chi_bar))
      << "one piece, of the whole fault";
  EXPECT_EQ(looks[2].notes.front().second, "Δp −200 bar");
}

TEST(MapFields, AreShownByNameOnFaultMapsOnly) {
  EXPECT_EQ(field_shown("--show", "state"), MapField::state);
  try {
    field_shown("--show", "colour");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("choose one of chi, slip, state, pressure"));
  }
  for (const CaseChartInfo& info : case_charts()) {
    EXPECT_NO_THROW(require_shows(info, MapField::chi));
    if (info.chart == CaseChart::fault_map)
      EXPECT_NO_THROW(require_shows(info, MapField::slip));
    else
      EXPECT_THROW(require_shows(info, MapField::slip), InputError) << info.name;
  }
}

TEST(PictureFile, IsNamedSvgOrPngAndNoInput) {
  EXPECT_THROW(require_picture_file("x.pdf", {".svg", ".png"}, {}), InputError);
  const auto input = std::filesystem::path(testing::TempDir()) / "input.svg";
  std::ofstream(input) << "<svg/>";
  EXPECT_THROW(require_picture_file(input, {".svg"}, {input}), InputError);
  EXPECT_NO_THROW(require_picture_file(input, {".svg"}, {}));
}

}  // namespace
}  // namespace faultsim
