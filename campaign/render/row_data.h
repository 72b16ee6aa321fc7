#pragma once

#include <string>
#include <vector>

#include "campaign/render/answer.h"

namespace faultsweep {

/// All rows of a table for the script of a page, which shows some of them at a time, JSON:
/// {"rows": n, "columns": [...]}. The cells read as on the screen. A column is, whichever is
/// shorter,
/// - {"texts": [...], "bytes": w, "at": "..."}: its different texts in the order in which they come
///   first, and which of them stands in each row; "at" is missing where there is only one;
/// - {"decimals": d, "bytes": w, "at": "..."}: the numbers of each row times 10^d, where all cells
///   are decimal numbers that are not negative;
/// - {"texts": [...]} with a text for each row.
/// "at" has w bytes per row, the lowest first, in base64.
/// @param columns  which of the table's, in order.
std::string row_data(const AnswerTable& table, const std::vector<std::size_t>& columns);

}  // namespace faultsweep
