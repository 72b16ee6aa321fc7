#include "campaign/spec/metrics.h"

#include <type_traits>

#include "campaign/common/names.h"
#include "simulator/result/measures.h"

namespace faultsweep {

namespace {

/// What follows from several fields, or is of the case.
const std::vector<MetricInfo>& other_metrics() {
  static const std::vector<MetricInfo> metrics = {
      {"jumps", Dimension::number, true, "there are slip events"},
      {"magnitude_if_released_at_once", Dimension::number, false,
       "Mw that M0 would have as one event; none in plane strain", true},
      {"n_episodes", Dimension::number, false,
       "activation episodes of the case: runs of load steps in which a fault slips far enough"},
      {"unexpected", Dimension::number, true,
       "a fault that slid before slides again after its pressure has recovered (docs/words.md)"},
      {"plane_strain", Dimension::number, true,
       "areas, potency and moments are per metre of strike"},
      {"weakening_resolved", Dimension::number, true,
       "cells are at most a third of the nucleation length where it slips: sizes of events are "
       "valid"},
      {"interpolated", Dimension::number, true,
       "its operator is interpolated between exact ones (an operator surface)"},
      {"surface_error", Dimension::number, false,
       "largest relative error measured for that, of slip without friction; none for exact "
       "operators",
       true},
      {"field_coverage", Dimension::number, false,
       "share of the compartments that its flow result covers; none without one", true},
      {"field_assumed", Dimension::number, false,
       "share of the integral of the change that is assumed beyond its cover; none without one",
       true},
      {"activation_step", Dimension::number, false, "first load step in which it slides", true},
      {"activation_depth", Dimension::length, false, "where it slides first", true},
      {"activation_pressure_change", Dimension::pressure, false,
       "pressure change then, in the region beside the fault there that changed more", true},
      {"activation_pressure_absolute", Dimension::pressure, false,
       "absolute pressure of that region, at activation_depth", true},
      {"activation_change_before", Dimension::pressure, false,
       "that region's last change at which it was found not to slide yet, where that was searched "
       "for within the load step (activation_tolerance)",
       true},
      {"activation_change_in_fault", Dimension::pressure, false,
       "change of the fluid pressure in the fault, there and then", true},
      {"opening_step", Dimension::number, false, "first load step in which it is open", true},
      {"opening_depth", Dimension::length, false, "where it opens first", true},
      {"opening_pressure_change", Dimension::pressure, false,
       "pressure change then, in the region beside the fault there that changed more", true},
      {"opening_pressure_absolute", Dimension::pressure, false,
       "absolute pressure of that region, at opening_depth", true},
      {"opening_change_in_fault", Dimension::pressure, false,
       "change of the fluid pressure in the fault, there and then", true},
      {"pressure_margin", Dimension::pressure, false,
       "further depletion (with a flow field: on average) to a critical index of 1, where nothing "
       "slides or opens",
       true},
      {"creep_normal_min", Dimension::pressure, false,
       "creeping salt: most compressive change of normal traction by creep; none without creep",
       true},
      {"creep_normal_max", Dimension::pressure, false,
       "creeping salt: most tensile change of normal traction by creep", true},
      {"creep_shear_max", Dimension::pressure, false,
       "creeping salt: largest change of shear traction by creep", true},
      {"creep_time_steps", Dimension::number, false,
       "creeping salt: steps into which the load steps were divided", true},
      {"creep_time_error", Dimension::pressure, false,
       "creeping salt: largest change of fault traction when a time step was halved", true},
      {"creep_time_resolved", Dimension::number, true,
       "creeping salt: that change is within creep_tolerance in every step", true},
  };
  return metrics;
}

}  // namespace

const std::vector<MetricInfo>& metric_catalogue() {
  static const std::vector<MetricInfo> catalogue = [] {
    std::vector<MetricInfo> all;
    const faultsim::Measures measures;
    faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto& value) {
      using Member = std::remove_cvref_t<decltype(value)>;
      all.push_back({std::string(field.metric()), faultsim::dimension_of(field.key),
                     std::is_same_v<Member, bool>, std::string(field.meaning),
                     !std::is_arithmetic_v<Member>, std::string(field.synonym)});
    });
    all.insert(all.end(), other_metrics().begin(), other_metrics().end());
    return all;
  }();
  return catalogue;
}

std::string metric_unit(const MetricInfo& metric, bool plane_strain) {
  const std::string unit = faultsim::si_unit(metric.dimension);
  return plane_strain && metric.is_extensive() ? unit + "/m" : unit;
}

}  // namespace faultsweep
