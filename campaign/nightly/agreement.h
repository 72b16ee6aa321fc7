#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/common/names.h"
#include "simulator/result/result.h"

/// How far two results of one case agree: bit for bit, in the last bits, within tolerances, or not.
namespace faultsweep {

/// What tonight's result of a case is to its baseline, the worse the later.
enum class Verdict {
  unblessed,           ///< no baseline to compare with; neither good nor bad.
  identical,           ///< bit for bit.
  within_tier,         ///< other environment: within the tolerances.
  last_bits,           ///< same environment: within the tolerances, but not identical.
  beyond_tier,         ///< a number (or a text or flag) differs by more than its tolerance.
  ranking_changed,     ///< stands on the other side of another case in the default ranking.
  activation_flipped,  ///< a fault activates, or when or which one, in one of them only.
  outcome_changed,     ///< another outcome, or other load steps, slip events or episodes.
  missing,             ///< the baseline has the case, tonight has no result of it.
};
constexpr auto words(Verdict) {
  return std::array{"unblessed",          "identical",       "within tier",
                    "last bits",          "beyond tier",     "ranking changed",
                    "activation flipped", "outcome changed", "missing"};
}
/// `last_bits` and everything worse.
inline bool is_regression(Verdict verdict) { return verdict >= Verdict::last_bits; }

/// How much numbers may differ between environments, as parts of the largest magnitude that the
/// quantity takes in the case: a ratio would mean nothing where a quantity is nearly 0.
struct Tolerances {
  double all = 1e-6;
  /// By key of schemas/result.schema.json. What a solver leaves over (residuals, penetration) is
  /// noise; nodes at the rim of a slipping area that hardly move count as slipping or not.
  std::map<std::string, double> of_quantity = {{"residual_before", 1},     {"residual_after", 1},
                                               {"max_penetration_m", 1},   {"n_stick", 0.02},
                                               {"n_slip", 0.02},           {"n_open", 0.02},
                                               {"slipping_area_m2", 0.02}, {"open_area_m2", 0.02}};
  double of(const std::string& quantity) const {
    const auto found = of_quantity.find(quantity);
    return found == of_quantity.end() ? all : found->second;
  }
};
/// Keys that Tolerances::of_quantity may have.
std::vector<std::string> quantities();

/// Representable numbers from a to b: 0 = equal (0 = -0), 1 = neighbours.
std::uint64_t ulps_between(double a, double b);

/// One value that differs.
struct Difference {
  std::string place;        ///< "load step 7 (gas_storage), fault 2", "slip event 1", "the case".
  std::optional<int> step;  ///< load step, for differences in one.
  std::string quantity;     ///< key of schemas/result.schema.json: "moment_nm".
  std::string baseline, tonight;  ///< JSON texts.
  std::uint64_t ulps = 0;         ///< between numbers; else 0.
  double deviation = 0;           ///< |difference| / largest magnitude of the quantity in the case;
                                  ///< infinite for what is not two numbers.
  Verdict verdict = Verdict::beyond_tier;  ///< what it makes of the case at least.
};

struct Agreement {
  Verdict verdict = Verdict::unblessed;
  std::uint64_t max_ulps = 0;
  std::optional<Difference> first;  ///< in the first load step that differs (else in what follows
                                    ///< from the steps): the one of most ulps.
  std::optional<Difference> worst;  ///< why the verdict is what it is, where it is not `first`.
};

/// Compares all numbers that the store keeps of a result (as first_difference of
/// store/same_numbers.h does); solver counts, wall times and warnings are not among them.
/// @param same_environment  then nothing less than the same bits will do.
Agreement compare_results(const faultsim::CaseResult& baseline, const faultsim::CaseResult& tonight,
                          bool same_environment, const Tolerances& tolerances);

/// Per case: the index of one whose side it changed in the default ranking (outcome class,
/// activated area, M0, pressure margin, chi_bar), by more than the tolerances; none = its order is
/// the same.
std::vector<std::optional<std::size_t>> changed_order(
    const std::vector<faultsim::CaseResult>& baseline,
    const std::vector<faultsim::CaseResult>& tonight, const Tolerances& tolerances);

}  // namespace faultsweep
