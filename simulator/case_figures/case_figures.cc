#include "simulator/case_figures/case_figures.h"

#include "simulator/case_figures/chosen.h"
#include "simulator/common/errors.h"

namespace faultsim {

const std::vector<CaseChartInfo>& case_charts() {
  static const std::vector<CaseChartInfo> charts = {
      {CaseChart::history, "history", "χ̄ per fault and pressures against time", false, true},
      {CaseChart::thickness, "thickness", "down-dip length with χ > 0.8 against time", false, true},
      {CaseChart::slip, "slip", "largest slip per fault against time", false, true},
      {CaseChart::section, "section", "cut across the field, faults coloured by χ", false, false},
      {CaseChart::profiles, "profiles", "pressure, tractions, χ, slip against depth", true, true},
      {CaseChart::fault_map, "fault-map", "χ, slip, … on a fault's plane; plane strain: in time",
       true, false},
      {CaseChart::stress_path, "stress-path", "traction against strength, with circle", true,
       true}};
  return charts;
}

const CaseChartInfo* case_chart_named(std::string_view name) {
  for (const CaseChartInfo& info : case_charts()) {
    if (name == info.name) return &info;
  }
  return nullptr;
}

MapField field_shown(const std::string& place, const std::string& word) {
  std::string all;
  for (std::size_t k = 0; k < words(MapField{}).size(); ++k) {
    const char* one = words(MapField{}).at(k);
    if (word == one) return static_cast<MapField>(k);
    all += concat(all.empty() ? "" : ", ", one);
  }
  case_figures::refuse(place, concat("\"", word, "\" is not what a fault map can show"),
                       "choose one of " + all);
}

void require_shows(const CaseChartInfo& info, MapField show) {
  if (info.chart == CaseChart::fault_map || show == MapField::chi) return;
  case_figures::refuse("--show", concat("is for a fault-map, which ", info.name, " is not"),
                       "leave it out, or plot a fault-map");
}

void require_draws_original(const CaseChartInfo& info) {
  if (info.draws_original) return;
  std::string others;
  for (const CaseChartInfo& one : case_charts()) {
    if (one.draws_original) others += concat(others.empty() ? "" : ", ", one.name);
  }
  case_figures::refuse("--before", concat("a ", info.name, " shows one case only"),
                       "choose a chart of curves: " + others);
}

std::string draw_case(const CasePicture& picture, const CaseChartRequest& request) {
  using namespace case_figures;
  Chosen chosen = choose(picture, request);
  for (const CaseChartInfo& info : case_charts()) {
    if (info.chart != request.chart || !info.needs_fields || picture.fields != nullptr) continue;
    refuse("chart",
           concat(info.name, " is drawn from the fields on the faults, which were not kept"),
           "run the scene with fault fields (/output/fault_fields); a campaign keeps those of the "
           "cases ranked first, with \"keep_fields\": \"stages\" those of all");
  }
  switch (request.chart) {
    case CaseChart::history:
    case CaseChart::thickness:
    case CaseChart::slip:
      return draw_history(chosen);
    case CaseChart::section:
      return draw_section(chosen);
    case CaseChart::profiles:
      return draw_profiles(chosen);
    case CaseChart::fault_map:
      return draw_fault_map(chosen);
    case CaseChart::stress_path:
      return draw_stress_path(chosen);
  }
  return {};
}

}  // namespace faultsim
