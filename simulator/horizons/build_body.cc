#include "simulator/horizons/build_body.h"

#include <algorithm>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/horizons/body_check.h"
#include "simulator/horizons/columns.h"
#include "simulator/horizons/pillar_check.h"
#include "simulator/horizons/tet_quality.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector3d;

/// What cells are made from, once nothing is wrong with it.
struct BodyPlan {
  MapMesh map;
  std::vector<MapSide> sides;
  CutMap cut;
  std::vector<int> compartment;  ///< per triangle of the map.
  Levels levels;
  std::vector<Vector3d> positions;  ///< of nodes on pillars.
  PillarNodes nodes;
  std::vector<Ladder> ladders;
};

/// Problems that make the next step senseless end the plan.
class Planner {
 public:
  Planner(const LayeredBody& body, const std::string& source) : body_(body), source_(source) {}

  BodyPlan run() {
    check_numbers(body_, problems_);
    const std::vector<DepthSurface> horizons = depth_surfaces(body_, problems_);
    stop_at_problems();
    const MapLines lines = meeting_lines(body_, problems_);
    stop_at_problems();
    BodyPlan plan;
    plan.map = mesh_map(body_, lines, problems_);
    stop_at_problems();
    plan.sides = sides_of(plan.map.triangles);
    plan.cut = cut_map(plan.map);
    plan.compartment = fill_compartments(plan.map, body_.compartments, problems_);
    check_faults_in_depth(body_, plan.map, problems_);
    stop_at_problems();
    const Pillars pillars(body_, plan.map);
    check_pillars(body_, plan.map, pillars, problems_);
    stop_at_problems();
    plan.levels = find_levels(body_, plan.map, plan.cut, pillars, horizons, problems_);
    stop_at_problems();
    place_nodes(plan, pillars);
    check_meetings(body_, plan.map, pillars, plan.nodes.z, problems_);
    stop_at_problems();
    return plan;
  }

 private:
  void stop_at_problems() const {
    if (!problems_.empty()) throw InputError(source_, problems_);
  }
  void place_nodes(BodyPlan& plan, const Pillars& pillars) const {
    plan.nodes = nodes_on_pillars(body_, plan.map, plan.cut, plan.levels);
    for (std::size_t v = 0; v < plan.map.vertices.size(); ++v)
      for (const double z : plan.nodes.z[v])
        plan.positions.push_back(pillars.at(static_cast<int>(v), z));
    plan.ladders = make_ladders(plan.map, plan.cut, plan.sides, plan.nodes,
                                order_of_pillars(body_, plan.map, pillars));
  }

  const LayeredBody& body_;
  const std::string& source_;
  std::vector<Problem> problems_;
};

/// Calls with the nodes of each facet of a wall, the place of the pillar that goes up (0 = a) and
/// its rank before.
template <typename Take>
void for_each_facet(const BodyPlan& plan, std::size_t side, const Take& take) {
  const MapSide& one = plan.sides[side];
  std::array<int, 2> rank = {0, 0};
  for (const std::uint8_t step : plan.ladders[side]) {
    const int a = plan.nodes.first[one.a] + rank[0], b = plan.nodes.first[one.b] + rank[1];
    const int upper = (step == 0 ? a : b) + 1;
    take(std::array<int, 4>{a, b, upper, -1}, step, rank[step]);
    ++rank[step];
  }
}

std::vector<FacetGroup> faults_of(const LayeredBody& body, const BodyPlan& plan) {
  std::vector<FacetGroup> groups;
  for (const LayeredFault& fault : body.faults) groups.push_back({fault.name, {}});
  for (const TracePiece& piece : trace_pieces(plan.map, plan.sides)) {
    const bool is_forward = plan.map.lines[piece.fault][piece.k] == piece.side->a;
    const auto side = static_cast<std::size_t>(piece.side - plan.sides.data());
    for_each_facet(plan, side, [&](const std::array<int, 4>& facet, std::size_t pillar, int rank) {
      const std::size_t k = (pillar == 0) == is_forward ? piece.k : piece.k + 1;
      if (rank >= plan.nodes.bottom_rank[piece.fault][k] &&
          rank < plan.nodes.top_rank[piece.fault][k])
        groups[piece.fault].facets.push_back(facet);
    });
  }
  return groups;
}

std::vector<FacetGroup> boundary_of(const LayeredBody& body, const BodyPlan& plan) {
  std::vector<FacetGroup> groups;
  for (const char* name : {"x-", "x+", "y-", "y+", "z-", "z+"}) groups.push_back({name, {}});
  const std::vector<Eigen::Vector2d>& at = plan.map.vertices;
  for (std::size_t s = 0; s < plan.sides.size(); ++s) {
    const MapSide& side = plan.sides[s];
    if (side.left >= 0 && side.right >= 0) continue;
    for (std::size_t group = 0; group < 4; ++group) {
      const auto axis = static_cast<Eigen::Index>(group / 2);
      const double plane = group % 2 == 0 ? body.low[axis] : body.high[axis];
      if (at[side.a][axis] != plane || at[side.b][axis] != plane) continue;
      for_each_facet(plan, s, [&](const std::array<int, 4>& facet, std::size_t, int) {
        groups[group].facets.push_back(facet);
      });
    }
  }
  for (const std::array<int, 3>& t : plan.map.triangles) {
    std::array<int, 4> low = {-1, -1, -1, -1}, high = low;
    for (std::size_t v = 0; v < 3; ++v) {
      low[v] = plan.nodes.first[t[v]];
      high[v] = low[v] + static_cast<int>(plan.nodes.z[t[v]].size()) - 1;
    }
    groups[4].facets.push_back(low);
    groups[5].facets.push_back(high);
  }
  return groups;
}

void measure(BuiltBody& built, const std::string& source) {
  std::size_t n_turned = 0;
  for (std::size_t cell = 0; cell < built.mesh.n_cells(); ++cell) {
    std::array<Vector3d, 4> corners;
    for (std::size_t v = 0; v < 4; ++v)
      corners[v] = built.mesh.nodes[built.mesh.corners[4 * cell + v]];
    const double sicn = scaled_inverse_condition(corners);
    built.n_slivers += sicn < 0.1;
    n_turned += !(sicn > 0);
    if (sicn >= built.smallest_sicn) continue;
    built.smallest_sicn = sicn;
    built.worst_place = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  }
  if (n_turned == 0) return;
  const Vector3d& at = built.worst_place;
  throw InputError(source, {{"/faults", 0,
                             concat(counted(n_turned, "cell is", "cells are"),
                                    " turned inside out, the worst at x ", at.x(), ", y ", at.y(),
                                    ", z ", at.z(), " m: pillars and horizons are too steep there"),
                             "make faults steeper, horizons flatter, or cells smaller"}});
}

}  // namespace

BuiltBody build_body(const LayeredBody& body, const std::string& source) {
  BodyPlan plan = Planner(body, source).run();
  Columns columns =
      fill_columns(plan.map, plan.cut, plan.sides, plan.nodes, plan.ladders, plan.positions);
  BuiltBody built;
  UncutMesh& mesh = built.mesh;
  mesh.nodes = std::move(plan.positions);
  mesh.nodes.insert(mesh.nodes.end(), columns.extra_nodes.begin(), columns.extra_nodes.end());
  mesh.corners = std::move(columns.corners);
  for (std::size_t cell = 0; cell < columns.layer.size(); ++cell) {
    const int layer = columns.layer[cell], compartment = plan.compartment[columns.triangle[cell]];
    const int region = compartment < 0 ? -1 : body.compartments[compartment].region[layer];
    mesh.material.push_back(body.layers[layer].material);
    mesh.region.push_back(region);
    mesh.region_fraction.push_back(region < 0 ? 0 : 1);
    built.compartment.push_back(compartment);
  }
  built.layer = std::move(columns.layer);
  mesh.faults = faults_of(body, plan);
  mesh.boundary = boundary_of(body, plan);
  built.n_extra_nodes = columns.extra_nodes.size();
  built.n_snapped = plan.levels.n_snapped;
  built.throws = found_throws(body, plan.map, plan.sides, plan.cut, plan.levels);
  measure(built, source);
  return built;
}

}  // namespace faultsim::horizons
