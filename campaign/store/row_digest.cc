#include "campaign/store/row_digest.h"

#include <array>

#include "simulator/common/fingerprint.h"

namespace faultsweep {

using faultsim::hash64;

namespace {

constexpr std::uint64_t kReal = 1, kText = 2;  // beside the column: 1, 1.0 and "1" differ
constexpr std::uint64_t kHigh = 1, kLow = 2;   // two hashes of a row, 128 bits together

}  // namespace

std::uint64_t RowDigest::column_key(std::string_view table, std::string_view column) {
  return hash64(column.data(), column.size(), hash64(table.data(), table.size()));
}

void RowDigest::add_integer(std::uint64_t column, std::int64_t value) {
  row_ += hash64(&value, sizeof value, column);
}

void RowDigest::add(std::uint64_t column, double value) {
  value += 0.0;  // SQLite forgets the sign of -0
  row_ += hash64(&value, sizeof value, column + kReal);
}

void RowDigest::add(std::uint64_t column, std::string_view text) {
  row_ += hash64(text.data(), text.size(), column + kText);
}

void RowDigest::add(std::uint64_t column, const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) add_integer(column, *whole);
  if (const auto* real = std::get_if<double>(&cell)) add(column, *real);
  if (const auto* text = std::get_if<std::string>(&cell)) add(column, *text);
}

void RowDigest::end_row() {
  high_ += hash64(&row_, sizeof row_, kHigh);
  low_ += hash64(&row_, sizeof row_, kLow);
  row_ = 0;
}

std::string RowDigest::text() const {
  const std::array<std::uint64_t, 2> sums = {high_, low_};
  return faultsim::fingerprint(sums.data(), sizeof sums);
}

}  // namespace faultsweep
