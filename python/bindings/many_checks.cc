#include "python/bindings/many_checks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "simulator/common/errors.h"
#include "simulator/common/near_miss.h"
#include "simulator/common/ranges.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_fields.h"

namespace faultsim::python {
namespace {

/// Problems of a request, one thing after the other.
class Problems {
 public:
  template <typename Check>
  void gather(const Check& check) {
    try {
      check();
    } catch (const InputError& error) {
      found_.insert(found_.end(), error.problems().begin(), error.problems().end());
    }
  }
  void throw_if_any() {
    if (!found_.empty()) throw InputError("run_many", std::move(found_));
  }

 private:
  std::vector<Problem> found_;
};

void refuse(std::string what, std::string cure) {
  throw InputError("run_many", std::move(what), std::move(cure));
}

void require_history(const std::string& key) {
  const FaultMetrics none;
  std::vector<std::string> names;
  for_each_field(none, [&](const Field& field, const auto&) { names.emplace_back(field.key); });
  if (!contains(names, key))
    refuse(concat("there is no \"", key, "\" of faults and load steps"), suggest(key, names));
}

void require_finite(const VariedParameter& one, Eigen::Index n_cases) {
  if (one.values == nullptr) return;
  const auto is_wrong = [](double value) { return !std::isfinite(value); };
  const double* end = one.values + n_cases;
  const double* first = std::find_if(one.values, end, is_wrong);
  if (first == end) return;
  refuse(concat("\"", one.name, "\" is no finite number in ", std::count_if(first, end, is_wrong),
                " of ", n_cases, " cases, first in case ", first - one.values, ", counted from 0"),
         "leave these cases out, or run with on_error=\"keep\"");
}

}  // namespace

std::vector<OutputColumn> checked_columns(const LoadedScene& loaded, const ManyRequest& request) {
  std::vector<std::string> stages, faults;
  for (const auto& stage : loaded.scene.stages) stages.push_back(stage.name);
  for (const auto& fault : loaded.scene.faults) faults.push_back(fault.name);
  Problems problems;
  std::set<std::string> pointers;
  for (const VariedParameter& one : request.parameters) {
    problems.gather([&] {
      if (!pointers.insert(resolve_parameter(loaded.document, one.name)).second)
        refuse(concat("\"", one.name, "\" is given twice"), "leave one of its columns out");
    });
    if (!request.keeps_going) problems.gather([&] { require_finite(one, request.n_cases); });
  }
  std::vector<OutputColumn> columns;
  for (const std::string& name : request.outputs)
    problems.gather([&] { columns.emplace_back(name, stages, faults); });
  for (const std::string& key : request.histories) problems.gather([&] { require_history(key); });
  problems.throw_if_any();
  return columns;
}

}  // namespace faultsim::python
