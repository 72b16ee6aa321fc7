#include "simulator/scene/offset_intervals.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "simulator/common/ranges.h"
#include "simulator/scene/field_depths.h"

namespace faultsim {
namespace {

constexpr double kSameDepth = 1e-6;   // m
constexpr double kKeptAway = 0.0125;  // of the distance between two offsets at which lines meet,
constexpr double kMostKeptAway = 2;   // m

FieldGeometry at_offset(FieldGeometry field, std::size_t block, double offset) {
  field.blocks[block].offset = offset;
  return field;
}

/// Distances between neighbouring depths that must be lines, from the surface down.
std::vector<double> gaps(const FieldGeometry& field) {
  std::vector<double> depths = line_depths(field), found;
  std::ranges::sort(depths);
  drop_repeated(depths, [](double a, double b) { return b - a < kSameDepth; });
  for (std::size_t i = 0; i + 1 < depths.size(); ++i) found.push_back(depths[i + 1] - depths[i]);
  return found;
}

/// Edges of a reservoir, and tips that faults might have because of them.
void add_edges(const FieldGeometry& field, const Block& block, std::vector<double>& depths) {
  std::set<double> overshoots;
  for (std::size_t f = 0; f <= field.blocks.size(); ++f) overshoots.insert(overshoot_of(field, f));
  const DepthInterval range = reservoir_range(field, block);
  for (const double edge : {range.top, range.bottom}) {
    depths.push_back(edge);
    for (const double beyond : overshoots)
      depths.insert(depths.end(), {edge - beyond, edge + beyond});
  }
}

/// Offsets in (from, to) at which two lines meet, ascending: where a depth that goes with the block
/// is one that does not, if that leaves fewer lines than beside it.
std::vector<double> meetings(const FieldGeometry& field, std::size_t block, double from,
                             double to) {
  constexpr double kBeside = 1e-3;  // m
  std::vector<double> fixed = {0, field.depth}, moving;
  for (const Layer& layer : field.layers) fixed.push_back(layer.top_depth);
  for (std::size_t i = 0; i < field.blocks.size(); ++i) {
    if (i != block) add_edges(field, field.blocks[i], fixed);
  }
  add_edges(field, at_offset(field, block, 0).blocks[block], moving);
  const auto n_gaps = [&](double offset) { return gaps(at_offset(field, block, offset)).size(); };
  std::vector<double> found;
  for (const double a : fixed) {
    for (const double b : moving) {
      const double at = a - b;
      if (at < from - kSameDepth || at > to + kSameDepth) continue;
      if (n_gaps(at) < std::max(n_gaps(at - kBeside), n_gaps(at + kBeside))) found.push_back(at);
    }
  }
  std::ranges::sort(found);
  drop_repeated(found, [](double a, double b) { return b - a < kSameDepth; });
  return found;
}

/// How much gaps may change from their layout.
struct Stretch {
  double least, largest;
};

/// A part φ of what the mesh allows, a hundredth less, so that rounding does not refuse what fits.
Stretch allowed(double part) {
  constexpr double kRoom = 0.99;
  return {1 - kRoom * part * (1 - kLeastStretch), 1 + kRoom * part * (kLargestStretch - 1)};
}

/// Between two offsets at which lines meet: each gap changes by 1, 0 or −1 m per metre of offset.
class Segment {
 public:
  /// [from, to] of the segment.
  Segment(const FieldGeometry& field, std::size_t block, double from, double to)
      : from_(from), to_(to), first_(gaps(at_offset(field, block, from))) {
    for (const double gap : gaps(at_offset(field, block, to)))
      slope_.push_back(std::round((gap - first_[slope_.size()]) / (to - from)));
  }

  /// As few intervals as cover it, their gaps stretched as little as so many let them.
  std::vector<OffsetInterval> intervals() const {
    std::vector<OffsetInterval> best = cover(1);
    double low = 0, high = 1;
    for (int i = 0; i < 30; ++i) {
      const double part = 0.5 * (low + high);
      std::vector<OffsetInterval> tried = cover(part, best.size());
      if (tried.empty()) {
        low = part;
      } else {
        high = part;
        best = std::move(tried);
      }
    }
    return best;
  }

 private:
  /// One after the other, each as long as it may be; none where that takes more than `most`.
  std::vector<OffsetInterval> cover(double part, std::size_t most = 1000) const {
    std::vector<OffsetInterval> all;
    for (double from = from_; from < to_; from = all.back().to) {
      if (all.size() == most) return {};
      all.push_back(longest(from, allowed(part)));
    }
    return all;
  }

  /// The layout is as far on as the gaps at `from` let it: then lines can be moved the furthest.
  OffsetInterval longest(double from, const Stretch& may) const {
    double layout = to_, end = to_;
    const auto gap = [&](std::size_t i, double at) { return first_[i] + slope_[i] * (at - from_); };
    for (std::size_t i = 0; i < first_.size(); ++i) {
      const double here = gap(i, from);
      if (slope_[i] > 0) layout = std::min(layout, from + here * (1 / may.least - 1));
      if (slope_[i] < 0) layout = std::min(layout, from + here * (1 - 1 / may.largest));
    }
    for (std::size_t i = 0; i < first_.size(); ++i) {
      const double there = gap(i, layout);
      if (slope_[i] > 0) end = std::min(end, layout + there * (may.largest - 1));
      if (slope_[i] < 0) end = std::min(end, layout + there * (1 - may.least));
    }
    return {from, end, layout};
  }

  double from_, to_;
  std::vector<double> first_, slope_;  ///< of gaps: at from_, and what they change by per metre.
};

}  // namespace

std::vector<OffsetInterval> offset_intervals(const FieldGeometry& field, std::size_t block,
                                             double from, double to) {
  // Beyond the range too, as an interval stays away from where lines meet just outside of it.
  const double span = field.depth;
  std::vector<double> ends = meetings(field, block, from - span, to + span);
  ends.insert(ends.begin(), from - span);
  ends.push_back(to + span);
  std::vector<OffsetInterval> intervals;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double away = std::min(kKeptAway * (ends[i + 1] - ends[i]), kMostKeptAway);
    const double low = std::max(from, ends[i] + away), high = std::min(to, ends[i + 1] - away);
    if (low >= high) continue;
    const std::vector<OffsetInterval> covered = Segment(field, block, low, high).intervals();
    intervals.insert(intervals.end(), covered.begin(), covered.end());
  }
  return intervals;
}

}  // namespace faultsim
