#include "simulator/result/approximation.h"

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr double kRounding = 1e-9;  // what rounding up or down takes for the number itself

/// "1.2e-4": two digits that are no less than the error.
std::string at_most(double error) {
  if (error == 0) return "0";
  int exponent = static_cast<int>(std::floor(std::log10(error)));
  long digits = std::lround(std::ceil(error * std::pow(10, 1 - exponent) * (1 - kRounding)));
  if (digits == 100) {
    digits = 10;
    ++exponent;
  }
  const std::string tenths = digits % 10 == 0 ? "" : concat(".", digits % 10);
  return concat(digits / 10, tenths, "e", exponent);
}

std::string surface_sentence(const CaseSurface& surface) {
  std::string errors = concat(at_most(surface.stiffness), " in H, ", at_most(surface.traction),
                              " in the locked traction");
  if (surface.observation > 0)
    errors += concat(", ", at_most(surface.observation), " in what is observed");
  const std::string stability = surface.stability ? " and " + at_most(*surface.stability) +
                                                        " in the weakening at which faults jump"
                                                  : std::string();
  const std::string cases = surface.chi_bar
                                ? concat("; there χ̄ of ", surface.n_cases,
                                         " cases is off by at most ", at_most(*surface.chi_bar))
                                : std::string();
  return concat("Its operator is interpolated between ", surface.n_operators,
                " exact ones, off by at most ", errors, surface.stability ? ", " : " and ",
                at_most(surface.slip), " in slip without friction", stability, " at ",
                surface.n_checks, " check points", cases, ".");
}

/// "26 %", "99.9 %": no more than the share.
std::string percent(double share) {
  const long tenths = std::lround(std::floor(1000 * share + kRounding));
  if (tenths == 0) return "less than 0.1 %";
  return concat(tenths / 10, tenths % 10 == 0 ? "" : concat(".", tenths % 10), " %");
}

}  // namespace

std::string approximation_sentence(const CaseResult& result) {
  constexpr double kWhole = 1 - 1e-6;
  std::string text;
  if (result.surface) text = surface_sentence(*result.surface);
  if (result.field_coverage && *result.field_coverage < kWhole) {
    text += concat(text.empty() ? "" : " ", "Its flow result covers ",
                   percent(*result.field_coverage), " of the compartments");
    if (result.field_assumed)
      text += concat(", and ", percent(1 - *result.field_assumed),
                     " of the integral of its change there");
    text += ".";
  }
  return text;
}

}  // namespace faultsim
