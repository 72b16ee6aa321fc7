#include "campaign/store/clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace faultsweep {

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string format_time(double seconds_since_1970) {
  const auto whole = static_cast<std::time_t>(seconds_since_1970);
  std::tm parts = {};
  localtime_r(&whole, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts);
  return text;
}

std::string format_duration(double seconds) {
  if (seconds < 1) return "less than 1 s";
  const long total = std::lround(std::max(0.0, seconds));
  constexpr long kMinute = 60, kHour = 3600, kDay = 86400;
  char text[64];
  if (total >= kDay) {
    std::snprintf(text, sizeof text, "%ld d %ld h", total / kDay, total % kDay / kHour);
  } else if (total >= kHour) {
    std::snprintf(text, sizeof text, "%ld h %02ld min", total / kHour, total % kHour / kMinute);
  } else if (total >= kMinute) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", total / kMinute, total % kMinute);
  } else {
    std::snprintf(text, sizeof text, "%ld s", total);
  }
  return text;
}

}  // namespace faultsweep
