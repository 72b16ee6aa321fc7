// Flow results on the faults of a scene: what compartments do must follow, and what they cannot do.
#include "simulator/operators/field_loads.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/elasticity/elasticity.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/loads/case_loads.h"
#include "simulator/loads/history.h"
#include "simulator/operators/cell_changes.h"
#include "simulator/reading/read_scene.h"
#include "simulator/scene/field_depths.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// A coarse field of two compartments beside a dipping fault with an offset, in plane strain.
json scene_of_two_blocks() {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", "1000 m"}, {"dip", "50 m"}, {"normal", "300 m"}, {"growth", 2.0}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["numerics"] = {{"plane_strain", "on"}};
  return scene;
}

/// A coarse box with a disc of pressure, which cells have in part, under a fault.
json scene_of_a_disc() {
  json scene = json::parse(starter_scene("box"));
  scene["mesh"] = {
      {"strike", "250 m"}, {"dip", "100 m"}, {"normal", "100 m"}, {"fine_margin", "0 m"}};
  scene["geometry"]["regions"] = {{{"name", "disc"},
                                   {"shape", "disc"},
                                   {"center", {"0 m", "0 m", "-2000 m"}},
                                   {"radius", "430 m"},
                                   {"thickness", "230 m"}}};
  return scene;
}

class FieldLoadsTest : public testing::Test {
 protected:
  explicit FieldLoadsTest(const json& scene = scene_of_two_blocks())
      : scene_(read_scene(parse_json(scene.dump(), "test"))) {
    for (Material& material : scene_.materials) material.biot = 0.8;
    std::vector<Problem> problems;
    plan_ = make_plan(scene_, problems);
    prepared_ = prepare_influence(SceneBulk(scene_, plan_), {}, {}, monitor_);
    mesh_ = bulk_problem(scene_, plan_).mesh;
  }

  /// Boxes of 250 m x all y x 40 m over all of the reservoirs, at reports a year apart.
  FlowField boxes(int n_reports) const {
    FlowField field;
    for (int t = 0; t < n_reports; ++t) field.date.push_back(1e9 + t * kYear);
    for (double x = -6000; x < 6000; x += 250) {
      for (double z = -4000; z < -2000; z += 40)
        field.cells.push_back({{x, -9000, z}, {x + 250, 9000, z + 40}});
    }
    field.value = Eigen::MatrixXd::Constant(std::ssize(field.cells), n_reports, 3e7);
    return field;
  }

  /// The scene with all of a flow result's reports, the first as its reference.
  Scene with(const FlowField& field) const {
    Scene scene = scene_;
    scene.pressure_field.field = std::make_shared<const FlowField>(field);
    for (std::size_t t = 0; t < field.date.size(); ++t) {
      scene.pressure_field.reports.push_back(static_cast<int>(t));
      scene.pressure_field.time.push_back(field.date[t] - field.date[0]);
    }
    return scene;
  }
  FieldCells cells() const { return {*prepared_.op, mesh_, *prepared_.block}; }
  FieldLoads loads_of(const FlowField& field) const { return field_loads(with(field), cells()); }

  /// Locked tractions at 0.7 years of a cooling of all by a field, and by the stages; without what
  /// there is at the start.
  std::pair<Eigen::VectorXd, Eigen::VectorXd> cooled_both_ways() {
    for (Material& material : scene_.materials) material.thermal_expansion = 1.2e-5;
    for (PressureHistory& history : scene_.pressure) {
      history.pressure_change.clear();
      history.time.clear();
    }
    FlowField field = boxes(2);
    field.value.col(0).setConstant(360);
    field.value.col(1).setConstant(330);
    Scene by_field = scene_, by_stage = scene_;
    by_field.temperature_field = with(field).pressure_field;
    for (std::size_t r = 0; r < scene_.pressure.size(); ++r)
      by_stage.temperature.push_back({static_cast<int>(r), {0, kYear}, {0, -30}});
    const FieldLoads loads = field_loads(by_field, cells());
    const StepLoads start = CaseLoads(by_stage, *prepared_.op).at(0);
    const StepLoads a = CaseLoads(by_field, *prepared_.op, {loads.history}).at(0.7 * kYear);
    const StepLoads b = CaseLoads(by_stage, *prepared_.op).at(0.7 * kYear);
    EXPECT_EQ(b.fault_pressure_change.norm(), 0);
    return {a.locked - start.locked, b.locked - start.locked};
  }

  /// Loads of a field whose pressures all fall by 20 MPa in a year are those of compartments that
  /// do so.
  void expect_depletion_as_of_compartments(FlowField field) {
    for (PressureHistory& history : scene_.pressure)
      history = {.region = history.region, .time = {0, kYear}, .pressure_change = {0, -2e7}};
    field.value.col(1).array() -= 2e7;
    const FieldLoads loads = loads_of(field);
    for (const RegionCoverage& region : loads.mapping.coverage)
      EXPECT_NEAR(region.covered, region.volume, 1e-12 * region.volume);
    Scene still = with(field);
    for (PressureHistory& history : still.pressure) history.pressure_change = {0, 0};
    const CaseLoads by_field(still, *prepared_.op, {loads.history});
    const CaseLoads by_compartment(scene_, *prepared_.op);
    for (const double time : {0.0, 0.3 * kYear, kYear, 2 * kYear}) {
      const StepLoads a = by_field.at(time), b = by_compartment.at(time);
      EXPECT_LT((a.locked - b.locked).norm(), 1e-12 * b.locked.norm()) << time;
      EXPECT_LT((a.fault_pressure_change - b.fault_pressure_change).norm(),
                1e-12 * b.fault_pressure_change.norm() + 1e-6)
          << time;
      for (std::size_t r = 0; r < a.pressure_change.size(); ++r)
        EXPECT_NEAR(a.pressure_change[r], b.pressure_change[r], 1e-5) << time;
    }
    EXPECT_GT(by_compartment.at(kYear).fault_pressure_change.norm(), 1e6);
  }

  static constexpr double kYear = 365.25 * 86400;
  SilentMonitor monitor_;
  Scene scene_;
  Plan plan_;
  PreparedInfluence prepared_;
  Mesh mesh_;
};

TEST_F(FieldLoadsTest, OfAUniformFieldAreThoseOfTheCompartments) {
  for (const FaultPressureRule rule :
       {FaultPressureRule::min, FaultPressureRule::max, FaultPressureRule::mean,
        FaultPressureRule::minus, FaultPressureRule::plus, FaultPressureRule::fraction}) {
    for (Fault& fault : scene_.faults) fault.pressure.rule = rule, fault.pressure.fraction = 0.3;
    expect_depletion_as_of_compartments(boxes(2));
  }
}

TEST_F(FieldLoadsTest, OfAUniformTemperatureAreThoseOfTheCompartments) {
  const auto [by_field, by_stage] = cooled_both_ways();
  EXPECT_LT((by_field - by_stage).norm(), 1e-11 * by_stage.norm());
  EXPECT_GT(by_stage.norm(), 1e6);
}

class FieldLoadsOfADisc : public FieldLoadsTest {
 protected:
  FieldLoadsOfADisc() : FieldLoadsTest(scene_of_a_disc()) {}
  FlowField halves() const {
    FlowField field;
    field.date = {1e9, 1e9 + kYear};
    field.cells = {{{-5000, -9000, -4000}, {60, 9000, 0}}, {{60, -9000, -4000}, {5000, 9000, 0}}};
    field.value = Eigen::MatrixXd::Constant(2, 2, 2e7);
    field.value(0, 1) -= 1e6;
    field.value(1, 1) -= 4e6;
    return field;
  }
};

TEST_F(FieldLoadsOfADisc, DepleteCellsInPartByTheirPart) {
  FlowField field = halves();
  field.value.setConstant(3e7);
  expect_depletion_as_of_compartments(field);
}

TEST_F(FieldLoadsOfADisc, CoolCellsInPartByTheirPart) {
  const auto [by_field, by_stage] = cooled_both_ways();
  EXPECT_LT((by_field - by_stage).norm(), 1e-11 * by_stage.norm());
  EXPECT_GT(by_stage.norm(), 1e5);
}

TEST_F(FieldLoadsOfADisc, HaveTheMeanOverTheDisc) {
  double sum = 0, volume = 0, sum_of_cells = 0, volume_of_cells = 0;
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    if (mesh_.region[c] < 0) continue;
    CellCorners corners;
    for (std::size_t i = 0; i < 8; ++i) corners[i] = mesh_.nodes[mesh_.cells[c][i]];
    const double low = corners[0].x(), high = corners[1].x();
    const double west = std::clamp((60 - low) / (high - low), 0.0, 1.0);
    const double change = -1e6 * west - 4e6 * (1 - west);
    const double whole = cell_volume(corners), part = mesh_.region_fraction[c] * whole;
    sum += part * change;
    volume += part;
    sum_of_cells += whole * change;
    volume_of_cells += whole;
  }
  const double mean = loads_of(halves()).history->region_change(0, 1);
  EXPECT_NEAR(mean, sum / volume, 1e-9 * std::abs(mean));
  EXPECT_GT(std::abs(sum_of_cells / volume_of_cells - mean), 1e3) << "cells in part must matter";
}

/// Flow cells that meet at the section's y count alike, and so a mirrored field is the same.
TEST_F(FieldLoadsTest, OfASectionAreTheMeanOfBothSidesOfIt) {
  FlowField field;
  field.date = {1e9, 1e9 + kYear};
  field.cells = {{{-6000, -9000, -4000}, {6000, 0, -2000}},
                 {{-6000, 0, -4000}, {6000, 9000, -2000}}};
  field.value = Eigen::MatrixXd::Constant(2, 2, 3e7);
  field.value.col(1) -= Eigen::Vector2d(5e6, 1.5e7);
  FlowField mirrored = field;
  mirrored.value.col(1).reverseInPlace();
  const FieldHistory there = *loads_of(field).history, back = *loads_of(mirrored).history;
  EXPECT_NEAR(there.region_change(0, 1), -1e7, 1e-6);
  EXPECT_LT((there.locked - back.locked).norm(), 1e-12 * there.locked.norm());
  for (const auto& [y, change] : {std::pair(-0.5, -5e6), std::pair(0.5, -1.5e7)}) {
    Scene scene = with(field);
    scene.pressure_field.y = y;
    EXPECT_NEAR(field_loads(scene, cells()).history->region_change(1, 1), change, 1e-6);
  }
}

TEST_F(FieldLoadsTest, OfTwoFieldsAreTheSumAtTheTimesOfBoth) {
  for (Material& material : scene_.materials) material.thermal_expansion = 1.2e-5;
  FlowField heat = boxes(2), fluid = boxes(3);
  heat.date = {1e9, 1e9 + 1.5 * kYear};
  heat.value.col(0).setConstant(360);
  heat.value.col(1).setConstant(345);
  fluid.value.col(1).array() -= 1e6;
  fluid.value.col(2).array() -= 4e6;
  const Scene wet = with(fluid);
  Scene both = wet, hot = scene_;
  both.temperature_field = hot.temperature_field = with(heat).pressure_field;
  const FieldHistory sum = *field_loads(both, cells()).history;
  const FieldHistory a = *field_loads(wet, cells()).history, b = *field_loads(hot, cells()).history;
  EXPECT_EQ(sum.time, (std::vector<double>{0, kYear, 1.5 * kYear, 2 * kYear}));
  const CaseLoads loads(both, *prepared_.op, {std::make_shared<FieldHistory>(sum)});
  EXPECT_THAT(loads.at(0.75 * kYear).temperature_change,
              testing::AllOf(testing::SizeIs(2), testing::Each(testing::DoubleNear(-7.5, 1e-9))));
  EXPECT_THAT(CaseLoads(wet, *prepared_.op, {std::make_shared<FieldHistory>(a)})
                  .at(kYear)
                  .temperature_change,
              testing::IsEmpty());
  for (const double t : {0.5, 1.0, 1.2, 1.5, 1.9}) {
    const Eigen::VectorXd expected =
        at_time(a.time, a.locked, t * kYear) + at_time(b.time, b.locked, t * kYear);
    EXPECT_LT((at_time(sum.time, sum.locked, t * kYear) - expected).norm(), 1e-12 * expected.norm())
        << t;
  }
}

/// A section stands for half a metre to both sides of it.
TEST_F(FieldLoadsTest, CoverTheShareOfTheCompartmentsThatTheirCellsLieIn) {
  for (Material& material : scene_.materials) material.thermal_expansion = 1.2e-5;
  const auto to = [&](double y) {
    FlowField field = boxes(2);
    for (FlowCell& cell : field.cells) cell.high.y() = y;
    return with(field);
  };
  const auto coverage = [&](const Scene& pressure, const Scene& temperature) {
    Scene both = pressure;
    both.temperature_field = temperature.pressure_field;
    return field_loads(both, cells()).coverage;
  };
  EXPECT_NEAR(coverage(to(9000), scene_), 1, 1e-12);
  EXPECT_NEAR(coverage(to(0.25), scene_), 0.75, 1e-12);
  EXPECT_NEAR(coverage(to(0.25), to(0)), 0.5, 1e-12) << "of the temperature";
  EXPECT_NEAR(coverage(to(-0.1), to(9000)), 0.4, 1e-12) << "of the pressure";
}

class FieldLoadsOfUnequalBlocks : public FieldLoadsTest {
 protected:
  FieldLoadsOfUnequalBlocks() : FieldLoadsTest(scene()) {}
  static json scene() {
    json scene = scene_of_two_blocks();
    scene["geometry"]["blocks"][1]["to"] = "3500 m";
    return scene;
  }
};

/// Compartments count by their volumes, not each alike.
TEST_F(FieldLoadsOfUnequalBlocks, CoverTheVolumeOfAllCompartmentsTogether) {
  FlowField west = boxes(2);
  std::erase_if(west.cells, [](const FlowCell& cell) { return cell.low.x() >= -1000; });
  west.value = Eigen::MatrixXd::Constant(std::ssize(west.cells), 2, 3e7);
  const FieldLoads loads = loads_of(west);
  const std::vector<RegionCoverage>& regions = loads.mapping.coverage;
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_GT(regions[0].covered, 0.1 * regions[0].volume);
  EXPECT_GT(regions[1].volume, 1.5 * regions[0].volume);
  EXPECT_EQ(regions[1].covered, 0);
  EXPECT_DOUBLE_EQ(loads.coverage, regions[0].covered / (regions[0].volume + regions[1].volume));
}

TEST_F(FieldLoadsTest, OfALinearFieldAreItsOwnDirectSolve) {
  const Eigen::Vector3d slope(3e3, 0, -2e3);  // Pa/m
  FlowField field = boxes(2);
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const FlowCell& cell = field.cells[f];
    field.value(static_cast<Eigen::Index>(f), 1) +=
        slope.dot(0.5 * (cell.low + cell.high) - Eigen::Vector3d(0, 0, -3000)) - 5e6;
  }
  const FieldLoads loads = loads_of(field);
  // The forces of all cells at once, each by the load of a region that is that cell alone.
  CondensedBulk bulk(bulk_problem(scene_, plan_), monitor_);
  const DofMap dofs(mesh_, bulk_problem(scene_, plan_).conditions,
                    static_cast<int>(bulk_problem(scene_, plan_).loads.size()));
  Eigen::VectorXd force = Eigen::VectorXd::Zero(dofs.n_unknowns());
  const Eigen::MatrixXd change = mapped_change(loads.mapping, field, 0);
  for (std::size_t c = 0; c < prepared_.block->cells.size(); ++c) {
    const InfluenceCell& cell = prepared_.block->cells[c];
    const double stress = scene_.materials[cell.material].biot * cell.fraction *
                          change(static_cast<Eigen::Index>(c), 1);
    for (const auto& [unknown, value] : dilatation_load(mesh_, dofs, cell.cell))
      force[unknown] += stress * value;
  }
  const Eigen::VectorXd direct = bulk.locked_traction(bulk.forward(force));
  EXPECT_LT((loads.history->locked.col(1) - direct).norm(), 1e-10 * direct.norm());
  EXPECT_GT(direct.cwiseAbs().maxCoeff(), 1e5);
}

/// Δp = 5 MPa below the start and 3 kPa/m across: beside the fault it is that of half a cell to
/// either side, not the mean of the block.
TEST_F(FieldLoadsTest, BesideAFaultAreThoseOfTheCellsThere) {
  FlowField field = boxes(2);
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const double x = 0.5 * (field.cells[f].low.x() + field.cells[f].high.x());
    field.value(static_cast<Eigen::Index>(f), 1) += 3e3 * x - 5e6;
  }
  const FieldLoads loads = loads_of(field);
  const FieldHistory& history = *loads.history;
  const auto& nodes = prepared_.op->geometry.nodes;
  const auto sides =
      side_regions(prepared_.op->geometry, LoadFactors(scene_, *prepared_.op).region_of_load());
  int n_minus = 0, n_plus = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double there = 3e3 * nodes[k].position.x() - 5e6;
    constexpr double kHalfACell = 3e3 * 300;  // and the flow's own cells are 250 m wide
    if (sides[k].minus >= 0) {
      const double change = history.region_change(sides[k].minus, 1) + history.beside_minus(row, 1);
      EXPECT_NEAR(change, there, kHalfACell);
      EXPECT_LT(change, there);
      ++n_minus;
    }
    if (sides[k].plus >= 0) {
      const double change = history.region_change(sides[k].plus, 1) + history.beside_plus(row, 1);
      EXPECT_NEAR(change, there, kHalfACell);
      EXPECT_GT(change, there);
      ++n_plus;
    } else {
      EXPECT_EQ(history.beside_plus(row, 1), 0);
    }
    EXPECT_EQ(history.beside_minus(row, 0), 0) << "nothing has changed yet";
  }
  EXPECT_GT(n_minus, 2);
  EXPECT_GT(n_plus, 2);
  EXPECT_GT(std::abs(history.beside_plus.col(1).cwiseAbs().maxCoeff()), 2e6);
  const StepLoads half = CaseLoads(with(field), *prepared_.op, {loads.history}).at(0.5 * kYear);
  EXPECT_LT((half.beside.col(1) - 0.5 * history.beside_plus.col(1)).norm(),
            1e-12 * history.beside_plus.norm());
}

TEST(PressureChanges, AreLinearFromOneTimeToAnother) {
  PressureChanges before{{-1, -3}, Eigen::Vector2d(2, 4)}, after{{-5, -7}, Eigen::Vector2d(6, 0)};
  EXPECT_EQ(between(before, after, 0.25).beside.rows(), 0);
  before.beside.setConstant(2, 2, 8);
  after.beside.setZero(2, 2);
  const PressureChanges there = between(before, after, 0.25);
  EXPECT_EQ(there.pressure_change, (std::vector<double>{-2, -4}));
  EXPECT_EQ(there.fault_pressure_change, Eigen::Vector2d(3, 3));
  EXPECT_EQ(there.beside, Eigen::Matrix2d::Constant(6));
}

TEST_F(FieldLoadsTest, BeginAtTheReference) {
  FlowField field = boxes(3);
  const double fall[3] = {4e6, 0, -1e6};
  for (int t = 0; t < 3; ++t) field.value.col(t).array() += fall[t];
  Scene scene = with(field);
  scene.pressure_field.reference = 1;
  scene.pressure_field.reports = {1, 2};
  scene.pressure_field.time = {0, kYear};
  const FieldLoads loads = field_loads(scene, cells());
  EXPECT_EQ(loads.history->locked.col(0).norm(), 0);
  EXPECT_NEAR(loads.history->region_change(0, 1), -1e6, 1e-6);
}

TEST_F(FieldLoadsTest, SayWhatBecameOfCellsThatAreNotCovered) {
  using testing::Contains;
  using testing::HasSubstr;
  FlowField field = boxes(2);
  field.value.col(1).array() -= 1e6;
  const std::vector<std::string> whole = loads_of(field).notes;
  EXPECT_THAT(whole, Contains("pressure field on east: 100 % of its volume covered"));
  EXPECT_THAT(whole, Contains(HasSubstr("are means over their volumes; those where a fault begins "
                                        "to slide or jumps are of the field's cells")));
  std::erase_if(field.cells, [](const FlowCell& cell) { return cell.low.x() > 100; });
  field.value.conservativeResize(std::ssize(field.cells), 2);
  EXPECT_THAT(loads_of(field).notes,
              Contains(testing::AllOf(HasSubstr("on east: 11.72 % of its volume covered; "),
                                      HasSubstr("covered in part take that part's mean; of the "
                                                "integral of its change at the last report 11.72 % "
                                                "lies in what is covered"))));
}

/// Half of the west is covered, and pressures fall more there than what the rest takes.
TEST_F(FieldLoadsTest, SayWhichPartOfTheIntegralIsAssumed) {
  FlowField field = boxes(2);
  std::vector<FieldIntegral> whole = loads_of(field).integrals;
  ASSERT_EQ(whole.size(), prepared_.block->region_names.size());
  EXPECT_TRUE(whole[0].is_whole());
  EXPECT_EQ(field_integrals_to_text(whole), "");
  std::erase_if(field.cells, [](const FlowCell& cell) { return cell.low.x() < -1000; });
  field.value = Eigen::MatrixXd::Constant(std::ssize(field.cells), 2, 3e7);
  double flow = 0;  // of the flow cells within the west, by hand
  const MappedCell west{.corners = block_corners(scene_, 0), .region = 0};
  for (std::size_t c = 0; c < field.cells.size(); ++c) {
    const double fall = 1e6 + 10 * field.cells[c].low.x();
    field.value(static_cast<Eigen::Index>(c), 1) -= fall;
    flow -= fall * overlap_volume(at_section(west.corners, 0), field.cells[c]);
  }
  const FieldLoads loads = loads_of(field);
  const FieldIntegral& one = loads.integrals[0];
  EXPECT_EQ(one.region, "west");
  EXPECT_GT(one.n_outside, 0);
  EXPECT_NEAR(one.has, flow, 1e-9 * std::abs(flow));
  EXPECT_LT(one.acts, 1.5 * one.has);
  EXPECT_NEAR(one.acts, loads.history->region_change(0, 1) * one.volume,
              1e-12 * std::abs(one.acts));
  EXPECT_NEAR(one.covered / one.volume,
              loads.mapping.coverage[0].covered / loads.mapping.coverage[0].volume, 1e-12);
  EXPECT_THAT(field_integrals_to_text(loads.integrals),
              testing::AllOf(testing::StartsWith("pressure field on west: "),
                             testing::HasSubstr("% of its volume is covered; of the integral of "
                                                "the change that acts at the last report, -"),
                             testing::HasSubstr("cells take what the nearest flow cell has")));
  const json rows = field_integrals_to_json(loads.integrals);
  EXPECT_EQ(rows[0]["integral_of_flow_cells"], one.has);
  // All of it falls.
  EXPECT_NEAR(rows[0]["assumed_share"].get<double>(), 1 - one.has / one.acts, 1e-12);
  double has = 0, acts = 0;
  for (const FieldIntegral& each : loads.integrals) has += each.has, acts += each.acts;
  EXPECT_NEAR(assumed_share(loads.integrals), 1 - has / acts, 1e-12);
  EXPECT_GT(assumed_share(loads.integrals), 0.1);
}

/// The mean over each compartment of what pictures show is what acts there.
TEST_F(FieldLoadsTest, AreShownInCellsAsTheyAct) {
  FlowField field = boxes(2);
  std::erase_if(field.cells, [](const FlowCell& cell) { return cell.low.x() > 1000; });
  field.value = Eigen::MatrixXd::Constant(std::ssize(field.cells), 2, 3e7);
  for (std::size_t c = 0; c < field.cells.size(); ++c)
    field.value(static_cast<Eigen::Index>(c), 1) -= 4e6 + 100 * field.cells[c].low.x();
  const Scene scene = with(field);
  const FieldLoads loads = field_loads(scene, cells());
  const CellChanges shown(scene, mesh_, false);
  ASSERT_TRUE(shown.has_pressure());
  EXPECT_FALSE(shown.has_temperature());
  EXPECT_EQ(shown.pressure(0).norm(), 0);
  const Eigen::VectorXd half = shown.pressure(0.5 * kYear);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    if (mesh_.region[c] < 0) {
      EXPECT_EQ(half[static_cast<Eigen::Index>(c)], 0);
    }
  }
  for (Eigen::Index r = 0; r < 2; ++r) {
    double sum = 0, volume = 0;
    for (const InfluenceCell& cell : prepared_.block->cells) {
      if (cell.region != r) continue;
      sum += cell.fraction * cell.volume * half[cell.cell];
      volume += cell.fraction * cell.volume;
    }
    EXPECT_NEAR(sum / volume, 0.5 * loads.history->region_change(r, 1), 1e-3) << r;
  }
}

/// Flow cells of 250 m and 40 m follow no fault and no top: each counts whole, with one
/// compartment.
TEST_F(FieldLoadsTest, KeepTheIntegralOfTheFlowGrid) {
  FlowField field = boxes(3);
  double whole = 0, size = 0;  // per metre of strike
  std::erase_if(field.cells, [&](const FlowCell& cell) {
    double within = 0;
    for (const std::size_t block : {0, 1})
      within += overlap_volume(at_section(block_corners(scene_, block), 0), cell);
    return within < 0.8 * 250 * 40;
  });
  field.value = Eigen::MatrixXd::Constant(std::ssize(field.cells), 3, 3e7);
  for (std::size_t c = 0; c < field.cells.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    field.value(row, 1) -= 1e6 * std::sin(0.01 * field.cells[c].low.x());
    field.value(row, 2) -= 4e6 + 500 * field.cells[c].low.x();
    whole += 250 * 40 * (field.value(row, 2) - field.value(row, 0));
    size += 250 * 40 * std::abs(field.value(row, 2) - field.value(row, 0));
  }
  Scene scene = with(field);
  const std::string key = field_loads_key(scene);
  scene.pressure_field.integral = IntegralRule::flow_grid;
  EXPECT_NE(field_loads_key(scene), key);
  const FieldLoads loads = field_loads(scene, cells());
  double acts = 0, volume = 0, scaled = 0;
  for (const FieldIntegral& one : loads.integrals) {
    ASSERT_TRUE(one.whole);
    EXPECT_NEAR(one.acts, one.whole->flow_grid, 1e-12 * size);
    scaled += std::abs(one.whole->mapped - one.acts);
    acts += one.acts;
    volume += one.whole->flow_volume;
  }
  EXPECT_NEAR(acts, whole, 1e-12 * size);
  EXPECT_GT(scaled, 1e-3 * size);
  EXPECT_NEAR(volume, 250 * 40 * static_cast<double>(field.cells.size()), 1e-6 * volume);
  // What pictures show is what acts.
  const Eigen::VectorXd shown = CellChanges(scene, mesh_, false).pressure(2 * kYear);
  double in_pictures = 0;
  for (const InfluenceCell& cell : prepared_.block->cells)
    in_pictures += cell.fraction * cell.volume * shown[cell.cell];
  EXPECT_NEAR(in_pictures, whole, 1e-12 * size);
  EXPECT_THAT(field_integrals_to_text(loads.integrals),
              testing::HasSubstr("bar m3, is that of its flow cells ("));
  EXPECT_THAT(field_integrals_to_text(loads.integrals, true), testing::HasSubstr(" bar m3/m, is "));
  const json row = field_integrals_to_json(loads.integrals)[0]["flow_grid"];
  EXPECT_EQ(row["integral"], loads.integrals[0].whole->flow_grid);
  EXPECT_EQ(row["largest_scaling"], loads.integrals[0].whole->largest_scaling);
}

TEST_F(FieldLoadsTest, HaveAKeyOfWhatTheyLookAt) {
  const Scene scene = with(boxes(2));
  const std::string key = field_loads_key(scene);
  Scene other = scene;
  other.faults[0].friction.static_friction_angle += 0.1;
  EXPECT_EQ(field_loads_key(other), key);
  other.faults[0].pressure.rule = FaultPressureRule::max;
  EXPECT_NE(field_loads_key(other), key);
  other = scene;
  other.materials[0].biot = 0.3;
  EXPECT_NE(field_loads_key(other), key);
  other = scene;
  other.pressure_field.fingerprint = "another";
  EXPECT_NE(field_loads_key(other), key);
}

}  // namespace
}  // namespace faultsim
