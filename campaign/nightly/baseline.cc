#include "campaign/nightly/baseline.h"

#include <algorithm>
#include <fstream>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/store/same_numbers.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/files/atomic_file.h"
#include "simulator/result/result_fields.h"
#include "simulator/result/result_json.h"

namespace faultsweep {

namespace {

constexpr int kFormat = 1;

/// A list of objects of one shape as a table: what is the same in all rows once, else a column per
/// number. A list that would not come back as it was stays as it is.
json unpack(const json& table) {
  if (!table.is_object()) return table;
  json list = json::array();
  for (const json& row : table.at("rows")) {
    json flat = json::object();
    for (std::size_t k = 0; k < row.size(); ++k) {
      flat[table.at("keys").at(k).get<std::string>()] = row[k];
    }
    json object = flat.empty() ? json::object() : flat.unflatten();
    object.update(table.at("same"));
    list.push_back(std::move(object));
  }
  return list;
}
json pack(const json& list) {
  if (list.size() < 2) return list;
  json same = list.front();
  for (const json& one : list) {
    for (auto it = same.begin(); it != same.end();) {
      it = one.contains(it.key()) && one[it.key()] == it.value() ? std::next(it) : same.erase(it);
    }
  }
  json keys, rows = json::array();
  for (json one : list) {
    for (const auto& [key, value] : same.items()) one.erase(key);
    json row = json::array(), names = json::array();
    const json flat = one.flatten();
    for (const auto& [key, value] : flat.items()) {
      names.push_back(key);
      row.push_back(value);
    }
    if (keys.is_null()) keys = names;
    if (keys != names) return list;
    rows.push_back(std::move(row));
  }
  json table = {{"same", same}, {"keys", keys}, {"rows", rows}};
  return unpack(table) == list ? table : list;
}

constexpr const char* kLists[] = {"steps", "stages", "events", "episodes"};

/// Bare: the rest would make every file differ.
json packed(const CaseResult& result) {
  json document = faultsim::result_to_json(bare(result));
  for (const char* key : kLists) document[key] = pack(document[key]);
  return document;
}

CaseResult unpacked(json document) {
  for (const char* key : kLists) document[key] = unpack(document.at(key));
  return faultsim::result_from_json(document);
}

json case_to_json(const NightCase& one) {
  return {{"case", one.position},
          {"identity", one.identity},
          {"label", one.label},
          {"result", packed(*one.result)}};
}

/// A line per case, so that a difference between two files shows which case it is.
std::string baseline_text(const Baseline& baseline) {
  json blessings = json::array();
  for (const Blessing& one : baseline.blessings) {
    blessings.push_back(
        {{"date", one.date}, {"reason", one.reason}, {"numerics_version", one.numerics_version}});
  }
  const Environment& environment = baseline.environment;
  const json head = {{"format", kFormat},
                     {"suite", baseline.suite},
                     {"fingerprint", environment.fingerprint},
                     {"version", environment.version},
                     {"numerics_version", environment.numerics_version},
                     {"environment", json::parse(environment.fields)},
                     {"blessed", blessings}};
  std::string text = head.dump(1);
  text.resize(text.size() - 2);  // "\n}"
  text += ",\n \"campaigns\": {";
  const char* separator = "\n";
  for (const NightCampaign& campaign : baseline.campaigns) {
    text += concat(separator, json(campaign.name).dump(), ": [\n");
    separator = ",\n";
    for (std::size_t k = 0; k < campaign.cases.size(); ++k) {
      text += case_to_json(campaign.cases[k]).dump();
      text += k + 1 < campaign.cases.size() ? ",\n" : "\n]";
    }
  }
  return text + "}\n}\n";
}

Baseline baseline_from_json(const json& document) {
  if (document.at("format") != kFormat) {
    throw StorageError(concat("it has format ", document.at("format").dump(),
                              ", this faultsweep reads ", kFormat));
  }
  Baseline baseline;
  baseline.suite = document.at("suite");
  baseline.environment = environment_from_json(document);
  for (const json& one : document.at("blessed")) {
    baseline.blessings.push_back({one.at("date"), one.at("reason"), one.at("numerics_version")});
  }
  for (const auto& [name, cases] : document.at("campaigns").items()) {
    NightCampaign campaign{name, {}};
    for (const json& one : cases) {
      NightCase& added = campaign.cases.emplace_back();
      added.position = one.at("case");
      added.identity = one.at("identity");
      added.label = one.at("label");
      added.result = unpacked(one.at("result"));
    }
    baseline.campaigns.push_back(std::move(campaign));
  }
  if (baseline.blessings.empty()) throw StorageError("it has never been blessed");
  return baseline;
}

}  // namespace

Environment environment_from_json(const json& document) {
  return {document.at("fingerprint"), document.at("environment").dump(), document.at("version"),
          document.at("numerics_version")};
}

std::vector<std::string> environment_differences(const Environment& here,
                                                 const Environment& there) {
  const json a = json::parse(here.fields), b = json::parse(there.fields);
  json all = a;
  all.update(b);
  std::vector<std::string> differences;
  for (const auto& [name, unused] : all.items()) {
    const json x = a.value(name, json()), y = b.value(name, json());
    if (x != y) {
      differences.push_back(concat(name, ": ", x.dump(), " here, ", y.dump(), " in the baseline"));
    }
  }
  return differences;
}

const NightCampaign* Baseline::find(const std::string& campaign) const {
  const auto found = std::ranges::find(campaigns, campaign, &NightCampaign::name);
  return found == campaigns.end() ? nullptr : &*found;
}

std::filesystem::path baseline_path(const std::filesystem::path& folder, const std::string& suite,
                                    const std::string& fingerprint) {
  return folder / suite / (fingerprint + ".json");
}

Baseline read_baseline(const std::filesystem::path& file) {
  return faultsim::with_context([&] { return concat("reading the baseline ", file.string()); },
                                [&] {
                                  std::ifstream stream(file, std::ios::binary);
                                  if (!stream) throw StorageError("the file cannot be read");
                                  try {
                                    Baseline baseline = baseline_from_json(json::parse(stream));
                                    if (baseline.environment.fingerprint != file.stem().string()) {
                                      throw StorageError(concat("it is for the environment ",
                                                                baseline.environment.fingerprint,
                                                                ", not of the one in its name"));
                                    }
                                    return baseline;
                                  } catch (const json::exception& error) {
                                    throw StorageError(error.what());
                                  }
                                });
}

std::optional<Baseline> find_baseline(const std::filesystem::path& folder, const std::string& suite,
                                      const Environment& environment) {
  const auto own = baseline_path(folder, suite, environment.fingerprint);
  if (std::filesystem::exists(own)) return read_baseline(own);
  std::optional<Baseline> newest;
  const auto key = [](const Baseline& b) {
    return b.blessings.back().date + b.environment.fingerprint;
  };
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder / suite, none)) {
    if (entry.path().extension() != ".json") continue;
    Baseline other = read_baseline(entry.path());
    if (!newest || key(other) > key(*newest)) newest = std::move(other);
  }
  return newest;
}

void write_baseline(const std::filesystem::path& folder, const Baseline& baseline) {
  std::error_code error;
  std::filesystem::create_directories(folder / baseline.suite, error);
  if (error) throw StorageError(concat("cannot make ", folder.string(), ": ", error.message()));
  faultsim::write_text(baseline_path(folder, baseline.suite, baseline.environment.fingerprint),
                       baseline_text(baseline));
}

std::string result_digest(const CaseResult& result) {
  constexpr int kAlwaysIn = 13;  // the store's version up to whose fields the first digests went
  json document = faultsim::result_to_json(bare(result));
  const auto forget_absent = [](json& object) {
    return [&object](const faultsim::Field& field, const auto&) {
      const std::string key(field.key);
      if (field.since > kAlwaysIn && object[key].empty()) object.erase(key);  // null or []
    };
  };
  faultsim::for_each_field(result, forget_absent(document));
  for (std::size_t k = 0; k < result.steps.size(); ++k)
    faultsim::for_each_field(result.steps[k], forget_absent(document["steps"][k]));
  const faultsim::FaultOnset onset;
  const auto forget_in_onsets = [&](json& stage) {
    for (json& fault : stage["faults"])
      for (const char* key : {"activation", "opening"})
        if (fault[key].is_object()) faultsim::for_each_field(onset, forget_absent(fault[key]));
  };
  forget_in_onsets(document["whole"]);
  for (json& stage : document["stages"]) forget_in_onsets(stage);
  return faultsim::fingerprint(document.dump());
}

}  // namespace faultsweep
