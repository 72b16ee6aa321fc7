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
  long double total = kind == "groups" ? 0 : 1;
  if (kind == "groups") {
    for (std::size_t i = 0; i < at(design + "/groups").size(); ++i) {
      total += count_cases(design + "/groups/" + std::to_string(i) + "/design");
    }
    return total;
  }
  for (const std::string& name : keys(design + "/parameters")) {
    const long double count = count_values(at(design + "/parameters/" + escape_token(name)));
    if (kind == "zip") return count;
    total = kind == "grid" ? total * count : total + count;
  }
  return total;
}

/// "100 (offset) x 25 (friction_angle)", "12 + 1000000 in 2 groups".
std::string SpecReader::describe_count(const std::string& design) {
  const auto kind = at(design + "/kind").get<std::string>();
  if (kind == "list") return "as listed";
  std::string text;
  if (kind == "groups") {
    const std::size_t n = at(design + "/groups").size();
    for (std::size_t i = 0; i < n; ++i) {
      text += (i == 0 ? "" : " + ") +
              digits(count_cases(design + "/groups/" + std::to_string(i) + "/design"));
    }
    return text + " in " + std::to_string(n) + " groups";
  }
  for (const std::string& name : keys(design + "/parameters")) {
    const long double count = count_values(at(design + "/parameters/" + escape_token(name)));
    if (!text.empty()) text += kind == "grid" ? " x " : kind == "zip" ? ", " : " + ";
    text += digits(count) + " (" + name + ")";
  }
  return text;
}

bool SpecReader::check_count() {
  const long double count = count_cases("/design");
  if (count <= static_cast<long double>(kMaximumCases)) return true;
  problem("/design", digits(count) + " cases (" + describe_count("/design") + ")",
          "a campaign has at most " + std::to_string(kMaximumCases) +
              " cases; use fewer values or split it");
  return false;
}

}  // namespace faultsweep
