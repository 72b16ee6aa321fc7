#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"

/// Tables with units, as spreadsheets and other programs write them; the one reader of all of them:
///
///   # comments and empty lines mean nothing
///   time [year], west [bar], "east, north [MPa] absolute"
///   0, 250, 25
///
/// Text in UTF-8, with or without a mark of byte order; lines end with LF, CR LF or CR. Cells are
/// separated by what the header has outside of quotes: semicolons, else commas, else tabs. Blanks
/// and tabs around cells mean nothing. Quotes are those of RFC 4180: a cell in quotes may hold
/// separators and, doubled, quotes; it ends on its line. Numbers are decimal with a point: a comma
/// is refused whatever separates, as 1,234 may be meant as 1.234 or as 1234.
namespace faultsim {

/// What the values of a column may be, SI.
struct ValueRange {
  double low, high;
  const char* text;  ///< for messages: "-10 GPa to 10 GPa".
};
// As in schemas/scene.schema.json.
inline constexpr ValueRange kLengthRange{-1e7, 1e7, "-10000 km to 10000 km"};
inline constexpr ValueRange kSizeRange{1e-3, 1e7, "1 mm to 10000 km"};
inline constexpr ValueRange kAngleRange{-360 * kDegree, 360 * kDegree, "-360 deg to 360 deg"};
inline constexpr ValueRange kTimeRange{0, 1e15 * 365.25 * 86400, "0 to 1e15 years"};
inline constexpr ValueRange kPressureRange{0, 1e10, "0 to 10 GPa absolute"};
inline constexpr ValueRange kPressureChangeRange{-1e10, 1e10, "-10 GPa to 10 GPa"};
inline constexpr ValueRange kTemperatureRange{0, 2000, "0 K to 2000 K"};

/// A cell of the header, "west [bar] absolute".
struct TableColumn {
  std::string text;                 ///< the whole cell.
  std::string name;                 ///< before the last brackets; all of it where there are none.
  std::optional<std::string> unit;  ///< within them; none: there are no brackets.
  std::string words;                ///< behind them.
};
TableColumn table_column(std::string_view cell);

/// A cell read as a number, or why it is none.
struct TableNumber {
  double value = 0;
  std::string what;  ///< "" = read.
  std::string cure;
};

/// A plain decimal number with a point, finite, nothing around it: none for hexadecimal, inf, nan
/// and 1e999. The nearest double. Takes some 20 ns.
std::optional<double> parse_number(std::string_view text);

/// text in quotes for a message: printable, and no longer than a line.
std::string table_quote(std::string_view text);

/// Cuts the next line off; ends of lines are LF, CR LF and CR.
std::string_view next_table_line(std::string_view& rest);

/// What separates the cells of a table with this header.
char table_separator(std::string_view header);

/// Whether a line holds nothing but blanks, or a comment.
bool is_idle_table_line(std::string_view line);

/// Reads a header and then row by row, and keeps what is wrong, with its line. Of problems with the
/// same cure the first 20 are spelled out and the others counted.
class TableReader {
 public:
  /// Reads the header. Refused there: quotes that do not close, characters that are none (NUL and
  /// others that a terminal would obey, bytes that are not UTF-8), more than 10,000 columns.
  /// @param text    must outlive the reader.
  /// @param source  of InputErrors.
  TableReader(std::string_view text, std::string source);

  /// None where the table has no header.
  const std::vector<TableColumn>& columns() const { return columns_; }
  /// Gives a column another heading, which somebody has said elsewhere.
  void rename(std::size_t column, TableColumn heading) { columns_[column] = std::move(heading); }

  /// Checks that a column has a unit of this dimension (temperatures: degC and degF are known too)
  /// and no words behind it, and keeps what it may hold.
  /// @param words  what may stand behind the unit.
  /// @param cure   how such a column is headed.
  bool set_unit(std::size_t column, Dimension dimension, const ValueRange& range,
                const std::string& cure, const std::vector<std::string>& words = {});

  /// Goes on to the next row that has a cell for each column; others are refused. False: the end.
  bool next_row();
  int line() const { return line_; }  ///< from 1, of the row; at first of the header.
  /// A cell of the row, without blanks and quotes around it.
  std::string_view cell(std::size_t column) const { return cells_[column]; }

  /// A cell as a finite decimal number in the column's unit, within its range in SI.
  TableNumber check_number(std::size_t column) const;
  /// The same, where what is wrong is kept; none after a refusal.
  std::optional<double> number(std::size_t column);
  /// The number in SI.
  std::optional<double> value(std::size_t column);

  void refuse(const std::string& what, const std::string& cure) { refuse_at(line_, what, cure); }
  /// @param line  0: the whole table.
  void refuse_at(int line, const std::string& what, const std::string& cure);
  bool is_sound() const { return problems_.empty(); }
  /// False where there is none, or none that can be read: said.
  /// @param cure  how such a table is headed.
  bool has_header(const std::string& cure);
  /// Throws InputError with all that is wrong, if something is.
  void require_sound() const;
  /// The same, and where there was no row.
  void require_rows(const std::string& cure);

 private:
  /// A value in SI is size · number + zero.
  struct Unit {
    double size = 1, zero = 0;
    std::optional<ValueRange> range;
  };
  static std::optional<Unit> unit_of(const std::string& unit, Dimension dimension);
  bool next_line(std::string_view& line);
  bool split(std::string_view line);
  bool split_quoted(std::string_view line);

  std::string_view rest_;
  std::string source_;
  int line_ = 0;
  char separator_ = ',';
  std::vector<TableColumn> columns_;
  std::vector<Unit> units_;
  std::vector<std::string_view> cells_;
  std::deque<std::string> unquoted_;  ///< cells of the row that had doubled quotes.
  bool has_rows_ = false;
  std::vector<Problem> problems_;
  std::map<std::string, std::size_t> counts_;  ///< of problems, by cure.
};

}  // namespace faultsim
