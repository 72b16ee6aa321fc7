#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "simulator/mesh/uncut_mesh.h"

namespace faultsim::test {

/// A box between lines of a grid before faults cut it, of hexahedra, or each of its cells six
/// tetrahedra around the diagonal from the low corner to the high one. Beyond a centre all is
/// mirrored, so that diagonals lead away from it. Boundary groups are the sides, in the order of
/// Side. Nodes may be moved afterwards.
class GridBody {
 public:
  using Lines = std::array<std::vector<double>, 3>;

  explicit GridBody(Lines lines, std::array<double, 3> centre = {kNone, kNone, kNone},
                    CellShape shape = CellShape::tetrahedron)
      : lines_(std::move(lines)), centre_(centre) {
    body.shape = shape;
    for (std::size_t k = 0; k < lines_[2].size(); ++k)
      for (std::size_t j = 0; j < lines_[1].size(); ++j)
        for (std::size_t i = 0; i < lines_[0].size(); ++i)
          body.nodes.emplace_back(lines_[0][i], lines_[1][j], lines_[2][k]);
    for_each_place({n_cells(0), n_cells(1), n_cells(2)}, [&](const Place& at) { add_cells(at); });
    body.material.assign(body.corners.size() / corners_of_cell(shape), 0);
    body.region.assign(body.material.size(), -1);
    body.region_fraction.assign(body.material.size(), 0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const std::size_t line : {std::size_t{0}, n_cells(axis)})
        body.boundary.push_back(
            {"", facets(axis, line, [](const Eigen::Vector3d&) { return true; })});
  }

  /// The part of a plane of the grid in which facets have their centres where `is_inside`.
  void add_fault(const std::string& name, std::size_t axis, double at,
                 const std::function<bool(const Eigen::Vector3d&)>& is_inside) {
    const auto line = std::ranges::min_element(lines_[axis], {},
                                               [&](double place) { return std::abs(place - at); });
    body.faults.push_back(
        {name, facets(axis, static_cast<std::size_t>(line - lines_[axis].begin()), is_inside)});
  }

  /// Turns or mirrors all.
  void turn(const Eigen::Matrix3d& by) {
    for (Eigen::Vector3d& x : body.nodes) x = by * x;
    if (by.determinant() > 0) return;
    for (std::size_t k = 0; k < body.corners.size(); k += 4)
      std::swap(body.corners[k], body.corners[k + 1]);
  }

  Eigen::Vector3d centre_of_cell(std::size_t cell) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t v = 0; v < 4; ++v) sum += body.nodes[node(body.corners[4 * cell + v])];
    return sum / 4;
  }

  UncutMesh body;

 private:
  using Place = std::array<std::size_t, 3>;

  static constexpr double kNone = -HUGE_VAL;

  static std::size_t node(int number) { return static_cast<std::size_t>(number); }
  std::size_t n_cells(std::size_t axis) const { return lines_[axis].size() - 1; }
  int number(const Place& at) const {
    return static_cast<int>(at[0] + lines_[0].size() * (at[1] + lines_[1].size() * at[2]));
  }

  template <typename Function>
  static void for_each_place(const Place& n, const Function& f) {
    for (std::size_t k = 0; k < n[2]; ++k)
      for (std::size_t j = 0; j < n[1]; ++j)
        for (std::size_t i = 0; i < n[0]; ++i) f(Place{i, j, k});
  }

  bool is_mirrored(std::size_t axis, std::size_t cell) const {
    return lines_[axis][cell] + lines_[axis][cell + 1] < 2 * centre_[axis];
  }
  /// The corner of a cell from which its diagonal leads away, or across to the other end.
  Place start(Place low, const std::array<bool, 3>& mirrored) const {
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] += mirrored[axis] ? 1 : 0;
    return low;
  }
  static void step(Place& at, std::size_t axis, const std::array<bool, 3>& mirrored) {
    at[axis] = mirrored[axis] ? at[axis] - 1 : at[axis] + 1;
  }

  void add_cells(const Place& low) {
    if (body.shape == CellShape::hexahedron) {
      for (std::size_t v = 0; v < 8; ++v)
        body.corners.push_back(
            number({low[0] + (v % 4 == 1 || v % 4 == 2), low[1] + v % 4 / 2, low[2] + v / 4}));
      return;
    }
    std::array<bool, 3> mirrored{};
    for (std::size_t axis = 0; axis < 3; ++axis) mirrored[axis] = is_mirrored(axis, low[axis]);
    const bool is_left_handed = (std::ranges::count(mirrored, true) % 2) == 1;
    Place axes = {0, 1, 2};
    do {
      Place at = start(low, mirrored);
      std::array<int, 4> corners = {number(at)};
      for (std::size_t v = 0; v < 3; ++v) {
        step(at, axes[v], mirrored);
        corners[v + 1] = number(at);
      }
      const bool is_even = (axes[1] + 3 - axes[0]) % 3 == 1;
      if (is_even == is_left_handed) std::swap(corners[2], corners[3]);
      body.corners.insert(body.corners.end(), corners.begin(), corners.end());
    } while (std::ranges::next_permutation(axes).found);
  }

  std::vector<std::array<int, 4>> facets(
      std::size_t axis, std::size_t line,
      const std::function<bool(const Eigen::Vector3d&)>& is_inside) const {
    std::vector<std::array<int, 4>> found;
    Place n = {n_cells(0), n_cells(1), n_cells(2)};
    n[axis] = 1;
    for_each_place(n, [&](Place low) {
      low[axis] = line;
      std::array<bool, 3> mirrored{};
      for (const std::size_t across : {(axis + 1) % 3, (axis + 2) % 3})
        mirrored[across] = is_mirrored(across, low[across]);
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      const Place begin = start(low, mirrored);
      Place left = begin, right = begin;
      step(left, u, mirrored);
      step(right, v, mirrored);
      Place high = left;
      step(high, v, mirrored);
      const int a = number(begin), b = number(left), c = number(high), d = number(right);
      const auto add = [&](const std::array<int, 4>& facet) {
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        const int n_corners = facet[3] < 0 ? 3 : 4;
        for (int k = 0; k < n_corners; ++k)
          centre += body.nodes[node(facet[static_cast<std::size_t>(k)])] / n_corners;
        if (is_inside(centre)) found.push_back(facet);
      };
      if (body.shape == CellShape::hexahedron) {
        add({a, b, c, d});
      } else {
        add({a, b, c, -1});
        add({a, d, c, -1});
      }
    });
    return found;
  }

  Lines lines_;
  std::array<double, 3> centre_;
};

/// n + 1 lines from `from` to `to`.
inline std::vector<double> even_lines(double from, double to, int n) {
  std::vector<double> lines;
  for (int k = 0; k <= n; ++k) lines.push_back(from + (to - from) * k / n);
  return lines;
}

}  // namespace faultsim::test
