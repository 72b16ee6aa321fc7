#include "simulator/horizons/ladders.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/horizons/map_operator.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using WallLine = std::array<int, 2>;  ///< ranks on a and b.

/// Parts of a way that count as equal, so that rounding decides nothing.
constexpr double kParts = 1e6;

class LadderMaker {
 public:
  LadderMaker(const MapMesh& map, const CutMap& cut, const std::vector<MapSide>& sides,
              const PillarNodes& nodes, const std::vector<double>& order)
      : map_(map), cut_(cut), nodes_(nodes), order_(order), lines_(sides.size()) {
    for (std::size_t s = 0; s < sides.size(); ++s) add_horizons(sides[s], lines_[s]);
    for (const TracePiece& piece : trace_pieces(map, sides))
      add_ends(piece, lines_[static_cast<std::size_t>(piece.side - sides.data())]);
    for (std::size_t s = 0; s < sides.size(); ++s) ladders_.push_back(climb(sides[s], lines_[s]));
  }
  std::vector<Ladder> ladders_;

 private:
  void add_horizons(const MapSide& side, std::vector<WallLine>& lines) const;
  void add_ends(const TracePiece& piece, std::vector<WallLine>& lines) const;
  Ladder climb(const MapSide& side, std::vector<WallLine>& lines) const;

  const MapMesh& map_;
  const CutMap& cut_;
  const PillarNodes& nodes_;
  const std::vector<double>& order_;
  std::vector<std::vector<WallLine>> lines_;
};

void LadderMaker::add_horizons(const MapSide& side, std::vector<WallLine>& lines) const {
  for (const int t : {side.left, side.right}) {
    if (t < 0) continue;
    const auto ranks = [&](int vertex) -> const std::vector<int>& {
      const auto corner = std::ranges::find(map_.triangles[t], vertex) - map_.triangles[t].begin();
      return nodes_.horizon_rank[cut_.places[t][static_cast<std::size_t>(corner)]];
    };
    const std::vector<int>&a = ranks(side.a), &b = ranks(side.b);
    for (std::size_t k = 0; k < a.size(); ++k) lines.push_back({a[k], b[k]});
  }
}

void LadderMaker::add_ends(const TracePiece& piece, std::vector<WallLine>& lines) const {
  const bool is_forward = map_.lines[piece.fault][piece.k] == piece.side->a;
  for (const auto* ranks : {&nodes_.bottom_rank[piece.fault], &nodes_.top_rank[piece.fault]}) {
    const int first = (*ranks)[piece.k], second = (*ranks)[piece.k + 1];
    lines.push_back(is_forward ? WallLine{first, second} : WallLine{second, first});
  }
}

Ladder LadderMaker::climb(const MapSide& side, std::vector<WallLine>& lines) const {
  const std::vector<double>&za = nodes_.z[side.a], &zb = nodes_.z[side.b];
  lines.push_back({0, 0});
  lines.push_back({static_cast<int>(za.size()) - 1, static_cast<int>(zb.size()) - 1});
  std::ranges::sort(lines);
  drop_repeated(lines);
  const bool a_first = std::pair(order_[side.a], side.a) < std::pair(order_[side.b], side.b);
  Ladder ladder;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto [a0, b0] = lines[k - 1];
    const auto [a1, b1] = lines[k];
    FAULTSIM_DEMAND(a0 <= a1 && b0 <= b1, "lines cross on a wall: ", a0, ' ', b0, ' ', a1, ' ', b1);
    const auto middle = [](const std::vector<double>& z, int from, int to, int at) {
      return std::llround(kParts * ((z[at] + z[at + 1]) / 2 - z[from]) / (z[to] - z[from]));
    };
    for (int a = a0, b = b0; a < a1 || b < b1;) {
      bool takes_a = b == b1;
      if (a < a1 && b < b1) {
        const auto on_a = middle(za, a0, a1, a), on_b = middle(zb, b0, b1, b);
        takes_a = on_a < on_b || (on_a == on_b && a_first);
      }
      ++(takes_a ? a : b);
      ladder.push_back(takes_a ? 0 : 1);
    }
  }
  return ladder;
}

}  // namespace

std::vector<Ladder> make_ladders(const MapMesh& map, const CutMap& cut,
                                 const std::vector<MapSide>& sides, const PillarNodes& nodes,
                                 const std::vector<double>& order) {
  return std::move(LadderMaker(map, cut, sides, nodes, order).ladders_);
}

std::vector<double> order_of_pillars(const LayeredBody& body, const MapMesh& map,
                                     const Pillars& pillars) {
  const std::size_t n = map.vertices.size();
  std::vector<Vector2d> lean;
  for (std::size_t v = 0; v < n; ++v)
    lean.emplace_back(pillars.in_map(static_cast<int>(v), body.top) -
                      pillars.in_map(static_cast<int>(v), body.base));
  // The potential whose gradient is nearest to the way that pillars lean: Δφ = ∇ · lean.
  const MapOperator op = map_operator(map.vertices, map.triangles, map.triangles, n);
  VectorXd right = VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (const std::array<int, 3>& t : map.triangles) {
    const Vector2d mean = (lean[t[0]] + lean[t[1]] + lean[t[2]]) / 3;
    for (std::size_t v = 0; v < 3; ++v) {
      // A ∇φ_v is half of the opposite side, turned inwards.
      const Vector2d opposite = map.vertices[t[(v + 2) % 3]] - map.vertices[t[(v + 1) % 3]];
      right[t[v]] += mean.dot(Vector2d(-opposite.y(), opposite.x())) / 2;
    }
  }
  const VectorXd potential = solve_potential(op, right);
  return {potential.begin(), potential.end()};
}

}  // namespace faultsim::horizons
