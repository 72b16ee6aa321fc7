#include "campaign/render/render.h"

#include <cmath>

#include "campaign/render/shown.h"
#include "simulator/figure/svg.h"

namespace faultsweep {

using faultsim::figure::escape_xml;

namespace {

std::string paragraph(const std::string& text, const char* kind) {
  return concat("<p class=\"", kind, "\">", escape_xml(text), "</p>\n");
}

/// The number in SI; "" for words.
std::string data_of(const AnswerValue& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  if (const auto* number = std::get_if<double>(&value))
    return std::isfinite(*number) ? exact_number(*number) : "";
  return "";
}

std::string cell_of(const AnswerCell& cell, const AnswerColumn& column) {
  const std::string data = data_of(cell.value);
  return concat("<td", data.empty() ? "" : concat(" data-value=\"", data, "\""), ">",
                escape_xml(shown_cell(cell, column)), "</td>");
}

bool is_shown(const AnswerTable& table, const AnswerColumn& column) {
  return column.need != Need::data && !(table.is_sortable && column.need == Need::extra);
}

/// The beginning of a table; of one that is sortable with the place where a script says how many
/// rows pass its filters.
std::string head_of(const AnswerTable& table) {
  const std::string key = escape_xml(table.key), place = "rows-" + key;
  std::string html = table.title.empty() ? "" : paragraph(table.title, "title");
  if (table.is_sortable) html += concat("<p id=\"", place, "\" class=\"faint\"></p>\n");
  html += concat("<div class=\"wide\"><table data-table=\"", key,
                 table.is_sortable ? concat("\" data-filter=\"", place) : "", "\"><thead><tr>");
  for (const AnswerColumn& one : table.columns)
    if (is_shown(table, one)) html += concat("<th>", escape_xml(shown_heading(one)), "</th>");
  return html + "</tr></thead>\n<tbody>\n";
}

std::string table_of(const AnswerTable& table) {
  std::string html = head_of(table);
  const std::size_t n = table.rows.size();
  const std::size_t n_shown = table.most_on_screen == 0 ? n : std::min(n, table.most_on_screen);
  for (std::size_t r = 0; r < n_shown; ++r) {
    html += "<tr>";
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      if (!is_shown(table, table.columns[k])) continue;
      html += cell_of(k < table.rows[r].size() ? table.rows[r][k] : AnswerCell{}, table.columns[k]);
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (n_shown < n) html += paragraph(concat("and ", n - n_shown, " more rows"), "faint");
  for (const std::string& note : table.notes) html += paragraph(note, "faint");
  return html;
}

std::string drawn(const AnswerChart& chart) {
  return std::visit([](const auto& one) { return faultsim::figure::draw(one); }, chart);
}

struct HtmlBlocks {
  std::string operator()(const AnswerTable& table) const {
    return table.on_screen ? table_of(table) : "";
  }
  std::string operator()(const AnswerNote& note) const { return paragraph(note.text, "faint"); }
  std::string operator()(const AnswerChart& chart) const {
    return faultsim::figure::on_page(drawn(chart));
  }
};

}  // namespace

std::string render_html(const Answer& answer) {
  std::string html;
  for (const std::string& sentence : answer.headline) html += paragraph(sentence, "answer");
  for (const AnswerBlock& block : answer.blocks) html += std::visit(HtmlBlocks{}, block);
  return html;
}

std::string first_chart(const Answer& answer) {
  for (const AnswerBlock& block : answer.blocks)
    if (const auto* chart = std::get_if<AnswerChart>(&block)) return drawn(*chart);
  return "";
}

}  // namespace faultsweep
