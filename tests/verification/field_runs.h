#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result_files/field_writer.h"

/// The reference scene in other ways, node by node.
namespace faultsim {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct Fields {
  Plan plan;
  double factor_bytes = 0;
  FaultGeometry geometry;
  std::vector<FaultFields> steps;
};

inline Fields run(Settings settings, const Settings& more) {
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
  const CaseResult end = run_case(scene, prepared, monitor, {{keep}});
  EXPECT_EQ(end.outcome, Outcome::converged) << end.reason;
  return fields;
}

/// Displaced compartments and weak faults, so that all three slip; contact solved to rounding.
inline const Settings kSlipping = {{"/tier", "custom"},
                                   {"/geometry/blocks/1/offset", "100 m"},
                                   {"/friction/friction_angle", "20 deg"},
                                   {"/output/observation_points", "[]"},
                                   {"/numerics/traction_tolerance", "1e-12"}};

struct Difference {
  double traction = 0, jump = 0;  ///< largest, over the largest of the whole case.
  double largest_jump = 0;
  int compared = 0;
};

/// @param place   where a node of `other` lies in `one`; none = it has no counterpart.
/// @param strike  −1: `other` is seen in a mirror along strike, and what points along it is turned.
template <typename Place>
Difference compare(const Fields& one, const Fields& other, const Place& place, double strike = 1) {
  Difference d;
  const Eigen::DiagonalMatrix<double, 3> seen(1, strike, 1);
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
      d.traction = std::max(d.traction, (x.traction.col(a) - seen * y.traction.col(b)).norm());
      d.jump = std::max(d.jump, (x.jump.col(a) - seen * y.jump.col(b)).norm());
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

}  // namespace faultsim
