#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "campaign/render/render.h"
#include "campaign/spec/metrics.h"
#include "campaign/store/records.h"
#include "simulator/common/units.h"

/// Tables for other programs, written row by row.
namespace faultsweep {

/// Text that goes to stdout, or to a file that gets its name when it is complete.
class TableOutput {
 public:
  /// @param target  "" = stdout. Throws StorageError.
  explicit TableOutput(const std::filesystem::path& target);
  ~TableOutput();
  TableOutput(TableOutput&&) noexcept;
  void write(std::string_view text);
  /// Throws StorageError when not everything could be written.
  void finish();

 private:
  void flush();
  struct File;
  std::unique_ptr<File> file_;  ///< none = stdout.
  std::string buffer_;
};

/// A cell as text; missing = "".
std::string cell_text(const Cell& cell);
/// A cell as a number; NaN where it is missing or text.
double number_of(const Cell& cell);
/// Of 12 significant digits, the fewest that are needed: 2394.8 for 2394.7999999999997; "nan" for
/// NaN.
std::string rounded_number(double value);
/// A number or a text as a field of a CSV file.
std::string csv_cell(const Cell& cell);
/// Text as one word: what is not printable ASCII, and quotes, become "_"; "" becomes "_".
std::string one_word(const std::string& text);
/// "offset", length -> "offset_m": the unit as column names of the store's views have it. Blanks of
/// "F2.max_slip in gas_storage" become "_".
std::string column_name(const std::string& given, faultsim::Dimension dimension);
/// The same of a metric: of plane strain "moment_nm_per_m".
std::string column_name(const MetricInfo& metric, bool plane_strain);

}  // namespace faultsweep
