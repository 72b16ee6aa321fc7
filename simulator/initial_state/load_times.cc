#include "simulator/initial_state/load_times.h"

#include <algorithm>

#include "simulator/common/text.h"
#include "simulator/common/units.h"

namespace faultsim {
namespace {

/// Extremes of the piecewise linear function through (x, y); its two ends are none.
void add_extremes(const std::vector<double>& x, const std::vector<double>& y,
                  const TurningPoint& like, std::vector<TurningPoint>& points) {
  int direction = 0;        // of the last piece that was not level
  std::size_t reached = 0;  // where that piece ended
  for (std::size_t i = 1; i < y.size(); ++i) {
    const int now = (y[i] > y[i - 1] ? 1 : 0) - (y[i] < y[i - 1] ? 1 : 0);
    if (now == 0) continue;
    if (direction == -now) {
      TurningPoint point = like;
      point.from = x[reached];
      point.to = x[i - 1];
      point.value = y[reached];
      points.push_back(point);
    }
    direction = now;
    reached = i;
  }
}

/// Δp(t) = scale · h(t − lag), with h = 0 at time 0.
void add_history(const PressureHistory& history, std::vector<TurningPoint>& points) {
  if (history.scale == 0 || history.time.empty()) return;
  std::vector<double> x, y;
  if (history.time.front() > 0) {
    x.push_back(history.lag);
    y.push_back(0);
  }
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    x.push_back(history.time[i] + history.lag);
    y.push_back(history.scale * history.pressure_change[i]);
  }
  add_extremes(x, y, {.load = "the pressure of " + history.region}, points);
}

/// Base times of the stages, without looking at any load.
std::vector<StepEnd> equal_steps(const Scene& scene) {
  std::vector<StepEnd> ends;
  double start = 0;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const Stage& stage = scene.stages[i];
    for (int k = 1; k <= stage.n_steps; ++k) {
      ends.push_back(
          {i, start + stage.duration * k / stage.n_steps, stage.duration / stage.n_steps, false});
    }
    start += stage.duration;
  }
  return ends;
}

/// The points that no step meets, each with the step that it lies in.
struct Unmet {
  std::size_t step;
  TurningPoint point;
};
std::vector<Unmet> unmet(const std::vector<StepEnd>& ends,
                         const std::vector<TurningPoint>& points) {
  std::vector<Unmet> result;
  double last = 0;  // s, of the point taken last: it becomes a step, which may meet others
  for (const TurningPoint& point : points) {
    const auto next = std::ranges::lower_bound(ends, point.from, {}, &StepEnd::time);
    if (next == ends.end()) break;
    const double near = kMetShare * next->length;
    const double before = next == ends.begin() ? 0 : std::prev(next)->time;
    if (next->time <= point.to + near || std::max(before, last) >= point.from - near) continue;
    result.push_back({static_cast<std::size_t>(next - ends.begin()), point});
    last = point.from;
  }
  return result;
}

std::string number_text(double value) { return formatted("%.6g", value); }

}  // namespace

std::vector<TurningPoint> turning_points(const Scene& scene) {
  std::vector<TurningPoint> points;
  for (const PressureHistory& history : scene.pressure) add_history(history, points);
  for (const Fault& fault : scene.faults) {
    const FaultPressure& pressure = fault.pressure;
    for (const double time : pressure.profile.turns) {
      points.push_back({.load = "the fault pressure of " + fault.name,
                        .from = time,
                        .to = time,
                        .is_report = true});
    }
    if (pressure.rule != FaultPressureRule::prescribed || pressure.prescribed == 0) continue;
    add_extremes(pressure.table.time, pressure.table.factor,
                 {.load = "the table of the fault pressure of " + fault.name,
                  .dimension = Dimension::number},
                 points);
  }
  for (std::size_t i = 0; i < scene.box.boundary.size(); ++i) {
    const BoundaryCondition& condition = scene.box.boundary[i];
    add_extremes(
        condition.table.time, condition.table.factor,
        {.load = "the table of boundary " + std::to_string(i), .dimension = Dimension::number},
        points);
  }
  for (const TemperatureHistory& history : scene.temperature) {
    const auto region = static_cast<std::size_t>(history.region);
    add_extremes(history.time, history.change,
                 {.load = "the temperature of " + scene.pressure[region].region,
                  .dimension = Dimension::temperature},
                 points);
  }
  for (const auto& [name, field] : {std::pair{"the pressure field", &scene.pressure_field},
                                    std::pair{"the temperature field", &scene.temperature_field}}) {
    for (const double time : field->time)
      points.push_back({.load = name, .from = time, .to = time, .is_report = true});
  }
  const double end = end_time(scene);
  std::erase_if(points, [&](const TurningPoint& p) { return p.to <= 0 || p.from >= end; });
  std::ranges::stable_sort(points, {}, &TurningPoint::from);
  return points;
}

double end_time(const Scene& scene) {
  double end = 0;
  for (const Stage& stage : scene.stages) end += stage.duration;
  return end;
}

std::vector<StepEnd> step_ends(const Scene& scene) {
  std::vector<StepEnd> ends = equal_steps(scene);
  if (scene.numerics.turning_points == TurningPoints::report) return ends;
  const std::vector<Unmet> cuts = unmet(ends, turning_points(scene));
  if (cuts.empty()) return ends;
  std::vector<StepEnd> all;
  auto cut = cuts.begin();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    StepEnd rest = ends[i];
    double start = i == 0 ? 0 : ends[i - 1].time;
    for (; cut != cuts.end() && cut->step == i; ++cut) {
      all.push_back({rest.stage, cut->point.from, cut->point.from - start, true});
      start = cut->point.from;
      rest.length = rest.time - start;
    }
    all.push_back(rest);
  }
  return all;
}

std::vector<TurningPoint> skipped_turning_points(const Scene& scene) {
  std::vector<TurningPoint> points;
  if (scene.numerics.turning_points != TurningPoints::report) return points;
  for (const TurningPoint& point : turning_points(scene)) {
    // One by one: a point that is skipped does not become a step that meets the next.
    if (!unmet(equal_steps(scene), {point}).empty()) points.push_back(point);
  }
  return points;
}

std::string turning_point_text(const TurningPoint& point) {
  const std::string when = number_text(from_si(point.from, Dimension::time, "year")) + " year";
  if (point.is_report) return point.load + " turns at " + when;
  const std::string value =
      point.dimension == Dimension::number
          ? number_text(point.value)
          : number_text(from_si(point.value, point.dimension, usual_unit(point.dimension))) + " " +
                usual_unit(point.dimension);
  return point.load + " reaches " + value + " at " + when;
}

}  // namespace faultsim
