#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What is stored about the nights of `faultsweep nightly`; columns: schemas/store_6.sql.
namespace faultsweep {

struct NightCaseRecord {
  std::string campaign;
  long position = 0;
  std::string identity, label;
  std::string verdict;  ///< to_string(Verdict).
  bool regressed = false;
  double max_ulps = 0;
  std::optional<int> load_step;
  std::string place, quantity, remark;
  std::string digest;  ///< of all numbers of the result; "" = no result.
  std::optional<double> wall_seconds;
  std::string outcome;
  std::optional<double> activated_area, moment, chi_bar;
};

struct NightRecord {
  std::int64_t id = 0;
  double at = 0, wall_seconds = 0;  ///< s since 1970; s.
  std::string suite;
  std::string environment, environment_fields, baseline_environment;
  std::string program_version;
  int numerics_version = 0;
  long n_compared = 0, n_regressed = 0;
  int exit_code = 0;
  std::optional<std::string> blessed;  ///< the reason, where the night became the baseline.
  std::vector<NightCaseRecord> cases;
};

}  // namespace faultsweep
