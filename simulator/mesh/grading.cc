#include "simulator/mesh/grading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStretch = 0.1;          // share of a cell that may be spread over the others
constexpr double kRatioTolerance = 1e-9;  // rounding of a length divided by a size
constexpr int kMaxSmoothing = 40;  // passes that smooth sizes across lines that must be there

/// Called with counts that are still doubles: a length over a size may be beyond every integer.
void require_few(double n_cells) {
  if (n_cells <= kMostCellsOnAxis) return;
  throw InputError(
      "scene",
      {{"/mesh", 0,
        concat("the mesh would have more than ", kMostCellsOnAxis, " cells along one axis"),
        "use larger cells, more growth, or a larger \"largest\""}});
}

int even_count(double length, double size) {
  const double count = std::ceil(length / size - kStretch);
  require_few(count);
  return std::max(1, static_cast<int>(count));
}

/// s_k = min(first r^k, last r^(n−1−k), largest) for k = 0 … n−1.
/// @param sizes  filled; asked for some hundred times per line, it keeps its memory.
const std::vector<double>& two_sided(int n, double ratio, double first, double last, double largest,
                                     std::vector<double>& sizes) {
  sizes.assign(n, largest);
  double up = first;
  for (int k = 0; k < n; ++k, up *= ratio) {
    sizes[k] = std::min(sizes[k], up);
    if (up >= largest) break;
  }
  double down = last;
  for (int k = n - 1; k >= 0; --k, down *= ratio) {
    sizes[k] = std::min(sizes[k], down);
    if (down >= largest) break;
  }
  return sizes;
}

double sum(const std::vector<double>& sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), 0.0);
}

std::vector<double> scaled_to(std::vector<double> sizes, double length) {
  const double scale = length / sum(sizes);
  for (double& size : sizes) size *= scale;
  return sizes;
}

/// Fewest cells whose two-sided growth reaches the length.
int fewest_cells(double length, double first, double last, double growth, double largest,
                 std::vector<double>& scratch) {
  const auto reaches = [&](int n) {
    return sum(two_sided(n, growth, first, last, largest, scratch)) >=
           length * (1 - kRatioTolerance);
  };
  int high = 1;
  while (!reaches(high)) require_few(high *= 2);
  int low = high / 2;  // does not reach (0 for high = 1)
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (reaches(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

std::vector<double> graded_sizes(double length, double first_size, double last_size, double growth,
                                 double largest) {
  FAULTSIM_DEMAND(length > 0 && first_size > 0 && last_size > 0 && largest > 0 && growth >= 1,
                  length, " ", first_size, " ", last_size, " ", largest, " ", growth);
  const double start = std::min({first_size, last_size, largest});
  if (start >= length) return {length};
  std::vector<double> scratch;
  const int n = fewest_cells(length, first_size, last_size, growth, largest, scratch);
  const auto at = [&](int count, double ratio) -> const std::vector<double>& {
    return two_sided(count, ratio, first_size, last_size, largest, scratch);
  };
  if (sum(at(n, 1)) >= length) {
    // Even n cells of the smallest size are too many: prefer one cell less, slightly stretched.
    if (n > 1 && length <= (1 + kStretch / (n - 1)) * sum(at(n - 1, growth)))
      return scaled_to(at(n - 1, growth), length);
    return std::vector<double>(static_cast<size_t>(n), length / n);
  }
  double low = 1, high = growth;
  for (int k = 0; k < 60; ++k) {  // 60 halvings: a double's 53 bits and some
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (sum(at(n, middle)) < length ? low : high) = middle;
  }
  return scaled_to(at(n, high), length);
}

LineBuilder::LineBuilder(double from, double to, double growth, double largest)
    : from_(from), to_(to), growth_(growth), largest_(largest > 0 ? largest : kInfinity) {
  FAULTSIM_DEMAND(from < to && growth >= 1, from, " ", to, " ", growth);
}

double LineBuilder::tolerance() const { return std::min(1e-6, 1e-9 * (to_ - from_)); }

void LineBuilder::add_line(double x) { add_line(x, kInfinity); }

void LineBuilder::add_line(double x, double size) {
  if (x > from_ + tolerance() && x < to_ - tolerance()) lines_.push_back({x, size});
}

void LineBuilder::add_window(double window_from, double window_to, double size) {
  window_from = std::max(window_from, from_);
  window_to = std::min(window_to, to_);
  if (!(window_to - window_from > tolerance())) return;
  windows_.push_back({window_from, window_to, size});
  add_line(window_from);
  add_line(window_to);
}

std::vector<LineBuilder::Line> LineBuilder::merged_lines() const {
  std::vector<Line> sorted = lines_;
  std::ranges::stable_sort(sorted, {}, &Line::x);
  std::vector<Line> merged = {{from_, kInfinity}};
  for (const Line& line : sorted) {
    if (line.x - merged.back().x < tolerance() && merged.size() > 1)
      merged.back().size = std::min(merged.back().size, line.size);
    else
      merged.push_back(line);
  }
  merged.push_back({to_, kInfinity});
  return merged;
}

double LineBuilder::window_size(double piece_from, double piece_to) const {
  const double middle = 0.5 * (piece_from + piece_to);
  double size = kInfinity;
  for (const Window& window : windows_)
    if (middle > window.from && middle < window.to) size = std::min(size, window.size);
  return size;
}

std::vector<double> LineBuilder::build() const {
  Pieces pieces = even_pieces();
  for (int pass = 0; pass < kMaxSmoothing; ++pass) {
    grade(pieces);
    double n_cells = 0;
    for (const std::vector<double>& piece : pieces.cells)
      n_cells += static_cast<double>(piece.size());
    require_few(n_cells);
    if (!lower_at_jumps(pieces)) break;
  }
  std::vector<double> result;
  for (size_t piece = 0; piece < pieces.cells.size(); ++piece) {
    const size_t n = pieces.cells[piece].size();
    double x = pieces.lines[piece].x;
    for (size_t k = 0; k < n; ++k) {
      // Even pieces by multiplication: rounding does not add up over thousands of cells.
      const double share = static_cast<double>(k) / static_cast<double>(n);
      result.push_back(pieces.even[piece] ? pieces.lines[piece].x + pieces.length(piece) * share
                                          : x);
      x += pieces.cells[piece][k];
    }
  }
  result.push_back(to_);
  return result;
}

LineBuilder::Pieces LineBuilder::even_pieces() const {
  Pieces pieces;
  pieces.lines = merged_lines();
  const size_t n_pieces = pieces.lines.size() - 1;
  pieces.cells.resize(n_pieces);
  pieces.even.assign(n_pieces, 0);
  pieces.graded_between.resize(n_pieces);
  for (const Line& line : pieces.lines) pieces.size.push_back(std::min(largest_, line.size));
  for (size_t piece = 0; piece < n_pieces; ++piece) {
    const double window = window_size(pieces.lines[piece].x, pieces.lines[piece + 1].x);
    double bound = pieces.length(piece);
    if (std::isfinite(window)) {
      const int n = even_count(pieces.length(piece), window);
      pieces.even[piece] = 1;
      bound = pieces.length(piece) / n;
      pieces.cells[piece].assign(static_cast<size_t>(n), bound);
    }
    pieces.lower(piece, bound);
    pieces.lower(piece + 1, bound);
  }
  return pieces;
}

void LineBuilder::grade(Pieces& pieces) const {
  const size_t n_pieces = pieces.cells.size();
  // Last of the cells that grow from `start` over a distance.
  const auto grown = [&](double start, double distance) {
    return (start + (growth_ - 1) * distance) / growth_;
  };
  for (size_t piece = 0; piece < n_pieces; ++piece)
    if (!pieces.even[piece])
      pieces.lower(piece + 1, grown(pieces.size[piece], pieces.length(piece)));
  for (size_t piece = n_pieces; piece-- > 0;)
    if (!pieces.even[piece])
      pieces.lower(piece, grown(pieces.size[piece + 1], pieces.length(piece)));
  for (size_t piece = 0; piece < n_pieces; ++piece) {
    if (pieces.even[piece]) continue;
    const double first = piece == 0 ? kInfinity : pieces.size[piece];
    const double last = piece + 1 == n_pieces ? kInfinity : pieces.size[piece + 1];
    const std::pair ends(first, last);
    if (pieces.graded_between[piece] == ends) continue;
    pieces.graded_between[piece] = ends;
    pieces.cells[piece] = graded_sizes(pieces.length(piece), first, last, growth_, largest_);
  }
}

bool LineBuilder::lower_at_jumps(Pieces& pieces) const {
  bool lowered = false;
  for (size_t line = 1; line < pieces.cells.size(); ++line) {
    const double before = pieces.cells[line - 1].back(), after = pieces.cells[line].front();
    const double small = std::min(before, after);
    if (std::max(before, after) <= growth_ * small * (1 + kRatioTolerance)) continue;
    if (std::isfinite(pieces.lines[line].size) || small >= pieces.size[line]) continue;
    pieces.size[line] = small;
    lowered = true;
  }
  return lowered;
}

void LineBuilder::Pieces::lower(size_t line, double bound) {
  if (std::isinf(lines[line].size)) size[line] = std::min(size[line], bound);
}

}  // namespace faultsim
