#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"

namespace faultsweep {
namespace {

std::string digits(long double count) {
  return count < 1e18L ? std::to_string(static_cast<long long>(count)) : "more than 10^18";
}

}  // namespace

long double SpecReader::count_values(const std::string& pointer) const {
  const json& parameter = at(pointer);
  if (parameter.is_array()) return static_cast<long double>(parameter.size());
  for (const char* list : {"values", "factors", "variants"}) {
    if (parameter.contains(list)) return static_cast<long double>(parameter[list].size());
  }
  return parameter.contains("count") ? parameter["count"].get<long double>() : 1;
}

/// In words: "100 (offset) x 25 (friction_angle)", "12 + 1000000 in 2 groups", "4096 x 8 rows".
SpecReader::CaseCount SpecReader::count_cases(const std::string& design) {
  const auto kind = at(design + "/kind").get<std::string>();
  if (kind == "list") return {static_cast<long double>(at(design + "/cases").size()), "as listed"};
  if (kind == "samples" || kind == "places") {
    return {static_cast<long double>(sample_file(design).n_rows),
            "lines of " + at(design + "/file").get<std::string>()};
  }
  if (const auto samples = count_samples(design)) {
    return {samples->first * samples->second,
            concat(digits(samples->first), kind == "morris" ? " trajectories" : " samples", " x ",
                   digits(samples->second), samples->second == 1 ? " row" : " rows")};
  }
  const bool multiplies = kind == "nested" || kind == "grid";
  CaseCount all{kind == "groups" ? 0.0L : 1.0L, ""};
  const auto add = [&](long double n, const std::string& name) {
    if (kind == "zip") {
      if (all.words.empty()) all.n = n;
    } else {
      all.n = multiplies ? all.n * n : all.n + n;
    }
    const char* between = multiplies ? " x " : kind == "zip" ? ", " : " + ";
    all.words += concat(all.words.empty() ? "" : between, digits(n), name);
  };
  if (kind == "groups" || kind == "nested") {
    const std::vector<std::string> parts = parts_of(design);
    for (const std::string& part : parts) add(count_cases(part).n, "");
    if (kind == "groups") all.words += concat(" in ", parts.size(), " groups");
    return all;
  }
  for (const auto& [name, place] : members(design + "/parameters"))
    add(count_values(place), concat(" (", name, ")"));
  return all;
}

/// Pointers of the designs in groups or a nested design.
std::vector<std::string> SpecReader::parts_of(const std::string& design) const {
  const bool nested = at(design + "/kind") == "nested";
  const std::string list = design + (nested ? "/designs" : "/groups");
  std::vector<std::string> parts;
  for (const Member& one : members(list)) parts.push_back(one.pointer + (nested ? "" : "/design"));
  return parts;
}

/// Samples (or trajectories) of a sampled design and the rows that each has; nothing for others.
std::optional<std::pair<long double, long double>> SpecReader::count_samples(
    const std::string& design) const {
  const auto kind = at(design + "/kind").get<std::string>();
  const auto number = [&](const char* key) { return at(design + key).get<long double>(); };
  const auto n_parameters = [&] {
    return static_cast<long double>(members(design + "/parameters").size());
  };
  if (kind == "latin-hypercube" || kind == "monte-carlo") {
    return std::pair(number("/samples"), 1.0L);
  }
  if (kind == "morris") return std::pair(number("/trajectories"), n_parameters() + 1);
  if (kind != "sobol") return std::nullopt;
  const bool second_order = has(design + "/second_order") && at(design + "/second_order");
  return std::pair(number("/samples"), (second_order ? 2 : 1) * n_parameters() + 2);
}

/// Designs that have a scene of their own.
std::size_t SpecReader::count_groups(const std::string& design) const {
  if (at(design + "/kind") != "groups") return 1;
  std::size_t count = 0;
  for (const std::string& part : parts_of(design)) count += count_groups(part);
  return count;
}

/// The scene of each group is read and planned by itself, which takes milliseconds.
bool SpecReader::check_group_count() {
  constexpr std::size_t kMost = 250;
  const std::size_t count = count_groups("/design");
  if (count <= kMost) return true;
  problem("/design", concat(count, " groups"),
          concat("a campaign has at most ", kMost,
                 " groups; use a parameter with variants for what they set"));
  return false;
}

bool SpecReader::check_count() {
  const CaseCount all = count_cases("/design");
  n_cases_ = all.n * count_scan();
  if (n_cases_ <= static_cast<long double>(kMaximumCases)) return true;
  problem("/design", concat(digits(n_cases_), " cases (", all.words, ")"),
          concat("a campaign has at most ", kMaximumCases,
                 " cases; use fewer values or split the campaign"));
  return false;
}

}  // namespace faultsweep
