#include "campaign/render/shown.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "campaign/common/names.h"
#include "simulator/common/printable.h"

namespace faultsweep {

namespace {

/// Digits in front of the point, of the largest numbers that are written without an exponent.
constexpr int kMostPlainDigits = 7;

}  // namespace

std::string format_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const std::string text = formatted("%.*g", digits, value + 0.0);
  if (text.find("e+") == std::string::npos) return text;
  const double rounded = std::strtod(text.c_str(), nullptr);
  const bool is_plain = std::abs(rounded) < std::pow(10.0, kMostPlainDigits);
  return is_plain ? formatted("%.0f", rounded) : text;
}

std::string in_unit(double value, const ShownUnit& unit, int digits) {
  return concat(format_number(value / unit.size, digits), unit.name.empty() ? "" : " ", unit.name);
}

std::string short_number(const std::string& text) {
  constexpr std::ptrdiff_t kDigits = 6;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string number(text.c_str(), static_cast<const char*>(end));
  const auto n_digits =
      std::ranges::count_if(number, [](unsigned char c) { return std::isdigit(c) != 0; });
  const bool alone = *end == '\0' || *end == ' ';
  const std::size_t point = number.find('.');
  if (!alone || n_digits <= kDigits || point == std::string::npos) return text;
  return format_number(value, std::max(static_cast<int>(kDigits), static_cast<int>(point))) + end;
}

std::string with_error(double value, double error) {
  if (!std::isfinite(value)) return "-";
  if (!(error > 0)) return error == 0 ? format_number(value) + " ± 0" : format_number(value);
  // %.0e rounds 0.0951 to 1e-01 first, so that the place is that of the digit that is shown.
  const std::string text = formatted("%.0e", error);
  const int place = std::stoi(text.substr(text.find('e') + 1));
  constexpr int kMostPlaces = 6;
  if (place > 0 && place < kMostPlainDigits && std::abs(value) < 100)
    return concat(formatted("%.0f", std::round(value) + 0.0), " ± ", format_number(error, 1));
  if (place > 0 || place < -kMostPlaces) {
    const std::string number = format_number(value, 3);
    // Both plainly, or neither.
    const bool is_plain = number.find("e+") == std::string::npos;
    return concat(number, " ± ", is_plain ? format_number(error, 1) : text);
  }
  return formatted("%.*f ± %.*f", -place, value + 0.0, -place, error);
}

std::string format_percent(double share, int digits) {
  constexpr double kLeast = 1e-5;
  if (!std::isfinite(share)) return "-";
  if (share > 0 && share < kLeast) return "< 0.001";
  if (share < 1 && share > 1 - kLeast) return "> 99.999";
  // 99.97 is not 100.
  const bool is_near_all = share < 1 && share > 1 - 0.5 * std::pow(10.0, -digits);
  return format_number(100 * share, is_near_all ? digits + 3 : digits);
}

std::string confidence_text(double confidence) { return format_number(100 * confidence, 4) + " %"; }

namespace {

std::string shown_number(double value, double error, const AnswerColumn& column) {
  if (!std::isfinite(value)) return std::isnan(value) ? "" : value > 0 ? "∞" : "-∞";
  if (column.unit.name == "%" && std::isnan(error)) return format_percent(value, column.digits);
  const double size = column.unit.size;
  return std::isnan(error) ? format_number(value / size, column.digits)
                           : with_error(value / size, error / size);
}

std::string shown_value(const AnswerCell& cell, const AnswerColumn& column) {
  if (const auto* flag = std::get_if<bool>(&cell.value)) return *flag ? "yes" : "no";
  if (const auto* count = std::get_if<std::int64_t>(&cell.value)) return std::to_string(*count);
  if (const auto* number = std::get_if<double>(&cell.value))
    return shown_number(*number, cell.error, column);
  if (const auto* words = std::get_if<std::string>(&cell.value)) return short_number(*words);
  return "";
}

}  // namespace

std::string shown_cell(const AnswerCell& cell, const AnswerColumn& column) {
  const std::string value = shown_value(cell, column);
  const std::string gap = value.empty() || cell.note.empty() ? "" : ", ";
  return faultsim::printable(value + gap + cell.note);
}

std::string shown_heading(const AnswerColumn& column) {
  return faultsim::printable(column.heading +
                             (column.unit.name.empty() ? "" : ", " + column.unit.name));
}

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

}  // namespace faultsweep
