#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <regex>
#include <sstream>

#include "simulator/common/errors.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/result_files/field_reader.h"
#include "simulator/result_files/field_recorder.h"
#include "simulator/result_files/field_writer.h"
#include "simulator/result_files/volume_writer.h"
#include "simulator/result_files/xdmf.h"
#include "tests/unit/cache/example_operator.h"
#include "tests/unit/result_files/h5_file.h"

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

/// The numbers that the XDMF text says are a step of an attribute, read from the bytes of the file.
std::vector<double> numbers_at(const std::filesystem::path& xmf, const std::string& grid,
                               const std::string& attribute, std::size_t step) {
  const std::string text = read_bytes(xmf);
  std::size_t at = 0;
  for (std::size_t k = 0; k <= step; ++k) at = text.find("<Time ", at + 1);
  at = text.find("<Grid Name=\"" + grid + "\"", at);
  at = text.find("<Attribute Name=\"" + attribute + "\"", at);
  const std::string rest = text.substr(at, 400);
  const std::regex place(
      R"re(Binary" NumberType="Float" Precision="8" Endian="Little" Seek="(\d+)" Dimensions="([0-9 ]+)">([^<]+)<)re");
  std::smatch match;
  EXPECT_TRUE(std::regex_search(rest, match, place)) << rest;
  std::size_t n = 1;
  std::istringstream sizes(match[2].str());
  for (std::size_t size = 0; sizes >> size;) n *= size;
  const std::string bytes = read_bytes(xmf.parent_path() / match[3].str());
  std::vector<double> numbers(n);
  const std::size_t from = std::stoul(match[1]);
  EXPECT_LE(from + 8 * n, bytes.size());
  std::memcpy(numbers.data(), bytes.data() + from, 8 * n);
  return numbers;
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

FaultOperator whole_operator() {
  FaultOperator op = example_operator("a");
  op.geometry.half_domain = false;
  return op;
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
  const FaultOperator op_ = whole_operator();
};

/// The numbers stand where the XDMF text says, step by step: what all readers of ParaView take.
TEST_F(FaultFieldsTest, XdmfFindsTheNumbersOfEachStep) {
  const H5File file(folder_.path() / "faults.h5");
  for (const char* name : {"traction_global", "slip_fault", "critical_index"}) {
    const Dataset all = file.read(concat("/faults/F1/steps/", name));
    const std::size_t n = all.values.size() / 3;
    for (std::size_t step = 0; step < 3; ++step) {
      const std::vector<double> numbers =
          numbers_at(folder_.path() / "faults.xmf", "F1", name, step);
      ASSERT_EQ(numbers.size(), n) << name;
      EXPECT_TRUE(std::equal(numbers.begin(), numbers.end(), all.values.begin() + long(n * step)))
          << name << " of step " << step;
    }
  }
}

TEST_F(FaultFieldsTest, GeometryAndTimesComeBack) {
  const H5File file(folder_.path() / "faults.h5");
  EXPECT_THAT(file.read("/time").values, ElementsAre(0, 1e7, 2e7));
  EXPECT_EQ(file.attribute("/time", "units"), "s");
  EXPECT_EQ(hdf5::read<std::string>(file.id(), "/stage")[2], "cushion_gas_injection");
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
  EXPECT_EQ(file.n_filters("/faults/F1/steps/traction_fault"), 1) << "a checksum and nothing else";
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
  expect_references_hold(path, 2 * 3 * 7);
  const std::string text = read_bytes(path);
  EXPECT_THAT(text, HasSubstr("CollectionType=\"Temporal\""));
  EXPECT_THAT(text, HasSubstr("<Time Value=\"20000000\"/>"));
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

/// Half the domain: columns at y = 0, 100 and 200 become five, and every sum that of the whole.
TEST(FieldWriter, WritesTheWholeFaultOfAHalfDomain) {
  const ScratchFolder folder;
  FaultOperator op = whole_operator();
  op.geometry.half_domain = true;
  OperatorFault& fault = op.geometry.faults[0];
  std::swap(fault.node_of_point[1],
            fault.node_of_point[5]);  // node 0 lies on the plane, node 1 beyond it
  FieldWriter writer(folder.path(), op.geometry);
  const FaultFields fields = example_fields(4, 1);
  writer.add_step(example_step(0), fields);
  writer.finish();
  const H5File file(folder.path() / "faults.h5");
  const std::string at = "/faults/F1/geometry/";
  const std::vector<double> points = file.read(at + "points").values;
  const std::vector<double> area = file.read(at + "area").values;
  ASSERT_EQ(area.size(), 20U);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(points[3 * k + 1], 100.0 * double(k / 4) - 200);
  EXPECT_EQ(area[9], 2 * op.geometry.nodes[0].area) << "the half area on the plane";
  EXPECT_EQ(area[6], op.geometry.nodes[1].area);
  EXPECT_EQ(std::accumulate(area.begin(), area.end(), 0.0),
            2 * (op.geometry.nodes[0].area + op.geometry.nodes[1].area));
  // Node 1 is point 14, at y = 100, and its image point 6.
  const auto three = [&](const std::string& path, std::size_t k) {
    const std::vector<double> values = file.read(path).values;
    return Eigen::Vector3d(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
  };
  for (const char* name : {"traction", "slip"}) {
    const std::string steps = concat("/faults/F1/steps/", name);
    const Eigen::Vector3d local = three(steps + "_fault", 14), image = three(steps + "_fault", 6);
    EXPECT_EQ(image, Eigen::Vector3d(local[0], -local[1], local[2])) << name;
    const Eigen::Vector3d global = three(steps + "_global", 14), seen = three(steps + "_global", 6);
    EXPECT_LT((seen - Eigen::Vector3d(global[0], -global[1], global[2])).norm(), 1e-6) << name;
    Eigen::Matrix3d frame;
    frame << three(at + "normal", 6), three(at + "strike", 6), three(at + "dip", 6);
    EXPECT_NEAR(frame.determinant(), 1, 1e-12);
    EXPECT_LT((frame * image - seen).norm(), 1e-6) << "the image's frame is that of its values";
  }
  const std::vector<double> cells = file.read(at + "cells").values;
  ASSERT_EQ(cells.size(), 4 * 12U);
  for (std::size_t k = 0; k < 12; ++k) {  // all faces turn the same way
    const auto corner = [&](std::size_t c) {
      const auto p = 3 * static_cast<std::size_t>(cells[4 * k + c]);
      return Eigen::Vector3d(points[p], points[p + 1], points[p + 2]);
    };
    const Eigen::Vector3d turn = (corner(1) - corner(0)).cross(corner(3) - corner(0));
    EXPECT_NEAR(turn.x(), 5000, 1e-9) << "face " << k;
  }
}

/// What is kept in memory is what a file gives back, of half a domain too.
TEST(FieldRecorder, KeepsWhatAFileKeeps) {
  for (const bool half : {false, true}) {
    const ScratchFolder folder;
    FaultOperator op = whole_operator();
    op.geometry.half_domain = half;
    FieldWriter writer(folder.path(), op.geometry);
    FieldRecorder recorder(op.geometry);
    for (int step = 0; step < 2; ++step) {
      const FaultFields fields = example_fields(4, 1 + step);
      writer.add_step(example_step(step), fields);
      recorder.add_step(example_step(step), fields);
    }
    writer.finish();
    const FieldReader reader(folder.path() / "faults.h5");
    EXPECT_EQ(recorder.steps(), reader.steps());
    EXPECT_EQ(recorder.times(), reader.times());
    ASSERT_EQ(recorder.faults().size(), reader.faults().size());
    for (std::size_t f = 0; f < reader.faults().size(); ++f) {
      const StoredFault &kept = recorder.faults()[f], &read = reader.faults()[f];
      EXPECT_EQ(kept.name, read.name);
      EXPECT_EQ(kept.points, read.points);
      EXPECT_EQ(kept.faces, read.faces);
      EXPECT_EQ(kept.split, read.split);
      for (std::size_t step = 0; step < 2; ++step) {
        const StoredFields here = recorder.fields(f, step), there = reader.fields(f, step);
        EXPECT_EQ(here.traction, there.traction);
        EXPECT_EQ(here.slip, there.slip);
        EXPECT_EQ(here.critical_index, there.critical_index);
        EXPECT_EQ(recorder.critical_index(f, step), here.critical_index);
        EXPECT_EQ(reader.critical_index(f, step), here.critical_index);
        EXPECT_EQ(here.fault_pressure_change, there.fault_pressure_change);
        EXPECT_EQ(here.state, there.state);
      }
      EXPECT_GT(reader.fields(f, 1).slip.norm(), 0);
    }
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
  const FaultOperator op = whole_operator();
  FieldWriter writer(folder.path(), op.geometry);
  writer.finish();
  expect_references_hold(folder.path() / "faults.xmf", 2 * 7);
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
  fault.points.erase(fault.points.begin(), fault.points.begin() + 4);
  fault.points.resize(4);
  fault.node_of_point = {-1, 0, 1, -1};
  fault.faces = {{0, 1, 1, 0}, {1, 2, 2, 1}, {2, 3, 3, 2}};
  geometry.faults = {fault};
  FieldWriter writer(folder.path(), geometry);
  writer.add_step(example_step(0), example_fields(2, 1));
  writer.finish();
  const H5File file(folder.path() / "faults.h5");
  EXPECT_THAT(file.read("/faults/F/geometry/cells").values, ElementsAre(0, 1, 1, 2, 2, 3));
  EXPECT_THAT(read_bytes(folder.path() / "faults.xmf"),
              HasSubstr("\"Polyline\" NumberOfElements=\"3\" NodesPerElement=\"2\""));
  expect_references_hold(folder.path() / "faults.xmf", 7);
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
  std::vector<Eigen::Vector3d> nodes(12);
  for (Eigen::Vector3d& node : nodes) node.setRandom();
  const std::vector<int> cells = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 9, 10, 11};
  const std::vector<VolumeSnapshot> snapshots = {{"initial", 0, Eigen::Matrix3Xd::Zero(3, 12)},
                                                 {"end", 5, Eigen::Matrix3Xd::Random(3, 12)}};
  write_volume(folder.path(), nodes, {cells, 8}, {3, 4}, snapshots);
  const H5File file(folder.path() / "volume.h5");
  const Dataset u = file.read("/displacement");
  ASSERT_THAT(u.shape, ElementsAre(2, 12, 3));
  EXPECT_EQ(u.values[3 * (12 + 7) + 2], snapshots[1].displacement(2, 7));
  EXPECT_EQ(file.read("/mesh/nodes").values[3 * 11 + 1], nodes[11].y());
  EXPECT_EQ(file.read("/mesh/cells").values[8], 4);
  EXPECT_THAT(file.read("/mesh/material").values, ElementsAre(3, 4));
  expect_references_hold(folder.path() / "volume.xmf", 6);
  const std::vector<double> end =
      numbers_at(folder.path() / "volume.xmf", "volume\" GridType=\"Uniform", "displacement", 1);
  EXPECT_TRUE(std::equal(end.begin(), end.end(), snapshots[1].displacement.data()));
}

TEST(Volume, HasWhatChangesInItsCells) {
  const ScratchFolder folder;
  const std::vector<Eigen::Vector3d> nodes(12, Eigen::Vector3d::Ones());
  const std::vector<int> cells = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 9, 10, 11};
  std::vector<VolumeSnapshot> snapshots(2, {"end", 0, Eigen::Matrix3Xd::Zero(3, 12)});
  snapshots[0].pressure_change = Eigen::Vector2d(-3, 0);
  snapshots[1].pressure_change = Eigen::Vector2d(-8, 2);
  write_volume(folder.path(), nodes, {cells, 8}, {3, 4}, snapshots);
  const H5File file(folder.path() / "volume.h5");
  EXPECT_THAT(file.read("/pressure_change").shape, ElementsAre(2, 2));
  EXPECT_THAT(file.read("/pressure_change").values, ElementsAre(-3, 0, -8, 2));
  expect_references_hold(folder.path() / "volume.xmf", 6);
  EXPECT_THAT(
      numbers_at(folder.path() / "volume.xmf", "volume\" GridType=\"Uniform", "pressure_change", 1),
      ElementsAre(-8, 2));
  EXPECT_THAT(read_bytes(folder.path() / "volume.xmf"),
              testing::Not(HasSubstr("temperature_change")));
}

TEST(Volume, WithoutSnapshotsShowsTheMesh) {
  const ScratchFolder folder;
  const std::vector<Eigen::Vector3d> nodes(8, Eigen::Vector3d::Ones());
  const std::vector<int> cell = {0, 1, 2, 3, 4, 5, 6, 7};
  write_volume(folder.path(), nodes, {cell, 8}, {0}, {});
  expect_references_hold(folder.path() / "volume.xmf", 3);
}

TEST(Volume, QuadraticTetrahedraAreSaidToBeSo) {
  const ScratchFolder folder;
  const std::vector<Eigen::Vector3d> nodes(11, Eigen::Vector3d::Ones());
  const std::vector<int> cells = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 2, 1, 3, 4, 5, 6, 7, 8, 10};
  write_volume(folder.path(), nodes, {cells, 10}, {0, 0}, {});
  EXPECT_THAT(H5File(folder.path() / "volume.h5").read("/mesh/cells").shape, ElementsAre(2, 10));
  EXPECT_THAT(read_bytes(folder.path() / "volume.xmf"),
              HasSubstr("\"Tetrahedron_10\" NumberOfElements=\"2\""));
}

}  // namespace
}  // namespace faultsim
