#include <algorithm>
#include <cmath>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/depth_chart.h"

namespace faultsim::case_figures {

namespace {

using figure::plain_number;

/// What is drawn against depth, in the units of the columns.
struct Profile {
  std::vector<double> depth, pressure, normal, shear, strength, chi, slip;
};

/// Along the line down dip through a point.
Profile profile_through(Eigen::Index point, const StoredFault& fault, const DipLines& lines,
                        const StoredFields& now, const CoulombLaw& friction) {
  Profile line;
  for (const DipCrossing& at : split_line(fault, lines, point)) {
    const auto mean = [&](auto value) {
      return (1 - at.share) * value(at.from) + at.share * value(at.to);
    };
    line.depth.push_back(-at.place.z());
    line.pressure.push_back(mean([&](int k) { return now.fault_pressure_change[k]; }) /
                            kBarInPascal);
    line.normal.push_back(-mean([&](int k) { return now.traction(0, k); }) / kMegapascal);
    line.shear.push_back(mean([&](int k) { return shear_at(now, k); }) / kMegapascal);
    line.strength.push_back(mean([&](int k) {
                              return friction.cohesion -
                                     std::min(now.traction(0, k), 0.0) *
                                         std::tan(friction.static_friction_angle);
                            }) /
                            kMegapascal);
    line.chi.push_back(mean([&](int k) { return now.critical_index[k]; }));
    line.slip.push_back(mean([&](int k) { return std::hypot(now.slip(1, k), now.slip(2, k)); }) /
                        kMillimetre);
  }
  return line;
}

/// Of the case before the change: at the same load step, on the line that is nearest to a place.
/// @param along  where that is along strike, m.  @param says  of the lines, for the remark.
Profile original_profile(const Chosen& chosen, std::size_t entry, const Eigen::Vector3d& place,
                         double along, std::string& says) {
  const auto known = original_fault(chosen);
  const auto before = known ? original_entry(chosen, entry) : std::nullopt;
  says = words_of_original(chosen.picture, before.has_value());
  if (!before) return {};
  const FieldSource& file = *chosen.picture.original->fields;
  const StoredFault& fault = file.faults()[known->fault];
  const auto nearest = nearest_split(fault, place);
  if (!nearest) return {};
  const DipLines lines = dip_lines(fault);
  const double at = lines.along(static_cast<int>(*nearest));
  if (std::abs(at - along) > kSamePlace)
    says = words_of_original(chosen.picture, true,
                             concat("at ", plain_number(at, 4), " m along strike"));
  return profile_through(*nearest, fault, lines, file.fields(known->fault, *before),
                         known->friction);
}

}  // namespace

std::string draw_profiles(Chosen chosen) {
  const std::size_t f = stored_fault(chosen), entry = stored_entry(chosen);
  const StoredFault& fault = chosen.picture.fields->faults()[f];
  const StoredFields stored = chosen.picture.fields->fields(f, entry);
  const auto most = static_cast<Eigen::Index>(most_critical(fault, stored.critical_index));
  const DipLines lines = dip_lines(fault);
  const double along = lines.along(static_cast<int>(most));
  const Profile now =
      profile_through(most, fault, lines, stored, chosen.scene().faults[chosen.fault].friction);
  std::string says_before;
  const Profile before =
      original_profile(chosen, entry, fault.points.col(most), along, says_before);
  const auto curve = [&](const char* name, std::size_t colour, std::vector<double> Profile::*what) {
    return figure::Curve{name, colour, now.*what, {}, {}, before.*what};
  };
  figure::DepthChart chart;
  chart.depth = now.depth;
  chart.depth_before = before.depth;
  chart.title = concat("Fault ", chosen.fault_name(), " against depth: ", moment_text(chosen));
  chart.remark =
      concat(says_before, subject_of(chosen.picture),
             chosen.result().plane_strain ? ""
                                          : concat("; line down dip at ", plain_number(along, 4),
                                                   " m ", along_strike_words(lines)));
  chart.bands = compartments_beside(chosen.scene(), chosen.fault);
  chart.columns = {
      {"Δp in the fault, bar", {curve("", 0, &Profile::pressure)}, {}, {0}},
      {"σ'ₙ, MPa (compression +)", {curve("", 0, &Profile::normal)}, {}, {0}},
      {"shear, MPa",
       {curve("|τ|", 0, &Profile::shear), curve("strength before slip", 1, &Profile::strength)},
       {},
       {0}},
      {"χ", {curve("", 0, &Profile::chi)}, {{0.8, ""}, {1, ""}}, {0, 1}},
      {"slip, mm", {curve("", 0, &Profile::slip)}, {}, {0, 1}}};
  return figure::draw(chart);
}

}  // namespace faultsim::case_figures
