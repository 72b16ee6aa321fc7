#include "campaign/render/render.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

constexpr std::size_t kGap = 2;           // blanks between columns
constexpr std::size_t kNarrowest = 20;    // of a column whose texts are broken ...
constexpr std::size_t kLongestWord = 32;  // ... at blanks, except in words longer than this

/// The beginning of a text that is at most so wide, up to a blank where there is one, and what is
/// left of it.
std::string cut_line(std::string& rest, std::size_t width) {
  if (display_width(rest) <= width) return std::exchange(rest, "");
  std::size_t end = 0, blank = std::string::npos;
  while (end < rest.size() && display_width(rest.substr(0, end + 1)) <= width) {
    if (rest[end] == ' ' && end > 0) blank = end;
    ++end;
  }
  while (end < rest.size() && (static_cast<unsigned char>(rest[end]) & 0xC0) == 0x80) ++end;
  if (blank != std::string::npos && rest[end] != ' ') end = blank;
  const std::string line = rest.substr(0, end);
  const std::size_t next = rest.find_first_not_of(' ', end);
  rest.erase(0, next == std::string::npos ? rest.size() : next);
  return line;
}

/// A column as it is laid out.
struct Laid {
  const AnswerColumn* column = nullptr;
  std::vector<std::string> cells;    ///< of the rows that are shown.
  std::vector<std::string> heading;  ///< its lines.
  std::size_t width = 0, natural = 0;
  std::size_t longest_word = kNarrowest;  ///< of texts, within the two limits above.
  bool to_the_right = true;               ///< numbers.
  std::size_t narrowest() const { return to_the_right ? natural : std::min(natural, longest_word); }
};

bool is_number(const AnswerCell& cell) {
  return cell.note.empty() && !std::holds_alternative<std::string>(cell.value) &&
         !std::holds_alternative<bool>(cell.value);
}

std::size_t widest_of(const std::vector<std::string>& texts) {
  std::size_t width = 0;
  for (const std::string& one : texts) width = std::max(width, display_width(one));
  return width;
}

/// The widest word of a text that is not too long to be kept in one piece.
std::size_t longest_word(std::string_view text) {
  std::size_t longest = 0;
  for (std::size_t from = 0, end = 0; from <= text.size(); from = end + 1) {
    end = std::min(text.find(' ', from), text.size());
    const std::size_t width = display_width(std::string(text.substr(from, end - from)));
    if (width <= kLongestWord) longest = std::max(longest, width);
  }
  return longest;
}

/// Columns with something in them.
std::vector<Laid> used_columns(const AnswerTable& table, std::size_t n_rows) {
  std::vector<Laid> all;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].need == Need::data) continue;
    Laid laid;
    laid.column = &table.columns[k];
    for (std::size_t r = 0; r < n_rows; ++r) {
      const AnswerCell cell = k < table.rows[r].size() ? table.rows[r][k] : AnswerCell{};
      laid.cells.push_back(shown_cell(cell, table.columns[k]));
      laid.longest_word = std::max(laid.longest_word, longest_word(laid.cells.back()));
      laid.to_the_right = laid.to_the_right && is_number(cell);
    }
    const bool is_used =
        std::ranges::any_of(laid.cells, [](const std::string& cell) { return !cell.empty(); });
    if (is_used) all.push_back(std::move(laid));
  }
  return all;
}

/// "In all 12 rows: outcome converged, χ̄ 1." of the columns that do not vary, which go; "" = none.
std::string take_constant(std::vector<Laid>& columns, std::size_t n_rows) {
  if (n_rows < 2) return "";
  const auto is_constant = [](const Laid& one) {
    return one.column->need != Need::always &&
           std::ranges::all_of(one.cells,
                               [&](const std::string& cell) { return cell == one.cells.front(); });
  };
  std::string told;
  for (const Laid& one : columns) {
    if (!is_constant(one)) continue;
    const std::string& unit = one.column->unit.name;
    told += concat(told.empty() ? "" : ", ", one.column->heading, " ", one.cells.front(),
                   unit.empty() ? "" : " ", unit);
  }
  std::erase_if(columns, is_constant);
  return told.empty() ? "" : concat("In all ", n_rows, " rows: ", told, ".");
}

/// The words of a heading, its unit one of them, in lines no wider than the cells need anyway.
std::vector<std::string> heading_in_lines(const AnswerColumn& column, std::size_t cells) {
  std::vector<std::string> words;
  std::string rest = column.heading + (column.unit.name.empty() ? "" : ",");
  while (!rest.empty()) {
    const std::size_t blank = std::min(rest.find(' '), rest.size());
    words.push_back(rest.substr(0, blank));
    rest.erase(0, std::min(blank + 1, rest.size()));
  }
  if (!column.unit.name.empty()) words.push_back(column.unit.name);
  const std::size_t width = std::max(cells, widest_of(words));
  std::vector<std::string> lines;
  for (const std::string& word : words) {
    const bool fits =
        !lines.empty() && display_width(lines.back()) + 1 + display_width(word) <= width;
    if (fits) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

void set_headings(std::vector<Laid>& columns, bool in_lines) {
  for (Laid& one : columns) {
    const std::size_t cells = widest_of(one.cells);
    one.heading = in_lines ? heading_in_lines(*one.column, cells)
                           : std::vector<std::string>{shown_heading(*one.column)};
    one.natural = one.width = std::max(cells, widest_of(one.heading));
  }
}

/// Of all columns, by a width of each, with the gaps between them.
template <typename Width>
std::size_t width_of(const std::vector<Laid>& columns, Width width) {
  std::size_t sum = columns.empty() ? 0 : kGap * (columns.size() - 1);
  for (const Laid& one : columns) sum += std::invoke(width, one);
  return sum;
}

std::size_t least_width(const std::vector<Laid>& columns) {
  return width_of(columns, &Laid::narrowest);
}

/// Takes what is too much from the widest texts. @pre least_width fits.
void narrow(std::vector<Laid>& columns, std::size_t width) {
  while (width_of(columns, &Laid::width) > width) {
    const auto widest = std::ranges::max_element(columns, [](const Laid& a, const Laid& b) {
      return a.width - a.narrowest() < b.width - b.narrowest();
    });
    const std::size_t surplus = width_of(columns, &Laid::width) - width;
    widest->width -= std::min(surplus, widest->width - widest->narrowest());
  }
}

/// Leaves out what can be done without until the rest fits, the last column of the least need
/// first; the headings of what went, "" = none.
std::string leave_out(std::vector<Laid>& columns, std::size_t width) {
  std::vector<std::string> gone;
  for (const Need need : {Need::extra, Need::wanted}) {
    for (std::size_t k = columns.size(); k-- > 0 && least_width(columns) > width;) {
      if (columns[k].column->need != need) continue;
      gone.push_back(shown_heading(*columns[k].column));
      columns.erase(columns.begin() + static_cast<long>(k));
    }
  }
  std::ranges::reverse(gone);
  return joined(gone, "; ");
}

/// A row, or the heading, in as many lines as its texts need.
void add_lines(const std::vector<Laid>& columns, std::vector<std::string> cells,
               std::string& text) {
  for (bool more = true; more;) {
    std::string line;
    more = false;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string cell = cut_line(cells[k], columns[k].width);
      more = more || !cells[k].empty();
      const std::string fill(columns[k].width - std::min(columns[k].width, display_width(cell)),
                             ' ');
      const std::string gap(k == 0 ? 0 : kGap, ' ');
      line += gap + (columns[k].to_the_right ? fill + cell : cell + fill);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
}

std::string rows_in_columns(const std::vector<Laid>& columns, std::size_t n_rows) {
  std::size_t n_lines = 0;
  for (const Laid& one : columns) n_lines = std::max(n_lines, one.heading.size());
  std::string text;
  for (std::size_t line = 0; line < n_lines; ++line) {
    std::vector<std::string> cells;
    for (const Laid& one : columns) {
      const std::size_t first = n_lines - one.heading.size();
      cells.push_back(line < first ? "" : one.heading[line - first]);
    }
    add_lines(columns, cells, text);
  }
  for (std::size_t r = 0; r < n_rows; ++r) {
    std::vector cells = mapped(columns, [&](const Laid& one) { return one.cells[r]; });
    add_lines(columns, cells, text);
  }
  return text;
}

/// Where not even the columns that are needed fit: a paragraph for each row.
std::string rows_as_paragraphs(const std::vector<Laid>& columns, std::size_t n_rows,
                               std::size_t width) {
  std::string text;
  for (std::size_t r = 0; r < n_rows; ++r) {
    std::string row;
    for (const Laid& one : columns) {
      if (one.cells[r].empty()) continue;
      const std::string& unit = one.column->unit.name;
      row += concat(row.empty() ? "" : "; ", one.column->heading, " ", one.cells[r],
                    unit.empty() ? "" : " ", unit);
    }
    text += wrapped(row, width, 2);
  }
  return text;
}

/// The rows, with what is said above and below them for the sake of the width.
std::string laid_out(std::vector<Laid> columns, std::size_t n_rows, std::size_t width) {
  std::string text;
  const std::string constant = take_constant(columns, n_rows);
  if (!constant.empty()) text += wrapped(constant, width);
  if (columns.empty()) return text;
  set_headings(columns, false);
  if (width_of(columns, &Laid::natural) > width) set_headings(columns, true);
  const std::vector<Laid> all = columns;
  const std::string gone = leave_out(columns, width);
  if (columns.empty() || least_width(columns) > width)
    return text + rows_as_paragraphs(all, n_rows, width);
  narrow(columns, width);
  text += rows_in_columns(columns, n_rows);
  if (!gone.empty()) {
    text += wrapped(concat("Not shown on ", width, " columns: ", gone, " (--wide, --json)"), width);
  }
  return text;
}

struct TextBlocks {
  std::size_t width;
  std::string operator()(const AnswerTable& table) const {
    return table.on_screen ? render_text(table, width) : "";
  }
  std::string operator()(const AnswerNote& note) const { return wrapped(note.text, width); }
  std::string operator()(const AnswerChart&) const { return ""; }
};

}  // namespace

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::string lines;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string rest = text.substr(from, end - from);
    const std::size_t inside = width > indent + kNarrowest ? width - indent : kNarrowest;
    for (bool first = true; first || !rest.empty(); first = false)
      lines +=
          (first ? "" : std::string(indent, ' ')) + cut_line(rest, first ? width : inside) + '\n';
    from = end + 1;
  }
  return lines;
}

std::string render_text(const AnswerTable& table, std::size_t width) {
  const std::size_t n = table.rows.size();
  const std::size_t n_shown = table.most_on_screen == 0 ? n : std::min(n, table.most_on_screen);
  std::string text = table.title.empty() ? "" : wrapped(table.title, width);
  text += laid_out(used_columns(table, n_shown), n_shown, width);
  if (n_shown < n) text += concat("and ", n - n_shown, " more rows\n");
  for (const std::string& note : table.notes) text += wrapped(note, width);
  return text;
}

std::string render_text(const Answer& answer, std::size_t width) {
  std::string text;
  for (const std::string& sentence : answer.headline) text += wrapped(sentence, width);
  bool after_note = false;
  for (const AnswerBlock& block : answer.blocks) {
    const std::string part = std::visit(TextBlocks{width}, block);
    if (part.empty()) continue;
    const bool is_note = std::holds_alternative<AnswerNote>(block);
    if (!text.empty() && !(is_note && after_note)) text += '\n';  // notes stand together
    text += part;
    after_note = is_note;
  }
  return text;
}

}  // namespace faultsweep
