#pragma once

#include <optional>

#include "simulator/result/field.h"

namespace faultsim {

/// What is measured over the steps of a stage (or of the whole case), of one fault or of all
/// together: what cases are ranked by. Definitions: docs/model.md, section 7; words: docs/words.md.
///
/// A new one is a member and an entry below with `since` the store's next version, and its value in
/// measures/stage_summary.cc; on what it depends that cells may leave open says
/// campaign/store/metric_columns.cc. JSON, wire, store, views, rank, export and compare follow.
struct Measures {
  bool activated = false;  ///< *slides*: slip since the start of the stage (whole case: since
                           ///< start) reaches the criterion.
  bool activation_resolved =
      true;                   ///< for certain, or certainly not: does not depend on the cells.
  bool slips = false;         ///< some node: mesh-dependent, a bound.
  bool opens = false;         ///< some node, in one of the steps.
  double activated_area = 0;  ///< m2, at its maximum over steps, sum over faults.
  double moment = 0;          ///< M0, N m, at the end (stage: summed over its steps).
  int n_events = 0;           ///< *jumps*; of a fault: that nucleated on it.
  double event_moment = 0;    ///< N m, of the largest event, over all faults that moved.
  std::optional<double> event_magnitude;    ///< its Mw; none without, or in plane strain.
  std::optional<double> event_stress_drop;  ///< Pa, its drop of shear traction; none without.
  double chi_bar = 0;                       ///< maximum over faults and steps.
  double chi_max = 0;                       ///< the same; mesh-dependent.
  double area_chi_080 = 0;                  ///< m2, maximum over steps of the sum over faults.
  double thickness_chi_080 = 0;             ///< m, maximum over faults and steps.
  double slipping_area = 0;                 ///< m2, maximum over steps of the sum over faults.
  double open_area = 0;                     ///< m2, the same.
  double max_slip = 0;                      ///< m, maximum over faults and steps, within the stage.
  double potency = 0;                       ///< m3, at the end, since the start.

  bool operator==(const Measures&) const = default;  ///< the very same numbers.
};

/// visit(Field, value) for each, in the order in which they are listed to users.
void for_each_measure(auto& m, auto&& visit) {
  visit(Field{.key = "activated",
              .meaning = "slip reached the activation criterion",
              .called = "slides",
              .synonym = "activated"},
        m.activated);
  visit(Field{.key = "activation_resolved",
              .meaning = "cells are small enough to tell whether slip reaches the criterion",
              .sql = "coalesce($.activation_resolved, 0)"},
        m.activation_resolved);
  visit(Field{.key = "slips",
              .meaning = "some node slipped; mesh-dependent, a bound",
              .sql = "($.max_slip_m > 0)"},
        m.slips);
  visit(Field{.key = "opens",
              .meaning = "some node is open; open_area says how far",
              .sql = "($.open_area_m2 > 0)"},
        m.opens);
  visit(Field{.key = "activated_area_m2", .meaning = "area that slides"}, m.activated_area);
  visit(Field{.key = "moment_nm", .meaning = "seismic moment M0, of slow slip and events"},
        m.moment);
  visit(Field{.key = "n_events", .meaning = "slip events: jumps of equilibrium that were followed"},
        m.n_events);
  visit(Field{.key = "event_moment_nm",
              .meaning = "M0 of the largest slip event; 0 if there is none"},
        m.event_moment);
  visit(Field{.key = "event_magnitude_mw",
              .meaning = "Mw of the largest slip event; none without events, or in plane strain"},
        m.event_magnitude);
  visit(Field{.key = "event_stress_drop_pa",
              .meaning =
                  "stress drop of the largest slip event, weighted by slip; none without events",
              .since = 12},
        m.event_stress_drop);
  visit(Field{.key = "chi_bar",
              .meaning = "critical index averaged over the activation length; mesh-independent"},
        m.chi_bar);
  visit(Field{.key = "chi_max", .meaning = "largest nodal critical index; mesh-dependent"},
        m.chi_max);
  visit(Field{.key = "area_chi_080_m2", .meaning = "area with critical index above 0.8"},
        m.area_chi_080);
  visit(Field{.key = "thickness_chi_080_m",
              .meaning = "down-dip length with critical index above 0.8"},
        m.thickness_chi_080);
  visit(Field{.key = "slipping_area_m2", .meaning = "area slipping in one step"}, m.slipping_area);
  visit(Field{.key = "open_area_m2", .meaning = "area that is open"}, m.open_area);
  visit(Field{.key = "max_slip_m", .meaning = "largest slip", .synonym = "slip"}, m.max_slip);
  visit(Field{.key = "potency_m3", .meaning = "slip integrated over area"}, m.potency);
}

}  // namespace faultsim
