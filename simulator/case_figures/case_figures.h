#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulator/result/result.h"
#include "simulator/result_files/field_source.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The charts of one case.
enum class CaseChart {
  history,      ///< χ̄ of each fault and Δp of each compartment against time.
  thickness,    ///< down-dip length with χ > 0.8 of each fault against time.
  slip,         ///< largest slip of each fault against time.
  section,      ///< cut across a field, faults coloured by χ at a step.
  profiles,     ///< Δp_f, σ'_n, τ and strength, χ, slip against depth, at a step.
  fault_map,    ///< χ on a fault's plane at a step; in plane strain against time.
  stress_path,  ///< traction of a fault's most critical point from step to step.
};
struct CaseChartInfo {
  CaseChart chart;
  const char* name;     ///< "fault-map".
  const char* meaning;  ///< for --help.
  bool needs_fields;    ///< faults.h5.
  bool draws_original;  ///< CasePicture::original.
};
const std::vector<CaseChartInfo>& case_charts();
const CaseChartInfo* case_chart_named(std::string_view name);  ///< nullptr = there is none.
/// What a fault map shows.
enum class MapField {
  chi,       ///< critical index.
  slip,      ///< size of the slip along the fault, mm.
  state,     ///< sticks, slips or is open in the load step.
  pressure,  ///< change of the pressure in the fault since the start, bar.
};
constexpr auto words(MapField) { return std::array{"chi", "slip", "state", "pressure"}; }

/// The field of a word. Throws InputError of `place` where there is none of this name.
MapField field_shown(const std::string& place, const std::string& word);
/// Throws InputError (of --show) where the chart is not a fault map and another field than χ is
/// asked for.
void require_shows(const CaseChartInfo& info, MapField show);
/// Throws InputError (of --before) where the chart does not draw a case before a change.
void require_draws_original(const CaseChartInfo& info);

/// What is drawn, and what it is drawn from.
struct CasePicture {
  const CaseResult& result;
  const Scene& scene;
  const FieldSource* fields = nullptr;  ///< none = only charts that do not need them.
  std::string name = {};                ///< before the title: "sweep/17"; "" = the result's title.
  /// The case before a change, or another to compare with: charts that draw it (CaseChartInfo) have
  /// its curves as thin, paler lines, of faults and compartments of the same names, and say its
  /// name.
  const CasePicture* original = nullptr;
};
struct CaseChartRequest {
  CaseChart chart = CaseChart::history;
  std::string fault = {};         ///< "" = that of the largest χ̄.
  std::optional<int> step = {};   ///< none = of its largest χ̄, or the last one stored before.
  bool with_cursor = false;       ///< histories: a line at the step, which a page can move.
  MapField show = MapField::chi;  ///< fault maps; other charts do not look at it.
};

/// The chart as SVG. Throws InputError: no such fault or step, no fields, a section of a box.
std::string draw_case(const CasePicture& picture, const CaseChartRequest& request);

/// Where a fault (index) of a field lies: its section, small, with the fault marked and depths
/// stretched by `place_stretch`. @param width  px. @pre the scene is a field.
std::string draw_place(const Scene& scene, std::size_t fault, double width);
/// How many times a depth is as long there as a distance across.
double place_stretch(const Scene& scene, double width);

/// The scale that reservoirs of a section are painted with.
struct ScaleLook {
  std::vector<std::string> colours;  ///< of its parts.
  std::vector<std::string> texts;    ///< all that is written at it, in the order of the drawing.
};
/// What a page changes in the section and the histories (with_cursor) when it shows another step.
struct StepLook {
  int step = 0;
  double time = 0;   ///< in the unit of the histories' axis.
  std::string says;  ///< "load step 10, primary production, 10 years".
  /// Of each fault: the part of the scale of χ (figure::chi_part) of each of its pieces, as the
  /// section has them, as a digit (0 to 9, then a to u): a case has thousands.
  std::vector<std::string> chi;
  /// Colours of the parts of the scale of χ: the first step has them.
  std::vector<std::string> chi_colours;
  std::vector<std::pair<std::string, std::string>> notes;  ///< per compartment: its Δp.
  /// Per compartment that is painted the part of the scale of each of its pieces, as a digit
  /// (0 to 9, then a to v); "." = none is known.
  std::vector<std::pair<std::string, std::string>> painted;
  std::optional<ScaleLook> scale;  ///< of all steps: the first one has it where there is one.
};
/// Of every step that has metrics. @pre the scene is a field.
std::vector<StepLook> step_looks(const CasePicture& picture);

/// The fault (index) with the largest χ̄ of the case and the step (index in CaseResult::steps, of
/// those that have metrics) that has it; among those at their strength the largest area with
/// χ > 0.8; the first of equals. @pre the result has faults and steps.
struct CriticalMoment {
  std::size_t fault = 0, step = 0;
};
CriticalMoment critical_moment(const CaseResult& result);

}  // namespace faultsim
