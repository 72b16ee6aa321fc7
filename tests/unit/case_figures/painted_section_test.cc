// Sections that are painted with the pressures of a flow result.
#include "simulator/case_figures/painted_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/section_pressures.h"
#include "simulator/common/dates.h"
#include "simulator/figure/palette.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kCellWidth = 10, kFiveYearsInSeconds = 5 * 365.25 * 86400;  // m, s
constexpr double kSlope = 20;                                                // bar per km

/// Change of pressure at the second report, of two that are ten years apart, bar.
using Change = std::function<double(double x, double y)>;
double falls_to_the_east(double x, double) { return -100 - kSlope * x / 1000; }

/// A flow result of upright cells over all depths and |y| <= 1000 m, between two x, m.
FlowLoad flow_result(const Change& change, double from = -2000, double to = 2000) {
  FlowField field;
  field.date = {*parse_date("1990-01-01"), *parse_date("1990-01-01") + 2 * kFiveYearsInSeconds};
  for (double x = from; x < to; x += kCellWidth) {
    for (double y = -1000; y < 1000; y += 100)
      field.cells.push_back({{x, y, -3000}, {x + kCellWidth, y + 100, -1000}});
  }
  field.value.setConstant(std::ssize(field.cells), 2, 2e7);
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const Eigen::Vector3d middle = (field.cells[f].low + field.cells[f].high) / 2;
    field.value(static_cast<Eigen::Index>(f), 1) += 1e5 * change(middle.x(), middle.y());
  }
  FlowLoad load;
  load.field = std::make_shared<const FlowField>(std::move(field));
  load.fingerprint = "1";
  load.reports = {0, 1};
  load.time = {0, 2 * kFiveYearsInSeconds};
  return load;
}

Scene painted_scene(const FlowLoad& load) {
  Scene scene = field_scene();
  scene.pressure_field = load;
  return scene;
}

/// What a reader makes of the colours: of each piece of a reservoir the range of Δp, bar, that its
/// colour has on the scale; NaN of one without colour.
std::vector<std::pair<double, double>> painted_in(const std::string& svg, const std::string& rock) {
  std::vector<std::string> scale, pieces;
  std::vector<double> ends;
  std::string group;
  for (const figure::SvgElement& one : figure::elements_of(svg)) {
    double value = 0;
    if (one.name == "g")
      group = one.attributes.contains("data-scale")     ? "scale"
              : one.attributes.contains("data-painted") ? one.attributes.at("data-painted")
                                                        : "";
    else if (group == rock && one.name == "polygon" && !one.has("stroke", "#b08900"))
      pieces.push_back(one.attributes.at("fill"));
    else if (group == "scale" && one.name == "rect" && !one.has("fill", "none"))
      scale.push_back(one.attributes.at("fill"));
    else if (group == "scale" && one.name == "text" && figure::read_number(one.text, value))
      ends.push_back(value);
  }
  if (ends.size() != 3) throw std::runtime_error("a scale without its ends and its middle");
  const double part = (ends[2] - ends[0]) / static_cast<double>(scale.size());
  std::vector<std::pair<double, double>> read;
  for (const std::string& fill : pieces) {
    const auto found = std::ranges::find(scale, fill);
    const double low =
        found == scale.end() ? NAN : ends[0] + part * static_cast<double>(found - scale.begin());
    read.emplace_back(low, low + part);
  }
  return read;
}

/// The middle of a piece, m across.
double middle_of(const SectionPressures& pressures, std::size_t block, std::size_t piece) {
  const auto& corners = pressures.corners(block, piece);
  return (corners[0].x + corners[1].x + corners[2].x + corners[3].x) / 4;
}

/// Numbers at the scale have three digits, cells of the flow result their width.
constexpr double kReadError = 0.5;

void expect_painted(const std::string& svg, const Scene& scene, double share,
                    const Change& change) {
  const SectionPressures pressures(scene, 0);
  for (const std::size_t block : {0U, 1U}) {
    const auto read = painted_in(svg, scene.field.blocks[block].name);
    ASSERT_EQ(read.size(), pressures.n_pieces());
    for (std::size_t k = 0; k < read.size(); ++k) {
      const double given = share * change(middle_of(pressures, block, k), 0);
      EXPECT_LT(read[k].first - kReadError, given) << block << " " << k;
      EXPECT_GT(read[k].second + kReadError, given) << block << " " << k;
    }
  }
}

TEST(PaintedSection, ShowsTheChangesOfTheFieldAtTheStep) {
  const Scene scene = painted_scene(flow_result(falls_to_the_east));
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string end = draw_case(picture, {CaseChart::section, {}, 2, false});
  EXPECT_EQ(figure::xml_problem(end), "");
  expect_painted(end, scene, 1, falls_to_the_east);
  expect_painted(draw_case(picture, {CaseChart::section, {}, 1, false}), scene, 0.5,
                 falls_to_the_east);
  expect_painted(draw_case(picture, {CaseChart::section, {}, 0, false}), scene, 0,
                 falls_to_the_east);
  for (const char* text :
       {">Δp, bar<", ">−140<", ">−69.8<", ">0<",
        "since 1990-01-01 (negative: it fell), at y = 0 m<",
        ">means over pieces of at most 40 m × 50 m; same scale at all load steps<",
        "west, mean Δp"})
    EXPECT_THAT(end, HasSubstr(text));
  EXPECT_LE(painted_in(end, "west").size(), 200U);
}

/// The field lies elsewhere and is turned: its x is the scene's y, and its y the scene's −x.
TEST(PaintedSection, TakesTheFieldWhereTheSceneHasIt) {
  FlowLoad load = flow_result([](double, double y) { return -100 + y / 50; });
  load.azimuth = std::numbers::pi / 2;
  const Scene scene = painted_scene(load);
  const SectionPressures pressures(scene, 0);
  std::size_t n_seen = 0;
  for (const std::size_t block : {0U, 1U}) {
    const std::vector<double> change = pressures.at(block, 2 * kFiveYearsInSeconds);
    for (std::size_t k = 0; k < change.size(); ++k) {
      const double x = middle_of(pressures, block, k);
      if (std::abs(x) > 900) {
        if (std::abs(x) > 1100) {
          EXPECT_TRUE(std::isnan(change[k])) << x;
        }
        continue;
      }
      EXPECT_NEAR(change[k] / 1e5, -100 - x / 50, 1.1) << x;  // cells of 100 m
      ++n_seen;
    }
  }
  EXPECT_GT(n_seen, 100U);
}

TEST(PaintedSection, HatchesWhatTheFlowGridDoesNotCover) {
  Scene scene = painted_scene(flow_result(falls_to_the_east, -2000, 1000));
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const CaseChartRequest request{CaseChart::section, {}, 2, false};
  const std::string svg = draw_case(picture, request);
  const SectionPressures pressures(scene, 0);
  const auto read = painted_in(svg, "east");
  std::size_t n_bare = 0;
  for (std::size_t k = 0; k < read.size(); ++k) {
    const bool is_beyond = middle_of(pressures, 1, k) > 1000;
    EXPECT_EQ(std::isnan(read[k].first), is_beyond) << k;
    n_bare += is_beyond ? 1U : 0U;
  }
  EXPECT_EQ(figure::elements_of(svg, "line", "stroke-width", "0.6").size(), n_bare);
  EXPECT_THAT(svg, HasSubstr("lies in the flow grid; beyond it the nearest flow cell"));
  scene.pressure_field.outside = OutsideRule::unchanged;
  EXPECT_THAT(draw_case(picture, request), HasSubstr("beyond it pressures do not change<"));
  // A grid that reaches no reservoir.
  scene = painted_scene(flow_result(falls_to_the_east, 5000, 6000));
  const std::string bare = draw_case(picture, request);
  EXPECT_EQ(figure::xml_problem(bare), "");
  EXPECT_THAT(bare, HasSubstr(">nothing is painted: the flow grid does not reach"));
  EXPECT_THAT(bare, Not(HasSubstr("0 everywhere")));
}

TEST(PaintedSection, IsAsItWasWithoutAFieldOfPressures) {
  Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string plain = draw_case(picture, {CaseChart::section, {}, 2, false});
  for (const char* word : {"data-painted", "data-scale", "Δp, bar"})
    EXPECT_THAT(plain, Not(HasSubstr(word)));
  for (const StepLook& look : step_looks(picture)) {
    EXPECT_TRUE(look.painted.empty());
    EXPECT_FALSE(look.scale);
  }
}

/// Of a field of temperatures alone those, in K, which the numbers of pressures are 1e5 of.
TEST(PaintedSection, ShowsTemperaturesWhereThereAreNoPressures) {
  Scene cooled = painted_scene(flow_result(falls_to_the_east));
  const CaseResult result = small_result();
  const auto drawn = [&](const Scene& scene) {
    return draw_case({result, scene, nullptr, {}}, {CaseChart::section, {}, 2, false});
  };
  const std::string pressures = drawn(cooled);
  std::swap(cooled.temperature_field, cooled.pressure_field);
  FlowField kelvin = *cooled.temperature_field.field;
  kelvin.value /= 1e5;
  cooled.temperature_field.field = std::make_shared<const FlowField>(kelvin);
  const std::string temperatures = drawn(cooled);
  EXPECT_THAT(temperatures, AllOf(HasSubstr("ΔT, K"), HasSubstr("flow result&#39;s temperature"),
                                  Not(HasSubstr("Δp, bar"))));
  const auto fills = [](const std::string& svg) {
    std::vector<std::string> all;
    for (const figure::SvgElement& one : figure::elements_of(svg))
      if (one.name == "polygon") all.push_back(one.attributes.at("fill"));
    return all;
  };
  const auto numbers = [](const std::string& svg) {
    std::vector<std::string> all;
    for (const figure::SvgElement& one : figure::elements_of(svg))
      if (one.name == "text" && one.text.find_first_not_of("−-0123456789.") == std::string::npos)
        all.push_back(one.text);
    return all;
  };
  EXPECT_EQ(numbers(temperatures), numbers(pressures));
  EXPECT_EQ(fills(temperatures), fills(pressures));
  EXPECT_GT(fills(temperatures).size(), 100u);
}

TEST(PaintedSection, SaysWhereFlowCellsLieOverEachOther) {
  FlowLoad load = flow_result(falls_to_the_east);
  FlowField twice = *load.field;
  twice.cells.push_back(twice.cells[2000]);
  twice.value.conservativeResize(twice.value.rows() + 1, Eigen::NoChange);
  twice.value.bottomRows(1).setConstant(2e7);
  twice.cells.back().low.y() = -1000, twice.cells.back().high.y() = 1000;
  load.field = std::make_shared<const FlowField>(twice);
  const Scene scene = painted_scene(load);
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::section, {}, 2, false});
  EXPECT_THAT(svg, HasSubstr(">pressures are not painted: flow cells overlap"));
  EXPECT_THAT(svg, Not(HasSubstr("data-painted")));
}

/// What a page's script paints at a step is what the drawing of that step has.
TEST(PaintedSection, IsPaintedByThePageAsItIsDrawn) {
  const Scene scene = painted_scene(flow_result(falls_to_the_east, -2000, 1000));
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const std::vector<StepLook> looks = step_looks(picture);
  ASSERT_EQ(looks.size(), 3U);
  ASSERT_TRUE(looks[0].scale);
  EXPECT_FALSE(looks[1].scale) << "the first has it for all";
  const ScaleLook& scale = *looks[0].scale;
  for (std::size_t step = 0; step < 3; ++step) {
    const std::string svg =
        draw_case(picture, {CaseChart::section, {}, static_cast<int>(step), false});
    std::vector<std::string> texts, drawn;
    std::string group;
    for (const figure::SvgElement& one : figure::elements_of(svg)) {
      if (one.name == "g") group = one.attributes.begin()->first;
      if (group == "data-scale" && one.name == "text") texts.push_back(one.text);
      if (group == "data-painted" && one.name == "polygon" && !one.has("stroke", "#b08900"))
        drawn.push_back(one.attributes.at("fill"));
    }
    for (std::string& text : texts)
      if (const auto at = text.find("&#39;"); at != std::string::npos) text.replace(at, 5, "'");
    EXPECT_EQ(texts, scale.texts);
    std::vector<std::string> painted;
    for (const auto& [name, parts] : looks[step].painted) {
      for (const char one : parts)
        painted.push_back(
            one == '.' ? "none" : scale.colours.at(std::stoul(std::string(1, one), nullptr, 36)));
    }
    EXPECT_EQ(painted, drawn);
  }
}

/// A case that falls twice as far before a change leaves half of the scale to the one after it.
TEST(PaintedSection, HasOneScaleWithTheCaseBeforeAChange) {
  const Scene scene = painted_scene(flow_result(falls_to_the_east));
  const Scene before =
      painted_scene(flow_result([](double x, double y) { return 2 * falls_to_the_east(x, y); }));
  const CaseResult result = small_result();
  const CasePicture original{result, before, nullptr, {}};
  const CasePicture picture{result, scene, nullptr, {}, &original};
  const std::string svg = draw_case(picture, {CaseChart::section, {}, 2, false});
  for (const char* text :
       {">−279<", ">−140<", ">0<", "same scale at all load steps and before the change<"})
    EXPECT_THAT(svg, HasSubstr(text));
  expect_painted(svg, scene, 1, falls_to_the_east);
}

/// Fields of one fault in three points, the middle one the most critical.
struct CriticalFields : FieldSource {
  CriticalFields() {
    fault.name = "F2";
    fault.points = Eigen::Matrix3Xd::Zero(3, 3);
    fault.points.row(1) << -500, 450, 500;
    fault.split = {1, 1, 1};
  }
  const std::vector<int>& steps() const override { return all_steps; }
  const std::vector<double>& times() const override { return all_times; }
  const std::vector<StoredFault>& faults() const override { return all_faults; }
  StoredFields fields(std::size_t, std::size_t) const override {
    StoredFields now;
    now.critical_index = Eigen::Vector3d(0.1, 0.9, 0.2);
    return now;
  }
  StoredFault fault;
  std::vector<int> all_steps = {0, 1, 2};
  std::vector<double> all_times = {0, kFiveYearsInSeconds, 2 * kFiveYearsInSeconds};
  std::vector<StoredFault> all_faults;
};

TEST(PaintedSection, OfAFieldIn3DGoesThroughTheMostCriticalPoint) {
  const Scene scene = painted_scene(flow_result([](double, double y) { return -y / 10; }));
  CaseResult result = small_result();
  result.plane_strain = false;
  CriticalFields fields;
  fields.all_faults = {fields.fault};
  const CasePicture picture{result, scene, &fields, {}};
  const auto change_at = [&](const CasePicture& shown) {
    figure::Section section = field_section(scene);
    case_figures::PaintedSection(shown).paint(2 * kFiveYearsInSeconds, section);
    return section.rocks.back().pieces.at(0).value;
  };
  EXPECT_NEAR(change_at(picture), -45, 1e-9);
  EXPECT_THAT(draw_case(picture, {CaseChart::section, {}, 2, false}),
              HasSubstr("at y = 450 m, where χ of F2 is largest<"));
  // A fault goes on beyond the reservoirs, whose end is then the nearest place.
  fields.all_faults[0].points(1, 1) = 1150;
  EXPECT_NEAR(change_at(picture), -95, 1e-9);
  EXPECT_THAT(draw_case({result, scene, nullptr, {}}, {CaseChart::section, {}, 2, false}),
              HasSubstr("at y = 0 m, the middle<"));
}

/// A block that ends before the section is not painted, and said to; where both beside the fault
/// end before its most critical point, the section goes through the nearer end.
TEST(PaintedSection, GoesThroughBlocksThatReachIt) {
  Scene scene = painted_scene(flow_result([](double, double y) { return -y / 10; }));
  scene.field.blocks[1].y_to = 300;
  CaseResult result = small_result();
  result.plane_strain = false;
  CriticalFields fields;
  fields.all_faults = {fields.fault};
  const auto painted = [&](std::size_t block) {
    figure::Section section = field_section(scene);
    case_figures::PaintedSection({result, scene, &fields, {}})
        .paint(2 * kFiveYearsInSeconds, section);
    return section.rocks.at(section.rocks.size() - 2 + block).pieces;
  };
  ASSERT_FALSE(painted(0).empty());
  EXPECT_NEAR(painted(0)[0].value, -45, 1e-9);
  EXPECT_TRUE(painted(1).empty());
  const auto svg = [&] {
    return draw_case({result, scene, &fields, {}}, {CaseChart::section, {}, 2, false});
  };
  EXPECT_THAT(svg(),
              HasSubstr("not painted, as it ends along the faults before the section: east<"));
  EXPECT_THAT(svg(), Not(HasSubstr("hatched"))) << "all of the west block is covered";
  scene.field.blocks[0].y_to = 400;
  EXPECT_NEAR(painted(0)[0].value, -35, 1e-9) << "the west block's end is nearer than the east's";
  EXPECT_THAT(svg(), HasSubstr("at y = 399.5 m"));
}

}  // namespace
}  // namespace faultsim
