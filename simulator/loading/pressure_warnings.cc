#include "simulator/loading/pressure_warnings.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/loads/history.h"

namespace faultsim {
namespace {

constexpr double kRounding = 1;  // Pa: "back to the initial pressure" is written in decimal units

std::string bar(double pascal) { return formatted("%.1f bar", pascal / 1e5); }
std::string years(double seconds) {
  return formatted("%.4g year", from_si(seconds, Dimension::time, "year"));
}
std::string metres(double value) { return formatted("%.0f m", value); }

/// Where a pressure acts and is judged.
struct Place {
  FaultPlace at;
  double initial = 0;  ///< Pa, before production.
  double least = 0;    ///< Pa, least total principal stress.
};

/// The largest value so far, and where and when it was.
struct Worst {
  double value = kRounding;
  double pressure = 0;  ///< Pa, reached.
  const Place* place = nullptr;
  const LoadStep* step = nullptr;
  void see(double now, double reached, const Place& where, const LoadStep& when) {
    if (!(now > value)) return;
    *this = {now, reached, &where, &when};
  }
};

class PressureWarnings {
 public:
  explicit PressureWarnings(const Scene& scene) : scene_(scene), steps_(load_steps(scene)) {}

  std::vector<std::string> all() {
    for (std::size_t r = 0; r < scene_.pressure.size(); ++r) region(r);
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) fault(f);
    return std::move(texts_);
  }

 private:
  void region(std::size_t r) {
    const std::vector<double>& changes = scene_.pressure[r].pressure_change;
    if (changes.empty()) return;  // a flow result's
    const DepthInterval depths = depths_of_region(scene_, r);
    std::vector<Place> places;
    for (const double depth : {depths.top, depths.bottom}) {
      const DepthSide side = depth == depths.top ? DepthSide::below : DepthSide::above;
      places.push_back({{.depth = depth, .side = side},
                        initial_region_pressure(scene_, r, depth),
                        least_stress(scene_, depth, side)});
    }
    judge("the pressure of " + scene_.pressure[r].region, places,
          [&](const FaultPlace&, double time) {
            return pressure_change_at(scene_.pressure[r], time);
          });
  }

  void fault(std::size_t f) {
    if (!may_rise(scene_.faults[f].pressure)) return;
    std::vector<Place> places;
    for (const FaultPlace& at : given_pressure_places(scene_, f)) {
      places.push_back({at, initial_state(scene_, -at.depth, at.side).pressure,
                        least_stress(scene_, at.depth, at.side)});
    }
    const std::string& name = scene_.faults[f].name;
    const bool is_table = scene_.faults[f].pressure.rule == FaultPressureRule::table;
    judge(is_table ? "the pressure of fault " + name + " from its table"
                   : "the prescribed pressure of fault " + name,
          places, [&](const FaultPlace& at, double time) {
            return given_pressure_change(scene_, f, at, time);
          });
  }

  /// Spares long tables of depletion.
  static bool may_rise(const FaultPressure& law) {
    const std::vector<double>& values = law.profile.change;
    return law.rule != FaultPressureRule::table ||
           std::ranges::any_of(values, [](double v) { return v > kRounding; });
  }

  template <typename Change>
  void judge(const std::string& of, const std::vector<Place>& places, const Change& change) {
    Worst rise, excess;
    for (const LoadStep& step : steps_) {
      for (const Place& place : places) {
        const double now = change(place.at, step.time), reached = place.initial + now;
        rise.see(now, reached, place, step);
        excess.see(reached - place.least, reached, place, step);
      }
    }
    if (rise.step == nullptr) return;
    const auto where = [](const Worst& worst) {
      return concat(bar(worst.pressure), " at ", metres(worst.place->at.depth),
                    " depth in load step ", worst.step->step, " (", worst.step->stage, ", after ",
                    years(worst.step->time), ")");
    };
    texts_.push_back(concat(of, " rises to ", where(rise), ", ", bar(rise.value),
                            " above the initial one of ", bar(rise.place->initial)));
    if (excess.step == nullptr) return;
    texts_.push_back(concat(of, " reaches ", where(excess),
                            ", above the least total principal stress of ",
                            bar(excess.place->least),
                            " there before production: rock would fracture, which is not "
                            "modelled"));
  }

  const Scene& scene_;
  std::vector<LoadStep> steps_;
  std::vector<std::string> texts_;
};

}  // namespace

std::vector<std::string> pressure_warnings(const Scene& scene) {
  return PressureWarnings(scene).all();
}

}  // namespace faultsim
