#include "campaign/spec/metrics.h"

namespace faultsweep {

const std::vector<MetricInfo>& metric_catalogue() {
  using faultsim::Dimension;
  static const std::vector<MetricInfo> catalogue = {
      {"slides", Dimension::number, true, "slip reached the activation criterion", false,
       "activated"},
      {"activation_resolved", Dimension::number, true,
       "cells are small enough to tell whether slip reaches the criterion"},
      {"slips", Dimension::number, true, "some node slipped; mesh-dependent, a bound"},
      {"jumps", Dimension::number, true, "there are slip events"},
      {"opens", Dimension::number, true, "some node is open; open_area says how far"},
      {"activated_area", Dimension::area, false, "area that slides"},
      {"moment", Dimension::moment, false, "seismic moment M0, of slow slip and events"},
      {"magnitude_if_released_at_once", Dimension::number, false,
       "Mw that M0 would have as one event; none in plane strain", true},
      {"n_events", Dimension::number, false,
       "slip events: jumps of equilibrium that were followed"},
      {"event_moment", Dimension::moment, false, "M0 of the largest slip event; 0 without"},
      {"event_magnitude", Dimension::number, false,
       "Mw of the largest slip event; none without, or in plane strain", true},
      {"n_episodes", Dimension::number, false,
       "activation episodes of the case: runs of load steps in which a fault slips far enough"},
      {"unexpected", Dimension::number, true,
       "a fault slides after its pressure has recovered that slid before (words.md)"},
      {"plane_strain", Dimension::number, true,
       "areas, potency and moments are per metre of strike"},
      {"weakening_resolved", Dimension::number, true,
       "cells at most a third of the nucleation length where it slips: sizes of events hold"},
      {"chi_bar", Dimension::number, false,
       "critical index averaged over the activation length; mesh-independent"},
      {"chi_max", Dimension::number, false, "largest nodal critical index; mesh-dependent"},
      {"area_chi_080", Dimension::area, false, "area with critical index above 0.8"},
      {"thickness_chi_080", Dimension::length, false,
       "down-dip length with critical index above 0.8"},
      {"slipping_area", Dimension::area, false, "area slipping in one step"},
      {"open_area", Dimension::area, false, "area that is open"},
      {"max_slip", Dimension::length, false, "largest slip", false, "slip"},
      {"potency", Dimension::potency, false, "slip integrated over area"},
      {"activation_step", Dimension::number, false, "first load step in which it slides", true},
      {"activation_depth", Dimension::length, false, "where it slides first", true},
      {"activation_pressure_change", Dimension::pressure, false,
       "then, of the region beside the fault there that changed more", true},
      {"activation_pressure_absolute", Dimension::pressure, false,
       "absolute pressure of that region, at activation_depth", true},
      {"activation_change_in_fault", Dimension::pressure, false,
       "change of the fluid pressure in the fault there then", true},
      {"opening_step", Dimension::number, false, "first load step in which it is open", true},
      {"opening_depth", Dimension::length, false, "where it opens first", true},
      {"opening_pressure_change", Dimension::pressure, false,
       "then, of the region beside the fault there that changed more", true},
      {"opening_pressure_absolute", Dimension::pressure, false,
       "absolute pressure of that region, at opening_depth", true},
      {"opening_change_in_fault", Dimension::pressure, false,
       "change of the fluid pressure in the fault there then", true},
      {"pressure_margin", Dimension::pressure, false,
       "further depletion to a critical index of 1, where nothing slides or opens", true},
      {"creep_normal_min", Dimension::pressure, false,
       "creeping salt: most compressive change of normal traction by creep; none without", true},
      {"creep_normal_max", Dimension::pressure, false,
       "creeping salt: most tensile change of normal traction by creep", true},
      {"creep_shear_max", Dimension::pressure, false,
       "creeping salt: largest change of shear traction by creep", true},
      {"creep_time_steps", Dimension::number, false,
       "creeping salt: steps that the load steps were divided into", true},
      {"creep_time_error", Dimension::pressure, false,
       "creeping salt: largest change of fault traction when a time step was halved", true},
      {"creep_time_resolved", Dimension::number, true,
       "creeping salt: that change is within creep_tolerance in every step", true},
  };
  return catalogue;
}

std::string metric_unit(const MetricInfo& metric, bool plane_strain) {
  const std::string unit = faultsim::si_unit(metric.dimension);
  return plane_strain && metric.is_extensive() ? unit + "/m" : unit;
}

}  // namespace faultsweep
