#pragma once

#include <cstddef>
#include <string>

#include "simulator/figure/svg.h"

/// The one place of colours, sizes of text and line styles.
namespace faultsim::figure {

inline constexpr double kTitleSize = 15, kLabelSize = 12, kTickSize = 11;
inline constexpr const char* kInk = "#222222";    ///< text.
inline constexpr const char* kFaint = "#6b6b6b";  ///< ticks, remarks; 5.3:1 on white.
inline constexpr const char* kGrid = "#e3e3e3";
inline constexpr const char* kFrame = "#8c8c8c";
inline constexpr const char* kFaultEdge = "#2b2b2b";  ///< around the colour of a fault's χ.
inline constexpr const char* kShade = "#f3f4f6";      ///< every other stage.
inline constexpr const char* kReservoir = "#f3e3b3";  ///< rock that is depleted.

/// Line of the k-th fault (from 0), or of the k-th of other things, in every chart: colours of
/// Okabe and Ito (2008), told apart by all kinds of colour blindness and, as the dashes differ too,
/// in grey.
Stroke fault_stroke(std::size_t k, double width = 2);
/// The same line as it was before a change: thin, and paler.
Stroke before_stroke(std::size_t k);
/// A colour, "#0072b2", as before_stroke has it.
std::string paler(const std::string& colour);

/// The colour of what is written of it: of its hue, and dark enough to be read (4.5 : 1) on white
/// and on kShade.
std::string fault_ink(std::size_t k);

/// Colour of a critical index: lightness falls throughout, the hue changes at 0.8 (blue to orange)
/// and at 1 (to dark red), so that both are seen in colour, and the order in grey. It falls in
/// parts, 20 below 0.8, 10 below the limit, and the limit.
std::string chi_colour(double chi);
inline constexpr std::size_t kChiParts = 31;
std::size_t chi_part(double chi);
std::string chi_part_colour(std::size_t part);
/// From here on a χ counts as 1: the tolerance to which slipping nodes keep to their strength.
inline constexpr double kChiAtLimit = 1 - 1e-6;
/// Colour of a share of cases that slide: lightness falls throughout, from pale blue (none) by
/// yellow and orange to the dark red of the limit (all); cut off at both ends.
std::string share_colour(double share);
/// Colour of a change, as a share of the largest from -1 (blue) by 0 (nearly white) to 1 (brown):
/// lightness falls as much to both sides; cut off at both ends.
std::string change_colour(double share);
/// Colours of what a face does: sticks, slips, is open. Lightness falls in this order.
inline constexpr const char *kStickColour = "#e3e9ef", *kSlipColour = "#f0a038",
                            *kOpenColour = "#7a4a9e";

}  // namespace faultsim::figure
