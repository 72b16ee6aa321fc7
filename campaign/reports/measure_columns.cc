#include "campaign/reports/measure_columns.h"

#include <array>
#include <optional>

#include "campaign/common/names.h"

namespace faultsweep {

using faultsim::Field;

namespace {

/// What a screen shows of a measure.
struct Shown {
  std::string_view key;
  const char* heading;
  int digits;
  Need need;
};
constexpr std::array kShown = {
    Shown{"activated", "slides", 4, Need::always},
    Shown{"chi_bar", "χ̄", 3, Need::always},
    Shown{"max_slip_m", "slip", 3, Need::always},
    Shown{"activated_area_m2", "sliding area", 4, Need::wanted},
    Shown{"moment_nm", "M0", 3, Need::wanted},
    Shown{"n_events", "events", 4, Need::wanted},
    Shown{"event_moment_nm", "M0 of largest event", 3, Need::extra},
    Shown{"event_magnitude_mw", "its Mw", 2, Need::extra},
    Shown{"opens", "opens", 4, Need::extra},
    Shown{"open_area_m2", "open area", 4, Need::extra},
    Shown{"chi_max", "χ max", 3, Need::extra},
    Shown{"area_chi_080_m2", "area χ > 0.8", 4, Need::extra},
};

}  // namespace

std::vector<AnswerColumn> measure_columns(bool per_metre) {
  std::vector<AnswerColumn> columns;
  const faultsim::Measures any;
  faultsim::for_each_measure(any, [&](const Field& field, const auto&) {
    const bool strike = per_metre && faultsim::is_extensive(field.key);
    const std::string key =
        concat(field.called.empty() ? field.key : field.called, strike ? "_per_m" : "");
    AnswerColumn column{key, std::string(field.metric()),
                        shown_unit(faultsim::dimension_of(field.key), strike), 4, Need::data};
    column.ranks = std::string(field.metric());
    for (const Shown& one : kShown) {
      if (one.key != field.key) continue;
      column.heading = one.heading;
      column.digits = one.digits;
      column.need = one.need;
    }
    columns.push_back(std::move(column));
  });
  return columns;
}

std::vector<AnswerCell> measure_cells(const faultsim::Measures& measures) {
  std::vector<AnswerCell> cells;
  faultsim::for_each_measure(measures,
                             [&](const Field&, const auto& value) { cells.emplace_back(value); });
  return cells;
}

std::optional<std::size_t> measure_called(std::string_view name) {
  std::optional<std::size_t> found;
  std::size_t index = 0;
  const faultsim::Measures any;
  faultsim::for_each_measure(any, [&](const Field& field, const auto&) {
    const bool is_synonym = !field.synonym.empty() && field.synonym == name;
    if (field.metric() == name || is_synonym) found = index;
    ++index;
  });
  return found;
}

}  // namespace faultsweep
