#include "campaign/render/row_data.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"
#include "simulator/common/base64.h"

namespace faultsweep {
namespace {

using Numbers = std::vector<std::uint64_t>;

/// As few bytes for each number as the largest needs.
nlohmann::json packed(const Numbers& numbers) {
  const std::uint64_t largest = numbers.empty() ? 0 : *std::ranges::max_element(numbers);
  int width = 1;
  while (largest >> (8 * width) != 0) ++width;
  std::string bytes;
  bytes.reserve(numbers.size() * static_cast<std::size_t>(width));
  for (const std::uint64_t number : numbers)
    for (int k = 0; k < width; ++k) bytes += static_cast<char>(number >> (8 * k) & 255U);
  return {{"bytes", width}, {"at", faultsim::base64(bytes)}};
}

/// "12.35" of 123500 and four decimals.
std::string decimal_text(std::uint64_t number, std::size_t decimals) {
  std::string digits = std::to_string(number);
  if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
  digits.insert(digits.size() - decimals, ".");
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

/// The digits without their point, times 10^decimals; none where that is not all that the text
/// says.
std::optional<std::uint64_t> times_power(const std::string& text, std::size_t decimals) {
  constexpr std::size_t kMostDigits = 15;  // that a number of JavaScript holds
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, point);
  const std::string behind = point < text.size() ? text.substr(point + 1) : "";
  if (digits.empty() || behind.size() > decimals) return std::nullopt;
  digits += behind + std::string(decimals - behind.size(), '0');
  const bool are_digits = std::ranges::all_of(digits, [](char c) { return '0' <= c && c <= '9'; });
  if (!are_digits || digits.size() > kMostDigits) return std::nullopt;
  const auto number = static_cast<std::uint64_t>(std::stoull(digits));
  return decimal_text(number, decimals) == text ? std::optional(number) : std::nullopt;
}

std::optional<nlohmann::json> as_decimals(const std::vector<std::string>& texts) {
  std::size_t decimals = 0;
  for (const std::string& text : texts) {
    const std::size_t point = text.find('.');
    if (point != std::string::npos) decimals = std::max(decimals, text.size() - point - 1);
  }
  Numbers numbers;
  for (const std::string& text : texts) {
    const auto number = times_power(text, decimals);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  nlohmann::json column = packed(numbers);
  column["decimals"] = decimals;
  return column;
}

nlohmann::json column_data(const AnswerTable& table, std::size_t column) {
  constexpr std::size_t kMostTexts = 65536;
  std::vector<std::string> texts, all;
  Numbers at;
  std::unordered_map<std::string, std::uint64_t> known;
  for (const std::vector<AnswerCell>& row : table.rows) {
    all.push_back(
        shown_cell(column < row.size() ? row[column] : AnswerCell{}, table.columns[column]));
    const auto [place, is_new] = known.try_emplace(all.back(), std::uint64_t{texts.size()});
    if (is_new) texts.push_back(all.back());
    at.push_back(place->second);
  }
  if (texts.size() == 1) return {{"texts", texts}};
  constexpr std::size_t kFew = 256;
  const bool is_varied = texts.size() > kMostTexts || 2 * texts.size() > all.size() + kFew;
  if (!is_varied) {
    nlohmann::json data = packed(at);
    data["texts"] = std::move(texts);
    return data;
  }
  if (auto decimals = as_decimals(all)) return *std::move(decimals);
  return {{"texts", std::move(all)}};
}

}  // namespace

std::string row_data(const AnswerTable& table, const std::vector<std::size_t>& columns) {
  nlohmann::json data = {{"rows", table.rows.size()}, {"columns", nlohmann::json::array()}};
  for (const std::size_t column : columns) data["columns"].push_back(column_data(table, column));
  return data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace faultsweep
