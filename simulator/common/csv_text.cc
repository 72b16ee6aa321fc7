#include "simulator/common/csv_text.h"

namespace faultsim {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  for (std::size_t to = line.find(','); to != std::string::npos; to = line.find(',', from)) {
    cells.push_back(trimmed(line.substr(from, to - from)));
    from = to + 1;
  }
  cells.push_back(trimmed(line.substr(from)));
  return cells;
}

void remove_byte_order_mark(std::string& first_line) {
  if (first_line.compare(0, 3, "\xEF\xBB\xBF") == 0) first_line.erase(0, 3);
}

}  // namespace faultsim
