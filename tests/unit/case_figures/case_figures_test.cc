#include "simulator/case_figures/case_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/output/write_result.h"
#include "simulator/scene/json_document.h"
#include "simulator/scene/read_scene.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

Scene field_scene() {
  Scene scene =
      read_scene(read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json"));
  scene.field.blocks[1].offset = 150;
  return scene;
}

/// Three steps in two stages on three faults; χ̄ of F2 is 1 in steps 1 and 2, its area grows.
CaseResult small_result() {
  CaseResult result;
  result.title = "a <small> case";
  result.outcome = Outcome::converged;
  result.plane_strain = true;
  result.fault_names = {"F1", "F2", "F3"};
  result.region_names = {"west", "east"};
  constexpr double kYear = 365.25 * 86400;
  for (int k = 0; k < 3; ++k) {
    StepResult step;
    step.step = k;
    step.stage = k == 0 ? "initial" : k == 1 ? "primary_production" : "gas_storage";
    step.time = 5 * k * kYear;
    step.outcome = Outcome::converged;
    step.pressure_change = {-k * 1e7, -k * 5e6};
    step.faults.resize(3);
    step.faults[0].chi_bar = 0.3 * k;
    step.faults[1].chi_bar = k == 0 ? 0.2 : 1 + (k == 1 ? 1e-9 : 0);
    step.faults[1].area_chi_080 = 100.0 * k;
    result.steps.push_back(step);
  }
  return result;
}

std::string message_of(const CasePicture& picture, const CaseChartRequest& request) {
  try {
    draw_case(picture, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

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

TEST(StepLooks, HaveAColourPerFaultAndTheWordsOfTheStep) {
  const Scene scene = field_scene();
  const CaseResult result = small_result();
  const std::vector<StepLook> looks = step_looks({result, scene, nullptr, {}});
  ASSERT_EQ(looks.size(), 3U);
  EXPECT_EQ(looks[1].says, "load step 1, primary production, 5 years");
  ASSERT_EQ(looks[1].colours.size(), 3U);
  EXPECT_NE(looks[1].colours[0], looks[1].colours[1]);
  EXPECT_EQ(looks[2].notes.front().second, "Δp −200 bar");
}

// Fields ------------------------------------------------------------------------------------------

/// A fault of two faces down dip in plane strain, written as a run writes it.
class StoredFields2 : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / "case_figures_fields";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
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

TEST_F(StoredFields2, AreReadBackAsTheyWereWritten) {
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

TEST_F(StoredFields2, GiveTheChartsThatNeedThem) {
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

TEST_F(StoredFields2, OfAFileThatIsNoneAreRefused) {
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
