#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simulator/case_figures/case_figures.h"
#include "simulator/figure/axis.h"

/// What the charts of a case share; for this folder.
namespace faultsim::case_figures {

inline constexpr double kBarInPascal = 1e5, kMegapascal = 1e6, kMillimetre = 1e-3;  ///< in SI.

/// What is drawn, decided: a fault and a step of the result. Refers to the picture, which outlives
/// it.
struct Chosen {
  const CasePicture& picture;
  CaseChartRequest request;
  std::size_t fault = 0;  ///< index in CaseResult::fault_names.
  std::size_t step = 0;   ///< index in CaseResult::steps.

  const CaseResult& result() const { return picture.result; }
  const Scene& scene() const { return picture.scene; }
  const std::string& fault_name() const { return result().fault_names[fault]; }
};

/// The fault and the step that are asked for; where none are, those of the largest χ̄ (of the case,
/// or of the fault). Throws InputError: no such fault or step, or nothing to draw at all.
Chosen choose(const CasePicture& picture, const CaseChartRequest& request);

/// Throws the InputError of one option.
[[noreturn]] void refuse(const std::string& option, const std::string& what,
                         const std::string& cure);

std::size_t n_steps_of(const CaseResult& result);  ///< steps that have metrics: the first n.

/// Histories that end within two years are drawn in days, others in years of 365.25 days.
bool in_days(const CaseResult& result);
double time_of(const CaseResult& result, double seconds);  ///< in that unit.

/// "years", or "years since 1990-01-01" where the scene has dates.
std::string time_unit_text(const CasePicture& picture);
/// Ticks at dates, in the unit of time_of, within the history; none where the scene has no dates.
std::vector<figure::Tick> date_ticks(const CasePicture& picture);

/// What a remark begins with, as it may be cut at its end: "thin: before the change; ", or with
/// the name of the original where it has one; or why there are no such lines; "" of a picture
/// without an original.
/// @param place  where its lines are, if elsewhere: "at 2,050 m depth".
std::string words_of_original(const CasePicture& picture, bool is_drawn = true,
                              const std::string& place = {});
/// For what a scale of colours holds: "same scale at all load steps", and of the original as well.
std::string same_scale_words(const CasePicture& picture, bool of_original);
/// The place of a name among names; none where it is not there.
std::optional<std::size_t> place_of(const std::vector<std::string>& names, const std::string& name);

std::string with_blanks(std::string name);           ///< "primary production".
std::string subject_of(const CasePicture& picture);  ///< its name, or the result's title.
std::string moment_text(const Chosen& chosen);       ///< "load step 10, production, 10 years".

/// The charts, as SVG.
std::string draw_history(const Chosen& chosen);  ///< χ̄, thickness or slip against time.
std::string draw_section(const Chosen& chosen);  ///< Throws InputError where the scene is a box.
std::string draw_profiles(Chosen chosen);        ///< @pre the picture has fields; as below.
std::string draw_fault_map(Chosen chosen);
std::string draw_stress_path(Chosen chosen);

}  // namespace faultsim::case_figures
