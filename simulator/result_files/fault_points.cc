#include "simulator/result_files/fault_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace faultsim {
namespace {

constexpr double kOnPlane = 1e-6;  // m, of y = 0

bool is_on_plane(const Eigen::Vector3d& position) { return std::abs(position.y()) < kOnPlane; }

/// A position, or a vector of the bulk such as a force, seen in the plane y = 0.
Eigen::Vector3d mirror(const Eigen::Vector3d& vector) {
  return {vector.x(), -vector.y(), vector.z()};
}

/// A node seen in the plane y = 0. Its frame stays right-handed, as that of the whole domain is:
/// normal and dip are mirrored, strike is mirrored and turned around.
OperatorNode mirror(OperatorNode node) {
  node.normal = mirror(node.normal);
  node.dip = mirror(node.dip);
  node.strike = -mirror(node.strike);
  return node;
}

/// The split point nearest to a position; -1 when the fault has none.
int nearest_node(const OperatorFault& fault, const Eigen::Vector3d& position) {
  int nearest = -1;
  double least = 0;
  for (std::size_t i = 0; i < fault.points.size(); ++i) {
    if (fault.node_of_point[i] < 0) continue;
    const double distance = (fault.points[i] - position).squaredNorm();
    if (nearest < 0 || distance < least) {
      nearest = fault.node_of_point[i];
      least = distance;
    }
  }
  return nearest;
}

/// Adds a point, or its image in the plane y = 0; returns its number.
int add_point(const OperatorFault& fault, std::size_t i, bool mirrored, FaultPoints& points) {
  const Eigen::Vector3d& position = fault.points[i];
  const Eigen::Vector3d place = mirrored ? mirror(position) : position;
  const bool is_split = fault.node_of_point[i] >= 0;
  points.source.push_back(is_split ? fault.node_of_point[i] : nearest_node(fault, position));
  points.split.push_back(is_split ? 1 : 0);
  points.mirrored.push_back(mirrored ? 1 : 0);
  points.share.push_back(1);
  points.position.insert(points.position.end(), place.data(), place.data() + 3);
  return static_cast<int>(points.source.size()) - 1;
}

/// The faces, or their images: those have their corners in reverse order, so that all faces turn
/// the same way.
void add_faces(const OperatorFault& fault, const std::vector<int>& number, bool mirrored,
               FaultPoints& points) {
  for (const auto& face : fault.faces) {
    // In plane strain the two sides of a face along strike are one: corners (a, b, b, a).
    for (std::size_t c = 0; c < points.points_per_cell; ++c) {
      const int at = face[mirrored ? points.points_per_cell - 1 - c : c];
      points.cells.push_back(number[at]);
    }
  }
}

}  // namespace

FaultPoints collect_points(const OperatorFault& fault, const FaultGeometry& geometry) {
  FaultPoints points;
  points.points_per_cell = geometry.plane_strain ? 2 : 4;
  const std::size_t n = fault.points.size();
  std::vector<int> number(n, -1), image(n, -1);
  if (geometry.half_domain) {
    std::vector<std::size_t> inwards(n);
    std::iota(inwards.begin(), inwards.end(), std::size_t{0});
    std::ranges::stable_sort(inwards, [&](std::size_t a, std::size_t b) {
      return fault.points[a].y() > fault.points[b].y();
    });
    for (const std::size_t i : inwards) {
      if (!is_on_plane(fault.points[i])) image[i] = add_point(fault, i, true, points);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    number[i] = add_point(fault, i, false, points);
    if (image[i] < 0) image[i] = number[i];
    if (geometry.half_domain && is_on_plane(fault.points[i])) points.share.back() = 2;
  }
  add_faces(fault, number, false, points);
  if (geometry.half_domain) add_faces(fault, image, true, points);
  return points;
}

OperatorNode node_of(const std::vector<OperatorNode>& nodes, const FaultPoints& points,
                     std::size_t i) {
  const OperatorNode& node = nodes[static_cast<std::size_t>(points.source[i])];
  return points.mirrored[i] != 0 ? mirror(node) : node;
}

Eigen::Vector3d as_seen(const Eigen::Vector3d& local, bool mirrored) {
  return {local[0], mirrored ? -local[1] : local[1], local[2]};
}

}  // namespace faultsim
