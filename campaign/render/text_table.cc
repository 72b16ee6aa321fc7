#include "campaign/render/text_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"

namespace faultsweep {
namespace {

bool looks_like_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.+-e%*") == std::string::npos;
}

struct TextColumn {
  std::size_t index, width;
  bool to_the_right;
};

std::vector<TextColumn> used_columns(const std::vector<std::string>& header,
                                     const std::vector<std::vector<std::string>>& rows) {
  std::vector<TextColumn> columns;
  for (std::size_t k = 0; k < header.size(); ++k) {
    TextColumn column{k, display_width(header[k]), true};
    bool used = false;
    for (const auto& row : rows) {
      column.width = std::max(column.width, display_width(row[k]));
      used = used || !row[k].empty();
      column.to_the_right = column.to_the_right && (row[k].empty() || looks_like_number(row[k]));
    }
    if (used) columns.push_back(column);
  }
  return columns;
}

/// Takes so many columns of the screen from the widest text of a block.
void narrow(std::vector<TextColumn>& block, std::size_t surplus) {
  const auto widest =
      std::max_element(block.begin(), block.end(), [](const TextColumn& a, const TextColumn& b) {
        return (a.to_the_right ? 0 : a.width) < (b.to_the_right ? 0 : b.width);
      });
  if (widest->to_the_right || widest->width <= kNarrowest) return;
  widest->width = std::max(kNarrowest, widest->width - std::min(widest->width, surplus));
}

/// A row, in as many lines as its texts need.
void add_lines(const std::vector<TextColumn>& block, std::vector<std::string> cells,
               std::string& text) {
  for (bool more = true; more;) {
    std::string line;
    more = false;
    for (const TextColumn& column : block) {
      const std::string cell = cut_line(cells[column.index], column.width);
      more = more || !cells[column.index].empty();
      const std::string fill(column.width - std::min(column.width, display_width(cell)), ' ');
      const std::string gap(line.empty() ? 0 : kGap, ' ');
      line += gap + (column.to_the_right ? fill + cell : cell + fill);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
}

}  // namespace

void TextTable::add_row(std::vector<std::string> cells) {
  FAULTSIM_DEMAND(cells.size() == header_.size(), cells.size(), " cells, ", header_.size(),
                  " columns");
  // Names in a store may come from before they were checked.
  for (std::string& cell : cells) cell = short_number(faultsim::printable(cell));
  rows_.push_back(std::move(cells));
}

std::string TextTable::text(std::size_t width) const {
  const std::vector<TextColumn> columns = used_columns(header_, rows_);
  if (columns.empty()) return "";
  std::string text;
  for (std::size_t first = 1, last = 1; text.empty() || first < columns.size(); first = last) {
    std::vector<TextColumn> block = {columns[0]};
    std::size_t taken = columns[0].width;
    for (last = first; last < columns.size(); ++last) {
      if (last > first && taken + kGap + columns[last].width > width) break;
      block.push_back(columns[last]);
      taken += kGap + columns[last].width;
    }
    if (taken > width) narrow(block, taken - width);
    if (!text.empty()) text += '\n';
    add_lines(block, header_, text);
    for (const auto& row : rows_) add_lines(block, row, text);
  }
  return text;
}

std::string first_fault(bool any, const std::string& fault, const std::optional<int>& step) {
  if (!any) return "";
  return faultsim::concat(fault.empty() ? "yes" : fault,
                          step ? faultsim::concat(" at step ", *step) : "");
}

}  // namespace faultsweep
