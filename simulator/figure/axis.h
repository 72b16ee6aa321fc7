#pragma once

#include <string>
#include <vector>

namespace faultsim::figure {

struct Tick {
  double value = 0;
  std::string label;
};

/// A scale with its ticks, linear between two ends.
struct Axis {
  std::string label;        ///< quantity and unit: "depth, m"; "" = none.
  double from = 0, to = 1;  ///< what is at the left (or bottom) and at the right end; from ≠ to.
  std::vector<Tick> ticks = {};
  /// Share of the axis at a value: 0 at `from`, 1 at `to`.
  double share(double value) const { return (value - from) / (to - from); }
};

/// Multiples of 1, 2 or 5 times a power of ten within [low, high], about n of them, with the digits
/// that tell them apart and a true minus. Nothing where the ends are not a finite range, or one
/// of last digits only.
std::vector<Tick> ticks_within(double low, double high, int n);

/// An axis that holds all finite values, widened to whole ticks; of values that are all alike a
/// range around them. Values that are not finite do not take part; without any the range is 0 to 1.
/// @param always  the range holds these whatever the values: {0} for lengths of bars.
Axis axis_over(const std::string& label, const std::vector<double>& values,
               const std::vector<double>& always = {}, int n_ticks = 5);
/// An axis from end to end as given, with ticks. @pre from ≠ to, finite.
Axis axis_between(const std::string& label, double from, double to, int n_ticks = 5);

/// A number with so many significant digits, for people: "−0.25", "1,440", "3.1e9".
std::string plain_number(double value, int digits = 3);

/// Where labels go that want to stand at these places: in the same order, `gap` apart at least and
/// within [low, high] as long as that has room, else evenly spread over it. Sum of squares of moves
/// is least where nothing is at an end.
std::vector<double> spread(const std::vector<double>& wanted, double gap, double low, double high);

}  // namespace faultsim::figure
