#include <algorithm>
#include <cmath>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/depth_chart.h"

namespace faultsim::case_figures {

using figure::plain_number;

std::string draw_profiles(Chosen chosen) {
  const std::size_t f = stored_fault(chosen), entry = stored_entry(chosen);
  const StoredFault& fault = chosen.picture.fields->faults()[f];
  const StoredFields now = chosen.picture.fields->fields(f, entry);
  const double y = fault.points(1, static_cast<Eigen::Index>(most_critical(fault, now)));
  const CoulombLaw& friction = chosen.scene().faults[chosen.fault].friction;
  figure::DepthChart chart;
  figure::Curve pressure{"", 0, {}}, normal{"", 0, {}}, shear{"|τ|", 0, {}},
      strength{"strength before slip", 1, {}}, chi{"", 0, {}}, slip{"", 0, {}};
  for (const std::size_t i : column_through(fault, y)) {
    const auto k = static_cast<Eigen::Index>(i);
    chart.depth.push_back(-fault.points(2, k));
    pressure.values.push_back(now.fault_pressure_change[k] / kBarInPascal);
    normal.values.push_back(-now.traction(0, k) / kMegapascal);
    shear.values.push_back(shear_at(now, k) / kMegapascal);
    strength.values.push_back((friction.cohesion - std::min(now.traction(0, k), 0.0) *
                                                       std::tan(friction.static_friction_angle)) /
                              kMegapascal);
    chi.values.push_back(now.critical_index[k]);
    slip.values.push_back(std::hypot(now.slip(1, k), now.slip(2, k)) / kMillimetre);
  }
  chart.title = concat("Fault ", chosen.fault_name(), " against depth: ", moment_text(chosen));
  chart.remark = subject_of(chosen.picture) +
                 (chosen.result().plane_strain
                      ? ""
                      : concat("; line down dip at ", plain_number(y, 4), " m along strike"));
  chart.bands = compartments_beside(chosen.scene(), chosen.fault);
  chart.columns = {{"Δp in the fault, bar", {pressure}, {}, {0}},
                   {"σ'ₙ, MPa (compression +)", {normal}, {}, {0}},
                   {"shear, MPa", {shear, strength}, {}, {0}},
                   {"χ", {chi}, {{0.8, ""}, {1, ""}}, {0, 1}},
                   {"slip, mm", {slip}, {}, {0, 1}}};
  return figure::draw(chart);
}

}  // namespace faultsim::case_figures
