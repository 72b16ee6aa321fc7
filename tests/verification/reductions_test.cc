// The family reductions leave every node as it is: the same scenes with and without them. Areas, M0
// and observation points are in tests/unit/loading/field_case_test.cc, creep in creep_off_test.cc.

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/loading/run_case.h"
#include "simulator/scene/read_scene.h"

namespace faultsim {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct Fields {
  Plan plan;
  double factor_bytes = 0;
  FaultGeometry geometry;
  std::vector<FaultFields> steps;
};

Fields run(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
  for (const auto& [pointer, value] : settings) set_value(document, pointer, value);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  Fields fields;
  fields.plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  SilentMonitor monitor;
  const PreparedOperator prepared = prepare_operator(scene, fields.plan, {}, false, monitor);
  fields.factor_bytes = prepared.op->factor_bytes;
  fields.geometry = prepared.op->geometry;
  const auto keep = [&](const StepResult&, const FaultFields& step) {
    fields.steps.push_back(step);
  };
  const CaseResult end = run_case(scene, prepared, monitor, keep);
  EXPECT_EQ(end.outcome, Outcome::converged) << end.reason;
  return fields;
}

/// Displaced compartments and weak faults, so that all three slip; contact solved to rounding.
const Settings kSlipping = {{"/tier", "custom"},
                            {"/geometry/blocks/1/offset", "100 m"},
                            {"/friction/friction_angle", "20 deg"},
                            {"/output/observation_points", "[]"},
                            {"/numerics/traction_tolerance", "1e-12"}};

struct Difference {
  double traction = 0, jump = 0;  ///< largest, over the largest of the whole case.
  double largest_jump = 0;
  int compared = 0;
};

/// @param place  where a node of `other` lies in `one`; none = it has no counterpart.
template <typename Place>
Difference compare(const Fields& one, const Fields& other, const Place& place) {
  Difference d;
  double traction = 0;
  EXPECT_EQ(one.steps.size(), other.steps.size());
  for (std::size_t k = 0; k < other.geometry.nodes.size(); ++k) {
    const std::optional<std::size_t> at = place(other.geometry.nodes[k].position);
    if (!at) continue;
    ++d.compared;
    const auto a = static_cast<Eigen::Index>(*at), b = static_cast<Eigen::Index>(k);
    for (std::size_t s = 0; s < other.steps.size(); ++s) {
      const auto &x = one.steps[s], &y = other.steps[s];
      traction = std::max(traction, y.traction.col(b).norm());
      d.largest_jump = std::max(d.largest_jump, y.jump.col(b).norm());
      d.traction = std::max(d.traction, (x.traction.col(a) - y.traction.col(b)).norm());
      d.jump = std::max(d.jump, (x.jump.col(a) - y.jump.col(b)).norm());
    }
  }
  d.traction /= traction;
  d.jump /= d.largest_jump;
  return d;
}

template <typename Same>
std::optional<std::size_t> find_node(const Fields& fields, const Same& same) {
  for (std::size_t k = 0; k < fields.geometry.nodes.size(); ++k) {
    if (same(fields.geometry.nodes[k].position)) return k;
  }
  return std::nullopt;
}

TEST(Reductions, HalfDomainKeepsTractionAndSlipOfEveryNode) {
  Settings coarse = kSlipping;
  coarse.emplace_back("/mesh",
                      R"({"strike": "600 m", "dip": "80 m", "normal": "150 m", "growth": 2})");
  const Fields half = run(coarse, {{"/numerics/half_domain", "on"}});
  const Fields full = run(coarse, {{"/numerics/half_domain", "off"}});
  ASSERT_TRUE(half.plan.half_domain && !full.plan.half_domain);
  const Difference d = compare(half, full, [&](const Eigen::Vector3d& x) {
    const Eigen::Vector3d mirrored(x.x(), std::abs(x.y()), x.z());
    return x.y() < -1e-6 ? std::optional<std::size_t>()
                         : find_node(half, [&](const Eigen::Vector3d& y) {
                             return (y - mirrored).norm() < 1e-6;
                           });
  });
  EXPECT_EQ(d.compared, static_cast<int>(half.geometry.nodes.size()));
  EXPECT_GT(d.largest_jump, 0.01);
  EXPECT_LT(d.traction, 1e-8);
  EXPECT_LT(d.jump, 1e-8);
}

/// Blocks and faults as long as the model, between rollers: nothing varies along strike.
TEST(Reductions, PlaneStrainKeepsThoseOfEveryColumn) {
  Settings prism = kSlipping;
  for (const char* length : {"length", "block_length", "fault_length"}) {
    prism.emplace_back(std::string("/geometry/") + length, "2000 m");
  }
  prism.emplace_back("/mesh",
                     R"({"strike": "500 m", "dip": "50 m", "normal": "100 m", "growth": 2})");
  const Fields plane = run(prism, {{"/numerics/plane_strain", "on"}});
  const Fields space = run(prism, {});
  ASSERT_TRUE(plane.plan.plane_strain && !space.plan.plane_strain);
  const Difference d = compare(plane, space, [&](const Eigen::Vector3d& x) {
    return find_node(plane, [&](const Eigen::Vector3d& y) {
      return std::hypot(x.x() - y.x(), x.z() - y.z()) < 1e-6;
    });
  });
  EXPECT_EQ(d.compared, static_cast<int>(space.geometry.nodes.size()));
  EXPECT_GT(d.compared, static_cast<int>(2 * plane.geometry.nodes.size()));
  EXPECT_GT(d.largest_jump, 0.01);
  EXPECT_LT(d.traction, 1e-8);
  EXPECT_LT(d.jump, 1e-8);
}

/// The count behind `plan`'s figures is that of the factor which is built.
TEST(PlannedFactor, IsTheOneBuilt) {
  Settings coarse = kSlipping;
  coarse.emplace_back("/mesh",
                      R"({"strike": "400 m", "dip": "60 m", "normal": "100 m", "growth": 1.8})");
  for (const char* plane : {"on", "off"}) {
    const Fields fields = run(coarse, {{"/numerics/plane_strain", plane}});
    EXPECT_GT(fields.plan.memory_bytes, fields.factor_bytes);
    EXPECT_NEAR(fields.plan.factor_bytes / fields.factor_bytes, 1, 0.1) << plane;
  }
}

}  // namespace
}  // namespace faultsim
