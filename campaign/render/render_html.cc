#include "campaign/render/render.h"

#include <algorithm>
#include <cmath>

#include "campaign/render/row_data.h"
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

/// The rows of a long table that are elements; its script has the others.
constexpr std::size_t kRowsOfAPage = 100;

/// With the name by which a page asks for rows in another order.
std::string head_cell(const AnswerColumn& column) {
  const std::string by =
      column.ranks.empty() ? std::string() : concat(" data-by=\"", escape_xml(column.ranks), "\"");
  return concat("<th data-key=\"", escape_xml(column.key), "\"", by, ">",
                escape_xml(shown_heading(column)), "</th>");
}

/// The beginning of a table; of one that is sortable with the place where a script says how many
/// rows pass its filters.
std::string head_of(const AnswerTable& table, std::size_t n_shown) {
  const std::string key = escape_xml(table.key), place = "rows-" + key;
  std::string html = table.title.empty() ? "" : paragraph(table.title, "title");
  if (table.is_sortable) {
    const std::size_t n = table.rows.size();
    html += concat("<p id=\"", place, "\" class=\"faint\">",
                   n_shown < n ? concat("The first ", n_shown, " of ", n, " rows.") : std::string(),
                   "</p>\n");
  }
  html += concat("<div class=\"wide\"><table data-table=\"", key,
                 table.is_sortable ? concat("\" data-filter=\"", place) : "", "\"><thead><tr>");
  for (const AnswerColumn& one : table.columns)
    if (is_shown(table, one)) html += head_cell(one);
  return html + "</tr></thead>\n<tbody>\n";
}

std::string html_row(const AnswerTable& table, const std::vector<AnswerCell>& row) {
  std::string html = "<tr>";
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (!is_shown(table, table.columns[k])) continue;
    html += cell_of(k < row.size() ? row[k] : AnswerCell{}, table.columns[k]);
  }
  return html + "</tr>\n";
}

/// All rows of a sortable table for the page's script.
std::string rows_as_data(const AnswerTable& table) {
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    if (is_shown(table, table.columns[k])) columns.push_back(k);
  return concat("<script type=\"application/json\" data-rows-of=\"", escape_xml(table.key), "\">",
                faultsim::figure::json_in_html(row_data(table, columns)), "</script>\n");
}

std::string table_of(const AnswerTable& table) {
  const std::size_t n = table.rows.size();
  const std::size_t most = table.is_sortable ? kRowsOfAPage : table.most_on_screen;
  const std::size_t n_shown = most == 0 ? n : std::min(n, most);
  std::string html = head_of(table, n_shown);
  for (std::size_t k = 0; k < n_shown; ++k) html += html_row(table, table.rows[k]);
  html += "</tbody></table></div>\n";
  if (n_shown < n)
    html += table.is_sortable ? rows_as_data(table)
                              : paragraph(concat("and ", n - n_shown, " more rows"), "faint");
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
