#include "campaign/spec/spec_reader.h"

namespace faultsweep {
namespace {

using nlohmann::json;

/// How many values a parameter of a grid has; 1 where it is incomplete, which is said elsewhere.
long double count_values(const json& parameter) {
  if (parameter.is_array()) return static_cast<long double>(parameter.size());
  for (const char* list : {"values", "factors", "variants"}) {
    if (parameter.contains(list)) return static_cast<long double>(parameter[list].size());
  }
  return parameter.contains("count") ? parameter["count"].get<long double>() : 1;
}

std::string digits(long double count) {
  return count < 1e18L ? std::to_string(static_cast<long long>(count)) : "more than 10^18";
}

}  // namespace

long double SpecReader::count_cases(const std::string& design) {
  const auto kind = at(design + "/kind").get<std::string>();
  if (kind == "list") return static_cast<long double>(at(design + "/cases").size());
  if (kind == "samples") return static_cast<long double>(sample_file(design).n_rows);
  if (kind == "groups" || kind == "nested") {
    const bool nested = kind == "nested";
    long double total = nested ? 1 : 0;
    for (const std::string& part : parts_of(design)) {
      total = nested ? total * count_cases(part) : total + count_cases(part);
    }
    return total;
  }
  if (const auto samples = count_samples(design)) return samples->first * samples->second;
  long double total = 1;
  for (const std::string& name : keys(design + "/parameters")) {
    const long double count =
        count_values(at(design + "/parameters/" + faultsim::pointer_token(name)));
    if (kind == "zip") return count;
    total = kind == "grid" ? total * count : total + count;
  }
  return total;
}

/// Pointers of the designs in groups or a nested design.
std::vector<std::string> SpecReader::parts_of(const std::string& design) const {
  const bool nested = at(design + "/kind") == "nested";
  const std::string list = design + (nested ? "/designs" : "/groups");
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < at(list).size(); ++i) {
    parts.push_back(list + "/" + std::to_string(i) + (nested ? "" : "/design"));
  }
  return parts;
}

/// Samples (or trajectories) of a sampled design and the rows that each has; nothing for others.
std::optional<std::pair<long double, long double>> SpecReader::count_samples(
    const std::string& design) const {
  const auto kind = at(design + "/kind").get<std::string>();
  const auto number = [&](const char* key) { return at(design + key).get<long double>(); };
  const auto n_parameters = [&] {
    return static_cast<long double>(keys(design + "/parameters").size());
  };
  if (kind == "latin-hypercube" || kind == "monte-carlo") {
    return std::pair(number("/samples"), 1.0L);
  }
  if (kind == "morris") return std::pair(number("/trajectories"), n_parameters() + 1);
  if (kind != "sobol") return std::nullopt;
  const bool second_order = has(design + "/second_order") && at(design + "/second_order");
  return std::pair(number("/samples"), (second_order ? 2 : 1) * n_parameters() + 2);
}

/// "100 (offset) x 25 (friction_angle)", "12 + 1000000 in 2 groups", "4096 x 8 rows".
std::string SpecReader::describe_count(const std::string& design) {
  const auto kind = at(design + "/kind").get<std::string>();
  if (kind == "list") return "as listed";
  if (kind == "samples") return "lines of " + at(design + "/file").get<std::string>();
  std::string text;
  if (kind == "groups" || kind == "nested") {
    const auto parts = parts_of(design);
    for (const std::string& part : parts) {
      text += (text.empty() ? "" : kind == "nested" ? " x " : " + ") + digits(count_cases(part));
    }
    return kind == "nested" ? text : text + " in " + std::to_string(parts.size()) + " groups";
  }
  if (const auto samples = count_samples(design)) {
    return digits(samples->first) + (kind == "morris" ? " trajectories" : " samples") + " x " +
           digits(samples->second) + (samples->second == 1 ? " row" : " rows");
  }
  for (const std::string& name : keys(design + "/parameters")) {
    const long double count =
        count_values(at(design + "/parameters/" + faultsim::pointer_token(name)));
    if (!text.empty()) text += kind == "grid" ? " x " : kind == "zip" ? ", " : " + ";
    text += digits(count) + " (" + name + ")";
  }
  return text;
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
  problem("/design", std::to_string(count) + " groups",
          "a campaign has at most " + std::to_string(kMost) +
              " groups; make a parameter with variants of what they set");
  return false;
}

bool SpecReader::check_count() {
  const long double count = count_cases("/design") * count_scan();
  n_cases_ = count;
  if (count <= static_cast<long double>(kMaximumCases)) return true;
  problem("/design", digits(count) + " cases (" + describe_count("/design") + ")",
          "a campaign has at most " + std::to_string(kMaximumCases) +
              " cases; use fewer values or split it");
  return false;
}

}  // namespace faultsweep
