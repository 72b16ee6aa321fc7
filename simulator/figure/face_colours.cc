#include "simulator/figure/face_colours.h"

#include <algorithm>
#include <cmath>

#include "simulator/figure/axis.h"
#include "simulator/figure/palette.h"

namespace faultsim::figure {

using Kind = FaceColours::Kind;

void FaceColours::hold(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

std::string colour_of(const FaceColours& colours, double value) {
  const double size = std::max(-colours.low, colours.high);
  const double share = size > 0 ? value / size : 0;
  switch (colours.kind) {
    case Kind::chi:
      return chi_colour(value);
    case Kind::amount:
      return share_colour(share);
    case Kind::change:
      return change_colour(share);
    case Kind::state:
      return value < 0.5 ? kStickColour : value < 1.5 ? kSlipColour : kOpenColour;
  }
  return kFrame;
}

std::vector<std::string> part_colours(const FaceColours& colours, std::size_t n_parts) {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < n_parts; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(n_parts);
    all.push_back(colour_of(colours, colours.low + (colours.high - colours.low) * share));
  }
  return all;
}

std::optional<std::size_t> part_of(const FaceColours& colours, double value, std::size_t n_parts) {
  if (!std::isfinite(value)) return std::nullopt;
  if (colours.is_of_zeros()) return 0;
  const double share = (value - colours.low) / (colours.high - colours.low);
  return static_cast<std::size_t>(
      std::clamp(share * static_cast<double>(n_parts), 0.0, static_cast<double>(n_parts - 1)));
}

std::vector<std::string> scale_texts(const FaceColours& colours) {
  if (colours.is_of_zeros()) return {colours.label + ": 0 everywhere", "", "", ""};
  return {colours.label, plain_number(colours.low), plain_number((colours.low + colours.high) / 2),
          plain_number(colours.high)};
}

void draw_scale(Svg& svg, const FaceColours& colours, Point place, double width,
                std::size_t n_parts) {
  constexpr double kHeight = 10;
  const std::vector<std::string> texts = scale_texts(colours);
  svg.text({place.x - 8, place.y + kHeight}, texts[0], {kLabelSize, kInk, Anchor::end});
  const std::vector<std::string> parts = part_colours(colours, n_parts);
  for (std::size_t k = 0; k < n_parts; ++k) {  // each to the end: nothing shines through
    const double from = width * static_cast<double>(k) / static_cast<double>(n_parts);
    svg.rect({place.x + from, place.y, width - from, kHeight}, parts[k]);
  }
  svg.rect({place.x, place.y, width, kHeight}, "none", {kFrame, 0.75});
  for (std::size_t k = 1; k < texts.size(); ++k) {
    const double share = static_cast<double>(k - 1) / 2;
    svg.text({place.x + width * share, place.y + kHeight + 13}, texts[k],
             {kTickSize, kFaint, Anchor::middle});
  }
}

}  // namespace faultsim::figure
