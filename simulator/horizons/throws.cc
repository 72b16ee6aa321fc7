#include "simulator/horizons/throws.h"

#include <algorithm>
#include <cmath>

#include "simulator/horizons/map_operator.h"

namespace faultsim::horizons {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Part of the throw at each vertex of a trace: 1, but falling to 0 at ends in the rock.
std::vector<double> tapers(const LayeredFault& fault, const MapMesh& map, int line) {
  const std::vector<int>& vertices = map.lines[line];
  std::vector<double> along = {0};
  for (std::size_t k = 1; k < vertices.size(); ++k)
    along.push_back(along.back() +
                    (map.vertices[vertices[k]] - map.vertices[vertices[k - 1]]).norm());
  const double length = along.back();
  const double over = std::isfinite(fault.moved->taper) ? fault.moved->taper : length / 4;
  std::vector<double> parts;
  for (const double s : along) {
    double part = 1;
    const auto from_tip = [&](double away) {
      return over > 0 ? away / over : away > 0 ? 1.0 : 0.0;
    };
    if (fault.first_end == TraceEnd::in_rock) part = std::min(part, from_tip(s));
    if (fault.last_end == TraceEnd::in_rock) part = std::min(part, from_tip(length - s));
    parts.push_back(part);
  }
  return parts;
}

/// What a throw is at both sides of its fault.
struct HeldThrow {
  std::vector<bool> is_held;  ///< per place.
  VectorXd up;                ///< m.
};

void hold_sides(const MapMesh& map, const CutMap& cut, const LayeredFault& fault,
                const TracePiece& piece, const std::vector<double>& parts, HeldThrow& held) {
  const std::vector<int>& line = map.lines[piece.fault];
  const double up = fault.moved->down * fault.moved->left_share, down = fault.moved->down - up;
  const bool is_forward = line[piece.k] == piece.side->a;
  for (const int triangle : {piece.side->left, piece.side->right}) {
    const bool is_left = (triangle == piece.side->left) == is_forward;
    for (const std::size_t k : {piece.k, piece.k + 1}) {
      const int place = place_at(map, cut, triangle, line[k]);
      held.is_held[place] = true;
      held.up[place] = parts[k] * (is_left ? up : -down);
    }
  }
}

}  // namespace

MatrixXd throw_fields(const LayeredBody& body, const MapMesh& map, const CutMap& cut) {
  const auto n = static_cast<Eigen::Index>(cut.n_places());
  MatrixXd fields = MatrixXd::Zero(n, map.n_faults);
  const MapOperator op = map_operator(map.vertices, map.triangles, cut.places, cut.n_places());
  const std::vector<MapSide> sides = sides_of(map.triangles);
  const std::vector<TracePiece> pieces = trace_pieces(map, sides);
  for (int f = 0; f < map.n_faults; ++f) {
    const LayeredFault& fault = body.faults[f];
    if (!fault.moved || fault.moved->down == 0) continue;
    const std::vector<double> parts = tapers(fault, map, f);
    HeldThrow held{std::vector<bool>(cut.n_places(), false), VectorXd::Zero(n)};
    for (const TracePiece& piece : pieces)
      if (piece.fault == f) hold_sides(map, cut, fault, piece, parts, held);
    const double reach2 = fault.moved->reach * fault.moved->reach;
    fields.col(f) = fill_between(op, op.area / reach2, held.is_held, held.up);
  }
  return fields;
}

double throw_in_depth(const LayeredFault& fault, double z) {
  if (!fault.moved) return 1;
  const double over = 2 * std::abs(fault.moved->down);
  double inside = std::numeric_limits<double>::infinity();
  if (fault.top) inside = std::min(inside, *fault.top - z);
  if (fault.bottom) inside = std::min(inside, z - *fault.bottom);
  if (over == 0) return 1;
  return std::clamp(inside / over, 0.0, 1.0);
}

}  // namespace faultsim::horizons
