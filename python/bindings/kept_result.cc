#include "python/bindings/kept_result.h"

#include <limits>

#include "python/bindings/case_drawing.h"
#include "simulator/common/near_miss.h"
#include "simulator/result/result_fields.h"

namespace faultsim::python {

std::string KeptResult::drawn(const std::string& chart, const std::string& fault,
                              std::optional<int> step, const std::string& show) const {
  FAULTSIM_DEMAND(scene != nullptr, "a stored result is drawn by its campaign");
  std::optional<FieldRecorder> kept;
  if (fields) kept.emplace(fields->recorder(*geometry));
  return drawn_case({.result = result, .scene = *scene, .fields = kept ? &*kept : nullptr}, chart,
                    fault, step, show);
}

Eigen::MatrixXd KeptResult::history(const std::string& key) const {
  const std::size_t n_faults = result.fault_names.size();
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(result.steps.size()),
                                                     static_cast<Eigen::Index>(n_faults),
                                                     std::numeric_limits<double>::quiet_NaN());
  std::vector<std::string> names;
  bool is_there = false;
  const FaultMetrics none;
  for_each_field(none, [&](const Field& field, const auto&) {
    names.emplace_back(field.key);
    is_there = is_there || field.key == key;
  });
  if (!is_there)
    throw InputError("history", concat("there is no \"", key, "\" of faults and load steps"),
                     suggest(key, names));
  for (std::size_t s = 0; s < result.steps.size(); ++s) {
    for (std::size_t f = 0; f < result.steps[s].faults.size(); ++f) {
      for_each_field(result.steps[s].faults[f], [&](const Field& field, const auto& value) {
        if (field.key == key)
          values(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(f)) =
              static_cast<double>(value);
      });
    }
  }
  return values;
}

}  // namespace faultsim::python
