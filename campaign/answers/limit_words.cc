#include "campaign/answers/limit_words.h"

#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

namespace {

std::string with_unit(const std::string& text, const LimitSearch& limit) {
  return concat(text, limit.unit.empty() ? "" : " ", limit.unit);
}

std::string bracket(double safe, double unsafe, const LimitSearch& limit) {
  return with_unit(concat("[", shortest_text(safe), ", ", shortest_text(unsafe), "]"), limit);
}

/// "non-monotone: unsafe -50 to -41, -12 to 0 bar", as far as values were tried.
std::string unsafe_parts(const LimitCell& cell, const LimitSearch& limit) {
  std::string text = "non-monotone: unsafe";
  const SearchPoint* first = nullptr;
  const SearchPoint* last = nullptr;
  const char* separator = " ";
  const auto close = [&] {
    if (first == nullptr) return;
    text += concat(separator, shortest_text(first->value));
    if (last != first) text += concat(" to ", shortest_text(last->value));
    separator = ", ";
    first = nullptr;
  };
  for (const SearchPoint& one : cell.finding.points) {
    if (one.state == PointState::safe) close();
    if (one.state != PointState::unsafe) continue;
    if (first == nullptr) first = &one;
    last = &one;
  }
  close();
  return with_unit(text, limit);
}

}  // namespace

std::string value_text(double value, const LimitSearch& limit) {
  return with_unit(shortest_text(value), limit);
}

std::string range_text(const LimitSearch& limit) {
  return concat(shortest_text(limit.scan.front()), " to ", value_text(limit.scan.back(), limit));
}

double si_of(double value, const LimitSearch& limit) {
  if (limit.unit.empty()) return value;
  return faultsim::parse_quantity(value_text(value, limit), limit.dimension).value;
}

std::string limit_text(const LimitCell& cell, const LimitSearch& limit) {
  const Crossing* crossing = cell.finding.limit();
  const std::string found =
      crossing != nullptr ? bracket(crossing->before.value, crossing->after.value, limit) : "";
  switch (cell.finding.verdict) {
    case LimitVerdict::unknown:
      return "not known: no result at the safe end of the range";
    case LimitVerdict::safe_throughout:
      return concat("safe in the whole range tried (", range_text(limit), ")");
    case LimitVerdict::unsafe_throughout:
      return concat("unsafe already at ", value_text(limit.scan.front(), limit));
    case LimitVerdict::limit:
      return found;
    case LimitVerdict::non_monotone:
      return concat(found, found.empty() ? "" : ", ", unsafe_parts(cell, limit));
  }
  faultsim::throw_internal("known verdict", "", __FILE__, __LINE__);
}

std::string short_text(const LimitCell& cell) {
  const LimitFinding& f = cell.finding;
  std::string text;
  if (const Crossing* crossing = f.limit()) {
    text = concat("[", shortest_text(crossing->before.value), ", ",
                  shortest_text(crossing->after.value), "]");
  } else if (f.verdict == LimitVerdict::safe_throughout) {
    text = "all safe";
  } else {
    text = f.verdict == LimitVerdict::unsafe_throughout ? "all unsafe" : to_string(f.verdict);
  }
  if (f.limit() != nullptr && f.verdict == LimitVerdict::non_monotone) text += " *";
  return text + (f.verdict == LimitVerdict::unknown || is_resolved(cell) ? "" : " ?");
}

std::string sure_text(const LimitCell& cell, const LimitSearch& limit) {
  const auto &safe = cell.finding.surely_safe, &unsafe = cell.finding.surely_unsafe;
  if (safe && unsafe) return bracket(safe->value, unsafe->value, limit);
  if (unsafe) return concat("unsafe from ", value_text(unsafe->value, limit));
  if (!safe) return "nothing";
  const bool is_all = cell.finding.verdict == LimitVerdict::safe_throughout &&
                      safe->value == cell.finding.points.back().value;
  return is_all ? std::string("safe in the whole range tried")
                : concat("safe to ", value_text(safe->value, limit));
}

bool is_resolved(const LimitCell& cell) {
  const LimitFinding& f = cell.finding;
  if (const Crossing* crossing = f.limit())
    return crossing->before.resolved && crossing->after.resolved;
  if (f.points.empty()) return false;
  if (f.verdict == LimitVerdict::safe_throughout)
    return f.surely_safe && f.surely_safe->value == f.points.back().value;
  return f.points.front().resolved;
}

std::string remark_of(const LimitCell& cell) {
  const LimitFinding& f = cell.finding;
  std::string text;
  if (f.n_unknown > 0) text = concat(counted(f.n_unknown, "case", "cases"), " not known");
  const Crossing* crossing = f.limit();
  if (crossing != nullptr && !crossing->narrow)
    text += concat(text.empty() ? "" : "; ", "not narrowed yet");
  return text;
}

std::string question_text(const LimitSearch& limit) {
  const bool up = limit.scan.back() > limit.scan.front();
  std::string faults = joined(limit.faults, ", ");
  return concat(limit.name, ": the ", up ? "highest" : "lowest", " value from ",
                value_text(limit.scan.front(), limit), " to ", value_text(limit.scan.back(), limit),
                " without \"", limit.unsafe, "\" on ", faults,
                limit.stage.empty() ? "" : concat(" in ", limit.stage), ", to ",
                value_text(limit.tolerance, limit), ".");
}

}  // namespace faultsweep
