#include "campaign/figures/fault_sheet_page.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"
#include "sheet_css.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/figure/svg.h"
#include "simulator/page/html_page.h"

namespace faultsweep {

namespace {

using faultsim::HtmlPage;
using faultsim::figure::escape_xml;
namespace figure = faultsim::figure;

/// A sheet as it is written.
struct Sheet {
  const FaultSheet& sheet;
  Answer answer;
  HtmlPage& page;
};

std::vector<std::string> band_sentences(const FaultSheet& sheet) {
  std::vector<std::string> all;
  for (const PressureBand& band : sheet.bands) all.push_back(band_words(band));
  return all;
}

/// What the parts of a sheet take on paper with letters of some size, CSS pixels; rather too much
/// than too little. It follows sheet.css.
class PaperHeight {
 public:
  explicit PaperHeight(double em) : em_(em), line_(1.26 * em) {}

  double of(const FaultSheet& sheet) const {
    return head(sheet) + place(sheet) + bands(sheet) + sliding(sheet) + events(sheet) +
           levels(sheet) + foot(sheet);
  }

 private:
  static constexpr double kWidth = 718, kHalf = 349;

  /// Lines of a text in a column, bold ones and breaks between words allowed for.
  double lines(const std::string& text, double width) const {
    constexpr double kLetter = 0.49;  // em
    return std::ceil(kLetter * em_ * static_cast<double>(display_width(text)) / width);
  }
  double sentences(const std::vector<std::string>& all, double width) const {
    double n = 0;
    for (const std::string& one : all) n += lines(one, width - 1.3 * em_);
    return n * line_ + 0.4 * em_;
  }
  double note(const std::string& text, double width) const {
    return lines(text, width) * line_ + 0.4 * em_;
  }
  double heading() const { return 2.4 * em_ + 2; }
  double row(double n_lines) const { return n_lines * line_ + 0.3 * em_ + 1; }

  double head(const FaultSheet& sheet) const {
    double height =
        3.0 * em_ + 4 +
        note(sheet.base.title + sheet.campaign.name + sheet.title + std::string(60, ' '), kWidth);
    for (const std::string& one : headline_of(sheet))
      height += 1.1 * (lines(one, kWidth / 1.15) * line_ + 0.6 * em_);
    return height;
  }
  double place(const FaultSheet& sheet) const {
    const double picture = sheet.place.is_field ? 162 + line_ + 0.4 * em_ : 0;
    return heading() + std::max(picture, row(1) + 4 * row(1) + note(initial_note(sheet), kHalf) +
                                             sentences(place_words(sheet), kHalf));
  }
  double bands(const FaultSheet& sheet) const {
    return heading() + 83 + 17.5 * static_cast<double>(sheet.bands.size()) +
           sentences(band_sentences(sheet), kWidth) + note(pressure_note(sheet), kWidth);
  }
  double sliding(const FaultSheet& sheet) const {
    const double moment = (kWidth - 38 * em_) / 3;  // what is left for where it begins
    double height = heading() + row(2) + note(share_note(sheet), kWidth);
    for (const StageSliding& one : sheet.stages) {
      const std::string words = "99 to 99.9 years, 999 to 999 bar, case 99999";
      height += row(one.first ? lines(words, moment) : 1);
    }
    return height;
  }
  double events(const FaultSheet& sheet) const {
    return heading() + sentences(event_words(sheet), kWidth);
  }
  double levels(const FaultSheet& sheet) const {
    double height = heading() + row(2);
    for (const LevelShare& one : sheet.levels) {
      const double name = 0.6 * em_ * static_cast<double>(display_width(one.level.name)) + 2 * em_;
      const double left = kWidth - 158 - name - 28 * em_;  // for meaning and condition
      height += row(std::max(
          {1.0, lines(one.level.words, 0.55 * left), lines(one.level.condition, 0.45 * left)}));
    }
    return height;
  }
  double foot(const FaultSheet& sheet) const {
    return heading() + std::max(sentences(sheet.errors, kHalf), sentences(sheet.provenance, kHalf));
  }

  double em_, line_;
};

/// Letters as large as the page has room for, pt; what does not fit even so takes a second page.
/// The page has 1,047 pixels; the estimate is up to 10 % too large.
double letters_of(const FaultSheet& sheet) {
  constexpr double kPage = 1050, kLargest = 8, kSmallest = 4.6, kStep = 0.1, kPoint = 4.0 / 3;
  double size = kLargest;
  while (size > kSmallest && PaperHeight(size * kPoint).of(sheet) > kPage) size -= kStep;
  return size;
}

void add_list(HtmlPage& page, const std::vector<std::string>& sentences) {
  page.add("<ul>\n");
  for (const std::string& one : sentences) page.add(concat("<li>", escape_xml(one), "</li>\n"));
  page.add("</ul>\n");
}

/// A table of the answer, those for people too.
const AnswerTable& part_called(const Answer& answer, const std::string& key) {
  for (const AnswerBlock& block : answer.blocks)
    if (const auto* table = std::get_if<AnswerTable>(&block); table != nullptr && table->key == key)
      return *table;
  faultsim::throw_internal("known table", key, __FILE__, __LINE__);
}

bool is_number(const AnswerCell& cell) {
  return std::holds_alternative<double>(cell.value) ||
         std::holds_alternative<std::int64_t>(cell.value);
}

/// A column of a table as paper has it: without those in which nothing stands, words to the left.
struct PaperColumn {
  std::string heading;
  std::vector<std::string> cells;  ///< HTML.
  bool is_words = false;
};

/// @param keys  which columns of the answer's table, in this order.
std::vector<PaperColumn> paper_columns(const AnswerTable& table,
                                       const std::vector<std::string>& keys) {
  std::vector<PaperColumn> columns;
  for (const std::string& key : keys) {
    const auto found = std::ranges::find(table.columns, key, &AnswerColumn::key);
    FAULTSIM_DEMAND(found != table.columns.end(), key);
    const auto k = static_cast<std::size_t>(found - table.columns.begin());
    PaperColumn column{escape_xml(shown_heading(*found)), {}, true};
    bool is_empty = true;
    for (const auto& row : table.rows) {
      const AnswerCell cell = k < row.size() ? row[k] : AnswerCell{};
      column.cells.push_back(escape_xml(shown_cell(cell, *found)));
      column.is_words = column.is_words && !is_number(cell);
      is_empty = is_empty && column.cells.back().empty();
    }
    if (!is_empty) columns.push_back(std::move(column));
  }
  return columns;
}

void add_table(HtmlPage& page, const std::vector<PaperColumn>& columns) {
  const auto kind = [](const PaperColumn& one) { return one.is_words ? " class=\"words\"" : ""; };
  std::string html = "<table><thead><tr>";
  for (const PaperColumn& one : columns)
    html += concat("<th", kind(one), ">", one.heading, "</th>");
  html += "</tr></thead>\n<tbody>\n";
  const std::size_t n_rows = columns.empty() ? 0 : columns.front().cells.size();
  for (std::size_t r = 0; r < n_rows; ++r) {
    html += "<tr>";
    for (const PaperColumn& one : columns)
      html += concat("<td", kind(one), ">", one.cells[r], "</td>");
    html += "</tr>\n";
  }
  page.add(html + "</tbody></table>\n");
}

/// The k-th chart of the answer, a chart of ranges.
const figure::RangeBars& chart_of(const Answer& answer, std::size_t k) {
  for (const AnswerBlock& block : answer.blocks) {
    const auto* chart = std::get_if<AnswerChart>(&block);
    if (chart != nullptr && k-- == 0) return std::get<figure::RangeBars>(*chart);
  }
  faultsim::throw_internal("known chart", "", __FILE__, __LINE__);
}

std::string counts_words(const FaultSheet& sheet) {
  return concat(grouped(sheet.counts.n_cases), sheet.counts.n_cases == 1 ? " case, " : " cases, ",
                grouped(sheet.counts.n_complete), " with a full history");
}

void add_head(Sheet& s, const std::string& id) {
  const FaultSheet& sheet = s.sheet;
  s.page.section(id, concat("Fault ", sheet.fault));
  s.page.paragraph(concat(sheet.base.title.empty() ? "" : sheet.base.title + ". ", "Campaign ",
                          sheet.campaign.name, sheet.title.empty() ? "" : ": " + sheet.title, " (",
                          counts_words(sheet), ")"),
                   "sub");
  for (const std::string& sentence : s.answer.headline) s.page.paragraph(sentence, "lead");
}

void add_place(Sheet& s) {
  constexpr double kWidth = 350;  // px, half of the page
  const FaultSheet& sheet = s.sheet;
  s.page.add("<div class=\"two\"><div>\n");
  s.page.heading("Where it is");
  if (sheet.place.is_field) {
    s.page.add(draw_place(sheet.base, sheet.fault_index, kWidth));
    const double stretch = place_stretch(sheet.base, kWidth);
    s.page.paragraph(
        concat("The base scene, ",
               stretch > 1.005 ? concat("depths stretched ", format_number(stretch, 2), " times.")
                               : std::string("to scale.")),
        "faint");
  }
  s.page.add("</div><div>\n");
  s.page.heading(concat("Before any production, at ", depth_text(sheet.datum), " depth"));
  add_table(s.page,
            paper_columns(part_called(s.answer, "initial"), {"quantity", "base", "low", "high"}));
  s.page.paragraph(initial_note(sheet), "faint");
  add_list(s.page, place_words(sheet));
  s.page.add("</div></div>\n");
}

void add_bands(Sheet& s) {
  const FaultSheet& sheet = s.sheet;
  s.page.heading(concat("Safe band of pressures, absolute, at ", depth_text(sheet.datum)));
  if (sheet.bands.empty()) {
    s.page.paragraph("Not known: no case has a full history of this fault.");
    return;
  }
  s.page.chart(figure::draw(chart_of(s.answer, 0)));
  add_list(s.page, band_sentences(sheet));
  s.page.paragraph(pressure_note(sheet), "faint");
}

void add_levels(Sheet& s) {
  constexpr double kBarWidth = 130, kBarHeight = 14;  // px
  const FaultSheet& sheet = s.sheet;
  s.page.heading(
      concat("Escalation levels", sheet.table.title.empty() ? "" : ": " + sheet.table.title));
  std::vector<PaperColumn> columns = paper_columns(
      part_called(s.answer, "levels"), {"level", "words", "condition", "estimate", "low", "high",
                                        "holds", "rows", "undecided", "unknown"});
  const figure::RangeBars& chart = chart_of(s.answer, 1);
  PaperColumn bars{"0 to 100 %, line: from and to", {}, true};
  for (std::size_t k = 0; k < chart.rows.size(); ++k) {
    bars.cells.push_back(figure::draw_alone(chart.rows[k], *chart.axis, kBarWidth, kBarHeight));
    std::string& name = columns.front().cells.at(k);
    name = concat(figure::draw_swatch(fill_of(sheet.levels[k].level.colour)), " <b>", name, "</b>");
  }
  columns.insert(columns.begin() + 3, std::move(bars));
  add_table(s.page, columns);
}

/// "fault-F2", as links at the top name it; of a name that is no word "sheet-2".
std::string id_of(const std::string& fault, std::size_t k) {
  const bool is_word = !fault.empty() && std::ranges::all_of(fault, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_';
  });
  return is_word ? "fault-" + fault : concat("sheet-", k + 1);
}

void add_fault(HtmlPage& page, const FaultSheet& sheet, const std::string& id) {
  Sheet s{sheet, to_answer({sheet}), page};
  page.add(concat("<article class=\"sheet\" style=\"font-size:",
                  format_number(letters_of(sheet), 2), "pt\">\n"));
  add_head(s, id);
  add_place(s);
  add_bands(s);
  page.heading("Sliding, stage by stage, and where it begins");
  add_table(page, paper_columns(part_called(s.answer, "stages"),
                                {"label", "estimate", "low", "high", "holds", "rows", "undecided",
                                 "unknown", "first_words", "half_words", "last_words"}));
  page.paragraph(share_note(sheet), "faint");
  page.heading("Slip events");
  add_list(page, event_words(sheet));
  add_levels(s);
  page.add("<div class=\"two\"><div>\n");
  page.heading("How far off this is");
  add_list(page, sheet.errors);
  page.add("</div><div>\n");
  page.heading("Where this comes from");
  add_list(page, sheet.provenance);
  page.add("</div></div>\n</article>\n");
}

}  // namespace

std::string sheet_page(const std::vector<FaultSheet>& sheets) {
  FAULTSIM_DEMAND(!sheets.empty(), "a sheet");
  HtmlPage page(concat(sheets.size() == 1 ? "Fault " + sheets.front().fault : std::string("Faults"),
                       " of ", sheets.front().campaign.name));
  page.style(faultsim::embedded::sheet_css);
  for (std::size_t k = 0; k < sheets.size(); ++k)
    add_fault(page, sheets[k], id_of(sheets[k].fault, k));
  return page.finish();
}

}  // namespace faultsweep
