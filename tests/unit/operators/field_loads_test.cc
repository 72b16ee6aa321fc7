// Flow results on the faults of a scene: what compartments do must follow, and what they cannot do.
#include "simulator/operators/field_loads.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/elasticity/elasticity.h"
#include "simulator/loads/case_loads.h"
#include "simulator/scene/read_scene.h"

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

class FieldLoadsTest : public testing::Test {
 protected:
  FieldLoadsTest() : scene_(read_scene(parse_json(scene_of_two_blocks().dump(), "test"))) {
    for (Material& material : scene_.materials) material.biot = 0.8;
    std::vector<Problem> problems;
    plan_ = make_plan(scene_, problems);
    prepared_ = prepare_influence(scene_, plan_, {}, {}, monitor_);
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
    field.pressure = Eigen::MatrixXd::Constant(std::ssize(field.cells), n_reports, 3e7);
    return field;
  }

  FieldLoads loads_of(const FlowField& field, const FieldChoice& choice = {}) const {
    return field_loads(scene_, plan_, prepared_, field, choice);
  }

  static constexpr double kYear = 365.25 * 86400;
  SilentMonitor monitor_;
  Scene scene_;
  Plan plan_;
  PreparedInfluence prepared_;
  Mesh mesh_;
};

TEST_F(FieldLoadsTest, OfAUniformFieldAreThoseOfTheCompartments) {
  for (PressureHistory& history : scene_.pressure) {
    history = {.region = history.region, .time = {0, kYear}, .pressure_change = {0, -2e7}};
  }
  for (const FaultPressureRule rule :
       {FaultPressureRule::min, FaultPressureRule::max, FaultPressureRule::mean}) {
    for (Fault& fault : scene_.faults) fault.pressure.rule = rule;
    FlowField field = boxes(2);
    field.pressure.col(1).array() -= 2e7;
    const FieldLoads loads = loads_of(field);
    for (const RegionCoverage& region : loads.mapping.coverage)
      EXPECT_NEAR(region.covered, region.volume, 1e-12 * region.volume);
    Scene still = scene_;
    for (PressureHistory& history : still.pressure) history.pressure_change = {0, 0};
    const CaseLoads by_field(still, *prepared_.op, 0, &loads.history);
    const CaseLoads by_compartment(scene_, *prepared_.op);
    for (const double time : {0.0, 0.3 * kYear, kYear, 2 * kYear}) {
      const StepLoads a = by_field.at(time), b = by_compartment.at(time);
      EXPECT_LT((a.locked - b.locked).norm(), 1e-12 * b.locked.norm()) << time;
      EXPECT_LT((a.fault_pressure_change - b.fault_pressure_change).norm(),
                1e-12 * b.fault_pressure_change.norm() + 1e-6)
          << time;
    }
    EXPECT_GT(by_compartment.at(kYear).fault_pressure_change.norm(), 1e6);
  }
}

TEST_F(FieldLoadsTest, OfALinearFieldAreItsOwnDirectSolve) {
  const Eigen::Vector3d slope(3e3, 0, -2e3);  // Pa/m
  FlowField field = boxes(2);
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const FlowCell& cell = field.cells[f];
    field.pressure(static_cast<Eigen::Index>(f), 1) +=
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
  EXPECT_LT((loads.history.locked.col(1) - direct).norm(), 1e-10 * direct.norm());
  EXPECT_GT(direct.cwiseAbs().maxCoeff(), 1e5);
}

TEST_F(FieldLoadsTest, BeginAtTheReferenceAndLeaveOutReportsOnALine) {
  FlowField field = boxes(5);
  const double fall[5] = {4e6, 0, -1e6, -2e6, -2.5e6};
  for (int t = 0; t < 5; ++t) field.pressure.col(t).array() += fall[t];
  const FieldLoads all = loads_of(field, {.reference = 1, .bound = 0.01});
  EXPECT_EQ(all.reports, (std::vector<int>{1, 3, 4}));
  EXPECT_EQ(all.history.time, (std::vector<double>{0, 2 * kYear, 3 * kYear}));
  EXPECT_EQ(all.history.locked.col(0).norm(), 0);
  EXPECT_EQ(loads_of(field, {.reference = 1, .bound = 1e7}).reports, (std::vector<int>{1, 4}));
}

TEST_F(FieldLoadsTest, RefuseWhatTheyCannotBe) {
  Plan half = plan_;
  half.half_domain = true;
  using testing::HasSubstr;
  EXPECT_THAT(([&] { field_loads(scene_, half, prepared_, boxes(2), {.reference = 2}); }),
              testing::ThrowsMessage<InputError>(testing::AllOf(HasSubstr("/numerics/half_domain"),
                                                                HasSubstr("has no report 2"))));
}

}  // namespace
}  // namespace faultsim
