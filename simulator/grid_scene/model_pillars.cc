#include "simulator/grid_scene/model_pillars.h"

#include "simulator/common/ranges.h"
#include "simulator/grid_scene/line_check.h"
#include "simulator/horizons/map_locator.h"
#include "simulator/horizons/traces.h"

namespace faultsim::grid_scene {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct ModelPillars::Body {
  horizons::LayeredBody body;
  horizons::MapMesh map;
  std::vector<horizons::MapSide> sides;
  horizons::Pillars pillars;
  horizons::MapLocator locator;

  Body(horizons::LayeredBody of, horizons::MapMesh mesh)
      : body(std::move(of)),
        map(std::move(mesh)),
        sides(horizons::sides_of(map.triangles)),
        pillars(body, map),
        locator(body, map, sides, pillars) {}
};

ModelPillars::ModelPillars(const ModelLines& lines) : lines_(lines) {
  if (first_misfit(lines)) return;
  horizons::LayeredBody body = body_of_lines(lines);
  std::vector<Problem> problems;
  const horizons::MapLines met = horizons::meeting_lines(body, problems);
  horizons::MapMesh map = horizons::mesh_map(body, met, problems);
  body_ = std::make_unique<const Body>(std::move(body), std::move(map));
}

ModelPillars::~ModelPillars() = default;

Polyline ModelPillars::fault_line(std::size_t fault, double z) const {
  if (!body_) return lines_.faults[fault].at(z, lines_.reference_z);
  // Upright above its top and below its bottom, as pillars are.
  const horizons::PillarDepth depth = body_->pillars.depth(z);
  return mapped(body_->map.lines[fault],
                [&](int vertex) { return body_->pillars.in_map(vertex, depth); });
}

Vector2d ModelPillars::at(const Vector3d& point, double z) const {
  if (!body_) return point.head<2>();
  const horizons::PlaceOnMap stands = body_->locator.find(point);
  const std::array<int, 3>& corner = body_->map.triangles[stands.triangle];
  const auto vertex = [&](std::size_t v) { return body_->map.vertices[corner[v % 3]]; };
  const double all = horizons::cross_of(vertex(0), vertex(1), vertex(2));
  Vector2d at = {0, 0};
  for (std::size_t v = 0; v < 3; ++v)
    at += horizons::cross_of(stands.at, vertex(v + 1), vertex(v + 2)) / all *
          body_->pillars.in_map(corner[v], z);
  return at;
}

}  // namespace faultsim::grid_scene
