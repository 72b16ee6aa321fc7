// Charts that are drawn from the fields on the faults: profiles, stress paths, sections.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "simulator/figure/palette.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/result_files/field_reader.h"
#include "tests/unit/case_figures/fields_of_a_fault.h"
#include "tests/unit/case_figures/read_curves.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

TEST_F(FieldsOfAFault, AreReadBackAsTheyWereWritten) {
  const FieldReader reader(folder_ / "faults.h5");
  EXPECT_EQ(reader.steps(), (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(reader.faults().size(), 1U);
  EXPECT_EQ(reader.faults()[0].name, "F2");
  ASSERT_EQ(reader.faults()[0].faces.size(), 2U);
  const StoredFields now = reader.fields(0, 2);
  EXPECT_EQ(now.traction(2, 1), 6e6);
  EXPECT_EQ(now.slip(2, 1), 0.02);
  EXPECT_EQ(now.critical_index[1], 0.8);
  EXPECT_EQ(now.fault_pressure_change[0], -2e6);
  EXPECT_EQ(now.state[1], 2);
}

TEST_F(FieldsOfAFault, GiveTheChartsThatNeedThem) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, &reader, {}};
  for (const CaseChart chart :
       {CaseChart::profiles, CaseChart::fault_map, CaseChart::stress_path}) {
    const std::string svg = draw_case(picture, {chart, "F2", {}, false});
    EXPECT_EQ(figure::xml_problem(svg), "");
    EXPECT_EQ(svg, draw_case(picture, {chart, "F2", {}, false}));
  }
  EXPECT_THAT(draw_case(picture, {CaseChart::stress_path, "F2", {}, false}),
              HasSubstr("at 2,050 m depth"));
  EXPECT_THAT(message_of(picture, {CaseChart::profiles, "F1", {}, false}),
              HasSubstr("no fields of fault F1 were kept"));
}

/// Tractions are compression positive in MPa, slips in mm, pressures in bar: at step 2.
TEST_F(FieldsOfAFault, ProfilesHaveTheFieldsInTheUnitsThatTheyName) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::profiles, "F2", {}, false});
  const CoulombLaw& friction = scene.faults[1].friction;
  const double strength =
      (friction.cohesion + 2e7 * std::tan(friction.static_friction_angle)) / 1e6;
  const std::vector<std::vector<double>> expected = {
      {-20, -20, -20}, {20, 20, 20}, {0, 6, 0}, {0.2, 0.8, 0}, {0, 20, 0}};
  for (std::size_t column = 0; column < expected.size(); ++column) {
    expect_values(read_off(svg, 0, true, column, column), expected[column],
                  0.01 * std::max(1.0, std::abs(expected[column][1])));
    expect_values(read_off(svg, 0, false, column), {2000, 2050, 2100}, 0.1);
  }
  expect_values(read_off(svg, 1, true, 0, 2), {strength, strength, strength}, 0.1);
}

TEST_F(FieldsOfAFault, AStressPathStartsOnTheCircleOfTheInitialState) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::stress_path, "F2", {}, false});
  expect_values(read_off(svg, 0, true), {20, 20, 20}, 0.1);
  expect_values(read_off(svg, 0, false), {0, 3, 6}, 0.1);
  const figure::ReadScale x = figure::read_scale(svg, true);
  const auto arc = figure::elements_of(svg, "polyline", "stroke", figure::kFaint).at(0).points();
  const StressAtDepth start = initial_state(scene, -2050);
  const double across = -(start.sigma[0] + start.pressure) / 1e6,
               down = -(start.sigma[8] + start.pressure) / 1e6;
  EXPECT_NEAR(x.value(arc.front().x), std::max(across, down), 0.1);
  EXPECT_NEAR(x.value(arc.back().x), std::min(across, down), 0.1);
  EXPECT_THAT(svg, HasSubstr(">end of primary production<"));
  EXPECT_THAT(svg, HasSubstr(">end of gas storage<"));
}

/// A traction that carries its Biot share of the pressure is on the circle of σ + α_f p0.
TEST_F(FieldsOfAFault, AStressPathHasTheCircleOfItsFaultsBiotCoefficient) {
  const FieldReader reader(folder_ / "faults.h5");
  Scene scene = field_scene();
  scene.faults[1].fault_biot = 0.6;
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::stress_path, "F2", {}, false});
  const figure::ReadScale x = figure::read_scale(svg, true);
  const auto arc = figure::elements_of(svg, "polyline", "stroke", figure::kFaint).at(0).points();
  const StressAtDepth start = initial_state(scene, -2050);
  EXPECT_NEAR(x.value(arc.front().x), -(start.sigma[8] + 0.6 * start.pressure) / 1e6, 0.1);
  EXPECT_NEAR(x.value(arc.back().x), -(start.sigma[0] + 0.6 * start.pressure) / 1e6, 0.1);
  EXPECT_THAT(svg, HasSubstr("grey circle: rock at the start, fault_biot 0.6; "));
}

/// Fields of the case before a change: of three points of F2, 10 m deeper, each with half the
/// shear.
struct EarlierFields : FieldSource {
  explicit EarlierFields(const FieldSource& now) : source(now), moved(now.faults()) {
    moved[0].points.row(2).array() -= 10;
  }
  const std::vector<int>& steps() const override { return source.steps(); }
  const std::vector<double>& times() const override { return source.times(); }
  const std::vector<StoredFault>& faults() const override { return moved; }
  StoredFields fields(std::size_t fault, std::size_t entry) const override {
    StoredFields all = source.fields(fault, entry);
    all.traction.row(2) *= 0.5;
    return all;
  }
  const FieldSource& source;
  std::vector<StoredFault> moved;
};

TEST_F(FieldsOfAFault, AreDrawnWithThoseBeforeAChange) {
  const FieldReader reader(folder_ / "faults.h5");
  EarlierFields earlier(reader);
  const Scene scene = field_scene();
  Scene other = scene;
  other.faults[1].friction.static_friction_angle = 0.2;
  const CaseResult result = small_result();
  const CasePicture original{result, other, &earlier, {}};
  CasePicture picture{result, scene, &reader, {}};
  const std::string map = draw_case(picture, {CaseChart::fault_map, "F2", {}, false});
  picture.original = &original;
  EXPECT_EQ(draw_case(picture, {CaseChart::fault_map, "F2", {}, false}), map);
  const std::string profiles = draw_case(picture, {CaseChart::profiles, "F2", {}, false});
  EXPECT_EQ(figure::xml_problem(profiles), "");
  EXPECT_THAT(profiles, HasSubstr(">thin: before the change; a &lt;small&gt; case<"));
  expect_values(read_thin(profiles, 0, true, 2, 2), {0, 3, 0}, 0.1);
  expect_values(read_thin(profiles, 0, false, 2), {2010, 2060, 2110}, 0.5);
  expect_values(read_off(profiles, 0, true, 2, 2), {0, 6, 0}, 0.1);
  const double strength = (other.faults[1].friction.cohesion + 2e7 * std::tan(0.2)) / 1e6;
  expect_values(read_thin(profiles, 1, true, 0, 2), {strength, strength, strength}, 0.1);
  const std::string path = draw_case(picture, {CaseChart::stress_path, "F2", {}, false});
  EXPECT_EQ(figure::xml_problem(path), "");
  EXPECT_THAT(path, HasSubstr(">thin: before the change, at 2,060 m depth; where"));
  expect_values(read_thin(path, 0, false), {0, 1.5, 3}, 0.1);
  // A fault that was not there, and fields that were not kept.
  earlier.moved[0].name = "F0";
  for (const CasePicture& none : {original, CasePicture{result, other, nullptr, {}}}) {
    picture.original = &none;
    for (const CaseChart chart : {CaseChart::profiles, CaseChart::stress_path}) {
      const std::string svg = draw_case(picture, {chart, "F2", {}, false});
      EXPECT_THAT(svg, HasSubstr(">not kept: before the change; "));
      EXPECT_THROW(read_thin(svg, 0, false), std::out_of_range);
    }
  }
}

TEST_F(FieldsOfAFault, ASectionHasTheLargerIndexOfItsEndsOnEachPiece) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::section, {}, 2, false});
  const figure::ReadScale depth = figure::read_scale(svg, false);
  const auto pieces = figure::elements_of(svg, "line", "stroke", figure::chi_colour(0.8));
  ASSERT_EQ(pieces.size(), 2U) << "0.2, 0.8 and 0 down dip";
  EXPECT_NEAR(depth.value(pieces[0].number("y1")), 2000, 3);
  EXPECT_NEAR(depth.value(pieces[1].number("y2")), 2100, 3);
}

TEST_F(FieldsOfAFault, OfAFileThatIsNoneAreRefused) {
  std::ofstream(folder_ / "broken.h5") << "no fields";
  EXPECT_THROW(FieldReader(folder_ / "broken.h5"), StorageError);
}

}  // namespace
}  // namespace faultsim
