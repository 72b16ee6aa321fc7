#include "campaign/rounds/limit_searcher.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

/// One of the values that a round has in each row of the design.
struct LimitSearcher::Value {
  std::size_t limit = 0;
  double number = 0;  ///< in the limit's unit.
};

namespace {

double spelled_number(const ordered_json& value) {
  return value.is_number() ? value.get<double>()
                           : std::strtod(value.get_ref<const std::string&>().c_str(), nullptr);
}

SearchPoint point_of(double value, const RowAnswers* answer, std::size_t question) {
  if (answer == nullptr) return {value, PointState::unknown, true, 0};
  const Held held = answer->held.at(question);
  SearchPoint point{value, PointState::unknown, true, answer->position};
  if (held == Held::unknown) return point;
  const bool is_unsafe = held == Held::yes || held == Held::undecided_yes;
  point.state = is_unsafe ? PointState::unsafe : PointState::safe;
  point.resolved = held == Held::yes || held == Held::no;
  return point;
}

std::string counts_text(const std::vector<LimitSearcher::Search>& searches) {
  std::map<LimitVerdict, long> counts;
  long n_wide = 0;
  for (const LimitSearcher::Search& one : searches) {
    ++counts[one.finding.verdict];
    const auto& crossings = one.finding.crossings;
    n_wide +=
        std::ranges::any_of(crossings, [](const Crossing& crossing) { return !crossing.narrow; });
  }
  std::string text = concat(searches.size(), " searches: ");
  const char* separator = "";
  for (const auto& [verdict, count] : counts) {
    text += concat(separator, count, " ", to_string(verdict));
    separator = ", ";
  }
  return n_wide == 0 ? text : concat(text, "; ", n_wide, " wider than their tolerance");
}

}  // namespace

std::vector<Question> LimitSearcher::questions() const {
  std::vector<Question> all;
  for (const LimitSearch& limit : limits_) {
    for (const std::string& fault : limit.faults)
      all.push_back({limit.unsafe, fault, limit.stage, limit.pointer + "/unsafe"});
  }
  return all;
}

std::vector<std::vector<LimitSearcher::Value>> LimitSearcher::values_of_rounds(
    const std::vector<ordered_json>& designs) const {
  std::vector<std::vector<Value>> rounds(designs.size());
  for (std::size_t k = 0; k < designs.size(); ++k) {
    for (std::size_t l = 0; l < limits_.size(); ++l) {
      if (k == 0) {
        for (const double number : limits_[l].scan) rounds[k].push_back({l, number});
      } else {
        for (const ordered_json& value : designs[k].at("values").at(limits_[l].name))
          rounds[k].push_back({l, spelled_number(value)});
      }
    }
  }
  return rounds;
}

std::vector<LimitSearcher::Search> LimitSearcher::search(
    const std::vector<RowAnswers>& answers, const std::vector<ordered_json>& designs) const {
  const auto rounds = values_of_rounds(designs);
  // Tried: configuration, limit, value -> answer; none where its case was excluded.
  std::map<std::pair<long, std::size_t>, std::map<double, const RowAnswers*>> tried;
  const auto note = [&](std::size_t round, long row, const RowAnswers* answer) {
    const auto n = static_cast<long>(rounds[round].size());
    const Value& value = rounds[round][static_cast<std::size_t>(row % n)];
    const RowAnswers*& place = tried[{row / n, value.limit}][value.number];
    if (answer != nullptr) place = answer;
  };
  for (const RowAnswers& one : answers) {
    if (one.round != 0) continue;
    const auto n = static_cast<long>(rounds[0].size());
    for (long k = 0; k < n; ++k) note(0, one.row / n * n + k, nullptr);
  }
  for (std::size_t k = 1; k < designs.size(); ++k)
    for (const ordered_json& row : designs[k].at("rows")) note(k, row.get<long>(), nullptr);
  for (const RowAnswers& one : answers) note(static_cast<std::size_t>(one.round), one.row, &one);

  std::vector<std::size_t> first_question;
  std::size_t n_questions = 0;
  for (const LimitSearch& limit : limits_) {
    first_question.push_back(n_questions);
    n_questions += limit.faults.size();
  }
  std::vector<Search> searches;
  for (const auto& [key, values] : tried) {
    const auto& [configuration, l] = key;
    const LimitSearch& limit = limits_[l];
    for (std::size_t fault = 0; fault < limit.faults.size(); ++fault) {
      std::vector<SearchPoint> points;
      for (const auto& [number, answer] : values)
        points.push_back(point_of(number, answer, first_question[l] + fault));
      const bool ascending = limit.scan.back() > limit.scan.front();
      searches.push_back(
          {configuration, l, fault, judge(std::move(points), ascending, limit.tolerance)});
    }
  }
  return searches;
}

Proposal LimitSearcher::propose(const std::vector<RowAnswers>& answers,
                                const std::vector<ordered_json>& designs) const {
  const std::vector<Search> searches = search(answers, designs);
  const std::string text = counts_text(searches);
  std::vector<std::set<double>> wanted(limits_.size());
  std::set<std::pair<long, std::pair<std::size_t, double>>> cases;  // configuration, limit, value
  for (const Search& one : searches) {
    const LimitSearch& limit = limits_[one.limit];
    for (const double value : next_values(one.finding, limit.scan.front(), limit.tolerance)) {
      wanted[one.limit].insert(value);
      cases.insert({one.configuration, {one.limit, value}});
    }
  }
  if (cases.empty()) return {nullptr, text};
  ordered_json design;
  std::map<std::pair<std::size_t, double>, long> places;
  for (std::size_t l = 0; l < limits_.size(); ++l) {
    ordered_json& values = design["values"][limits_[l].name] = ordered_json::array();
    if (wanted[l].empty()) wanted[l].insert(limits_[l].scan.front());  // in no row
    for (const double value : wanted[l]) {
      places.emplace(std::pair(l, value), static_cast<long>(places.size()));
      values.push_back(ordered_json(spelled(value + 0.0, limits_[l].unit)));  // no "-0"
    }
  }
  for (const auto& [configuration, value] : cases) {
    design["rows"].push_back(configuration * static_cast<long>(places.size()) + places.at(value));
  }
  return {std::move(design), text};
}

ordered_json LimitSearcher::spec_of_round(ordered_json spec, const ordered_json& design) const {
  spec["limits_round"] = design;
  return spec;
}

}  // namespace faultsweep
