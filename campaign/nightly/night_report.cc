#include "campaign/nightly/night_report.h"

#include <algorithm>
#include <map>

#include "campaign/render/render.h"
#include "campaign/render/shown.h"
#include "campaign/store/clock.h"

namespace faultsweep {

namespace {

NightCaseRecord record_of(const std::string& campaign, const NightCase& one) {
  NightCaseRecord record;
  record.campaign = campaign;
  record.position = one.position;
  record.identity = one.identity;
  record.label = one.label;
  record.wall_seconds = one.wall_seconds;
  record.verdict = to_string(one.result ? Verdict::unblessed : Verdict::missing);
  record.regressed = !one.result;
  record.remark = one.result ? "" : one.trouble;
  if (one.result) {
    record.digest = result_digest(*one.result);
    record.outcome = faultsim::to_string(one.result->outcome);
    record.activated_area = one.result->whole.activated_area;
    record.moment = one.result->whole.moment;
    record.chi_bar = one.result->whole.chi_bar;
  }
  return record;
}

std::string words_of(const Difference& one) {
  std::string text =
      concat(one.place, ": ", one.quantity, " ", one.tonight, ", was ", one.baseline);
  if (one.ulps > 0) text += concat(" (", one.ulps, " ulp)");
  return text;
}

void enter(const Agreement& agreement, NightCaseRecord& record) {
  record.verdict = to_string(agreement.verdict);
  record.regressed = is_regression(agreement.verdict);
  record.max_ulps = static_cast<double>(agreement.max_ulps);
  if (!agreement.first) return;
  record.load_step = agreement.first->step;
  record.place = agreement.first->place;
  record.quantity = agreement.first->quantity;
  record.remark = words_of(*agreement.first);
  const std::string worst = words_of(*agreement.worst);
  if (worst != record.remark) record.remark += "; most telling: " + worst;
}

const NightCaseRecord* find(const NightRecord& night, const NightCaseRecord& like) {
  for (const NightCaseRecord& one : night.cases) {
    if (one.campaign == like.campaign && one.identity == like.identity) return &one;
  }
  return nullptr;
}

std::string name_of(const NightCaseRecord& one) {
  return one.position > 0 ? concat(one.campaign, "/", one.position) : one.identity;
}

/// Nights of the same suite and environment, newest first.
std::vector<const NightRecord*> comparable(const NightRecord& tonight,
                                           const std::vector<NightRecord>& earlier) {
  std::vector<const NightRecord*> nights;
  for (auto it = earlier.rbegin(); it != earlier.rend(); ++it) {
    if (it->suite == tonight.suite && it->environment == tonight.environment) {
      nights.push_back(&*it);
    }
  }
  return nights;
}

std::string advice_on_time(const NightCaseRecord& tonight,
                           const std::vector<const NightRecord*>& nights) {
  constexpr std::size_t kMost = 7;
  constexpr int kLeast = 3;
  constexpr double kFactor = 1.25, kSeconds = 0.1;
  int n = 0;
  double longest = 0;
  for (std::size_t k = 0; k < std::min(kMost, nights.size()); ++k) {
    const NightCaseRecord* before = find(*nights[k], tonight);
    if (before == nullptr || !before->wall_seconds) continue;
    longest = std::max(longest, *before->wall_seconds);
    ++n;
  }
  if (n < kLeast || !tonight.wall_seconds) return "";
  if (*tonight.wall_seconds <= kFactor * longest + kSeconds) return "";
  return concat(name_of(tonight), " took ", format_number(*tonight.wall_seconds, 3), " s; at most ",
                format_number(longest, 3), " s in the ", n, " nights before");
}

std::string counts_text(const NightRecord& night) {
  std::map<std::string, long> counts;
  for (const NightCaseRecord& one : night.cases) ++counts[one.verdict];
  std::string text;
  for (const auto& [verdict, n] : counts) {
    text += concat(text.empty() ? "" : ", ", n, " ", verdict);
  }
  return text;
}

/// Cases whose numbers are not those of the last comparable night before.
long n_changed(const std::vector<NightRecord>& nights, std::size_t k) {
  const std::vector<NightRecord> earlier(nights.begin(),
                                         nights.begin() + static_cast<std::ptrdiff_t>(k));
  const auto before = comparable(nights[k], earlier);
  if (before.empty()) return 0;
  return std::ranges::count_if(nights[k].cases, [&](const auto& one) {
    const NightCaseRecord* then = find(*before.front(), one);
    return then != nullptr && then->digest != one.digest;
  });
}

}  // namespace

std::vector<NightCaseRecord> judge_campaign(const NightCampaign* baseline,
                                            const NightCampaign& tonight, bool same_environment,
                                            const Tolerances& tolerances) {
  std::vector<NightCaseRecord> records;
  std::map<std::string, std::size_t> places;  // of identities in records
  for (const NightCase& one : tonight.cases) {
    places[one.identity] = records.size();
    records.push_back(record_of(tonight.name, one));
  }
  if (baseline == nullptr) return records;
  std::vector<CaseResult> before, now;
  std::vector<std::size_t> compared;
  for (const NightCase& one : baseline->cases) {
    const auto place = places.find(one.identity);
    if (place == places.end()) {
      NightCase gone = one;
      gone.result.reset();
      gone.trouble = "the baseline has this case, the suite does not";
      records.push_back(record_of(tonight.name, gone));
      continue;
    }
    const NightCase& again = tonight.cases[place->second];
    if (!again.result) continue;
    enter(compare_results(*one.result, *again.result, same_environment, tolerances),
          records[place->second]);
    compared.push_back(place->second);
    before.push_back(*one.result);
    now.push_back(*again.result);
  }
  const auto changed = changed_order(before, now, tolerances);
  for (std::size_t k = 0; k < changed.size(); ++k) {
    NightCaseRecord& record = records[compared[k]];
    if (!changed[k]) continue;
    record.remark += concat(record.remark.empty() ? "" : "; ", "is now on the other side of case ",
                            records[compared[*changed[k]]].position, " in the ranking");
    const bool is_worse = record.verdict == to_string(Verdict::activation_flipped) ||
                          record.verdict == to_string(Verdict::outcome_changed);
    if (!is_worse) record.verdict = to_string(Verdict::ranking_changed);
    record.regressed = true;
  }
  return records;
}

std::vector<std::string> night_advice(const NightRecord& tonight,
                                      const std::vector<NightRecord>& earlier) {
  const std::vector<const NightRecord*> nights = comparable(tonight, earlier);
  std::vector<std::string> advice;
  for (const NightCaseRecord& one : tonight.cases) {
    for (const NightRecord* night : nights) {
      const NightCaseRecord* before = find(*night, one);
      if (before == nullptr || before->digest.empty() || one.digest.empty()) continue;
      if (before->digest != one.digest) {
        advice.push_back(concat(name_of(one), ": numbers differ from those of the night of ",
                                format_time(night->at)));
      }
      break;
    }
    if (std::string text = advice_on_time(one, nights); !text.empty()) {
      advice.push_back(std::move(text));
    }
  }
  return advice;
}

std::string night_to_text(const NightRecord& night, const std::vector<std::string>& remarks,
                          const std::vector<std::string>& advice, std::size_t width) {
  std::string text = concat("suite ", night.suite, ", ", format_time(night.at), ", ",
                            format_duration(night.wall_seconds), "\n");
  for (const std::string& remark : remarks) text += remark + "\n";
  AnswerTable table{"cases",
                    "",
                    {{"verdict", "verdict", {}, 4, Need::always},
                     {"case", "case", {}, 4, Need::always},
                     {"max_ulps", "max ulp", {}, 6, Need::always},
                     {"remark", "first difference", {}, 4, Need::always},
                     {"label", "parameters", {}, 4, Need::always}}};
  for (const NightCaseRecord& one : night.cases) {
    if (one.verdict == to_string(Verdict::identical)) continue;
    table.rows.push_back({one.verdict, name_of(one),
                          one.max_ulps > 0 ? AnswerCell(one.max_ulps) : AnswerCell(), one.remark,
                          one.label});
  }
  text += render_text(table, width);
  for (const std::string& one : advice) text += "note: " + one + "\n";
  text += concat(night.n_compared, " compared: ", counts_text(night), "\n");
  if (night.n_compared == 0) text += "NOTHING WAS COMPARED\n";
  if (night.n_regressed > 0) text += concat("REGRESSED: ", night.n_regressed, " cases\n");
  return text;
}

json night_to_json(const NightRecord& night, const std::vector<std::string>& remarks,
                   const std::vector<std::string>& advice) {
  const auto optional = [](const auto& value) { return value ? json(*value) : json(nullptr); };
  json cases = json::array();
  for (const NightCaseRecord& one : night.cases) {
    cases.push_back({{"campaign", one.campaign},
                     {"case", one.position},
                     {"identity", one.identity},
                     {"label", one.label},
                     {"verdict", one.verdict},
                     {"regressed", one.regressed},
                     {"max_ulps", one.max_ulps},
                     {"load_step", optional(one.load_step)},
                     {"place", one.place},
                     {"quantity", one.quantity},
                     {"remark", one.remark},
                     {"digest", one.digest},
                     {"wall_s", optional(one.wall_seconds)},
                     {"outcome", one.outcome},
                     {"activated_area_m2", optional(one.activated_area)},
                     {"moment_nm", optional(one.moment)},
                     {"chi_bar", optional(one.chi_bar)}});
  }
  return {{"suite", night.suite},
          {"at", night.at},
          {"wall_s", night.wall_seconds},
          {"environment", night.environment},
          {"environment_fields", json::parse(night.environment_fields)},
          {"baseline_environment", night.baseline_environment},
          {"version", night.program_version},
          {"numerics_version", night.numerics_version},
          {"compared", night.n_compared},
          {"regressed", night.n_regressed},
          {"exit_code", night.exit_code},
          {"blessed", optional(night.blessed)},
          {"remarks", remarks},
          {"advice", advice},
          {"cases", cases}};
}

std::string history_to_text(const std::vector<NightRecord>& nights, std::size_t width) {
  const Need all = Need::always;
  AnswerTable table{"nights",
                    "",
                    {{"at", "night", {}, 4, all},
                     {"suite", "suite", {}, 4, all},
                     {"environment", "environment", {}, 4, Need::wanted},
                     {"version", "version", {}, 4, Need::extra},
                     {"numerics_version", "numerics", {}, 4, Need::extra},
                     {"compared", "compared", {}, 4, all},
                     {"regressed", "regressed", {}, 4, all},
                     {"changed", "changed", {}, 4, Need::wanted},
                     {"exit_code", "exit", {}, 4, Need::extra},
                     {"wall_s", "time", seconds(), 3, Need::wanted},
                     {"blessed", "blessed", {}, 4, all}}};
  for (std::size_t k = 0; k < nights.size(); ++k) {
    const NightRecord& night = nights[k];
    const bool own = night.environment == night.baseline_environment;
    table.rows.push_back({format_time(night.at), night.suite,
                          night.environment.substr(0, 8) + (own ? "" : " (other)"),
                          night.program_version, night.numerics_version, night.n_compared,
                          night.n_regressed, n_changed(nights, k), night.exit_code,
                          night.wall_seconds, night.blessed.value_or("")});
  }
  return render_text(table, width);
}

json history_to_json(const std::vector<NightRecord>& nights) {
  json all = json::array();
  for (const NightRecord& night : nights) all.push_back(night_to_json(night, {}, {}));
  return {{"nights", all}};
}

}  // namespace faultsweep
