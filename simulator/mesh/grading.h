#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace faultsim {

inline constexpr double kMostCellsOnAxis = 50'000;  ///< 20 km in cells of 0.4 m.

/// Grid lines of one axis: lines that must be there, windows of even spacing, growth elsewhere.
///
/// Windows are cut at the lines in them and each piece is divided evenly into
/// max(1, ceil(length / size − 0.1)) cells, so a cell is stretched by at most a tenth (a piece of
/// one cell) and otherwise never larger than asked. Between windows the cells grow by at most
/// `growth` from both ends; where a line that must be there leaves no room for that, the ratio next
/// to it may be larger. Deterministic; cost linear in the number of lines, of which there are at
/// most kMostCellsOnAxis.
class LineBuilder {
 public:
  /// @param largest  cap of graded cells, m; 0 = none. @pre from < to, growth ≥ 1.
  LineBuilder(double from, double to, double growth, double largest);
  /// A line at x; ignored outside (from, to). Lines closer than tolerance() are one line.
  void add_line(double x);
  /// A line whose first cells on both sides have this size (or less where there is no room).
  void add_line(double x, double size);
  /// Spacing `size` in [window_from, window_to], clipped to the axis. Overlaps take the smaller
  /// size.
  void add_window(double window_from, double window_to, double size);
  /// Distance below which two lines are one, m: 1e-6, or less on a body shorter than a kilometre.
  double tolerance() const;
  /// Throws InputError about "/mesh" when there would be more cells than kMostCellsOnAxis, before
  /// it makes them.
  std::vector<double> build() const;

 private:
  struct Line {
    double x;
    double size;  // infinity = not given
  };
  struct Window {
    double from, to, size;
  };
  /// The axis cut at the lines.
  struct Pieces {
    std::vector<Line> lines;
    std::vector<double> size;                // per line: of the first cells on its graded sides
    std::vector<std::vector<double>> cells;  // per piece: sizes
    std::vector<char> even;                  // per piece: lies in a window
    std::vector<std::pair<double, double>> graded_between;  // per piece: sizes at its ends
    double length(size_t piece) const { return lines[piece + 1].x - lines[piece].x; }
    void lower(size_t line, double bound);  // unless the line has a size of its own
  };
  std::vector<Line> merged_lines() const;
  Pieces even_pieces() const;
  void grade(Pieces& pieces) const;
  bool lower_at_jumps(Pieces& pieces) const;  // true if a size was lowered
  double window_size(double piece_from, double piece_to) const;

  double from_, to_, growth_, largest_;
  std::vector<Line> lines_;
  std::vector<Window> windows_;
};

/// Sizes of the cells of a piece of this length that begin at first_size and last_size (infinity =
/// free) and grow towards the middle by a common ratio ≤ growth, the fewest that fit, capped by
/// `largest` (infinity = none). They add up to length. Throws as LineBuilder::build.
std::vector<double> graded_sizes(double length, double first_size, double last_size, double growth,
                                 double largest);

}  // namespace faultsim
