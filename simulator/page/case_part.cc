#include "simulator/page/case_part.h"

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

std::string steps_json(const std::vector<StepLook>& looks) {
  nlohmann::json steps = nlohmann::json::array();
  for (const StepLook& look : looks) {
    nlohmann::json notes = nlohmann::json::object();
    for (const auto& [name, note] : look.notes) notes[name] = note;
    steps.push_back(
        {{"time", look.time}, {"says", look.says}, {"colours", look.colours}, {"notes", notes}});
  }
  return steps.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

/// The slider, hidden until the script is there, and the section that it colours.
void add_section(HtmlPage& page, const CasePicture& picture) {
  const std::vector<StepLook> looks = step_looks(picture);
  page.data("", steps_json(looks));
  page.add(
      concat("<div class=\"slider\" hidden><label>load step <input type=\"range\" min=\"0\" max=\"",
             looks.size() - 1, "\" value=\"", critical_moment(picture.result).step,
             "\" aria-label=\"load step\"></label><output></output></div>\n"));
  page.add(draw_case(picture, {CaseChart::section, {}, {}, true}));
}

}  // namespace

void add_case_part(HtmlPage& page, const CasePicture& picture, long number) {
  const bool is_field = picture.scene.geometry_kind == GeometryKind::field;
  if (is_field) {
    page.add(concat("<div data-case=\"", number, "\">\n"));
    add_section(page, picture);
  }
  page.add(draw_case(picture, {CaseChart::history, {}, {}, is_field}));
  if (is_field) page.add("</div>\n");
  if (picture.fields == nullptr) return;
  for (const auto chart : {CaseChart::profiles, CaseChart::fault_map, CaseChart::stress_path})
    page.add(draw_case(picture, {chart, {}, {}, false}));
}

}  // namespace faultsim
