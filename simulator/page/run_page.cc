#include "simulator/page/run_page.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/svg.h"
#include "simulator/page/case_part.h"
#include "simulator/result/result_sentences.h"
#include "simulator/scene/tiers.h"

namespace faultsim {
namespace {

using figure::escape_xml;
using figure::plain_number;

constexpr double kMillimetre = 1e-3;

void add_answer(HtmlPage& page, const CaseResult& result) {
  if (result.outcome != Outcome::converged && result.outcome != Outcome::event)
    page.paragraph(concat(to_string(result.outcome), ": ", result.reason), "answer");
  page.paragraph(sliding_sentence(result), "answer");
  for (const std::string& sentence : unresolved_sentences(result))
    page.paragraph(sentence, "answer");
  for (const std::string& sentence : {unexpected_sentence(result), creep_sentence(result)})
    if (!sentence.empty()) page.paragraph(sentence);
}

/// As a number of few digits has them: a moment of 9,920,794 is known to be 9,920,000.
double rounded(double value, int digits) {
  return std::strtod(formatted("%.*e", digits - 1, value).c_str(), nullptr);
}

std::string blank_for_dash(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// Words of a flag that cells may leave open.
std::string sliding_words(const FaultStageMetrics& fault) {
  if (!fault.activation_resolved) return "unresolved";
  return fault.activated ? "slides" : fault.slips ? "no, slips" : "no";
}

std::string onset_words(const FaultStageMetrics& fault) {
  if (!fault.activation) return "";
  return concat("step ", fault.activation->step, ", ",
                pressures_text(fault.activation->pressures, fault.activation->depth));
}

void add_stages(HtmlPage& page, const CaseResult& result) {
  page.section("stages", "Stage by stage");
  const char* area = result.plane_strain ? "sliding, m² per m of strike" : "sliding, m²";
  const char* moment = result.plane_strain ? "M0, N m per m" : "M0, N m";
  std::string html = "<div class=\"wide\"><table>\n<thead><tr>";
  const auto head = [&](const char* name, bool is_words) {
    html += concat(is_words ? "<th class=\"words\">" : "<th>", escape_xml(name), "</th>");
  };
  for (const char* name : {"stage", "fault"}) head(name, true);
  head("χ̄", false);
  head("slides", true);
  for (const char* name : {"slip within the stage, mm", area, moment, "slip events"})
    head(name, false);
  head("slides from", true);
  html += "</tr></thead>\n<tbody>\n";
  const auto number = [](double value, int digits) {
    return concat("<td>", escape_xml(plain_number(rounded(value, digits), digits)), "</td>");
  };
  const auto words = [](const std::string& text) {
    return concat("<td class=\"words\">", escape_xml(text), "</td>");
  };
  for (const StageMetrics& stage : result.stages) {
    for (const FaultStageMetrics& fault : stage.faults) {
      html += "<tr>" + words(blank_for_dash(stage.stage)) + words(fault.fault) +
              number(fault.chi_bar, 3) + words(sliding_words(fault)) +
              number(fault.max_slip / kMillimetre, 3) + number(fault.activated_area, 3) +
              number(fault.moment, 3) + number(fault.n_events, 4) + words(onset_words(fault)) +
              "</tr>\n";
    }
  }
  page.add(html + "</tbody></table></div>\n");
}

/// Of each fault, at its own largest χ̄; without fields the reason why not.
void add_faults(HtmlPage& page, const CasePicture& picture) {
  page.section("faults", "Fault by fault");
  if (picture.fields == nullptr) {
    page.paragraph("No fields of this run were kept (/output/fault_fields).", "faint");
    return;
  }
  for (const std::string& fault : picture.result.fault_names) {
    page.heading(fault);
    for (const auto chart : {CaseChart::profiles, CaseChart::fault_map, CaseChart::stress_path}) {
      page.unless_refused([&] { page.chart(draw_case(picture, {chart, fault, {}, false})); });
    }
  }
}

/// What is known of the error of its cells.
std::string cells_sentence(const Scene& scene) {
  const Tier* tier = find_tier(scene.tier);
  const bool is_of_tier = tier != nullptr && tier->sizes == scene.mesh;
  return is_of_tier ? concat("The cells are those of tier ", tier->name,
                             ". Measured in plane strain against small ones: ", tier->errors, ".")
                    : "No tier names an error of these cells: a run with smaller ones shows it.";
}

void add_doubts(HtmlPage& page, const CasePicture& picture) {
  const CaseResult& result = picture.result;
  page.section("how-sure", "How sure this is");
  page.paragraph(cells_sentence(picture.scene));
  if (result.warnings.empty()) page.paragraph("This run gave no warnings.", "faint");
  for (const std::string& warning : result.warnings) page.paragraph(warning);
}

void add_provenance(HtmlPage& page, const CaseResult& result, const std::string& scene,
                    const std::string& program) {
  page.section("provenance", "Where this comes from");
  page.paragraph(concat("Scene ", result.identity, ", operator ", result.operator_fingerprint,
                        ", numerics version ", result.numerics_version, "; page by ", program,
                        ". To run it again, with the same bits: faultsim run --from-report "
                        "PAGE.html. A flow result that the scene names is not in the page."));
  const std::string text = nlohmann::json::parse(scene).dump(1);
  page.details("scene", text);
  page.data("scene", text);
}

}  // namespace

std::string run_page(const CasePicture& picture, const std::string& scene,
                     const std::string& program) {
  const CaseResult& result = picture.result;
  HtmlPage page(picture.name.empty() ? result.title : picture.name);
  add_answer(page, result);
  page.section("history", "Step by step");
  page.unless_refused([&] { add_case_steps(page, picture, 1); });
  add_stages(page, result);
  add_faults(page, picture);
  add_doubts(page, picture);
  add_provenance(page, result, scene, program);
  return page.finish();
}

}  // namespace faultsim
