#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/result/result.h"

namespace faultsim::python {

/// A number that many cases are asked for: "chi_bar" of the whole case, "F2.chi_bar" of a fault,
/// "chi_bar in production" of a stage, "F2.chi_bar in production" of both. Names are those by which
/// campaigns rank (`faultsweep rank --list-metrics`), and those of result.json.
class OutputColumn {
 public:
  /// Throws InputError for a name that is none, or that no fault or stage has.
  OutputColumn(const std::string& name, const std::vector<std::string>& stages,
               const std::vector<std::string>& faults);

  /// 0 or 1 for what is true or not; NaN where the case has no value.
  double of(const CaseResult& result) const;

  /// What there is of cases, in the order in which it is listed to users.
  static std::vector<std::string> names_of_case();

 private:
  std::string stage_, fault_, measure_;
};

}  // namespace faultsim::python
