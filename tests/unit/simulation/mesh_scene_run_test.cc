#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"
#include "tests/unit/files/scratch_folder.h"
#include "tests/unit/mesh/mesh_scene.h"

/// Scenes whose body is a mesh from a file, from the scene to its result.
namespace faultsim {
namespace {

class MeshSceneRun : public testing::Test {
 protected:
  /// Leaves the reservoir on one side of fault A alone. @param turned  each so many cells are
  /// numbered the other way round; 0 = none.
  void deplete_one_side(std::size_t turned = 0) const {
    UncutMesh body = test::meshed_cube();
    for (std::size_t cell = 0; turned > 0 && cell < body.n_cells(); cell += turned)
      std::swap(body.corners[4 * cell], body.corners[4 * cell + 1]);
    for (std::size_t cell = 0; cell < body.n_cells(); ++cell) {
      double x = 0;
      for (std::size_t v = 0; v < 4; ++v) x += body.nodes[body.corners[4 * cell + v]].x() / 4;
      if (x < 200) body.region[cell] = -1;
    }
    test::write_mesh_scene(folder_, body);
  }

  const ScratchFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path();
  const std::filesystem::path file_ = test::write_mesh_scene(folder_);
};

/// A confined layer that is depleted by Δp: the horizontal stress rises by γ_h |Δp|, γ_h = (1 −
/// 2ν)/(1 − ν), on every vertical plane, whatever its strike; and nowhere else.
TEST_F(MeshSceneRun, AConfinedLayerCompactsExactly) {
  const Scene scene = read_scene(read_json_file(file_.string()));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  ASSERT_TRUE(problems.empty());
  EXPECT_EQ(plan.n_cells, 384);
  SilentMonitor monitor;
  const PreparedOperator prepared = prepare_operator(scene, plan, {}, false, monitor);
  std::vector<FaultFields> steps;
  const auto keep = [&](const StepResult&, const FaultFields& step) { steps.push_back(step); };
  const CaseResult result = run_case(scene, prepared, monitor, {{keep}});
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  const double gamma = 0.7 / 0.85;
  const auto& nodes = prepared.op->geometry.nodes;
  ASSERT_EQ(nodes.size(), 25u + 15);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const double z = nodes[k].position.z();
    if (std::abs(std::abs(z + 2000) - 100) < 1) continue;  // where the layer ends
    const Eigen::Vector3d change =
        steps.back().traction.col(column) - steps.front().traction.col(column);
    EXPECT_NEAR(change[0], std::abs(z + 2000) < 100 ? gamma * 15e6 : 0, 1e-9 * 15e6) << z;
    EXPECT_NEAR(change[1], 0, 1e-9 * 15e6);
    EXPECT_NEAR(change[2], 0, 1e-9 * 15e6);
  }
}

TEST_F(MeshSceneRun, CellsMayBeNumberedTheOtherWayRound) {
  deplete_one_side();
  const CaseResult result = Simulation::from_file(file_.string()).run();
  deplete_one_side(3);
  const CaseResult other = Simulation::from_file(file_.string()).run();
  ASSERT_EQ(other.outcome, Outcome::converged) << other.reason;
  const double chi = result.steps.back().faults[0].chi_bar;
  EXPECT_GT(chi, 0.05);
  EXPECT_NEAR(other.steps.back().faults[0].chi_bar, chi, 1e-9);
}

/// A flow result that is even in the reservoir does what its compartment does.
TEST_F(MeshSceneRun, AFlowResultIsMappedOntoTetrahedra) {
  deplete_one_side();
  std::ofstream(folder_ / "flow.csv")
      << "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 2000-01-01 [bar], 2010-01-01 [bar]\n"
         "100, 200, 2000, 200, 400, 200, 300, 150\n"
         "300, 200, 2000, 200, 400, 200, 300, 150\n";
  const std::string stages = R"([{"name": "production", "until": "2010-01-01", "steps": 2}])";
  const CaseResult mapped =
      Simulation::from_file(file_.string(), {{"/start_date", "2000-01-01"},
                                             {"/stages", stages},
                                             {"/compartments", "{}"},
                                             {"/pressure_field", R"({"file": "flow.csv"})"}})
          .run();
  const CaseResult whole = Simulation::from_file(file_.string()).run();
  ASSERT_EQ(mapped.outcome, Outcome::converged) << mapped.reason;
  EXPECT_NEAR(mapped.field_coverage.value_or(0), 1, 1e-12);
  const double chi = whole.steps.back().faults[0].chi_bar;
  EXPECT_GT(chi, 0.05);
  EXPECT_NEAR(mapped.steps.back().faults[0].chi_bar, chi, 1e-9);
}

/// Depleted on one side of fault A alone, which slides then; in whatever order faults are listed.
TEST_F(MeshSceneRun, FaultsSlideInAnyOrder) {
  deplete_one_side();
  const Change weak{"/friction/friction_coefficient", "0.1"};
  const CaseResult one = Simulation::from_file(file_.string(), {weak}).run();
  const CaseResult other =
      Simulation::from_file(file_.string(),
                            {weak, {"/faults", R"([{"name": "B"}, {"name": "A"}])"}})
          .run();
  ASSERT_EQ(one.outcome, Outcome::converged) << one.reason;
  ASSERT_EQ(other.outcome, Outcome::converged) << other.reason;
  const auto &a = one.steps.back().faults[0], &b = one.steps.back().faults[1];
  EXPECT_GT(a.max_slip, 1e-3);
  EXPECT_NEAR(other.steps.back().faults[1].max_slip, a.max_slip, 1e-6 * a.max_slip);
  EXPECT_NEAR(other.steps.back().faults[1].moment, a.moment, 1e-6 * a.moment);
  EXPECT_NEAR(other.steps.back().faults[0].chi_bar, b.chi_bar, 1e-6);
}

}  // namespace
}  // namespace faultsim
