// The family reductions leave every node as it is: the same scenes with and without them. Areas, M0
// and observation points are in tests/unit/loading/field_case_test.cc, creep in creep_off_test.cc.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "tests/unit/cache/example_operator.h"
#include "tests/unit/result_files/h5_file.h"
#include "tests/verification/field_runs.h"

namespace faultsim {
namespace {

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

struct FieldFile {
  explicit FieldFile(const Fields& fields) {
    FieldWriter writer(folder.path(), fields.geometry);
    for (const FaultFields& step : fields.steps) writer.add_step(StepResult(), step);
    writer.finish();
  }
  /// All components of a dataset, over all steps, of the points in the order of their y, x, z.
  std::vector<double> sorted(const std::string& fault, const std::string& dataset) const {
    const H5File file(folder.path() / "faults.h5");
    const Dataset points = file.read("/faults/" + fault + "/geometry/points");
    const std::size_t n = points.shape[0];
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto place = [&](std::size_t k) {
      const double* p = &points.values[3 * k];
      return std::tuple(std::lround(1e3 * p[1]), std::lround(1e3 * p[0]), std::lround(1e3 * p[2]));
    };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
    const std::vector<double> all = file.read("/faults/" + fault + "/" + dataset).values;
    const bool in_time = dataset.rfind("steps/", 0) == 0;
    const std::size_t n_steps = in_time ? file.read("/time").shape[0] : 1;
    const std::size_t n_components = all.size() / n / n_steps;
    std::vector<double> values;
    for (std::size_t s = 0; s < n_steps; ++s) {
      for (const std::size_t k : order) {
        const double* from = &all[(s * n + k) * n_components];
        values.insert(values.end(), from, from + n_components);
      }
    }
    return values;
  }
  ScratchFolder folder;
};

/// faults.h5 holds whole faults, whichever half was modelled.
TEST(Reductions, HalfDomainWritesTheFieldsOfTheWhole) {
  Settings coarse = kSlipping;
  coarse.emplace_back("/mesh",
                      R"({"strike": "600 m", "dip": "80 m", "normal": "150 m", "growth": 2})");
  const FieldFile half(run(coarse, {{"/numerics/half_domain", "on"}}));
  const FieldFile whole(run(coarse, {{"/numerics/half_domain", "off"}}));
  for (const char* fault : {"F1", "F2", "F3"}) {
    for (const char* dataset :
         {"geometry/points", "geometry/area", "geometry/split", "geometry/normal",
          "geometry/strike", "geometry/dip", "steps/traction_fault", "steps/traction_global",
          "steps/slip_fault", "steps/slip_global", "steps/critical_index", "steps/state",
          "steps/static_critical_index", "steps/fault_pressure_change"}) {
      const std::vector<double> a = half.sorted(fault, dataset), b = whole.sorted(fault, dataset);
      ASSERT_EQ(a.size(), b.size()) << fault << " " << dataset;
      double size = 1e-12, difference = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        size = std::max(size, std::abs(b[i]));
        difference = std::max(difference, std::abs(a[i] - b[i]));
      }
      EXPECT_LT(difference, 1e-8 * size) << fault << " " << dataset;
    }
  }
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
