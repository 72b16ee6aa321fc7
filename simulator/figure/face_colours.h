#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// What the colours of faces and cells are of, and the scale that says which is which.
struct FaceColours {
  enum class Kind {
    chi,     ///< critical index: chi_colour.
    amount,  ///< from 0 to the largest: share_colour.
    change,  ///< of either sign: change_colour of its share of the largest size.
    state,   ///< 0 = sticks, 1 = slips (a line across the face), 2 = is open (a cross).
  };
  Kind kind = Kind::chi;
  std::string label = {};  ///< of the scale, with its unit: "slip, mm"; not of χ and states.
  /// Ends of the scale of amounts and changes, in which 0 lies: of all that is to be compared by
  /// colour, which may be more than is drawn.
  double low = 0, high = 0;
  std::string same = {};  ///< where else the same scale holds: "same scale at all load steps".

  /// Widens the scale to hold a value; nothing where it is not finite.
  void hold(double value);
  bool is_of_zeros() const { return !(high > low); }
};

std::string colour_of(const FaceColours& colours, double value);

/// In how many parts, each of one colour, a scale of amounts or changes is drawn.
inline constexpr std::size_t kScaleParts = 60;
/// Their colours from its low end on. @pre amounts or changes, and so below.
std::vector<std::string> part_colours(const FaceColours& colours, std::size_t n_parts);
/// The part that a value lies in; none where it is not finite.
std::optional<std::size_t> part_of(const FaceColours& colours, double value, std::size_t n_parts);

/// What the scale says, in the order of its elements: before it what it is of, and below its ends
/// and its middle; of nothing but zeros that, and "" below.
std::vector<std::string> scale_texts(const FaceColours& colours);
/// The scale in a box at the place, its label before it and its numbers below.
void draw_scale(Svg& svg, const FaceColours& colours, Point place, double width,
                std::size_t n_parts = kScaleParts);

}  // namespace faultsim::figure
