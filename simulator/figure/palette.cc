#include "simulator/figure/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace faultsim::figure {
namespace {

using Rgb = std::array<double, 3>;

/// By hand: a drawing may have thousands of them, and printf takes half a microsecond each.
std::string hex(const Rgb& colour) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const double part : colour) {
    const auto byte = static_cast<std::size_t>(std::lround(part));
    text += kDigits[byte / 16];
    text += kDigits[byte % 16];
  }
  return text;
}

Rgb between(const Rgb& a, const Rgb& b, double share) {
  Rgb mixed;
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = a[c] + (b[c] - a[c]) * share;
  return mixed;
}

}  // namespace

Stroke fault_stroke(std::size_t k, double width) {
  static constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#aa4499",
                                             "#56b4e9", "#a6761d", "#222222"};
  static constexpr const char* kDashes[] = {"", "8 3", "3 3", "9 3 2 3"};
  // 7 colours and 4 dashes have no common factor: 28 lines before the first comes again.
  return {kColours[k % std::size(kColours)], width, kDashes[k % std::size(kDashes)]};
}

std::string paler(const std::string& colour) {
  constexpr Rgb kWhite = {255, 255, 255};
  constexpr double kShare = 0.4;  // of white
  Rgb rgb;
  for (std::size_t c = 0; c < 3; ++c) rgb[c] = std::stoi(colour.substr(1 + 2 * c, 2), nullptr, 16);
  return hex(between(rgb, kWhite, kShare));
}

Stroke before_stroke(std::size_t k) {
  Stroke stroke = fault_stroke(k, 1);
  stroke.colour = paler(fault_ink(k));  // a thin line of the line's own colour would hardly be seen
  return stroke;
}

std::string fault_ink(std::size_t k) {
  static constexpr const char* kInks[] = {"#005f95", "#b04e00", "#00795a", "#a03a90",
                                          "#1a6fa8", "#84601a", "#222222"};
  return kInks[k % std::size(kInks)];
}

namespace {

constexpr std::size_t kBelow = 20, kAbove = 10;  // parts on both sides of kHighChi
constexpr double kHighChi = 0.8;
static_assert(kBelow + kAbove + 1 == kChiParts);

std::size_t part_of_share(double share, std::size_t n_parts) {
  const auto n = static_cast<double>(n_parts);
  return static_cast<std::size_t>(std::clamp(share * n, 0.0, n - 1));
}

}  // namespace

std::size_t chi_part(double chi) {
  if (chi >= kChiAtLimit) return kChiParts - 1;
  if (chi >= kHighChi) return kBelow + part_of_share((chi - kHighChi) / (1 - kHighChi), kAbove);
  return part_of_share(chi / kHighChi, kBelow);
}

std::string chi_part_colour(std::size_t part) {
  constexpr Rgb kNone = {240, 244, 248}, kBlue = {150, 190, 226}, kOrange = {240, 160, 56},
                kBrown = {196, 84, 8}, kLimit = {110, 10, 40};
  const auto middle = [](std::size_t k, std::size_t n) {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(n);
  };
  if (part >= kChiParts - 1) return hex(kLimit);
  if (part >= kBelow) return hex(between(kOrange, kBrown, middle(part - kBelow, kAbove)));
  return hex(between(kNone, kBlue, middle(part, kBelow)));
}

std::string chi_colour(double chi) { return chi_part_colour(chi_part(chi)); }

std::string share_colour(double share) {
  static constexpr Rgb kStops[] = {
      {232, 240, 248}, {253, 224, 150}, {240, 155, 64}, {192, 64, 32}, {110, 10, 40}};
  const double place = std::clamp(share, 0.0, 1.0) * (std::size(kStops) - 1);
  const auto k = std::min(static_cast<std::size_t>(place), std::size(kStops) - 2);
  return hex(between(kStops[k], kStops[k + 1], place - static_cast<double>(k)));
}

std::string change_colour(double share) {
  constexpr Rgb kFallen = {10, 70, 140}, kNone = {246, 246, 244}, kRisen = {130, 60, 6};
  const double size = std::min(std::abs(share), 1.0);
  return hex(between(kNone, share < 0 ? kFallen : kRisen, size));
}

}  // namespace faultsim::figure
