#include "campaign/answers/seen.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include "campaign/common/names.h"
#include "simulator/common/printable.h"

namespace faultsweep {

namespace {

constexpr const char* kForms =
    "write \"F2 slid before 8 yr +- 0.5 yr\", \"F2 did not slide before 8 yr\", \"event of Mw 3 +- "
    "0.2 on F2 between -120 bar and -80 bar +- 5 bar\", \"no event of Mw 3 on F2\", \"max_slip = "
    "20 "
    "mm +- 5 mm\" or \"F2.slides in gas_storage, wrong 0.1\"";

/// Of a statement: std::regex_match makes a call within a call for each.
constexpr std::size_t kMostLetters = 2000;

/// Whether this is how a statement may name the fault: as it is called, or in quotes.
bool is_name_of(const std::string& name, const NamedId& fault) {
  if (name == fault.name) return true;
  if (name.empty() || (name.front() != '"' && name.front() != '\'')) return false;
  const auto quoted = quoted_at(name, 0);
  return quoted && quoted->end == name.size() && quoted->inside == fault.name;
}

double share_below(double distance, double error) {
  if (error == 0) return distance >= 0 ? 1 : 0;
  return 0.5 * std::erfc(-distance / error / std::sqrt(2.0));
}

/// Reads one statement; what is wrong with it is thrown as its own InputError or said in problems.
class StatementReader {
 public:
  StatementReader(const CampaignInfo& campaign, const Selection& selection,
                  std::vector<Problem>& problems)
      : campaign_(campaign), selection_(selection), problems_(problems) {}

  SeenStatement read(const std::string& text) {
    static const std::regex kSlid(R"((.+?) (slid|did not slide) before (.+?)( \+- (.+))?)");
    static const std::regex kEvent(
        R"((no )?event of Mw (\S+)( \+- (\S+))? on (.+?)( between (.+) and (.+?)( \+- (.+))?)?)");
    static const std::regex kMetric(R"((.+?) = (.+) \+- (.+))");
    static const std::regex kCondition(R"((.+?)(, wrong (\S+))?)");
    statement_ = {};
    statement_.text = text;
    if (text.size() > kMostLetters) {
      constexpr std::size_t kMostShown = 60;
      statement_.text = faultsim::shortened(text, kMostShown);
      problem(concat("has ", text.size(), " characters"),
              concat("write at most ", kMostLetters, ", or several statements"));
      return statement_;
    }
    std::smatch parts;
    if (std::regex_match(text, parts, kSlid)) {
      read_slid(parts);
    } else if (std::regex_match(text, parts, kEvent)) {
      read_event(parts);
    } else if (std::regex_match(text, parts, kMetric)) {
      read_metric(parts);
    } else if (std::regex_match(text, parts, kCondition)) {
      read_condition(parts);
    } else {
      problem("is empty", kForms);
    }
    return statement_;
  }

 private:
  void problem(const std::string& what, const std::string& cure) {
    problems_.push_back({"", 0, concat("\"", statement_.text, "\": ", what), cure});
  }

  double quantity(const std::string& text, Dimension dimension) {
    const auto parsed = faultsim::parse_quantity(text, dimension);
    if (!parsed.ok) problem(parsed.what, parsed.cure);
    return parsed.ok ? parsed.value : 0;
  }
  double error(const std::string& text, Dimension dimension) {
    const double value = quantity(text, dimension);
    if (value < 0) problem("the error is negative", "write it without the minus sign");
    return std::abs(value);
  }

  void set_fault(const std::string& name) {
    for (const NamedId& one : selection_.faults)
      if (is_name_of(name, one)) statement_.fault = one.id;
    if (statement_.fault != 0) return;
    std::string names = joined(selection_.faults, ", ", &NamedId::name);
    problem(concat("there is no fault ", name), "there are: " + names);
  }

  void read_slid(const std::smatch& parts) {
    statement_.kind = SeenStatement::Kind::slid;
    statement_.denied = parts[2] == "did not slide";
    set_fault(parts[1]);
    statement_.value = quantity(parts[3], Dimension::time);
    if (parts[5].matched) statement_.error = error(parts[5], Dimension::time);
  }

  void read_event(const std::smatch& parts) {
    statement_.kind = SeenStatement::Kind::event;
    statement_.denied = parts[1].matched;
    statement_.value = quantity(parts[2], Dimension::number);
    if (parts[4].matched) statement_.error = error(parts[4], Dimension::number);
    set_fault(parts[5]);
    if (!parts[6].matched) return;
    const double a = quantity(parts[7], Dimension::pressure);
    const double b = quantity(parts[8], Dimension::pressure);
    statement_.from = std::min(a, b), statement_.to = std::max(a, b);
    if (parts[10].matched) statement_.range_error = error(parts[10], Dimension::pressure);
  }

  void read_metric(const std::smatch& parts) {
    statement_.kind = SeenStatement::Kind::metric;
    try {
      const auto metrics = choose_metrics(selection_, parts[1], true, false);
      if (metrics.size() != 1) {
        problem("a statement is about a single metric", kForms);
        return;
      }
      statement_.column = {metrics[0].sql, {}};
      statement_.value = quantity(parts[2], metrics[0].dimension);
      statement_.error = error(parts[3], metrics[0].dimension);
      if (statement_.error == 0)
        problem("no case has exactly this value", "give an error above zero");
    } catch (const InputError& wrong) {
      take_over(wrong);
    }
  }

  void read_condition(const std::smatch& parts) {
    statement_.kind = SeenStatement::Kind::condition;
    if (parts[3].matched) statement_.error = error(parts[3], Dimension::number);
    if (statement_.error >= 0.5) {
      problem("a report that is as often wrong as right says nothing", "write a number below 0.5");
    }
    try {
      statement_.condition = parts[1];
      parse_condition(statement_.condition, campaign_, selection_);
    } catch (const InputError& wrong) {
      take_over(wrong);
    }
  }

  void take_over(const InputError& wrong) {
    for (const Problem& one : wrong.problems()) problem(one.what, one.cure + "; or " + kForms);
  }

  const CampaignInfo& campaign_;
  const Selection& selection_;
  std::vector<Problem>& problems_;
  SeenStatement statement_;
};

double likelihood_of_events(const SeenStatement& statement, const std::vector<SeenEvent>& events) {
  double none = 1;
  for (const SeenEvent& one : events) {
    if (one.fault != statement.fault) continue;
    double p = share_below(one.magnitude.value() - statement.value, statement.error);
    if (statement.from) {
      const double above = one.change - *statement.from, below = *statement.to - one.change;
      p *= std::max(0.0, share_below(above, statement.range_error) +
                             share_below(below, statement.range_error) - 1);
    }
    none *= 1 - p;
  }
  return 1 - none;
}

/// Of the statement's fault; null where it has none.
const CaseOnsets::Onset* onset_of(const SeenStatement& statement, const CaseHistory& history) {
  for (const CaseOnsets::Onset& one : history.onsets)
    if (one.fault == statement.fault) return &one;
  return nullptr;
}

/// T lies behind the end of the step before and not behind that of its own.
WeightRange likelihood_within_step(const SeenStatement& statement, const CaseOnsets::Onset& onset) {
  const double by_end = share_below(statement.value - onset.time, statement.error);
  const double by_begin = statement.error > 0
                              ? share_below(statement.value - onset.began, statement.error)
                              : (onset.began < statement.value ? 1.0 : 0.0);
  return statement.denied ? WeightRange{1 - by_begin, 1 - by_end} : WeightRange{by_end, by_begin};
}

}  // namespace

std::vector<SeenStatement> read_seen(const std::vector<std::string>& statements,
                                     const CampaignInfo& campaign, const Selection& selection) {
  std::vector<Problem> problems;
  StatementReader reader(campaign, selection, problems);
  std::vector<SeenStatement> read;
  for (const std::string& one : statements) {
    std::string text;  // "±" is "+-"
    for (std::size_t i = 0; i < one.size(); ++i) {
      const bool plus_minus = one.compare(i, 2, "\xC2\xB1") == 0;
      text += plus_minus ? "+-" : std::string(1, one[i]);
      i += plus_minus ? 1 : 0;
    }
    read.push_back(reader.read(text));
  }
  if (!problems.empty()) throw InputError("--seen", problems);
  return read;
}

double likelihood(const SeenStatement& statement, const CaseHistory& history, double value) {
  double p = 0;
  switch (statement.kind) {
    case SeenStatement::Kind::slid:
      if (const auto* onset = onset_of(statement, history))
        p = share_below(statement.value - onset->time, statement.error);
      break;
    case SeenStatement::Kind::event:
      p = likelihood_of_events(statement, history.events);
      break;
    case SeenStatement::Kind::metric: {
      const double distance = (value - statement.value) / statement.error;
      return std::isfinite(distance) ? std::exp(-0.5 * distance * distance) : 0;
    }
    case SeenStatement::Kind::condition:
      return value == 1 ? 1 - statement.error : statement.error;
  }
  return statement.denied ? 1 - p : p;
}

WeightRange likelihood_by_cells(const SeenStatement& statement, const CaseHistory& history,
                                double value, Held held) {
  switch (statement.kind) {
    case SeenStatement::Kind::slid: {
      if (contains(history.unresolved, statement.fault)) return {0, 1};
      if (const auto* onset = onset_of(statement, history))
        return likelihood_within_step(statement, *onset);
      break;
    }
    case SeenStatement::Kind::event:
      if (!history.events_resolved) return {0, 1};
      break;
    case SeenStatement::Kind::metric:
      break;
    case SeenStatement::Kind::condition:
      if (held == Held::undecided_no || held == Held::undecided_yes)
        return {statement.error, 1 - statement.error};
      break;
  }
  const double computed = likelihood(statement, history, value);
  return {computed, computed};
}

WeightRange likelihood_range(const SeenStatement& statement, const CaseHistory& history) {
  const double so_far = likelihood(statement, history, 0);
  switch (statement.kind) {
    case SeenStatement::Kind::slid:
      return onset_of(statement, history) == nullptr ? WeightRange{0, 1}
                                                     : WeightRange{so_far, so_far};
    case SeenStatement::Kind::event:  // further ones make it likelier that there was one
      return statement.denied ? WeightRange{0, so_far} : WeightRange{so_far, 1};
    case SeenStatement::Kind::metric:
      return {0, 1};
    case SeenStatement::Kind::condition:
      return {statement.error, 1 - statement.error};
  }
  FAULTSIM_DEMAND(false, static_cast<int>(statement.kind));
  return {};
}

}  // namespace faultsweep
