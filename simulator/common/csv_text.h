#pragma once

#include <string>
#include <vector>

namespace faultsim {

/// Without blanks, tabs, line ends and quotation marks at its ends.
std::string trimmed(const std::string& text);

/// The cells of a line of CSV, trimmed; a comma at its end begins an empty one.
std::vector<std::string> csv_cells(const std::string& line);

/// Removes the mark of byte order that spreadsheets put before the first line.
void remove_byte_order_mark(std::string& first_line);

}  // namespace faultsim
