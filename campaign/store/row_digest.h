#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "campaign/store/records.h"

namespace faultsweep {

/// A checksum over rows of tables: the sum of the hashes of the rows, each the hash of a sum over
/// its values with their columns. So the order of rows and columns has no say, a column that is
/// NULL counts as little as one that is not there, and rows that are being written can be added as
/// they are bound, in any order, without being read back. Finds what was damaged, not what was
/// forged.
class RowDigest {
 public:
  /// What a column is known by here.
  static std::uint64_t column_key(std::string_view table, std::string_view column);

  /// Adds a value to the present row, as the column stores it: whole numbers, real ones and text
  /// differ; NULL adds nothing.
  template <std::integral Value>
  void add(std::uint64_t column, Value value) {
    add_integer(column, static_cast<std::int64_t>(value));
  }
  void add(std::uint64_t column, double value);
  void add(std::uint64_t column, std::string_view text);
  void add(std::uint64_t column, const std::string& text) { add(column, std::string_view(text)); }
  void add(std::uint64_t column, const char* text) { add(column, std::string_view(text)); }
  template <typename Value>
  void add(std::uint64_t column, const std::optional<Value>& value) {
    if (value) add(column, *value);
  }
  void add(std::uint64_t column, const Cell& cell);
  void end_row();

  /// 32 hexadecimal digits, of the rows that have ended.
  std::string text() const;

 private:
  void add_integer(std::uint64_t column, std::int64_t value);

  std::uint64_t row_ = 0, high_ = 0, low_ = 0;
};

}  // namespace faultsweep
