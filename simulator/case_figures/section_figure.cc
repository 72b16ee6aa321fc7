#include <algorithm>
#include <string_view>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/painted_section.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/palette.h"
#include "simulator/figure/section.h"

namespace faultsim {
namespace case_figures {
namespace {

using figure::plain_number;

/// Pieces of a fault's line with their χ, from the fields on the line through the most critical
/// point; false where they were not kept.
bool colour_by_fields(const Chosen& chosen, std::size_t fault, figure::Section::FaultLine& line) {
  const FieldSource* file = chosen.picture.fields;
  if (file == nullptr) return false;
  const int step = chosen.result().steps[chosen.step].step;
  const auto entry = std::ranges::find(file->steps(), step);
  if (entry == file->steps().end()) return false;
  for (std::size_t f = 0; f < file->faults().size(); ++f) {
    const StoredFault& stored = file->faults()[f];
    if (stored.name != chosen.result().fault_names[fault]) continue;
    const Eigen::VectorXd chi =
        file->critical_index(f, static_cast<std::size_t>(entry - file->steps().begin()));
    const auto most = static_cast<Eigen::Index>(most_critical(stored, chi));
    const std::vector<std::size_t> column = column_through(stored, stored.points(1, most));
    if (column.size() < 2) return false;
    line.points.clear();
    for (std::size_t i = 0; i < column.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(column[i]);
      line.points.push_back({stored.points(0, k), -stored.points(2, k)});
      if (i == 0) continue;
      line.chi.push_back(std::max(chi[static_cast<Eigen::Index>(column[i - 1])], chi[k]));
    }
    return true;
  }
  return false;
}

/// "Δp −160 bar" of a compartment at a step, "mean Δp" of a flow result; "" where its pressure is
/// not given.
std::string pressure_note(const Chosen& chosen, const StepResult& step, const std::string& name) {
  const CaseResult& result = chosen.result();
  const char* quantity = chosen.scene().pressure_field.is_given() ? "mean Δp " : "Δp ";
  for (std::size_t r = 0; r < result.region_names.size(); ++r) {
    if (result.region_names[r] != name || r >= step.pressure_change.size()) continue;
    return quantity + plain_number(step.pressure_change[r] / kBarInPascal) + " bar";
  }
  return "";
}

/// The section with χ and pressures of the step. @return whether all χ are those of fields.
bool fill_section(const Chosen& chosen, figure::Section& section) {
  const StepResult& step = chosen.result().steps[chosen.step];
  bool all_fields = true;
  for (std::size_t f = 0; f < section.faults.size() && f < step.faults.size(); ++f) {
    if (colour_by_fields(chosen, f, section.faults[f])) continue;
    section.faults[f].chi = {step.faults[f].chi_bar};
    all_fields = false;
  }
  for (figure::Section::Rock& rock : section.rocks) {
    if (rock.is_reservoir) rock.note = pressure_note(chosen, step, rock.name);
  }
  return all_fields;
}

/// A part of a scale, as scripts read it.
char digit_of(std::size_t part) {
  constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuvwxyz";
  static_assert(figure::kPaintedParts <= kDigits.size() && figure::kChiParts <= kDigits.size());
  return kDigits[part];
}

/// StepLook::painted of a reservoir.
std::string painted_text(const figure::Section::Rock& rock, const figure::FaceColours& colours) {
  std::string text;
  for (const figure::Section::Rock::Piece& piece : rock.pieces) {
    const auto part = figure::part_of(colours, piece.value, figure::kPaintedParts);
    text += part ? digit_of(*part) : '.';
  }
  return text;
}

ScaleLook scale_look(const figure::Section::Painted& painted) {
  ScaleLook look{figure::part_colours(painted.colours, figure::kPaintedParts),
                 figure::scale_texts(painted.colours)};
  look.texts.insert(look.texts.end(), painted.words.begin(), painted.words.end());
  return look;
}

}  // namespace

std::string draw_section(const Chosen& chosen) {
  if (chosen.scene().geometry_kind != GeometryKind::field) {
    refuse("chart",
           concat("a section is drawn of a field, and this scene is a ",
                  is_meshed(chosen.scene()) ? "mesh" : "box"),
           "choose another chart: history, profiles, fault-map");
  }
  figure::Section section = field_section(chosen.scene());
  const bool all_fields = fill_section(chosen, section);
  PaintedSection(chosen.picture).paint(chosen.result().steps[chosen.step].time, section);
  section.title = concat("The field across its faults",
                         chosen.request.with_cursor ? "" : ": " + moment_text(chosen));
  section.remark = concat(subject_of(chosen.picture), "; to scale; colour: ",
                          all_fields ? "χ down dip, on the line where it is largest"
                                     : "χ̄ of the whole fault (fields were not kept)");
  return figure::draw(section);
}

}  // namespace case_figures

double place_stretch(const Scene& scene, double width) {
  constexpr double kHeight = 130, kAxes = 160;  // px, names of layers too
  const figure::Section section = field_section(scene);
  const double scale = (width - kAxes) / (section.to - section.from);
  return std::max(1.0, kHeight / ((section.base - section.top) * scale));
}

std::string draw_place(const Scene& scene, std::size_t fault, double width) {
  figure::Section section = field_section(scene);
  section.title = concat("Where fault ", scene.faults[fault].name, " is");
  section.width = width;
  section.stretch = place_stretch(scene, width);
  section.marked = fault;
  return figure::draw(section);
}

std::vector<StepLook> step_looks(const CasePicture& picture) {
  using namespace case_figures;
  std::vector<StepLook> looks;
  if (n_steps_of(picture.result) == 0) return looks;
  Chosen chosen{picture, {}, 0, 0};
  const PaintedSection painted(picture);
  const figure::Section empty = field_section(picture.scene);
  for (chosen.step = 0; chosen.step < n_steps_of(picture.result); ++chosen.step) {
    figure::Section section = empty;
    fill_section(chosen, section);
    const StepResult& step = picture.result.steps[chosen.step];
    painted.paint(step.time, section);
    StepLook look;
    look.step = step.step;
    look.time = time_of(picture.result, step.time);
    look.says = moment_text(chosen);
    for (const figure::Section::FaultLine& fault : section.faults) {
      std::string& parts = look.chi.emplace_back();
      for (const double chi : fault.chi) parts += digit_of(figure::chi_part(chi));
    }
    for (std::size_t part = 0; looks.empty() && part < figure::kChiParts; ++part)
      look.chi_colours.push_back(figure::chi_part_colour(part));
    for (const figure::Section::Rock& rock : section.rocks) {
      if (rock.is_reservoir) look.notes.emplace_back(rock.name, rock.note);
      if (!rock.pieces.empty())
        look.painted.emplace_back(rock.name, painted_text(rock, section.painted->colours));
    }
    if (looks.empty() && !look.painted.empty()) look.scale = scale_look(*section.painted);
    looks.push_back(std::move(look));
  }
  return looks;
}

}  // namespace faultsim
