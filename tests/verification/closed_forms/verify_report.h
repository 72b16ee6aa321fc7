#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace faultsim {

/// One comparison of a verification case.
struct VerifyRow {
  std::string quantity;  ///< "t_N at dip 65°".
  double expected;       ///< in `unit`.
  double computed;       ///< in `unit`.
  double error;  ///< |computed − expected| / scale; the scale is |expected| unless the text says.
  double tolerance;  ///< the largest error that passes.
  std::string unit;
  bool pass;
};

/// What a verification case found.
struct VerifyReport {
  std::string name;  ///< "V1-dip65".
  std::string title;
  std::vector<std::string> scenes;  ///< files of docs/examples/verification.
  std::vector<VerifyRow> rows;
  std::vector<std::string> remarks;  ///< sizes, times are not among them: the text is reproducible.
  std::string failure;               ///< why the case could not be evaluated; empty if it was.

  /// |computed − expected| ≤ tolerance · scale; a NaN never passes.
  void compare(const std::string& quantity, const std::string& unit, double expected,
               double computed, double tolerance, double scale);
  /// The same with scale = |expected| (1 where expected = 0).
  void compare(const std::string& quantity, const std::string& unit, double expected,
               double computed, double tolerance);
  /// An error already measured: expected 0, the error must be ≤ tolerance.
  void bound(const std::string& quantity, const std::string& unit, double error, double tolerance);
  /// computed ≥ least, as for orders of convergence; the error is the shortfall.
  void at_least(const std::string& quantity, double least, double computed);
  /// A statement that holds or does not: expected 1.
  void holds(const std::string& statement, bool is_true);

  /// Evaluated, with at least one row and none missed.
  bool passed() const;
};

/// A number for a label: shortest of six digits ("1.4", "18000").
std::string short_number(double value);

/// Order of convergence from errors at cell sizes h and h/2: log2(coarse / fine).
double observed_order(double coarse_error, double fine_error);

/// A table for the screen.
std::string report_to_text(const VerifyReport& report);
/// The same for results/verification/figures.md.
std::string report_to_markdown(const VerifyReport& report);
nlohmann::json report_to_json(const VerifyReport& report);

}  // namespace faultsim
