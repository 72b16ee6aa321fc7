#include "simulator/case_figures/stored_line.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsim::case_figures {

std::size_t stored_fault(const Chosen& chosen) {
  const std::vector<StoredFault>& faults = chosen.picture.fields->faults();
  for (std::size_t f = 0; f < faults.size(); ++f) {
    if (faults[f].name == chosen.fault_name()) return f;
  }
  refuse("--fault", "no fields of fault " + chosen.fault_name() + " were kept", "name another");
}

std::size_t stored_entry(Chosen& chosen) {
  const std::vector<int>& steps = chosen.picture.fields->steps();
  if (steps.empty()) refuse("--step", "the fields hold no load step", "run the case again");
  const int wanted = chosen.result().steps[chosen.step].step;
  const auto after = std::ranges::upper_bound(steps, wanted);
  const std::size_t entry =
      after == steps.begin() ? 0 : static_cast<std::size_t>(after - steps.begin()) - 1;
  if (steps[entry] != wanted && chosen.request.step) {
    refuse("--step", concat("the fields of load step ", wanted, " were not kept"),
           "choose one of " + joined(steps, ", "));
  }
  for (std::size_t k = 0; k < chosen.result().steps.size(); ++k) {
    if (chosen.result().steps[k].step == steps[entry]) chosen.step = k;
  }
  return entry;
}

std::vector<std::size_t> column_through(const StoredFault& fault, double y) {
  std::vector<std::size_t> column;
  constexpr double kSameLine = 1e-3;  // m
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] != 0 &&
        std::abs(fault.points(1, static_cast<Eigen::Index>(i)) - y) < kSameLine) {
      column.push_back(i);
    }
  }
  std::ranges::sort(column, [&](std::size_t a, std::size_t b) {
    return fault.points(2, static_cast<Eigen::Index>(a)) >
           fault.points(2, static_cast<Eigen::Index>(b));
  });
  return column;
}

std::size_t most_critical(const StoredFault& fault, const StoredFields& fields) {
  std::size_t most = fault.split.size();
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] == 0) continue;
    if (most == fault.split.size() || fields.critical_index[i] > fields.critical_index[most]) {
      most = i;
    }
  }
  if (most == fault.split.size()) refuse("--fault", "no point of it can move", "name another");
  return most;
}

double shear_at(const StoredFields& fields, Eigen::Index k) {
  return std::hypot(fields.traction(1, k), fields.traction(2, k));
}

}  // namespace faultsim::case_figures
