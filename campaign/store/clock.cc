#include "campaign/store/clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "campaign/common/names.h"

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
  if (total >= kDay) return formatted("%ld d %ld h", total / kDay, total % kDay / kHour);
  if (total >= kHour) return formatted("%ld h %02ld min", total / kHour, total % kHour / kMinute);
  if (total >= kMinute) return formatted("%ld min %02ld s", total / kMinute, total % kMinute);
  return formatted("%ld s", total);
}

}  // namespace faultsweep
