#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "simulator/gmsh/records.h"

namespace faultsim {
namespace {

static_assert(std::endian::native == std::endian::little);

}  // namespace

template <typename What>
void BinaryRecords::refuse(const char* cure, const What& what) {
  if (is_sound_) problems_.add(place(), cure, what);
  is_sound_ = false;
}

bool BinaryRecords::next(std::string_view form) {
  form_ = form;
  is_sound_ = true;
  record_ = byte_;
  return !rest_.empty();
}

template <typename Number>
Number BinaryRecords::take() {
  std::array<char, sizeof(Number)> bytes{};
  if (rest_.size() < bytes.size()) {
    refuse(kSaveAnew, [&] { return concat("the section ends within ", form_); });
    rest_ = {};
    return 0;
  }
  std::copy_n(rest_.begin(), bytes.size(), bytes.begin());
  if (is_swapped_) std::ranges::reverse(bytes);
  rest_.remove_prefix(bytes.size());
  byte_ += static_cast<int>(bytes.size());
  return std::bit_cast<Number>(bytes);
}

std::int64_t BinaryRecords::integer() { return take<std::int32_t>(); }

std::int64_t BinaryRecords::count() {
  const auto value = take<std::uint64_t>();
  if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return static_cast<std::int64_t>(value);
  refuse(kSaveAnew, [&] {
    return concat(value, " is more than 9223372036854775807 (expected: ", form_, ')');
  });
  return 0;
}

double BinaryRecords::real() {
  const auto value = take<double>();
  if (std::isfinite(value)) return value;
  refuse("mesh again; the geometry may have a coordinate that is not a number",
         [&] { return concat(value, " is not a finite number (expected: ", form_, ')'); });
  return 0;
}

void BinaryRecords::skip(int n_numbers) {
  for (int i = 0; i < n_numbers; ++i) take<std::uint64_t>();
}

bool BinaryRecords::may_hold(std::int64_t n_records, int n_bytes) const {
  return n_records <= std::ssize(rest_) / n_bytes;
}

}  // namespace faultsim
