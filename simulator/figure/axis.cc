#include "simulator/figure/axis.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsim::figure {
namespace {

constexpr const char* kMinus = "\xE2\x88\x92";  // U+2212

/// 1, 2 or 5 times a power of ten that divides the range into about n parts.
double nice_step(double range, int n) {
  const double rough = range / std::max(n, 1);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/// Without exponent, with so many decimals and commas between thousands.
std::string fixed_text(double value, int decimals) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, std::abs(value), std::chars_format::fixed, decimals)
          .ptr;
  std::string number(text, end);
  const bool is_zero = number.find_first_not_of("0.") == std::string::npos;
  const std::size_t point = std::min(number.find('.'), number.size());
  for (std::size_t k = point; k > 3; k -= 3) number.insert(k - 3, ",");
  return (value < 0 && !is_zero ? kMinus : "") + number;
}

std::string exponent_text(double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, std::abs(value),
                                 std::chars_format::scientific, digits - 1)
                       .ptr;
  std::string number(text, end);
  const std::size_t e = number.find('e');
  std::string mantissa = number.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  const int exponent = std::stoi(number.substr(e + 1));
  return concat(value < 0 ? kMinus : "", mantissa, "e", exponent < 0 ? kMinus : "",
                std::abs(exponent));
}

bool wants_exponent(double size) { return size >= 1e7 || (size > 0 && size < 1e-4); }

}  // namespace

std::vector<Tick> ticks_within(double low, double high, int n) {
  if (!(std::isfinite(low) && std::isfinite(high) && low < high)) return {};
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low < 1e-12 * size) return {};  // steps of a range of last digits do not add up
  const double step = nice_step(high - low, n);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const bool exponents = wants_exponent(size);
  std::vector<Tick> ticks;
  const double slack = 1e-9 * (high - low);
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) {
    const double value = k == 0 ? 0 : k * step;
    ticks.push_back({value, value == 0  ? "0"
                            : exponents ? exponent_text(value, 3)
                                        : fixed_text(value, decimals)});
  }
  return ticks;
}

Axis axis_over(const std::string& label, const std::vector<double>& values,
               const std::vector<double>& always, int n_ticks) {
  double low = INFINITY, high = -INFINITY;
  for (const auto* list : {&values, &always}) {
    for (const double value : *list) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) low = 0, high = 1;
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size || high == low) {
    const double half = size > 0 ? 0.5 * size : 0.5;
    low -= half, high += half;
  }
  const double step = nice_step(high - low, n_ticks);
  constexpr double kSlack = 1e-6;  // of a step: a χ of 1 up to a solver's tolerance ends at 1
  low = std::floor(low / step + kSlack) * step;
  high = std::ceil(high / step - kSlack) * step;
  return axis_between(label, low, high, n_ticks);
}

Axis axis_between(const std::string& label, double from, double to, int n_ticks) {
  FAULTSIM_DEMAND(std::isfinite(from) && std::isfinite(to) && from != to, from, " to ", to);
  return {label, from, to, ticks_within(std::min(from, to), std::max(from, to), n_ticks)};
}

std::string plain_number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  if (wants_exponent(std::abs(value))) return exponent_text(value, digits);
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  std::string text = fixed_text(value, std::max(0, digits - before));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::vector<double> spread(const std::vector<double>& wanted, double gap, double low, double high) {
  const std::size_t n = wanted.size();
  if (n == 0) return {};
  if (n > 1) gap = std::min(gap, (high - low) / static_cast<double>(n - 1));
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  // Neighbours that are too close become one block, which stands at the mean of what its members
  // want of its first place (isotonic regression: pool adjacent violators).
  struct Block {
    double sum;
    std::size_t count;
    double place() const { return sum / static_cast<double>(count); }
  };
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < n; ++k) {
    blocks.push_back({wanted[order[k]] - gap * static_cast<double>(k), 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].place() > blocks.back().place()) {
      blocks[blocks.size() - 2].sum += blocks.back().sum;
      blocks[blocks.size() - 2].count += blocks.back().count;
      blocks.pop_back();
    }
  }
  std::vector<double> placed(n);
  std::size_t k = 0;
  const double last = high - gap * static_cast<double>(n - 1);
  for (const Block& block : blocks) {
    for (std::size_t i = 0; i < block.count; ++i, ++k) {
      placed[order[k]] = std::clamp(block.place(), low, last) + gap * static_cast<double>(k);
    }
  }
  return placed;
}

}  // namespace faultsim::figure
