#include "simulator/horizons/columns.h"

#include <algorithm>
#include <set>

#include "simulator/common/errors.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector3d;
using Ranks = std::array<int, 3>;

/// One column; corner c of the triangle has the walls c (to the next corner) and c − 1.
class ColumnFiller {
 public:
  ColumnFiller(const MapMesh& map, const CutMap& cut, const std::vector<MapSide>& sides,
               const PillarNodes& nodes, const std::vector<Ladder>& ladders,
               const std::vector<Vector3d>& positions, int triangle, Columns& columns)
      : nodes_(nodes), positions_(positions), triangle_(triangle), columns_(columns) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int v = map.triangles[triangle][c], next = map.triangles[triangle][(c + 1) % 3];
      vertex_[c] = v;
      horizons_[c] = &nodes.horizon_rank[cut.places[triangle][c]];
      const MapSide* side = find_side(sides, v, next);
      wall_[c] = &ladders[static_cast<std::size_t>(side - sides.data())];
      is_turned_[c] = side->a != v;
    }
  }
  void run();

 private:
  static std::size_t after(std::size_t c) { return (c + 1) % 3; }
  static std::size_t before(std::size_t c) { return (c + 2) % 3; }
  /// Whether the step of wall w is that of its own corner, not of the one after.
  bool is_own(std::size_t w, std::size_t step) const {
    return ((*wall_[w])[step] == 0) != is_turned_[w];
  }
  bool wants(std::size_t w, std::size_t corner) const {
    return done_[w] < wall_[w]->size() && is_own(w, done_[w]) == (w == corner);
  }
  int node(std::size_t c, int rank) const { return nodes_.first[vertex_[c]] + rank; }
  void add(int a, int b, int c, int d, int layer);
  void go_up(std::size_t corner);
  std::vector<Ranks> way_up(std::size_t w) const;
  Ranks next_triangle() const;
  void fill_stuck();

  const PillarNodes& nodes_;
  const std::vector<Vector3d>& positions_;
  int triangle_;
  Columns& columns_;
  std::array<int, 3> vertex_;
  std::array<const std::vector<int>*, 3> horizons_;
  std::array<const Ladder*, 3> wall_;
  std::array<bool, 3> is_turned_;
  std::array<std::size_t, 3> done_ = {0, 0, 0};  ///< steps of each wall.
  Ranks rank_ = {0, 0, 0};
};

void ColumnFiller::add(int a, int b, int c, int d, int layer) {
  columns_.corners.insert(columns_.corners.end(), {a, b, c, d});
  columns_.layer.push_back(layer);
  columns_.triangle.push_back(triangle_);
}

void ColumnFiller::go_up(std::size_t corner) {
  const int layer = layer_above(*horizons_[corner], rank_[corner]);
  const int upper = node(corner, rank_[corner] + 1);
  add(node(0, rank_[0]), node(1, rank_[1]), node(2, rank_[2]), upper, layer);
  ++rank_[corner];
  ++done_[corner];
  ++done_[before(corner)];
}

/// What a wall reaches from here on: ranks at both of its corners, −1 at the third.
std::vector<Ranks> ColumnFiller::way_up(std::size_t w) const {
  Ranks at = {-1, -1, -1};
  at[w] = rank_[w];
  at[after(w)] = rank_[after(w)];
  std::vector<Ranks> way = {at};
  for (std::size_t step = done_[w]; step < wall_[w]->size(); ++step) {
    ++at[is_own(w, step) ? w : after(w)];
    way.push_back(at);
  }
  return way;
}

/// The lowest triangle above the reached one whose sides are edges of all three walls.
Ranks ColumnFiller::next_triangle() const {
  const std::vector<Ranks> first = way_up(0), second = way_up(1);
  const std::vector<Ranks> third_list = way_up(2);
  const std::set<Ranks> third(third_list.begin(), third_list.end());
  for (std::size_t k = 1; k < first.size(); ++k)
    for (const Ranks& other : second) {
      if (other[1] != first[k][1] || !third.contains({first[k][0], -1, other[2]})) continue;
      return {first[k][0], first[k][1], other[2]};
    }
  FAULTSIM_DEMAND(false, "a column without a top at vertex ", vertex_[0]);
  return rank_;
}

void ColumnFiller::fill_stuck() {
  const Ranks top = next_triangle();
  const int layer = layer_above(*horizons_[0], rank_[0]);
  const int middle = nodes_.n_nodes + static_cast<int>(columns_.extra_nodes.size());
  Vector3d sum = Vector3d::Zero();
  int n = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (int k = rank_[c]; k <= top[c]; ++k, ++n) sum += positions_[node(c, k)];
  columns_.extra_nodes.push_back(sum / n);
  add(node(0, rank_[0]), node(1, rank_[1]), node(2, rank_[2]), middle, layer);
  add(node(0, top[0]), node(2, top[2]), node(1, top[1]), middle, layer);
  for (std::size_t w = 0; w < 3; ++w) {
    int own = rank_[w], other = rank_[after(w)];
    while (own < top[w] || other < top[after(w)]) {
      const bool moves_own = is_own(w, done_[w]++);
      const int upper = moves_own ? node(w, own + 1) : node(after(w), other + 1);
      // Counter-clockwise from outside is lower, lower of the next corner, upper.
      add(node(w, own), upper, node(after(w), other), middle, layer);
      ++(moves_own ? own : other);
    }
  }
  rank_ = top;
}

void ColumnFiller::run() {
  while (done_[0] < wall_[0]->size() || done_[1] < wall_[1]->size() ||
         done_[2] < wall_[2]->size()) {
    std::size_t corner = 0;
    while (corner < 3 && !(wants(corner, corner) && wants(before(corner), corner))) ++corner;
    if (corner < 3) {
      go_up(corner);
    } else {
      fill_stuck();
    }
  }
}

}  // namespace

Columns fill_columns(const MapMesh& map, const CutMap& cut, const std::vector<MapSide>& sides,
                     const PillarNodes& nodes, const std::vector<Ladder>& ladders,
                     const std::vector<Vector3d>& positions) {
  Columns columns;
  for (std::size_t t = 0; t < map.triangles.size(); ++t)
    ColumnFiller(map, cut, sides, nodes, ladders, positions, static_cast<int>(t), columns).run();
  return columns;
}

}  // namespace faultsim::horizons
