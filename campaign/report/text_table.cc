#include "campaign/report/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"

namespace faultsweep {
namespace {

bool looks_like_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.+-e%*") == std::string::npos;
}

}  // namespace

std::size_t display_width(const std::string& text) {
  std::size_t width = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const bool continues = (byte & 0xC0) == 0x80;
    // U+0300 to U+036F, such as the bar of χ̄, sit on the letter before: bytes CC 80 to CD AF.
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0;
    const bool combines = byte == 0xCC || (byte == 0xCD && next < 0xB0);
    if (!continues && !combines) ++width;
  }
  return width;
}

std::string format_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

void TextTable::add_row(std::vector<std::string> cells) {
  FAULTSIM_DEMAND(cells.size() == header_.size(), cells.size(), " cells, ", header_.size(),
                  " columns");
  // Names in a store may come from before they were checked.
  for (std::string& cell : cells) cell = faultsim::printable(cell);
  rows_.push_back(std::move(cells));
}

std::string TextTable::text() const {
  struct Column {
    std::size_t index, width;
    bool to_the_right;
  };
  std::vector<Column> columns;
  for (std::size_t k = 0; k < header_.size(); ++k) {
    Column column{k, display_width(header_[k]), true};
    bool used = false;
    for (const auto& row : rows_) {
      column.width = std::max(column.width, display_width(row[k]));
      used = used || !row[k].empty();
      column.to_the_right = column.to_the_right && (row[k].empty() || looks_like_number(row[k]));
    }
    if (used) columns.push_back(column);
  }
  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (const Column& column : columns) {
      const std::string& cell = cells[column.index];
      const std::string fill(column.width - display_width(cell), ' ');
      line += (line.empty() ? "" : "  ") + (column.to_the_right ? fill + cell : cell + fill);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  add_line(header_);
  for (const auto& row : rows_) add_line(row);
  return text;
}

}  // namespace faultsweep
