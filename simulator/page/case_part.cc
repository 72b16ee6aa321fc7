#include "simulator/page/case_part.h"

#include "simulator/common/errors.h"
#include "simulator/page/steps_json.h"

namespace faultsim {
namespace {

/// Of a field. The slider, hidden until the script is there, and what it changes. Drawn before
/// anything is added: what cannot be drawn leaves nothing half open.
void add_section_and_slider(HtmlPage& page, const CasePicture& picture, long number) {
  const std::string section = draw_case(picture, {CaseChart::section, {}, {}, true}),
                    history = draw_case(picture, {CaseChart::history, {}, {}, true});
  const nlohmann::json steps = steps_json(picture);
  page.add(concat("<div data-case=\"", number, "\">\n"));
  page.data("", steps.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  page.add(
      concat("<div class=\"slider\" hidden><label>load step <input type=\"range\" min=\"0\" max=\"",
             steps.size() - 1, "\" value=\"", critical_moment(picture.result).step,
             "\" aria-label=\"load step\"></label><output></output></div>\n"));
  page.chart(section);
  page.chart(history);
  page.add("</div>\n");
}

}  // namespace

void add_case_steps(HtmlPage& page, const CasePicture& picture, long number) {
  if (picture.scene.geometry_kind == GeometryKind::field) {
    add_section_and_slider(page, picture, number);
  } else {
    page.chart(draw_case(picture, {CaseChart::history, {}, {}, false}));
  }
}

void add_case_part(HtmlPage& page, const CasePicture& picture, long number) {
  add_case_steps(page, picture, number);
  if (picture.fields == nullptr) return;
  for (const auto chart : {CaseChart::profiles, CaseChart::fault_map, CaseChart::stress_path})
    page.chart(draw_case(picture, {chart, {}, {}, false}));
}

}  // namespace faultsim
