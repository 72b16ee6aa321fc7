#include "simulator/case_figures/case_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/documents/json_document.h"
#include "simulator/figure/palette.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result_files/field_reader.h"
#include "simulator/result_files/field_writer.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

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

/// Years of the calendar, at their first of January.
TEST(DrawCase, HasDatesWhereTheSceneHas) {
  Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string without = draw_case(picture, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(without, HasSubstr(">time, years<"));
  scene.start_date = parse_date("1990-07-02");  // 182 days into the year
  const std::string svg = draw_case(picture, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr(">date<"));
  EXPECT_THAT(svg, Not(HasSubstr("years")));
  const auto x_of = [&](const std::string& year) {
    for (const auto& one : figure::elements_of(svg, "text", "text-anchor", "middle"))
      if (one.text == year) return one.number("x");
    return std::nan("");
  };
  const double per_year = (x_of("2000") - x_of("1992")) / 8;
  const auto frames = figure::elements_of(svg, "rect", "fill", "none");
  ASSERT_FALSE(frames.empty());
  EXPECT_NEAR(x_of("1992") - frames[0].number("x"), 1.5 * per_year, 0.01 * per_year);
  EXPECT_THAT(draw_case(picture, {CaseChart::section, {}, 1, false}),
              HasSubstr("primary production, 1995-07-02 (5 years)"));
}

/// A field that only cools has a line that says so.
TEST(DrawCase, HasTheTemperatureOfRegionsThatCool) {
  Scene scene = field_scene();
  constexpr double kYear = 365.25 * 86400;
  scene.temperature = {{1, {0, 10 * kYear}, {0, -40}}};
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr("ΔT, K"));
  const auto lines =
      figure::elements_of(svg, "polyline", "stroke", figure::fault_stroke(13).colour);
  const auto has_half = [](const figure::SvgElement& one) {  // −20 K after five of ten years
    const auto p = one.points();
    return p.size() == 3 && std::abs(p[1].y - (p[0].y + p[2].y) / 2) < 0.02 && p[2].y > p[0].y + 50;
  };
  EXPECT_TRUE(std::ranges::any_of(lines, has_half));
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

/// Values of the lines of a colour, as the k-th x or y scale of the drawing gives them.
std::vector<double> read_off(const std::string& svg, std::size_t colour, bool along_x,
                             std::size_t line = 0, std::size_t scale = 0) {
  const figure::ReadScale read = figure::read_scale(svg, along_x, scale);
  const auto lines =
      figure::elements_of(svg, "polyline", "stroke", figure::fault_stroke(colour).colour);
  std::vector<double> values;
  for (const figure::Point& one : lines.at(line).points())
    values.push_back(read.value(along_x ? one.x : one.y));
  return values;
}

void expect_values(const std::vector<double>& read, const std::vector<double>& given,
                   double error) {
  ASSERT_EQ(read.size(), given.size());
  for (std::size_t k = 0; k < read.size(); ++k) EXPECT_NEAR(read[k], given[k], error) << k;
}

TEST(DrawCase, AHistoryIsInYearsBarAndMillimetres) {
  const Scene scene = field_scene();
  CaseResult result = small_result();
  for (StepResult& step : result.steps) {
    step.faults[0].max_slip = 0.012 * step.step;
    step.faults[0].thickness_chi_080_max = 40.0 * step.step;
  }
  SlipEvent event;
  event.fault = "F2", event.time = result.steps[1].time, event.magnitude = 2.345;
  event.resolved = false;
  result.events = {event};
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string slip = draw_case(picture, {CaseChart::slip, {}, {}, false});
  expect_values(read_off(slip, 0, true), {0, 5, 10}, 0.02);
  expect_values(read_off(slip, 0, false), {0, 12, 24}, 0.1);
  expect_values(read_off(slip, 6, false, 0, 1), {0, -100, -200}, 1.5);  // of the west
  EXPECT_THAT(slip, HasSubstr(">Mw 2.3 (unresolved) on F2<"));
  const std::string thickness = draw_case(picture, {CaseChart::thickness, {}, {}, false});
  expect_values(read_off(thickness, 0, false), {0, 40, 80}, 0.3);
  const std::string chi = draw_case(picture, {CaseChart::history, {}, {}, false});
  expect_values(read_off(chi, 0, false), {0, 0.3, 0.6}, 0.005);
  // The first stage goes from the start to step 1, and is shaded; the second is not.
  const figure::ReadScale time = figure::read_scale(chi, true);
  const auto shades = figure::elements_of(chi, "rect", "fill", figure::kShade);
  ASSERT_EQ(shades.size(), 2U) << "in each of two panels";
  EXPECT_NEAR(time.value(shades[0].number("x")), 0, 0.02);
  EXPECT_NEAR(time.value(shades[0].number("x") + shades[0].number("width")), 5, 0.02);
  double middle = 0;
  for (const figure::SvgElement& one : figure::elements_of(chi))
    if (one.text == "gas storage") middle = time.value(one.number("x"));
  EXPECT_NEAR(middle, 7.5, 0.05);
}

TEST(DrawCase, IsInDaysWhereAllIsOverInLessThanTwoYears) {
  const Scene scene = field_scene();
  CaseResult result = small_result();
  for (StepResult& step : result.steps) step.time = step.step * 10 * 86400.0;
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr("time, days"));
  expect_values(read_off(svg, 0, true), {0, 10, 20}, 0.03);
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

/// The case before a change: F1 comes to half of what it is now, F3 was called F0, F2 is the same;
/// it took twice as long, and the west lost 150 bar at the end.
CaseResult original_result() {
  CaseResult original = small_result();
  original.fault_names[2] = "F0";
  for (StepResult& step : original.steps) {
    step.time *= 2;
    step.faults[0].chi_bar = 0.15 * step.step;
    step.faults[0].max_slip = 0.1 * step.step;
    step.pressure_change[0] *= 0.75;
  }
  return original;
}

/// The thin line of a curve, as read off the drawing's scales.
std::vector<double> read_thin(const std::string& svg, std::size_t colour, bool along_x,
                              std::size_t line = 0, std::size_t scale = 0) {
  const figure::ReadScale read = figure::read_scale(svg, along_x, scale);
  const auto lines =
      figure::elements_of(svg, "polyline", "stroke", figure::before_stroke(colour).colour);
  std::vector<double> values;
  for (const figure::Point& one : lines.at(line).points())
    values.push_back(read.value(along_x ? one.x : one.y));
  return values;
}

TEST(DrawCase, HasTheHistoryBeforeAChangeByTheNamesOfFaultsAndRegions) {
  const Scene scene = field_scene();
  const CaseResult result = small_result(), before = original_result();
  const CasePicture original{before, scene, nullptr, {}};
  CasePicture picture{result, scene, nullptr, {}};
  for (const CaseChart chart : {CaseChart::history, CaseChart::thickness, CaseChart::slip}) {
    EXPECT_THAT(draw_case(picture, {chart, {}, {}, true}), Not(HasSubstr("before the change")));
  }
  const std::string section = draw_case(picture, {CaseChart::section, {}, 1, true});
  picture.original = &original;
  EXPECT_EQ(draw_case(picture, {CaseChart::section, {}, 1, true}), section);
  const std::string svg = draw_case(picture, {CaseChart::history, {}, {}, true});
  EXPECT_EQ(figure::xml_problem(svg), "");
  EXPECT_THAT(svg, HasSubstr(">thin: before the change; a"));
  expect_values(read_off(svg, 0, false), {0, 0.3, 0.6}, 0.005);
  expect_values(read_off(svg, 0, true), {0, 5, 10}, 0.05);
  expect_values(read_thin(svg, 0, false), {0, 0.15, 0.3}, 0.005);
  expect_values(read_thin(svg, 0, true), {0, 10, 20}, 0.05);
  expect_values(read_thin(svg, 1, false), {0.2, 1, 1}, 0.005);
  EXPECT_THROW(read_thin(svg, 2, false), std::out_of_range) << "F3 was not there";
  EXPECT_THAT(svg, HasSubstr(">F0, before<"));
  expect_values(read_thin(svg, 3, false), {0, 0, 0}, 0.005);
  expect_values(read_off(svg, 6, false, 0, 1), {0, -100, -200}, 1.5);
  expect_values(read_thin(svg, 6, false, 0, 1), {0, -75, -150}, 1.5);
  CasePicture named = original;
  named.name = "sweep/3";
  picture.original = &named;
  EXPECT_THAT(draw_case(picture, {CaseChart::history, {}, {}, true}),
              HasSubstr(">thin: sweep/3; a"));
  const std::string slip = draw_case(picture, {CaseChart::slip, {}, {}, false});
  expect_values(read_thin(slip, 0, false), {0, 100, 200}, 1);
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

TEST(StepLooks, HaveAColourPerFaultAndTheWordsOfTheStep) {
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::vector<StepLook> looks = step_looks({result, scene, nullptr, {}});
  ASSERT_EQ(looks.size(), 3U);
  EXPECT_EQ(looks[1].says, "load step 1, primary production, 5 years");
  ASSERT_EQ(looks[1].colours.size(), 3U);
  EXPECT_NE(looks[1].colours[0], looks[1].colours[1]);
  EXPECT_EQ("#" + looks[1].colours[0], figure::chi_colour(result.steps[1].faults[0].chi_bar))
      << "one piece, of the whole fault";
  EXPECT_EQ(looks[2].notes.front().second, "Δp −200 bar");
}

// Fields ------------------------------------------------------------------------------------------

/// A fault of two faces down dip in plane strain, written as a run writes it.
class FieldsOfAFault : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void SetUp() override {
    std::string name = testing::TempDir() + "case_figures_XXXXXX";
    folder_ = mkdtemp(name.data());
    FaultGeometry geometry;
    geometry.plane_strain = true;
    OperatorFault fault;
    fault.name = "F2";
    for (int k = 0; k < 3; ++k) {
      OperatorNode node;
      node.position = {0, 0.5, -2000.0 - 50 * k};
      node.normal = {1, 0, 0};
      node.strike = {0, 1, 0};
      node.dip = {0, 0, -1};
      node.area = 50;
      geometry.nodes.push_back(node);
      fault.points.push_back(node.position);
      fault.node_of_point.push_back(k);
    }
    fault.faces = {{0, 1, 1, 0}, {1, 2, 2, 1}};
    fault.n_nodes = 3;
    geometry.faults = {fault};
    FieldWriter writer(folder_, geometry);
    for (const StepResult& step : small_result().steps) writer.add_step(step, fields(step.step));
    writer.finish();
  }
  static FaultFields fields(int step) {
    FaultFields fields;
    fields.traction = Eigen::Matrix3Xd::Zero(3, 3);
    fields.traction.row(0).setConstant(-2e7);
    fields.traction(2, 1) = 3e6 * step;
    fields.jump = Eigen::Matrix3Xd::Zero(3, 3);
    fields.jump(2, 1) = 0.01 * step;
    fields.critical_index = Eigen::Vector3d(0.1 * step, 0.4 * step, 0);
    fields.static_critical_index = fields.critical_index;
    fields.state = Eigen::Vector3i(0, step, 0);
    fields.fault_pressure_change = Eigen::Vector3d::Constant(-1e6 * step);
    return fields;
  }
  std::filesystem::path folder_;
};

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
      EXPECT_THAT(svg, HasSubstr(">nothing is kept of before the change; "));
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

/// In plane strain a column per step, which holds since the step before.
TEST_F(FieldsOfAFault, AMapAgainstTimeHasTheMeanOfEachFace) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::fault_map, "F2", {}, false});
  const figure::ReadScale time = figure::read_scale(svg, true),
                          depth = figure::read_scale(svg, false);
  const auto upper = figure::elements_of(svg, "polygon", "fill", figure::chi_colour(0.5));
  ASSERT_EQ(upper.size(), 1U) << "of 0.2 and 0.8, at step 2";
  EXPECT_NEAR(time.value(upper[0].points()[0].x), 5, 0.05);
  EXPECT_NEAR(time.value(upper[0].points()[2].x), 10, 0.05);
  EXPECT_NEAR(depth.value(upper[0].points()[0].y), 2000, 0.5);
  EXPECT_NEAR(depth.value(upper[0].points()[2].y), 2050, 0.5);
}

/// The corners of a map's faces of a colour, along the axes of the drawing.
std::vector<std::array<double, 4>> faces_of(const std::string& svg, const std::string& colour) {
  const figure::ReadScale x = figure::read_scale(svg, true), y = figure::read_scale(svg, false);
  std::vector<std::array<double, 4>> all;
  for (const figure::SvgElement& one : figure::elements_of(svg, "polygon", "fill", colour)) {
    const auto corners = one.points();
    all.push_back({x.value(corners[0].x), x.value(corners[2].x), y.value(corners[0].y),
                   y.value(corners[2].y)});
  }
  return all;
}

void expect_faces(const std::vector<std::array<double, 4>>& faces,
                  const std::vector<std::array<double, 4>>& expected) {
  ASSERT_EQ(faces.size(), expected.size());
  for (std::size_t k = 0; k < faces.size(); ++k)
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(faces[k][c], expected[k][c], 0.5);
}

/// The middle point of three slips 10 mm in step 1, and is open with 20 mm in step 2; Δp falls by
/// 10 bar in each step.
TEST_F(FieldsOfAFault, MapsOfOtherFieldsHaveTheirValuesAgainstTime) {
  const FieldReader reader(folder_ / "faults.h5");
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const auto drawn = [&](MapField show) {
    const std::string svg =
        draw_case({result, scene, &reader, {}}, {CaseChart::fault_map, "F2", {}, false, show});
    EXPECT_EQ(figure::xml_problem(svg), "");
    return svg;
  };
  const std::string slip = drawn(MapField::slip);  // means of faces: 5 mm and 10 mm, the largest
  expect_faces(faces_of(slip, figure::share_colour(0.5)), {{0, 5, 2000, 2050}, {0, 5, 2050, 2100}});
  expect_faces(faces_of(slip, figure::share_colour(1)), {{5, 10, 2000, 2050}, {5, 10, 2050, 2100}});
  for (const char* text :
       {">slip, mm<", ">10<", ">5<", ">Slip of fault F2 against depth and time<"})
    EXPECT_THAT(slip, HasSubstr(text));
  EXPECT_EQ(figure::change_colour(-1), "#0a468c") << "blue: it fell";
  const std::string pressure = drawn(MapField::pressure);
  expect_faces(faces_of(pressure, figure::change_colour(-0.5)),
               {{0, 5, 2000, 2050}, {0, 5, 2050, 2100}});
  expect_faces(faces_of(pressure, figure::change_colour(-1)),
               {{5, 10, 2000, 2050}, {5, 10, 2050, 2100}});
  for (const char* text : {">Δp, bar<", ">−20<", ">−10<", ">0<"})
    EXPECT_THAT(pressure, HasSubstr(text));
  const std::string state = drawn(MapField::state);
  expect_faces(faces_of(state, figure::kSlipColour), {{0, 5, 2000, 2050}, {0, 5, 2050, 2100}});
  expect_faces(faces_of(state, figure::kOpenColour), {{5, 10, 2000, 2050}, {5, 10, 2050, 2100}});
  for (const char* text : {">sticks<", ">slips<", ">is open<"}) EXPECT_THAT(state, HasSubstr(text));
  // Told without colours: a line across each of four faces and the two of the key, a second one
  // where it is open.
  EXPECT_EQ(figure::elements_of(state, "line", "stroke-width", "0.6").size(), 6U);
  EXPECT_EQ(figure::elements_of(state, "line", "stroke", "#ffffff").size(), 3U);
  EXPECT_NE(state, drawn(MapField::chi));
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

/// Two faces beside each other along strike: of the first one corner of four slips, of the second
/// two do.
TEST(PlaneMap, MarksFacesOfWhichHalfOfTheCornersMove) {
  std::string name = testing::TempDir() + "case_figures_XXXXXX";
  const std::filesystem::path folder = mkdtemp(name.data());
  FaultGeometry geometry;
  OperatorFault fault;
  fault.name = "F2";
  for (int k = 0; k < 6; ++k) {
    OperatorNode node;
    node.position = {7.0, 100.0 * (k / 2), -2000.0 - 50 * (k % 2)};
    node.normal = {1, 0, 0}, node.strike = {0, 1, 0}, node.dip = {0, 0, -1};
    node.area = 50;
    geometry.nodes.push_back(node);
    fault.points.push_back(node.position);
    fault.node_of_point.push_back(k);
  }
  fault.faces = {{0, 2, 3, 1}, {2, 4, 5, 3}};
  fault.n_nodes = 6;
  geometry.faults = {fault};
  FaultFields fields;
  fields.traction = fields.jump = Eigen::Matrix3Xd::Zero(3, 6);
  fields.critical_index.resize(6);
  fields.critical_index << 0.1, 0.2, 0.3, 0.4, 0.7, 0.6;
  fields.static_critical_index = fields.critical_index;
  fields.state.setZero(6);
  fields.state[2] = 1, fields.state[5] = 2;
  fields.fault_pressure_change.setZero(6);
  CaseResult result = small_result();
  result.plane_strain = false;
  FieldWriter writer(folder, geometry);
  for (const StepResult& step : result.steps) writer.add_step(step, fields);
  writer.finish();
  const FieldReader reader(folder / "faults.h5");
  const Scene scene = field_scene();
  const std::string svg =
      draw_case({result, scene, &reader, {}}, {CaseChart::fault_map, "F2", {}, false});
  const auto outlines = figure::elements_of(svg, "polygon", "fill", "none");
  ASSERT_EQ(outlines.size(), 1U);
  const figure::ReadScale y = figure::read_scale(svg, true);
  EXPECT_NEAR(y.value(outlines[0].points()[0].x), 100, 0.5);
  EXPECT_NEAR(y.value(outlines[0].points()[1].x), 200, 0.5);
  EXPECT_EQ(figure::elements_of(svg, "polygon", "fill", figure::chi_colour(0.25)).size(), 1U);
  EXPECT_EQ(figure::elements_of(svg, "polygon", "fill", figure::chi_colour(0.5)).size(), 1U);
  // Of the second face one corner slips and one is open, the first sticks; nowhere is there slip
  // yet, which is said.
  const auto other = [&](MapField show) {
    return draw_case({result, scene, &reader, {}}, {CaseChart::fault_map, "F2", {}, false, show});
  };
  const std::string state = other(MapField::state);
  expect_faces(faces_of(state, figure::kStickColour), {{0, 100, 2000, 2050}});
  expect_faces(faces_of(state, figure::kOpenColour), {{100, 200, 2000, 2050}});
  EXPECT_TRUE(figure::elements_of(state, "polygon", "fill", "none").empty());
  EXPECT_THAT(state, HasSubstr(">State of fault F2: load step 2, "));
  EXPECT_THAT(other(MapField::slip), HasSubstr(">slip, mm: 0 everywhere<"));
}

TEST_F(FieldsOfAFault, OfAFileThatIsNoneAreRefused) {
  std::ofstream(folder_ / "broken.h5") << "no fields";
  EXPECT_THROW(FieldReader(folder_ / "broken.h5"), StorageError);
}

// Files -------------------------------------------------------------------------------------------

TEST(PictureFile, IsNamedSvgOrPngAndNoInput) {
  EXPECT_THROW(require_picture_file("x.pdf", {".svg", ".png"}, {}), InputError);
  const auto input = std::filesystem::path(testing::TempDir()) / "input.svg";
  std::ofstream(input) << "<svg/>";
  EXPECT_THROW(require_picture_file(input, {".svg"}, {input}), InputError);
  EXPECT_NO_THROW(require_picture_file(input, {".svg"}, {}));
}

}  // namespace
}  // namespace faultsim
