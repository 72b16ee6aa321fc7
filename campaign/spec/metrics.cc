#include "campaign/spec/metrics.h"

namespace faultsweep {

const std::vector<MetricInfo>& metric_catalogue() {
  using faultsim::Dimension;
  static const std::vector<MetricInfo> catalogue = {
      {"activated", Dimension::number, true, "slip reached the activation criterion"},
      {"activated_area", Dimension::area, false, "area that slipped over the activation length"},
      {"moment", Dimension::moment, false, "seismic moment M0"},
      {"magnitude", Dimension::number, false, "Mw of the moment; none in plane strain", true},
      {"n_events", Dimension::number, false,
       "slip events: jumps of equilibrium that were followed"},
      {"event_moment", Dimension::moment, false, "M0 of the largest slip event; 0 without"},
      {"event_magnitude", Dimension::number, false,
       "Mw of the largest slip event; none without, or in plane strain", true},
      {"n_episodes", Dimension::number, false,
       "activation episodes of the case: runs of load steps in which a fault slips far enough"},
      {"unexpected", Dimension::number, true,
       "activated again as pressure recovers, after an activation on the way down"},
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
      {"max_slip", Dimension::length, false, "largest slip"},
      {"potency", Dimension::potency, false, "slip integrated over area"},
      {"activation_step", Dimension::number, false, "first load step with activation", true},
      {"activation_pressure", Dimension::pressure, false,
       "pressure change of the most depleted region at activation", true},
      {"pressure_margin", Dimension::pressure, false,
       "further depletion to activation, of inactive cases", true},
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

}  // namespace faultsweep
