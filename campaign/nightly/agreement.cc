#include "campaign/nightly/agreement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include "campaign/common/json.h"
#include "campaign/store/records.h"
#include "campaign/store/same_numbers.h"
#include "simulator/common/errors.h"
#include "simulator/result/result_json.h"

namespace faultsweep {

namespace {

/// A mere function of a moment, which is compared: another libm changes it where moments agree.
bool is_magnitude(const std::string& key) {
  static const std::set<std::string> magnitudes = {
      "magnitude_mw", "magnitude_if_released_at_once_mw", "event_magnitude_mw"};
  return magnitudes.contains(key);
}

/// A number of the store that is not a magnitude.
bool is_compared(const std::string& key) {
  static const std::set<std::string> of_the_run = {
      "format",           "title",  "identity", "warnings",  "operator_fingerprint",
      "numerics_version", "counts", "wall_s",   "observed_m"};
  static const std::set<std::string> names = {"regions", "faults", "observations"};
  static const std::set<std::string> walked_apart = {"steps",  "events", "episodes",
                                                     "stages", "whole",  "creep"};
  return !of_the_run.contains(key) && !names.contains(key) && !walked_apart.contains(key) &&
         !is_magnitude(key);
}

/// The largest magnitude that each quantity takes in a document.
void find_scales(const json& value, const std::string& key, std::map<std::string, double>& scales) {
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) find_scales(member, name, scales);
  } else if (value.is_array()) {
    for (const json& element : value) find_scales(element, key, scales);
  } else if (value.is_number()) {
    double& scale = scales[key];
    scale = std::max(scale, std::abs(value.get<double>()));
  }
}

Verdict verdict_on(const std::string& quantity) {
  static const std::set<std::string> activation = {"activated", "activation_step",
                                                   "activated_fault", "activation"};
  static const std::set<std::string> course = {"outcome", "failed_step", "number"};
  if (activation.count(quantity) > 0) return Verdict::activation_flipped;
  return course.count(quantity) > 0 ? Verdict::outcome_changed : Verdict::beyond_tier;
}

/// Walks two documents of the same shape and notes every value that differs, load steps first.
class Walk {
 public:
  Walk(const json& baseline, const json& tonight, bool with_magnitudes)
      : with_magnitudes_(with_magnitudes) {
    find_scales(baseline, "", scales_);
    find_scales(tonight, "", scales_);
    steps(baseline.at("steps"), tonight.at("steps"));
    list("slip event", baseline.at("events"), tonight.at("events"));
    list("episode", baseline.at("episodes"), tonight.at("episodes"));
    const json &before = baseline.at("stages"), &now = tonight.at("stages");
    for (std::size_t k = 0; k < std::min(before.size(), now.size()); ++k) {
      stage(concat("stage ", k + 1), before[k], now[k]);
    }
    count("stage", before, now);
    stage("the whole history", baseline.at("whole"), tonight.at("whole"));
    object("the case", baseline, tonight);
  }
  std::vector<Difference> differences;

 private:
  void steps(const json& baseline, const json& tonight) {
    const std::size_t n = std::min(baseline.size(), tonight.size());
    for (std::size_t k = 0; k < n; ++k) {
      step_ = baseline[k].at("step").get<int>();
      const std::string place =
          concat("load step ", *step_, " (", baseline[k].at("stage").get<std::string>(), ")");
      // Without equilibrium a step has no metrics in the store.
      const auto outcome =
          stored_word<faultsim::Outcome>(baseline[k].at("outcome").get<std::string>(), "outcome");
      object(place, baseline[k], tonight[k]);
      if (!faultsim::in_equilibrium(outcome)) continue;
      list(place + ", fault", baseline[k].at("faults"), tonight[k].at("faults"));
      const json &before = baseline[k].at("creep"), &now = tonight[k].at("creep");
      if (before.is_null() || now.is_null()) {
        leaf(place, "time_steps", before.is_null() ? before : before.at("time_steps"),
             now.is_null() ? now : now.at("time_steps"));
        continue;
      }
      object(place, before, now);
      list(place + ", creep at fault", before.at("faults"), now.at("faults"));
    }
    step_.reset();
    count("load steps", baseline, tonight);
  }
  void list(const std::string& name, const json& baseline, const json& tonight) {
    for (std::size_t k = 0; k < std::min(baseline.size(), tonight.size()); ++k) {
      object(concat(name, " ", k + 1), baseline[k], tonight[k]);
    }
    count(name, baseline, tonight);
  }
  void stage(const std::string& place, const json& baseline, const json& tonight) {
    object(place, baseline, tonight);
    list(place + ", fault", baseline.at("faults"), tonight.at("faults"));
  }
  void count(const std::string& of, const json& baseline, const json& tonight) {
    if (baseline.size() == tonight.size()) return;
    note("number of " + of, "number", baseline.size(), tonight.size(), 0,
         std::numeric_limits<double>::infinity());
  }
  void object(const std::string& place, const json& baseline, const json& tonight) {
    for (const auto& [key, value] : baseline.items()) {
      const bool was_kept = !later_fields().contains(key) || !(value.is_null() || value.empty());
      const bool is_taken = is_compared(key) || (with_magnitudes_ && is_magnitude(key));
      if (!is_taken || !was_kept) continue;
      const json& other = tonight.at(key);
      if (value.is_object() && other.is_object()) {
        object(concat(place, ", ", key), value, other);
      } else {
        leaf(place, key, value, other);
      }
    }
  }
  void leaf(const std::string& place, const std::string& key, const json& baseline,
            const json& tonight) {
    if (baseline == tonight) return;
    if (baseline.is_array() && tonight.is_array()) {
      for (std::size_t k = 0; k < std::min(baseline.size(), tonight.size()); ++k) {
        leaf(place, key, baseline[k], tonight[k]);
      }
      return count(key, baseline, tonight);
    }
    if (baseline.is_number() && tonight.is_number()) {
      const double a = baseline.get<double>(), b = tonight.get<double>();
      // scale > 0: two numbers that differ are not both 0.
      return note(place, key, baseline, tonight, ulps_between(a, b),
                  std::abs(a - b) / scales_.at(key));
    }
    // Reasons quote residuals: their wording decides nothing, their outcome does.
    note(place, key, baseline, tonight, 0,
         key == "reason" ? 0 : std::numeric_limits<double>::infinity());
  }
  void note(const std::string& place, const std::string& quantity, const json& baseline,
            const json& tonight, std::uint64_t ulps, double deviation) {
    differences.push_back({place, step_, quantity, baseline.dump(), tonight.dump(), ulps, deviation,
                           verdict_on(quantity)});
  }

  bool with_magnitudes_;
  std::map<std::string, double> scales_;
  std::optional<int> step_;
};

/// Magnitudes count where they are all that differs.
std::vector<Difference> differences(const json& baseline, const json& tonight) {
  std::vector<Difference> found = Walk(baseline, tonight, false).differences;
  return found.empty() ? Walk(baseline, tonight, true).differences : found;
}

/// Of the first load step that differs, else of all: the difference of most ulps.
const Difference& first_of(const std::vector<Difference>& all) {
  auto end = std::ranges::find_if(
      all, [&](const Difference& one) { return one.step != all.front().step; });
  return *std::max_element(
      all.begin(), end, [](const Difference& a, const Difference& b) { return a.ulps < b.ulps; });
}

/// What the default order compares, each the larger the earlier; see store/ranking.cc.
std::array<double, 6> sort_key(const CaseResult& r) {
  const double outcome_class = rank_class(r.outcome, true);
  constexpr double kNoMargin = 9e99;  // as in the store: after those that have one
  const double margin = std::isnan(r.pressure_margin) ? kNoMargin : r.pressure_margin;
  return {-outcome_class, r.whole.activated_area, r.whole.open_area, r.whole.moment,
          -margin,        r.whole.chi_bar};
}

/// 1: a is before b, -1: behind, 0: alike within the tolerances.
int order(const CaseResult& a, const CaseResult& b, const Tolerances& tolerances) {
  static constexpr std::array<const char*, 6> kQuantities = {
      "outcome", "activated_area_m2", "open_area_m2", "moment_nm", "pressure_margin_pa", "chi_bar"};
  const auto x = sort_key(a), y = sort_key(b);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double scale = std::max(std::abs(x[k]), std::abs(y[k]));
    if (std::abs(x[k] - y[k]) > tolerances.of(kQuantities[k]) * scale) return x[k] > y[k] ? 1 : -1;
  }
  return 0;
}

}  // namespace

std::vector<std::string> quantities() {
  CaseResult full;
  full.steps.emplace_back();
  full.steps[0].pressure_change = full.steps[0].temperature_change = {0};
  full.steps[0].faults.emplace_back();
  full.steps[0].creep = faultsim::StepCreep{0, 0, true, {{}}};
  full.events.emplace_back();
  full.episodes.emplace_back();
  full.surface.emplace().stability = 0;
  full.field_coverage = full.field_assumed = 0;
  faultsim::FaultOnset& onset = full.whole.faults.emplace_back().activation.emplace();
  onset.load_before = onset.load_after = onset.change_before = 0;
  std::map<std::string, double> scales;
  json document = faultsim::result_to_json(full);
  document["pressure_margin_pa"] = 0;
  for (const char* key :
       {"change_minus_pa", "change_plus_pa", "absolute_minus_pa", "absolute_plus_pa"}) {
    document["episodes"][0]["pressures"][key] = 0;
  }
  find_scales(document, "", scales);
  std::vector<std::string> names;
  for (const auto& [name, scale] : scales) {
    if (is_compared(name)) names.push_back(name);
  }
  return names;
}

std::uint64_t ulps_between(double a, double b) {
  const auto ordered = [](double x) {  // monotonic in x, 0 and -0 alike
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
  };
  const std::int64_t x = ordered(a), y = ordered(b);
  return x > y ? static_cast<std::uint64_t>(x) - static_cast<std::uint64_t>(y)
               : static_cast<std::uint64_t>(y) - static_cast<std::uint64_t>(x);
}

Agreement compare_results(const CaseResult& baseline, const CaseResult& tonight,
                          bool same_environment, const Tolerances& tolerances) {
  const std::string somewhere = first_difference(baseline, tonight);
  if (somewhere.empty()) return {Verdict::identical, 0, {}, {}};
  Agreement agreement;
  std::vector<Difference> all =
      differences(faultsim::result_to_json(baseline), faultsim::result_to_json(tonight));
  FAULTSIM_DEMAND(!all.empty(), somewhere);
  const Verdict least = same_environment ? Verdict::last_bits : Verdict::within_tier;
  for (Difference& one : all) {
    const bool is_small =
        one.verdict == Verdict::beyond_tier && one.deviation <= tolerances.of(one.quantity);
    if (is_small) one.verdict = least;
    agreement.max_ulps = std::max(agreement.max_ulps, one.ulps);
  }
  agreement.first = first_of(all);
  agreement.worst = *std::ranges::max_element(all, [&](const Difference& a, const Difference& b) {
    if (a.verdict != b.verdict) return a.verdict < b.verdict;
    return a.deviation / tolerances.of(a.quantity) < b.deviation / tolerances.of(b.quantity);
  });
  agreement.verdict = agreement.worst->verdict;
  return agreement;
}

std::vector<std::optional<std::size_t>> changed_order(const std::vector<CaseResult>& baseline,
                                                      const std::vector<CaseResult>& tonight,
                                                      const Tolerances& tolerances) {
  FAULTSIM_DEMAND(baseline.size() == tonight.size(), baseline.size(), " and ", tonight.size());
  std::vector<std::optional<std::size_t>> changed(baseline.size());
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    for (std::size_t j = i + 1; j < baseline.size(); ++j) {
      const int before = order(baseline[i], baseline[j], tolerances);
      if (before * order(tonight[i], tonight[j], tolerances) >= 0) continue;
      changed[i] = j;
      changed[j] = i;
    }
  }
  return changed;
}

}  // namespace faultsweep
