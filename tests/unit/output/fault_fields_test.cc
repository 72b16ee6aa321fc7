#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <regex>

#include "simulator/common/errors.h"
#include "simulator/output/hdf5_support.h"
#include "simulator/output/write_result.h"
#include "simulator/output/xdmf.h"
#include "tests/unit/output/example_operator.h"
#include "tests/unit/output/h5_file.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Element names that are open at the end, "" for a well-formed text; enough of XML for our files.
std::string check_xml(const std::string& text) {
  std::vector<std::string> open;
  const std::regex tag(R"(<(/?)([A-Za-z?!]+)((?:\s+\w+="[^"<]*")*)\s*(/?)[^<>]*>)");
  std::size_t n_tags = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    const std::smatch& match = *it;
    ++n_tags;
    const std::string name = match[2];
    if (name[0] == '?' || name[0] == '!' || match[4] == "/") continue;
    if (match[1] != "/") {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "unexpected end of " + name;
    } else {
      open.pop_back();
    }
  }
  if (n_tags != static_cast<std::size_t>(std::count(text.begin(), text.end(), '<'))) {
    return "not every < begins a tag";
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

/// Every reference of the XDMF text names a dataset of the file next to it with the shape given.
void expect_references_hold(const std::filesystem::path& xmf, std::size_t at_least) {
  const std::string text = read_bytes(xmf);
  EXPECT_EQ(check_xml(text), "");
  const std::regex reference(R"re(Format="HDF"[^>]*Dimensions="([0-9 ]+)">([^<:]+):([^<]+)<)re");
  std::size_t n = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), reference), end; it != end; ++it, ++n) {
    EXPECT_EQ((*it)[2].str(), xmf.stem().string() + ".h5");
    const H5File file(xmf.parent_path() / (*it)[2].str());
    std::string shape;
    for (const hsize_t size : file.read((*it)[3].str()).shape) {
      shape += (shape.empty() ? "" : " ") + std::to_string(size);
    }
    EXPECT_EQ(shape, (*it)[1].str()) << (*it)[3].str();
  }
  EXPECT_GE(n, at_least);
}

FaultFields example_fields(int n, double scale) {
  FaultFields fields;
  fields.traction = Eigen::Matrix3Xd::NullaryExpr(
      3, n, [&](Eigen::Index i, Eigen::Index k) { return -1e6 * scale * double(1 + 3 * k + i); });
  fields.jump = Eigen::Matrix3Xd::NullaryExpr(
      3, n, [&](Eigen::Index i, Eigen::Index k) { return 1e-3 * scale * double(1 + 3 * k + i); });
  fields.critical_index = Eigen::VectorXd::LinSpaced(n, 0.1, 0.4) * scale;
  fields.static_critical_index = Eigen::VectorXd::LinSpaced(n, 0.5, 0.8) * scale;
  fields.state = Eigen::VectorXi::NullaryExpr(n, [](Eigen::Index k) { return (int(k) + 2) % 3; });
  fields.fault_pressure_change = Eigen::VectorXd::LinSpaced(n, -4e5, -1e5) * scale;
  return fields;
}

StepResult example_step(int step) {
  StepResult result;
  result.step = step;
  result.stage = step == 0 ? "initial" : "cushion_gas_injection";
  result.time = 1e7 * step;
  result.outcome = Outcome::converged;
  return result;
}

class FaultFieldsTest : public testing::Test {
 protected:
  FaultFieldsTest() {
    FieldWriter writer(folder_.path(), op_.geometry);
    for (int step = 0; step < 3; ++step) {
      writer.add_step(example_step(step), example_fields(4, 1 + step));
    }
    EXPECT_EQ(folder_.n_entries(), 0U) << "nothing before finish()";
    writer.finish();
  }
  const ScratchFolder folder_;
  const FaultOperator op_ = example_operator("a");
};

TEST_F(FaultFieldsTest, GeometryAndTimesComeBack) {
  const H5File file(folder_.path() / "faults.h5");
  EXPECT_THAT(file.read("/time").values, ElementsAre(0, 1e7, 2e7));
  EXPECT_EQ(file.attribute("/time", "units"), "s");
  EXPECT_EQ(hdf5::read_texts(file.id(), "/stage")[2], "cushion_gas_injection");
  const Dataset points = file.read("/faults/F1/geometry/points");
  EXPECT_THAT(points.shape, ElementsAre(12, 3));
  EXPECT_EQ(points.values[3 * 5 + 2], -2050);
  EXPECT_THAT(file.read("/faults/F1/geometry/cells").shape, ElementsAre(6, 4));
  const Dataset split = file.read("/faults/F1/geometry/split");
  EXPECT_EQ(std::accumulate(split.values.begin(), split.values.end(), 0.0), 2);
  EXPECT_EQ(split.values[5], 1);
}

TEST_F(FaultFieldsTest, FieldsAreInTheFaultFrameAndGlobal) {
  const H5File file(folder_.path() / "faults.h5");
  const Dataset local = file.read("/faults/F1/steps/traction_fault");
  const Dataset global = file.read("/faults/F1/steps/traction_global");
  const Dataset slip = file.read("/faults/F1/steps/slip_global");
  ASSERT_THAT(local.shape, ElementsAre(3, 12, 3));
  const FaultFields fields = example_fields(4, 2);  // step 1
  const OperatorNode& node = op_.geometry.nodes[1];
  const Eigen::Matrix3d frame =
      (Eigen::Matrix3d() << node.normal, node.strike, node.dip).finished();
  const std::size_t at = 3 * (12 + 6);  // step 1, point 6 is node 1
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto i = at + static_cast<std::size_t>(c);
    EXPECT_EQ(local.values[i], fields.traction(c, 1));
    EXPECT_NEAR(global.values[i], (frame * fields.traction.col(1))[c], 1e-6);
    EXPECT_NEAR(slip.values[i], (frame * fields.jump.col(1))[c], 1e-15);
  }
  EXPECT_EQ(file.attribute("/faults/F1/steps/traction_fault", "units"), "Pa");
  EXPECT_THAT(file.attribute("/faults/F1/steps/traction_fault", "long_name"),
              HasSubstr("minus side"));
  EXPECT_EQ(file.n_filters("/faults/F1/steps/traction_fault"), 3);
  EXPECT_THAT(file.attribute("/faults/F1/steps/state", "legend"), HasSubstr("2 = open"));
}

TEST_F(FaultFieldsTest, FaultEdgesHaveTheNearestTractionAndNoSlip) {
  const H5File file(folder_.path() / "faults.h5");
  const Dataset traction = file.read("/faults/F1/steps/traction_fault");
  const Dataset slip = file.read("/faults/F1/steps/slip_fault");
  const Dataset state = file.read("/faults/F1/steps/state");
  const FaultFields fields = example_fields(4, 1);  // step 0
  // Point 4 is above node 0 (point 5), point 7 below node 1 (point 6).
  EXPECT_EQ(traction.values[3 * 4], fields.traction(0, 0));
  EXPECT_EQ(traction.values[3 * 7 + 1], fields.traction(1, 1));
  EXPECT_EQ(slip.values[3 * 4], 0);
  EXPECT_EQ(slip.values[3 * 5], fields.jump(0, 0));
  EXPECT_EQ(state.values[4], 0);
  const Dataset chi = file.read("/faults/F1/steps/critical_index");
  EXPECT_THAT(chi.shape, ElementsAre(3, 12));
  EXPECT_EQ(chi.values[0], fields.critical_index[0]);
}

TEST_F(FaultFieldsTest, SecondFaultHasItsOwnNodesAndAPlainName) {
  const H5File file(folder_.path() / "faults.h5");
  const std::string group = "/faults/F2__east____co_1";
  EXPECT_EQ(file.attribute(group, "name"), "F2 <east> & co/1");
  const Dataset state = file.read(group + "/steps/state");
  EXPECT_EQ(state.values[6], 2);
  const Dataset chi = file.read(group + "/steps/static_critical_index");
  EXPECT_DOUBLE_EQ(chi.values[6], 0.8);
}

TEST_F(FaultFieldsTest, XdmfIsWellFormedAndItsReferencesHold) {
  const auto path = folder_.path() / "faults.xmf";
  expect_references_hold(path, 2 * 3 * 14);
  const std::string text = read_bytes(path);
  EXPECT_THAT(text, HasSubstr("CollectionType=\"Temporal\""));
  EXPECT_THAT(text, HasSubstr("<Time Value=\"20000000\"/>"));
  EXPECT_THAT(text, HasSubstr("\"1 12 3\"><DataItem Format=\"XML\" NumberType=\"Int\" "
                              "Dimensions=\"3 3\">2 0 0 1 1 1 1 12 3<"));
  EXPECT_THAT(text, HasSubstr("Name=\"F2 &lt;east&gt; &amp; co/1\""));
  EXPECT_THAT(text, Not(HasSubstr(folder_.path().string())));
  if (std::system("command -v xmllint > /dev/null") == 0) {
    EXPECT_EQ(std::system(("xmllint --nonet --noout " + path.string()).c_str()), 0);
  }
}

TEST_F(FaultFieldsTest, SameFieldsGiveSameBytes) {
  const ScratchFolder other;
  FieldWriter writer(other.path(), op_.geometry);
  for (int step = 0; step < 3; ++step) {
    writer.add_step(example_step(step), example_fields(4, 1 + step));
  }
  writer.finish();
  for (const char* name : {"faults.h5", "faults.xmf"}) {
    EXPECT_TRUE(read_bytes(other.path() / name) == read_bytes(folder_.path() / name)) << name;
  }
}

TEST(FieldWriter, AbandonedLeavesNothing) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  {
    FieldWriter writer(folder.path(), op.geometry);
    writer.add_step(example_step(0), example_fields(4, 1));
  }
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(FieldWriter, WithoutStepsShowsTheGeometry) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  FieldWriter writer(folder.path(), op.geometry);
  writer.finish();
  expect_references_hold(folder.path() / "faults.xmf", 2 * 6);
  EXPECT_THAT(read_bytes(folder.path() / "faults.xmf"), Not(HasSubstr("Temporal")));
}

TEST(FieldWriter, TakesASceneWithoutFaults) {
  const ScratchFolder folder;
  FieldWriter writer(folder.path(), FaultGeometry());
  FaultFields none;
  none.traction.resize(3, 0);
  none.jump.resize(3, 0);
  EXPECT_NO_THROW(writer.add_step(StepResult(), none));
  writer.finish();
  EXPECT_EQ(check_xml(read_bytes(folder.path() / "faults.xmf")), "");
}

TEST(FieldWriter, PlaneStrainDrawsLines) {
  const ScratchFolder folder;
  FaultGeometry geometry;
  geometry.plane_strain = true;
  OperatorFault fault = example_fault(geometry, "F", 0);
  fault.n_columns = 1;
  fault.grid_position.erase(fault.grid_position.begin(), fault.grid_position.begin() + 4);
  fault.grid_position.resize(4);
  fault.grid_node = {-1, 0, 1, -1};
  fault.grid_used = {1, 1, 1, 1};
  fault.column_width = {1};
  fault.faces = {{0, 1, 1, 0}, {1, 2, 2, 1}, {2, 3, 3, 2}};
  geometry.faults = {fault};
  FieldWriter writer(folder.path(), geometry);
  writer.add_step(example_step(0), example_fields(2, 1));
  writer.finish();
  const H5File file(folder.path() / "faults.h5");
  EXPECT_THAT(file.read("/faults/F/geometry/cells").values, ElementsAre(0, 1, 1, 2, 2, 3));
  EXPECT_THAT(read_bytes(folder.path() / "faults.xmf"),
              HasSubstr("\"Polyline\" NumberOfElements=\"3\" NodesPerElement=\"2\""));
  expect_references_hold(folder.path() / "faults.xmf", 14);
}

TEST(FieldWriter, NaNIsABug) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  FieldWriter writer(folder.path(), op.geometry);
  FaultFields fields = example_fields(4, 1);
  fields.critical_index[2] = std::nan("");
  EXPECT_THROW(writer.add_step(example_step(0), fields), InternalError);
}

TEST(Volume, DisplacementsComeBack) {
  const ScratchFolder folder;
  const Eigen::Matrix3Xd nodes = Eigen::Matrix3Xd::Random(3, 12);
  const std::vector<std::array<int, 8>> cells = {{0, 1, 2, 3, 4, 5, 6, 7},
                                                 {4, 5, 6, 7, 8, 9, 10, 11}};
  const std::vector<VolumeSnapshot> snapshots = {{"initial", 0, Eigen::Matrix3Xd::Zero(3, 12)},
                                                 {"end", 5, Eigen::Matrix3Xd::Random(3, 12)}};
  write_volume(folder.path(), nodes, cells, {3, 4}, snapshots);
  const H5File file(folder.path() / "volume.h5");
  const Dataset u = file.read("/displacement");
  ASSERT_THAT(u.shape, ElementsAre(2, 12, 3));
  EXPECT_EQ(u.values[3 * (12 + 7) + 2], snapshots[1].displacement(2, 7));
  EXPECT_EQ(file.read("/mesh/nodes").values[3 * 11 + 1], nodes(1, 11));
  EXPECT_EQ(file.read("/mesh/cells").values[8], 4);
  EXPECT_THAT(file.read("/mesh/material").values, ElementsAre(3, 4));
  expect_references_hold(folder.path() / "volume.xmf", 8);
}

TEST(Volume, WithoutSnapshotsShowsTheMesh) {
  const ScratchFolder folder;
  write_volume(folder.path(), Eigen::Matrix3Xd::Random(3, 8), {{0, 1, 2, 3, 4, 5, 6, 7}}, {0}, {});
  expect_references_hold(folder.path() / "volume.xmf", 3);
}

}  // namespace
}  // namespace faultsim
