#include "simulator/horizons/snapping.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace faultsim::horizons {
namespace {

constexpr double kSnap = 0.12;  // of a cell
// Of a cell, between horizons at faults whose throw is that of points: it is a measured one.
constexpr double kSnapMeasured = 0.03;

/// A depth on a pillar that may be moved, and whose it is: horizons of one place, or one fault's
/// ends, must stay apart.
struct PillarDepth {
  double* z;
  int owner;  ///< place of the cut map; −1 − fault: an end of it.
  bool is_horizon;
};

/// Of z, m; empty if low > high.
struct Range {
  double low, high;
};

Range common_part(const Range& one, const Range& other) {
  return {std::max(one.low, other.low), std::min(one.high, other.high)};
}

class Snapper {
 public:
  Snapper(const LayeredBody& body, const MapMesh& map, const CutMap& cut, Levels& levels)
      : body_(body), map_(map), cut_(cut), levels_(levels), sides_(sides_of(map.triangles)) {
    for (const TracePiece& piece : trace_pieces(map, sides_)) pieces_.push_back(piece);
    on_pillar_.resize(map.vertices.size());
    is_measured_.resize(map.vertices.size(), true);
    for (int f = 0; f < map.n_faults; ++f)
      for (std::size_t k = 0; k < map.lines[f].size(); ++k) gather(f, k);
  }
  void run(std::vector<Problem>& problems);

 private:
  using Line = std::array<PillarDepth, 2>;  ///< a depth at both ends of a piece of a trace.

  void gather(int fault, std::size_t k);
  double limit(const PillarDepth& p, const PillarDepth& q, bool is_measured) const;
  void snap_all();
  void snap(std::vector<PillarDepth>& depths, bool is_measured);
  std::vector<Line> lines_over(const TracePiece& piece);
  bool uncross(const TracePiece& piece);
  bool is_ordered(const TracePiece& piece) const;
  Range room(const PillarDepth& depth) const;
  bool can_join(const PillarDepth& p, const PillarDepth& q) const;
  void join(PillarDepth& p, PillarDepth& q);

  const LayeredBody& body_;
  const MapMesh& map_;
  const CutMap& cut_;
  Levels& levels_;
  std::vector<MapSide> sides_;
  std::vector<TracePiece> pieces_;
  std::vector<std::vector<PillarDepth>> on_pillar_;  ///< per vertex, of faults only.
  std::vector<bool> is_measured_;  ///< per vertex: throws of all faults there are those of points.
};

void Snapper::gather(int fault, std::size_t k) {
  const int vertex = map_.lines[fault][k];
  if (body_.faults[fault].moved) is_measured_[vertex] = false;
  std::vector<PillarDepth>& here = on_pillar_[vertex];
  if (here.empty())
    for (const int place : cut_.at[vertex])
      for (double& z : levels_.horizons[place]) here.push_back({&z, place, true});
  if (body_.faults[fault].bottom) here.push_back({&levels_.bottom[fault][k], -1 - fault, false});
  if (body_.faults[fault].top) here.push_back({&levels_.top[fault][k], -1 - fault, false});
}

/// Where a horizon may move without using up the layers above and below it on its side.
Range Snapper::room(const PillarDepth& depth) const {
  if (!depth.is_horizon) return {body_.base, body_.top};
  const std::vector<double>& z = levels_.horizons[depth.owner];
  const auto k = static_cast<std::size_t>(depth.z - z.data());
  const double above = k == 0 ? body_.top : z[k - 1];
  const double below = k + 1 == z.size() ? body_.base : z[k + 1];
  const double kept = kSnapMeasured * body_.cells.at_faults;
  return {below + std::min(kept, (z[k] - below) / 2), above - std::min(kept, (above - z[k]) / 2)};
}

/// At a tip both sides are one place, whose horizons stay apart.
bool Snapper::can_join(const PillarDepth& p, const PillarDepth& q) const {
  const Range both = common_part(room(p), room(q));
  return p.owner != q.owner && both.low <= both.high;
}

/// Horizons meet half way, or as near to it as their layers allow.
void Snapper::join(PillarDepth& p, PillarDepth& q) {
  if (*p.z == *q.z) return;
  ++levels_.n_snapped;
  if (p.is_horizon == q.is_horizon) {
    const Range both = common_part(room(p), room(q));
    const double middle = (*p.z + *q.z) / 2;
    *p.z = *q.z = both.low > both.high ? middle : std::clamp(middle, both.low, both.high);
  } else if (p.is_horizon) {
    *q.z = *p.z;
  } else {
    *p.z = *q.z;
  }
}

/// Depths that are closer are joined, m.
double Snapper::limit(const PillarDepth& p, const PillarDepth& q, bool is_measured) const {
  const bool is_throw = is_measured && p.is_horizon && q.is_horizon;
  return (is_throw ? kSnapMeasured : kSnap) * body_.cells.at_faults;
}

void Snapper::snap_all() {
  for (std::size_t v = 0; v < on_pillar_.size(); ++v) snap(on_pillar_[v], is_measured_[v]);
}

/// Joins groups of neighbours of different owners to their mean; ends of faults follow horizons.
void Snapper::snap(std::vector<PillarDepth>& depths, bool is_measured) {
  std::ranges::stable_sort(depths,
                           [](const PillarDepth& p, const PillarDepth& q) { return *p.z < *q.z; });
  for (std::size_t first = 0; first < depths.size();) {
    std::size_t last = first + 1;
    const auto is_new_owner = [&](const PillarDepth& one) {
      return std::none_of(depths.begin() + static_cast<std::ptrdiff_t>(first),
                          depths.begin() + static_cast<std::ptrdiff_t>(last),
                          [&](const PillarDepth& other) { return other.owner == one.owner; });
    };
    while (last < depths.size() && is_new_owner(depths[last]) &&
           *depths[last].z - *depths[last - 1].z <
               limit(depths[last], depths[last - 1], is_measured))
      ++last;
    double sum = 0, n = 0;
    for (std::size_t k = first; k < last; ++k) {
      if (!depths[k].is_horizon) continue;
      sum += *depths[k].z;
      n += 1;
    }
    const double joined = n > 0 ? sum / n : *depths[first].z;
    const bool are_equal = *depths[first].z == *depths[last - 1].z;
    for (std::size_t k = first; k < last && !are_equal; ++k) *depths[k].z = joined;
    if (!are_equal) levels_.n_snapped += static_cast<int>(last - first) - 1;
    first = last;
  }
}

/// Horizons of both sides and the fault's ends, over a piece of its trace.
std::vector<Snapper::Line> Snapper::lines_over(const TracePiece& piece) {
  const int f = piece.fault;
  const std::array<int, 2> ends = {map_.lines[f][piece.k], map_.lines[f][piece.k + 1]};
  std::vector<Line> lines;
  for (const int triangle : {piece.side->left, piece.side->right}) {
    const auto place = [&](int vertex) {
      const auto corner = std::ranges::find(map_.triangles[triangle], vertex);
      return cut_
          .places[triangle][static_cast<std::size_t>(corner - map_.triangles[triangle].begin())];
    };
    const int a = place(ends[0]), b = place(ends[1]);
    for (std::size_t k = 0; k < body_.horizons.size(); ++k)
      lines.push_back({PillarDepth{&levels_.horizons[a][k], a, true},
                       PillarDepth{&levels_.horizons[b][k], b, true}});
  }
  for (std::vector<double>* z : {&levels_.bottom[f], &levels_.top[f]})
    lines.push_back({PillarDepth{&(*z)[piece.k], -1 - f, false},
                     PillarDepth{&(*z)[piece.k + 1], -1 - f, false}});
  return lines;
}

bool Snapper::uncross(const TracePiece& piece) {
  bool has_changed = false;
  std::vector<Line> lines = lines_over(piece);
  for (std::size_t p = 0; p < lines.size(); ++p)
    for (std::size_t q = 0; q < p; ++q) {
      const double first = *lines[p][0].z - *lines[q][0].z;
      const double second = *lines[p][1].z - *lines[q][1].z;
      if (!(first * second < 0)) continue;
      std::size_t end = std::abs(first) <= std::abs(second) ? 0 : 1;
      if (!can_join(lines[p][end], lines[q][end]) && can_join(lines[p][1 - end], lines[q][1 - end]))
        end = 1 - end;
      join(lines[p][end], lines[q][end]);
      has_changed = true;
    }
  return has_changed;
}

/// Whether horizons at both ends of a piece are still apart.
bool Snapper::is_ordered(const TracePiece& piece) const {
  for (const std::size_t k : {piece.k, piece.k + 1})
    for (const int place : cut_.at[map_.lines[piece.fault][k]]) {
      const std::vector<double>& z = levels_.horizons[place];
      if (std::ranges::adjacent_find(z, std::less_equal()) != z.end()) return false;
    }
  return true;
}

void Snapper::run(std::vector<Problem>& problems) {
  constexpr int kSweeps = 50;
  snap_all();
  for (int round = 0; round < kSweeps; ++round) {
    bool has_changed = false;
    for (const TracePiece& piece : pieces_) has_changed |= uncross(piece);
    snap_all();
    if (!has_changed) break;
  }
  for (const TracePiece& piece : pieces_) {
    if (!uncross(piece) && is_ordered(piece)) continue;
    problems.push_back({concat("/faults/", piece.fault), 0,
                        concat("the horizons of both sides of \"", body_.faults[piece.fault].name,
                               "\" cross too steeply at ",
                               map_place(map_.vertices[map_.lines[piece.fault][piece.k]])),
                        "make cells at faults smaller, or taper the throw over a longer distance"});
    return;
  }
}

}  // namespace

void snap_levels(const LayeredBody& body, const MapMesh& map, const CutMap& cut, Levels& levels,
                 std::vector<Problem>& problems) {
  Snapper(body, map, cut, levels).run(problems);
}

}  // namespace faultsim::horizons
