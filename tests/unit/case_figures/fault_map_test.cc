// Maps of a quantity on a fault.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "simulator/figure/palette.h"
#include "simulator/result_files/field_reader.h"
#include "simulator/result_files/field_writer.h"
#include "tests/unit/case_figures/fields_of_a_fault.h"
#include "tests/unit/case_figures/fields_of_one_fault.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

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

/// One face of F2 that slips by 2 mm in the first step and 8 mm more in the second, in which it
/// gains 10 bar back of the 40 bar that it lost; times a factor.
struct OneSlidingFace : FieldsOfOneFault {
  explicit OneSlidingFace(double factor = 1) : FieldsOfOneFault(face()), times_more(factor) {}
  StoredFields fields(std::size_t, std::size_t entry) const override {
    static constexpr std::array kSlips = {0.0, 0.002, 0.010}, kPressures = {0.0, -4e6, -3e6};
    StoredFields now;
    now.traction = now.slip = Eigen::Matrix3Xd::Zero(3, 4);
    now.slip.row(2).setConstant(times_more * kSlips.at(entry));
    now.critical_index = Eigen::Vector4d::Constant(0.5);
    now.fault_pressure_change = Eigen::Vector4d::Constant(times_more * kPressures.at(entry));
    now.state = {0, 0, 0, 0};
    return now;
  }
  double times_more;

 private:
  static StoredFault face() {
    StoredFault fault;
    fault.name = "F2";
    fault.points.resize(3, 4);
    fault.points << 0, 0, 0, 0, 0, 100, 100, 0, -2000, -2000, -2050, -2050;
    fault.faces = {{0, 1, 2, 3}};
    fault.split = {1, 1, 1, 1};
    return fault;
  }
};

/// Maps of one case of a fault in its plane.
class MapScale : public testing::Test {
 protected:
  MapScale() : scene_(field_scene()), result_(small_result()) { result_.plane_strain = false; }
  std::string map(MapField show, int step, const CasePicture* original = nullptr) const {
    return draw_case({result_, scene_, &fields_, {}, original},
                     {CaseChart::fault_map, "F2", step, false, show});
  }
  static std::size_t n_faces(const std::string& svg, const std::string& colour) {
    return figure::elements_of(svg, "polygon", "fill", colour).size();
  }
  Scene scene_;
  CaseResult result_;
  OneSlidingFace fields_;
};

TEST_F(MapScale, OfSlipsAndPressuresIsThatOfAllLoadSteps) {
  for (const auto& [step, share] : {std::pair(0, 0.0), {1, 0.2}, {2, 1.0}}) {
    const std::string slip = map(MapField::slip, step);
    EXPECT_EQ(n_faces(slip, figure::share_colour(share)), 1U) << step;
    for (const char* text : {">slip, mm<", ">0<", ">5<", ">10<", ">same scale at all load steps<"})
      EXPECT_THAT(slip, HasSubstr(text));
  }
  for (const auto& [step, share] : {std::pair(0, 0.0), {1, -1.0}, {2, -0.75}}) {
    const std::string pressure = map(MapField::pressure, step);
    EXPECT_EQ(n_faces(pressure, figure::change_colour(share)), 1U) << step;
    for (const char* text :
         {">Δp, bar<", ">−40<", ">−20<", ">0<", ">same scale at all load steps<"})
      EXPECT_THAT(pressure, HasSubstr(text));
  }
}

TEST_F(MapScale, HoldsTheCaseBeforeAChangeToo) {
  const OneSlidingFace more(2);
  CasePicture original{result_, scene_, &more, {}};
  const std::string slip = map(MapField::slip, 2, &original);
  EXPECT_EQ(n_faces(slip, figure::share_colour(0.5)), 1U);
  for (const char* text : {">20<", ">same scale at all load steps and before the change<"})
    EXPECT_THAT(slip, HasSubstr(text));
  EXPECT_EQ(n_faces(map(MapField::pressure, 1, &original), figure::change_colour(-0.5)), 1U);
  original.name = "sweep/3";
  EXPECT_THAT(map(MapField::slip, 2, &original),
              HasSubstr(">same scale at all load steps and in sweep/3<"));
  // Of which no fields were kept.
  original.fields = nullptr;
  EXPECT_EQ(map(MapField::slip, 2, &original), map(MapField::slip, 2));
}

/// χ has the scale that it always has, and states have none.
TEST_F(MapScale, OfOtherFieldsIsThatOfEveryCase) {
  const OneSlidingFace more(2);
  const CasePicture original{result_, scene_, &more, {}};
  for (const MapField show : {MapField::chi, MapField::state}) {
    EXPECT_EQ(map(show, 1, &original), map(show, 1));
    EXPECT_THAT(map(show, 1), Not(HasSubstr("same scale")));
  }
}

}  // namespace
}  // namespace faultsim
