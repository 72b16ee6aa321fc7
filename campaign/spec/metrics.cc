#include "campaign/spec/metrics.h"

namespace faultsweep {

const std::vector<MetricInfo>& metric_catalogue() {
  using faultsim::Dimension;
  static const std::vector<MetricInfo> catalogue = {
      {"activated", Dimension::number, true, "slip reached the activation criterion"},
      {"activated_area", Dimension::area, false, "area that slipped over the activation length"},
      {"moment", Dimension::moment, false, "seismic moment M0"},
      {"magnitude", Dimension::number, false, "Mw of the moment; none in plane strain"},
      {"n_events", Dimension::number, false,
       "slip events: jumps of equilibrium that were followed"},
      {"event_moment", Dimension::moment, false, "M0 of the largest slip event; 0 without"},
      {"event_magnitude", Dimension::number, false,
       "Mw of the largest slip event; none without, or in plane strain"},
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
      {"activation_step", Dimension::number, false, "first load step with activation"},
      {"activation_pressure", Dimension::pressure, false,
       "pressure change of the most depleted region at activation"},
      {"pressure_margin", Dimension::pressure, false,
       "further depletion to activation, of inactive cases"},
  };
  return catalogue;
}

}  // namespace faultsweep
