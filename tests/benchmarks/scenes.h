#pragma once

#include <string>
#include <vector>

#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"

namespace faultsim::benchmarks {

/// Even cells, so that records stay comparable when a tier changes.
inline constexpr const char* kEven10 = R"({"dip": "10 m", "normal": "10 m"})";
inline constexpr const char* kEven20 = R"({"strike": "100 m", "dip": "20 m", "normal": "20 m"})";

struct PlannedScene {
  Scene scene;
  Plan plan;
};

/// An example scene with changes ("/pointer", value), planned.
inline PlannedScene planned(const std::string& file,
                            const std::vector<std::pair<std::string, std::string>>& changes) {
  JsonDocument document =
      read_json_file(std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/scenes/" + file);
  for (const auto& [pointer, value] : changes) set_value(document, pointer, value);
  PlannedScene result{read_scene(document), {}};
  std::vector<Problem> problems;
  result.plan = make_plan(result.scene, problems);
  if (!problems.empty()) throw InputError(file, problems);
  return result;
}

}  // namespace faultsim::benchmarks
