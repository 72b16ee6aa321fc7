#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "simulator/common/table_reader.h"
#include "simulator/gmsh/records.h"

namespace faultsim {
namespace {

constexpr const char* kLineCure =
    "write each on a line of its own, as Gmsh does, in decimal numbers with a point: 1.5, 1e5";

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view without_spaces(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

template <typename What>
void TextRecords::refuse(const What& what) {
  if (is_sound_) problems_.add(place(), kLineCure, what);
  is_sound_ = false;
}

bool TextRecords::next(std::string_view form) {
  form_ = form;
  is_sound_ = true;
  skip_empty_lines();
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  text_ = without_spaces(rest_.substr(0, end));
  left_ = text_;
  byte_ = next_byte_;
  line_ = next_line_;
  const std::size_t taken = std::min(end + 1, rest_.size());
  rest_.remove_prefix(taken);
  next_byte_ += static_cast<int>(taken);
  ++next_line_;
  return true;
}

void TextRecords::skip_empty_lines() {
  for (;;) {
    std::size_t n = 0;
    while (n < rest_.size() && is_space(rest_[n])) ++n;
    if (n < rest_.size() && rest_[n] != '\n') return;
    if (n < rest_.size()) ++n;  // with its end
    if (n == 0) return;
    rest_.remove_prefix(n);
    next_byte_ += static_cast<int>(n);
    ++next_line_;
  }
}

bool TextRecords::is_at_end() {
  skip_empty_lines();
  return rest_.empty();
}

std::string_view TextRecords::rest_of_line() { return without_spaces(left_); }

std::string_view TextRecords::word() {
  while (!left_.empty() && is_space(left_.front())) left_.remove_prefix(1);
  std::size_t end = 0;
  while (end < left_.size() && !is_space(left_[end])) ++end;
  const std::string_view found = left_.substr(0, end);
  left_.remove_prefix(end);
  if (found.empty())
    refuse([&] { return concat(table_quote(text_), " ends too early for ", form_); });
  return found;
}

std::int64_t TextRecords::whole_number(std::int64_t least, std::int64_t most, const char* range) {
  if (!is_sound_) return 0;
  const std::string_view text = word();
  if (text.empty()) return 0;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = end == text.data() + text.size() && error == std::errc();
  if (is_number && value >= least && value <= most) return value;
  refuse([&] {
    return concat(table_quote(text), " is not a whole number ", range, " (expected: ", form_, ')');
  });
  return 0;
}

std::int64_t TextRecords::integer() {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  return whole_number(-kMost - 1, kMost, "from -2147483648 to 2147483647");
}

std::int64_t TextRecords::count() {
  return whole_number(0, std::numeric_limits<std::int64_t>::max(), "from 0 to 9223372036854775807");
}

double TextRecords::real() {
  if (!is_sound_) return 0;
  const std::string_view text = word();
  if (text.empty()) return 0;
  const std::optional<double> value = parse_number(text);
  if (!value)
    refuse([&] { return concat(table_quote(text), " is not a number (expected: ", form_, ')'); });
  return value.value_or(0);
}

void TextRecords::skip(int n_numbers) {
  for (int i = 0; i < n_numbers && is_sound_; ++i) word();
}

bool TextRecords::is_whole() {
  if (is_sound_ && !rest_of_line().empty())
    refuse([&] { return concat(table_quote(text_), " contains more than ", form_); });
  return is_sound_;
}

bool TextRecords::may_hold(std::int64_t n_records, int /*n_bytes*/) const {
  constexpr std::int64_t kLeastLine = 2;  // the last may do without its end
  return n_records <= (std::ssize(rest_) + 1) / kLeastLine;
}

}  // namespace faultsim
