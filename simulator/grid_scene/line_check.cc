#include "simulator/grid_scene/line_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "simulator/common/ranges.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/trace_ends.h"
#include "simulator/horizons/body_check.h"
#include "simulator/horizons/map_mesh.h"
#include "simulator/horizons/pillar_check.h"
#include "simulator/horizons/traces.h"

namespace faultsim::grid_scene {
namespace {

using Eigen::Vector2d;

horizons::TraceEnd end_of_trace(LineEnd end) {
  return end == LineEnd::fault ? horizons::TraceEnd::at_fault : horizons::TraceEnd::in_rock;
}

/// The number behind "/faults/"; −1: it points elsewhere.
int fault_in(const std::string& pointer) {
  const std::string begin = "/faults/";
  if (pointer.rfind(begin, 0) != 0) return -1;
  int number = -1;
  std::from_chars(pointer.data() + begin.size(), pointer.data() + pointer.size(), number);
  return number;
}

/// Faults that cross each other, at first, at less than 26 degrees (the builder wants 25, and
/// points are moved): the later one.
std::optional<Misfit> flat_crossing(const ModelLines& lines) {
  constexpr double kLeast = 26 * std::numbers::pi / 180;
  for (std::size_t q = 0; q < lines.faults.size(); ++q) {
    for (std::size_t p = 0; p < q; ++p) {
      const auto crossing = crossing_beyond(lines.faults[q].trace, lines.faults[p].trace, 0);
      if (!crossing || crossing->angle >= kLeast) continue;
      return Misfit{static_cast<int>(q),
                    concat("it crosses ", lines.faults[p].name, " at ",
                           std::round(crossing->angle * 180 / std::numbers::pi), " degrees")};
    }
  }
  return std::nullopt;
}

/// What the builder would say before it looks at horizons.
std::vector<Problem> problems_of(const horizons::LayeredBody& body) {
  std::vector<Problem> problems;
  horizons::check_numbers(body, problems);
  // Too many cells are said of the scene that is written: no fault is to blame for them, and a
  // map of them would take minutes.
  const auto of_cells = [](const Problem& problem) { return problem.pointer == "/cells"; };
  if (std::erase_if(problems, of_cells) > 0 || !problems.empty()) return problems;
  const horizons::MapLines met = horizons::meeting_lines(body, problems);
  if (!problems.empty()) return problems;
  const horizons::MapMesh map = horizons::mesh_map(body, met, problems);
  if (!problems.empty()) return problems;
  horizons::check_faults_in_depth(body, map, problems);
  if (!problems.empty()) return problems;
  const horizons::Pillars pillars(body, map);
  horizons::check_pillars(body, map, pillars, problems);
  return problems;
}

/// Lines without a fault, those that end at it in the rock.
ModelLines without_fault(const ModelLines& lines, std::size_t fault) {
  ModelLines without = lines;
  const Polyline trace = lines.faults[fault].trace;
  without.faults.erase(without.faults.begin() + static_cast<std::ptrdiff_t>(fault));
  const auto ends_at_it = [&](const Vector2d& end) {
    const double away = corner_point::nearest_on_line(trace, end).distance;
    return away <= lines.strike &&
           std::ranges::none_of(without.faults, [&](const ModelFault& other) {
             const bool is_own = end == other.trace.front() || end == other.trace.back();
             return !is_own && corner_point::nearest_on_line(other.trace, end).distance < away;
           });
  };
  for (ModelFault& other : without.faults) {
    if (ends_at_it(other.trace.front())) other.first_end = LineEnd::rock;
    if (ends_at_it(other.trace.back())) other.last_end = LineEnd::rock;
  }
  return without;
}

/// The last fault without which lines fit, or else, on request, without which the builder says
/// something else first; −1: none.
int fault_to_blame(const ModelLines& lines, const std::string& first, Blame blame) {
  int changes_it = -1;
  for (std::size_t f = lines.faults.size(); f-- > 0;) {
    const std::vector<Problem> problems = problems_of(body_of_lines(without_fault(lines, f)));
    if (problems.empty()) return static_cast<int>(f);
    if (changes_it < 0 && !contains(problems, first, &Problem::what))
      changes_it = static_cast<int>(f);
  }
  return blame == Blame::of_the_first ? changes_it : -1;
}

}  // namespace

horizons::LayeredBody body_of_lines(const ModelLines& lines) {
  horizons::LayeredBody body;
  body.low = lines.low;
  body.high = lines.high;
  body.base = lines.base;
  body.trace_depth = lines.reference_z;
  body.layers = {{0}};
  body.cells.at_faults = lines.strike;
  for (const ModelFault& fault : lines.faults) {
    body.faults.push_back({.name = fault.name,
                           .trace = fault.trace,
                           .first_end = end_of_trace(fault.first_end),
                           .last_end = end_of_trace(fault.last_end),
                           .profiles = mapped(fault.leans, horizons::straight_profile),
                           .top = fault.top,
                           .bottom = fault.bottom,
                           .moved = {}});
  }
  for (const ModelDivider& divider : lines.dividers)
    body.dividers.push_back({divider.name, divider.line});
  return body;
}

std::optional<Misfit> first_misfit(const ModelLines& lines, Blame blame) {
  if (const std::optional<Misfit> flat = flat_crossing(lines)) return flat;
  const std::vector<Problem> problems = problems_of(body_of_lines(lines));
  if (problems.empty()) return std::nullopt;
  Misfit last;  // the last of the faults: the shortest
  for (const Problem& problem : problems) {
    const int fault = fault_in(problem.pointer);
    const bool is_of_line = problem.pointer.find("/trace") != std::string::npos;
    if (last.what.empty() || fault > last.fault)
      last = {fault, problem.what, fault >= 0 && !is_of_line};
  }
  if (last.fault < 0) last.fault = fault_to_blame(lines, last.what, blame);
  return last;
}

}  // namespace faultsim::grid_scene
