#include "simulator/common/dates.h"

#include <chrono>
#include <cmath>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

/// The digits at [begin, begin + n) as a number; -1 where something else stands there.
int digits(const std::string& text, std::size_t begin, std::size_t n) {
  if (begin + n > text.size()) return -1;
  int value = 0;
  for (std::size_t i = begin; i < begin + n; ++i) {
    if (text[i] < '0' || text[i] > '9') return -1;
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

/// Seconds of "hh:mm" or "hh:mm:ss".
std::optional<int> parse_time_of_day(const std::string& text) {
  if (text.size() != 5 && text.size() != 8) return std::nullopt;
  const bool has_seconds = text.size() == 8;
  if (text[2] != ':' || (has_seconds && text[5] != ':')) return std::nullopt;
  const int hours = digits(text, 0, 2), minutes = digits(text, 3, 2);
  const int seconds = has_seconds ? digits(text, 6, 2) : 0;
  if (hours < 0 || hours > 23 || minutes < 0 || minutes > 59 || seconds < 0 || seconds > 59) {
    return std::nullopt;
  }
  return 3600 * hours + 60 * minutes + seconds;
}

}  // namespace

std::optional<double> parse_date(const std::string& text) {
  constexpr std::size_t kDate = 10;  // letters of YYYY-MM-DD
  if (text.size() < kDate || text[4] != '-' || text[7] != '-') return std::nullopt;
  const int year = digits(text, 0, 4), month = digits(text, 5, 2), day = digits(text, 8, 2);
  if (year < 1 || month < 0 || day < 0) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  constexpr double kDay = 86400;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  const double seconds = kDay * static_cast<double>(days);
  if (text.size() == kDate) return seconds;
  if (text[kDate] != 'T' && text[kDate] != ' ') return std::nullopt;
  std::string clock = text.substr(kDate + 1);
  if (!clock.empty() && clock.back() == 'Z') clock.pop_back();
  const std::optional<int> time = parse_time_of_day(clock);
  if (!time) return std::nullopt;
  return seconds + *time;
}

std::string date_text(double seconds) {
  constexpr double kDay = 86400;
  const std::chrono::sys_days days{std::chrono::days(std::lround(std::floor(seconds / kDay)))};
  const std::chrono::year_month_day date(days);
  return formatted("%04d-%02u-%02u", static_cast<int>(date.year()),
                   static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace faultsim
