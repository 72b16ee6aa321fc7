#include "campaign/nightly/nightly_suite.h"

#include <algorithm>
#include <filesystem>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/spec.h"
#include "nightly_schema.h"
#include "simulator/common/fingerprint.h"
#include "simulator/documents/schema.h"

namespace faultsweep {

using faultsim::JsonDocument;

namespace {

std::vector<std::string> texts(const json& document, const char* key) {
  return document.value(key, std::vector<std::string>{});
}

/// As every tool does: a relative path starts at the file that names it.
std::string from_suite(const std::string& suite, const std::string& path) {
  return (std::filesystem::path(suite).parent_path() / path).lexically_normal().string();
}

SampleRequest read_sample(const json& value, const std::string& suite) {
  SampleRequest sample;
  sample.store = from_suite(suite, value.at("store"));
  sample.campaign = value.at("campaign");
  sample.top = value.value("top", sample.top);
  sample.sample = value.value("sample", sample.sample);
  sample.same_environment = value.value("same_environment", true);
  return sample;
}

/// What the schema cannot say.
void check(const JsonDocument& document, const NightlySuite& suite,
           std::vector<Problem>& problems) {
  const auto problem = [&](const std::string& pointer, const std::string& what,
                           const std::string& cure) {
    problems.push_back({pointer, document.line_of(pointer), what, cure});
  };
  if (!is_plain_name(suite.name)) {
    problem("/name", concat("\"", suite.name, "\" is not a valid name for a folder"),
            kPlainNameCure);
  }
  std::error_code ignored;  // a name that is too long is not a file either
  for (std::size_t k = 0; k < suite.campaigns.size(); ++k) {
    if (!std::filesystem::is_regular_file(suite.campaigns[k], ignored)) {
      problem(concat("/campaigns/", k), concat("there is no file ", suite.campaigns[k]),
              "give a campaign spec, relative to the suite");
    }
  }
  for (std::size_t k = 0; k < suite.samples.size(); ++k) {
    if (!std::filesystem::exists(suite.samples[k].store + "/campaign.sqlite", ignored)) {
      problem(concat("/samples/", k, "/store"),
              concat("there is no store ", suite.samples[k].store),
              "give the folder of a store, relative to the suite");
    }
  }
  const std::vector<std::string> known = quantities();
  for (const auto& [name, tolerance] : suite.tolerances.of_quantity) {
    if (!contains(known, name)) {
      problem("/tolerances/" + faultsim::pointer_token(name),
              concat("\"", name, "\" is not a quantity that is compared"),
              "name it as schemas/result.schema.json does");
    }
  }
}

}  // namespace

NightlySuite read_nightly_suite(const std::string& path) {
  static const faultsim::Schema schema(json::parse(faultsim::embedded::nightly_schema));
  const JsonDocument document = faultsim::read_json_file(path);
  std::vector<Problem> problems = faultsim::check_schema(document, schema);
  if (!problems.empty()) throw InputError(path, problems);
  const json& value = document.value;
  NightlySuite suite;
  suite.source = path;
  suite.name = value.at("name");
  for (const std::string& spec : texts(value, "campaigns")) {
    suite.campaigns.push_back(from_suite(path, spec));
  }
  suite.verification = texts(value, "verification");
  for (const json& sample : value.value("samples", json::array())) {
    suite.samples.push_back(read_sample(sample, path));
  }
  suite.tolerances.all = value.value("tolerance", suite.tolerances.all);
  for (const auto& [name, tolerance] : value.value("tolerances", std::map<std::string, double>{})) {
    suite.tolerances.of_quantity[name] = tolerance;
  }
  check(document, suite, problems);
  if (!problems.empty()) throw InputError(path, problems);
  return suite;
}

std::vector<std::size_t> sampled_places(const std::vector<std::string>& keys, long top,
                                        long sample) {
  const std::size_t n = keys.size();
  const std::size_t n_top = std::min(n, static_cast<std::size_t>(top));
  const std::size_t n_parts = std::min(n - n_top, static_cast<std::size_t>(sample));
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < n_top; ++k) places.push_back(k);
  for (std::size_t part = 0; part < n_parts; ++part) {
    const std::size_t begin = n_top + part * (n - n_top) / n_parts;
    const std::size_t end = n_top + (part + 1) * (n - n_top) / n_parts;
    std::size_t chosen = begin;
    for (std::size_t k = begin; k < end; ++k) {
      const auto hash = [&](std::size_t i) { return faultsim::fingerprint(keys[i]); };
      if (hash(k) < hash(chosen)) chosen = k;
    }
    places.push_back(chosen);
  }
  return places;
}

}  // namespace faultsweep
