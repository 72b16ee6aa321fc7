#include "simulator/case_figures/painted_section.h"

#include <algorithm>
#include <cmath>

#include "simulator/case_figures/chosen.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/figure/axis.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

namespace faultsim::case_figures {
namespace {

using figure::plain_number;

/// Where the section lies along the faults, and in words why there.
struct SectionPlace {
  double y = 0;  ///< m.
  std::string why;
};

/// y on a fault, within what one of the blocks beside it covers.
double beside_a_block(const FieldGeometry& field, std::size_t fault, double y) {
  constexpr double kInside = 0.5;  // m: half of what a section at y is wide
  double nearest = HUGE_VAL;
  for (const Block& block : blocks_beside(field, fault)) {
    const StrikeInterval ends = block_ends(field, block);
    const double inset = std::min(kInside, ends.length() / 2), from = ends.from + inset;
    const double at = std::clamp(y, from, std::max(from, ends.to - inset));
    if (std::abs(at - y) < std::abs(nearest - y)) nearest = at;
  }
  return nearest;
}

/// The line on which χ is largest in the whole case; none where its fields were not kept.
std::optional<SectionPlace> critical_line(const CasePicture& picture) {
  const CriticalMoment moment = critical_moment(picture.result);
  Chosen chosen{picture, {}, moment.fault, moment.step};
  const FieldSource* file = picture.fields;
  if (file == nullptr || file->steps().empty()) return std::nullopt;
  const auto f = place_of(mapped(file->faults(), &StoredFault::name), chosen.fault_name());
  if (!f || !contains(file->faults()[*f].split, 1)) return std::nullopt;
  const StoredFault& fault = file->faults()[*f];
  const auto most = most_critical(fault, file->critical_index(*f, stored_entry(chosen)));
  const double y = fault.points(1, static_cast<Eigen::Index>(most));
  return SectionPlace{beside_a_block(picture.scene.field, chosen.fault, y),
                      concat(", where χ of ", chosen.fault_name(), " is largest")};
}

SectionPlace place_of_section(const CasePicture& picture) {
  if (picture.result.plane_strain) return {painted_load(picture.scene).y, ""};
  return critical_line(picture).value_or(SectionPlace{0, ", the middle"});
}

/// What is painted, and its unit.
struct Quantity {
  bool is_pressure;
  double unit() const { return is_pressure ? kBarInPascal : 1; }
  const char* label() const { return is_pressure ? "Δp, bar" : "ΔT, K"; }
  const char* name() const { return is_pressure ? "pressure" : "temperature"; }
  const char* plural() const { return is_pressure ? "pressures" : "temperatures"; }
  bool operator==(const Quantity&) const = default;
};

Quantity quantity_of(const CasePicture& picture) {
  return {picture.scene.pressure_field.is_given()};
}

bool is_painted(const CasePicture& picture) {
  return picture.scene.geometry_kind == GeometryKind::field &&
         painted_load(picture.scene).is_given() && n_steps_of(picture.result) > 0;
}

/// Widens the scale to hold a case's changes at all its load steps.
void hold_all(const SectionPressures& pressures, const CaseResult& result, double unit,
              figure::FaceColours& colours) {
  for (std::size_t k = 0; k < n_steps_of(result); ++k) {
    for (std::size_t b = 0; b < pressures.n_blocks(); ++b) {
      if (!pressures.reaches(b)) continue;
      for (const double change : pressures.at(b, result.steps[k].time)) colours.hold(change / unit);
    }
  }
}

std::string metres(double length) { return plain_number(length, 4) + " m"; }

/// "not painted, as they end along the faults before the section: east"; "" where none does.
std::string ended_words(const Scene& scene, const SectionPressures& pressures) {
  std::vector<std::string> names;
  for (std::size_t b = 0; b < pressures.n_blocks(); ++b)
    if (!pressures.reaches(b)) names.push_back(scene.field.blocks[b].name);
  if (names.empty()) return "";
  return concat("not painted, as ", names.size() == 1 ? "it ends" : "they end",
                " along the faults before the section: ", joined(names, ", "));
}

std::vector<std::string> words_of(const CasePicture& picture, const SectionPlace& place,
                                  const SectionPressures& pressures, bool has_original) {
  const FlowLoad& load = painted_load(picture.scene);
  const Quantity quantity = quantity_of(picture);
  if (pressures.n_all() == 0)
    return {concat("nothing is painted: no block reaches y = ", metres(place.y), place.why)};
  if (pressures.n_covered() == 0) {
    return {concat("nothing is painted: the flow grid does not reach the reservoirs at y = ",
                   metres(place.y), place.why)};
  }
  const double since = load.field->date[static_cast<std::size_t>(load.reference)];
  std::vector<std::string> words = {
      concat("in reservoirs: change of the flow result's ", quantity.name(), " since ",
             date_text(since), " (negative: it fell), at y = ", metres(place.y), place.why),
      concat("means over pieces of at most ", plain_number(pressures.width()), " m × ",
             plain_number(pressures.height()), " m; ", same_scale_words(picture, has_original))};
  if (load.integral == IntegralRule::flow_grid)
    words.emplace_back("before scaling to the integrals of the flow grid; what acts is scaled");
  if (const std::string ended = ended_words(picture.scene, pressures); !ended.empty())
    words.push_back(ended);
  if (pressures.n_covered() < pressures.n_all()) {
    words.push_back(
        concat("hatched: pieces of which less than half lies in the flow grid; beyond it ",
               load.outside == OutsideRule::nearest ? "the nearest flow cell's change acts"
                                                    : concat(quantity.plural(), " do not change")));
  }
  return words;
}

}  // namespace

PaintedSection::PaintedSection(const CasePicture& picture) {
  if (!is_painted(picture)) return;
  painted_.emplace();
  const Quantity quantity = quantity_of(picture);
  unit_ = quantity.unit();
  const SectionPlace place = place_of_section(picture);
  try {
    pressures_.emplace(picture.scene, place.y);
    figure::FaceColours& colours = painted_->colours;
    colours.kind = figure::FaceColours::Kind::change;
    if (pressures_->n_covered() > 0) colours.label = quantity.label();
    hold_all(*pressures_, picture.result, unit_, colours);
    const bool has_original = picture.original != nullptr && is_painted(*picture.original) &&
                              quantity_of(*picture.original) == quantity;
    if (has_original) {
      const CasePicture& original = *picture.original;
      hold_all({original.scene, place_of_section(original).y}, original.result, unit_, colours);
    }
    painted_->words = words_of(picture, place, *pressures_, has_original);
  } catch (const InputError& error) {
    pressures_.reset();
    painted_ = figure::Section::Painted{
        {}, {concat(quantity.plural(), " are not painted: ", error.problems().front().what)}};
  }
}

void PaintedSection::paint(double time, figure::Section& section) const {
  section.painted = painted_;
  if (!pressures_) return;
  std::size_t block = 0;  // reservoirs stand in the order of their blocks
  for (figure::Section::Rock& rock : section.rocks) {
    if (!rock.is_reservoir) continue;
    rock.pieces.clear();
    const std::size_t b = block++;
    if (!pressures_->reaches(b)) continue;
    const std::vector<double> change = pressures_->at(b, time);
    for (std::size_t k = 0; k < change.size(); ++k)
      rock.pieces.push_back({pressures_->corners(b, k), change[k] / unit_});
  }
}

}  // namespace faultsim::case_figures
