#pragma once

#include <utility>
#include <vector>

#include "simulator/result_files/field_source.h"
#include "tests/unit/case_figures/small_case.h"

namespace faultsim {

/// Fields of one fault at the load steps of small_result(); what they are, a test says by fields().
struct FieldsOfOneFault : FieldSource {
  explicit FieldsOfOneFault(StoredFault fault) : all_faults{std::move(fault)} {
    for (const StepResult& step : small_result().steps) {
      all_steps.push_back(step.step);
      all_times.push_back(step.time);
    }
  }
  const std::vector<int>& steps() const override { return all_steps; }
  const std::vector<double>& times() const override { return all_times; }
  const std::vector<StoredFault>& faults() const override { return all_faults; }

  std::vector<int> all_steps;
  std::vector<double> all_times;
  std::vector<StoredFault> all_faults;
};

}  // namespace faultsim
