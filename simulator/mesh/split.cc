#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/mesh/hat_areas.h"
#include "simulator/mesh/structured_grid.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using Index3 = std::array<size_t, 3>;

constexpr std::array<Index3, 8> kCorner = {{{0, 0, 0},
                                            {1, 0, 0},
                                            {1, 1, 0},
                                            {0, 1, 0},  // VTK order
                                            {0, 0, 1},
                                            {1, 0, 1},
                                            {1, 1, 1},
                                            {0, 1, 1}}};

int to_int(size_t n) { return static_cast<int>(n); }

[[noreturn]] void refuse(const std::string& pointer, const std::string& what,
                         const std::string& cure) {
  throw InputError("scene", {{pointer, 0, what, cure}});
}

Cells grid_cells(const StructuredGrid& grid) {
  Cells cells;
  cells.reserve(grid.n_cells());
  for (size_t k = 0; k + 1 < grid.n_lines(2); ++k)
    for (size_t j = 0; j + 1 < grid.n_lines(1); ++j)
      for (size_t i = 0; i + 1 < grid.n_lines(0); ++i) {
        std::array<int, 8> cell;
        for (size_t v = 0; v < 8; ++v)
          cell[v] = to_int(grid.point({i + kCorner[v][0], j + kCorner[v][1], k + kCorner[v][2]}));
        cells.add(cell);
      }
  return cells;
}

/// Grid index of a point of a fault's plane.
Index3 on_plane(const GridFault& fault, size_t column, size_t row) {
  Index3 at{};
  at[fault.axis] = fault.plane;
  at[fault.column_axis] = column;
  at[fault.row_axis] = row;
  return at;
}

/// Per point the number of its plus copy, or -1: behind all points, fault by fault.
std::vector<int> number_plus_copies(const StructuredGrid& grid) {
  std::vector<int> plus_of(grid.n_points(), -1);
  size_t next = grid.n_points();
  for (const GridFault& fault : grid.faults) {
    const size_t n_columns = grid.n_lines(fault.column_axis), n_rows = grid.n_lines(fault.row_axis);
    FAULTSIM_DEMAND(fault.split.size() == n_columns * n_rows, fault.split.size());
    FAULTSIM_DEMAND(fault.plane > 0 && fault.plane + 1 < grid.n_lines(fault.axis), fault.plane);
    for (size_t column = 0; column < n_columns; ++column)
      for (size_t row = 0; row < n_rows; ++row) {
        if (!fault.split[column * n_rows + row]) continue;
        const size_t point = grid.point(on_plane(fault, column, row));
        FAULTSIM_DEMAND(plus_of[point] < 0, "two faults split point ", point);
        plus_of[point] = to_int(next++);
      }
  }
  return plus_of;
}

/// Adds the plus copies at the places of their points.
void add_plus_copies(const std::vector<int>& plus_of, std::vector<Vector3d>& nodes) {
  const auto is_split = [](int plus) { return plus >= 0; };
  nodes.resize(plus_of.size() + static_cast<size_t>(std::ranges::count_if(plus_of, is_split)));
  for (size_t point = 0; point < plus_of.size(); ++point)
    if (plus_of[point] >= 0) nodes[static_cast<size_t>(plus_of[point])] = nodes[point];
}

/// Hands the plus copies to the cells beyond the faults' planes.
void split_cells(const StructuredGrid& grid, const std::vector<int>& plus_of, Mesh& mesh) {
  for (const GridFault& fault : grid.faults) {
    const size_t n_columns = grid.n_lines(fault.column_axis), n_rows = grid.n_lines(fault.row_axis);
    for (size_t column = 0; column + 1 < n_columns; ++column)
      for (size_t row = 0; row + 1 < n_rows; ++row)
        for (int& node : mesh.cells[grid.cell(on_plane(fault, column, row))]) {
          if (node >= to_int(grid.n_points()) || plus_of[static_cast<size_t>(node)] < 0) continue;
          // Of the nodes of this cell only those on the plane are of this fault.
          const size_t n = static_cast<size_t>(node);
          const Index3 at = {n % grid.n_lines(0), n / grid.n_lines(0) % grid.n_lines(1),
                             n / (grid.n_lines(0) * grid.n_lines(1))};
          if (at[fault.axis] == fault.plane &&
              fault.split[at[fault.column_axis] * n_rows + at[fault.row_axis]])
            node = plus_of[n];
        }
  }
}

std::vector<BoundaryFace> boundary_faces(const StructuredGrid& grid, const Mesh& mesh) {
  // Corners of each side of a cell, counter-clockwise seen from outside; order of Side.
  constexpr std::array<std::array<size_t, 4>, 6> kSide = {
      {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
  std::vector<BoundaryFace> faces;
  for (size_t side = 0; side < 6; ++side) {
    const size_t axis = side / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (size_t n = 0; n + 1 < grid.n_lines(b); ++n)
      for (size_t m = 0; m + 1 < grid.n_lines(c); ++m) {
        Index3 at{};
        at[axis] = side % 2 == 0 ? 0 : grid.n_lines(axis) - 2;
        at[b] = n;
        at[c] = m;
        const size_t cell = grid.cell(at);
        BoundaryFace face{to_int(cell), static_cast<Side>(side), {-1, -1, -1, -1, -1, -1}};
        for (size_t v = 0; v < 4; ++v) face.places[v] = mesh.cells[cell][kSide[side][v]];
        faces.push_back(face);
      }
  }
  return faces;
}

/// Ties the far face of each tied axis to the near one, and plus copies to plus copies.
void tie_faces(const StructuredGrid& grid, const std::vector<int>& plus_of, Mesh& mesh) {
  mesh.tied_to.resize(mesh.nodes.size());
  for (size_t n = 0; n < mesh.nodes.size(); ++n) mesh.tied_to[n] = to_int(n);
  std::array<bool, 3> tied = grid.tied;
  if (grid.plane_strain) tied[1] = true;
  if (!tied[0] && !tied[1] && !tied[2]) return;
  const Vector3d extent = mesh.nodes[grid.n_points() - 1] - mesh.nodes[0];
  const double tolerance = 1e-9 * extent.norm();
  Index3 at{};
  for (at[2] = 0; at[2] < grid.n_lines(2); ++at[2])
    for (at[1] = 0; at[1] < grid.n_lines(1); ++at[1])
      for (at[0] = 0; at[0] < grid.n_lines(0); ++at[0]) {
        Index3 root = at;
        Vector3d offset = Vector3d::Zero();
        for (size_t axis = 0; axis < 3; ++axis)
          if (tied[axis] && at[axis] + 1 == grid.n_lines(axis)) {
            root[axis] = 0;
            offset[static_cast<int>(axis)] = extent[static_cast<int>(axis)];
          }
        const size_t from = grid.point(at), to = grid.point(root);
        if (from == to) continue;
        if ((mesh.nodes[from] - mesh.nodes[to] - offset).norm() > tolerance)
          refuse("/faults", "opposite tied faces do not match: the grid is sheared between them",
                 "turn the patch so that it runs straight from one tied face to the other");
        if ((plus_of[from] < 0) != (plus_of[to] < 0))
          refuse("/faults", "a fault cuts one of two tied faces but not the other",
                 "let the patch pass beyond both tied faces or end inside the body");
        mesh.tied_to[from] = to_int(to);
        if (plus_of[from] >= 0) mesh.tied_to[static_cast<size_t>(plus_of[from])] = plus_of[to];
      }
}

/// Makes one FaultSurface from a cut fault.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const StructuredGrid& grid, const GridFault& fault,
                 const std::vector<int>& plus_of, const Mesh& mesh)
      : grid_(grid), fault_(fault), plus_of_(plus_of), mesh_(mesh) {}

  FaultSurface build() {
    surface_.name = fault_.name;
    find_range();
    find_nodes();
    add_faces();
    return std::move(surface_);
  }

 private:
  bool splits(size_t column, size_t row) const {
    return fault_.split[column * grid_.n_lines(fault_.row_axis) + row] != 0;
  }
  size_t point(size_t column, size_t row) const {
    return grid_.point(on_plane(fault_, column, row));
  }
  /// Row line of the r-th row of the block: rows go down dip.
  size_t row_line(int r) const {
    const bool up = fault_.dip[static_cast<int>(fault_.row_axis)] > 0;
    return up ? first_row_ + static_cast<size_t>(r) : last_row_ - static_cast<size_t>(r);
  }
  size_t column_line(int c) const { return first_column_ + static_cast<size_t>(c); }
  size_t grid_index(int c, int r) const {
    return static_cast<size_t>(c) * static_cast<size_t>(n_rows_) + static_cast<size_t>(r);
  }

  /// The smallest block of points that holds the split ones and one ring around them.
  void find_range() {
    const size_t n_columns = grid_.n_lines(fault_.column_axis),
                 n_rows = grid_.n_lines(fault_.row_axis);
    first_column_ = n_columns, first_row_ = n_rows, last_column_ = 0, last_row_ = 0;
    for (size_t column = 0; column < n_columns; ++column)
      for (size_t row = 0; row < n_rows; ++row)
        if (splits(column, row)) {
          first_column_ = std::min(first_column_, column);
          last_column_ = std::max(last_column_, column);
          first_row_ = std::min(first_row_, row);
          last_row_ = std::max(last_row_, row);
        }
    if (first_column_ == n_columns)
      refuse("/faults",
             concat("fault \"", fault_.name, "\" splits no node: it is smaller than a cell"),
             "use smaller cells at the fault or a larger fault");
    first_column_ -= first_column_ > 0;
    first_row_ -= first_row_ > 0;
    last_column_ += last_column_ + 1 < n_columns;
    last_row_ += last_row_ + 1 < n_rows;
    n_columns_ = grid_.plane_strain ? 1 : to_int(last_column_ - first_column_ + 1);
    n_rows_ = to_int(last_row_ - first_row_ + 1);
  }

  void find_nodes() {
    node_at_.assign(grid_index(n_columns_, 0), -1);
    // A tied point lies on the near end of its axis or axes, hence comes first in line order; look
    // it up by its mesh node.
    std::vector<std::pair<int, int>> roots;  // (minus mesh node, surface node)
    for (int c = 0; c < n_columns_; ++c)
      for (int r = 0; r < n_rows_; ++r) {
        const size_t at = point(column_line(c), row_line(r));
        if (plus_of_[at] < 0 || !splits(column_line(c), row_line(r)) ||
            mesh_.tied_to[at] != to_int(at))
          continue;
        node_at_[grid_index(c, r)] = to_int(surface_.nodes.size());
        roots.push_back({to_int(at), to_int(surface_.nodes.size())});
        surface_.nodes.push_back(
            {to_int(at), plus_of_[at], fault_.normal, fault_.strike, fault_.dip, 0.0});
      }
    std::ranges::sort(roots);
    for (int c = 0; c < n_columns_; ++c)
      for (int r = 0; r < n_rows_; ++r) {
        const size_t at = point(column_line(c), row_line(r));
        if (!splits(column_line(c), row_line(r)) || mesh_.tied_to[at] == to_int(at)) continue;
        const auto found =
            std::ranges::lower_bound(roots, std::pair<int, int>(mesh_.tied_to[at], -1));
        if (found == roots.end() || found->first != mesh_.tied_to[at])
          refuse("/faults", concat("fault \"", fault_.name, "\" is tied to another fault"),
                 "let one patch pass beyond both tied faces");
        node_at_[grid_index(c, r)] = found->second;
      }
  }

  /// Faces with a split corner, their corners numbered along the grid; then those as points.
  void add_faces() {
    const double thickness = grid_.plane_strain ? mesh_.thickness : 1;
    const int n_face_columns = grid_.plane_strain ? 1 : n_columns_ - 1;
    std::vector<int> number(node_at_.size(), -1);
    for (int c = 0; c < n_face_columns; ++c)
      for (int r = 0; r + 1 < n_rows_; ++r) {
        const int other = grid_.plane_strain ? c : c + 1;
        const std::array<size_t, 4> corner = {grid_index(c, r), grid_index(c, r + 1),
                                              grid_index(other, r + 1), grid_index(other, r)};
        if (std::ranges::none_of(corner, [&](size_t k) { return node_at_[k] >= 0; })) continue;
        add_face(c, r, corner, thickness);
        for (const size_t k : corner) number[k] = 0;
      }
    for (int c = 0; c < n_columns_; ++c)
      for (int r = 0; r < n_rows_; ++r) {
        const size_t k = grid_index(c, r);
        if (number[k] < 0) continue;
        number[k] = to_int(surface_.points.size());
        surface_.points.push_back(mesh_.nodes[point(column_line(c), row_line(r))]);
        surface_.node_of_point.push_back(node_at_[k]);
      }
    for (FaultFace& face : surface_.faces)
      for (int& corner : face.points) corner = number[static_cast<size_t>(corner)];
  }

  void add_face(int c, int r, const std::array<size_t, 4>& corner, double thickness) {
    const size_t column = column_line(c), row = std::min(row_line(r), row_line(r + 1));
    const HatAreas areas = quad_areas({mesh_.nodes[point(column, row_line(r))],
                                       mesh_.nodes[point(column, row_line(r + 1))],
                                       mesh_.nodes[point(column + 1, row_line(r + 1))],
                                       mesh_.nodes[point(column + 1, row_line(r))]});
    Index3 plus = on_plane(fault_, column, row), minus = plus;
    --minus[fault_.axis];
    FaultFace face{
        {}, {}, to_int(grid_.cell(minus)), to_int(grid_.cell(plus)), areas.total / thickness};
    for (size_t v = 0; v < 4; ++v) {
      face.points[v] = to_int(corner[v]);
      face.nodes[v] = node_at_[corner[v]];
      if (face.nodes[v] >= 0)
        surface_.nodes[static_cast<size_t>(face.nodes[v])].area += areas.corner[v] / thickness;
    }
    surface_.faces.push_back(face);
  }

  const StructuredGrid& grid_;
  const GridFault& fault_;
  const std::vector<int>& plus_of_;
  const Mesh& mesh_;
  FaultSurface surface_;
  size_t first_column_ = 0, last_column_ = 0, first_row_ = 0, last_row_ = 0;
  int n_columns_ = 0, n_rows_ = 0;  // of that block
  std::vector<int> node_at_;        // of the surface, at its points; -1 = not split
};

/// What a mesh takes of its grid as it is.
Mesh take_grid(StructuredGrid& grid) {
  Mesh mesh;
  mesh.nodes = std::move(grid.position);
  mesh.material = std::move(grid.material);
  mesh.region = std::move(grid.region);
  mesh.region_fraction = std::move(grid.region_fraction);
  FAULTSIM_DEMAND(mesh.nodes.size() == grid.n_points() && mesh.material.size() == grid.n_cells() &&
                      mesh.region.size() == grid.n_cells() &&
                      mesh.region_fraction.size() == grid.n_cells(),
                  mesh.nodes.size(), " ", mesh.material.size());
  mesh.plane_strain = grid.plane_strain;
  mesh.thickness = grid.plane_strain ? grid.lines[1].back() - grid.lines[1].front() : 1;
  return mesh;
}

bool same_topology(const FaultSurface& a, const FaultSurface& b) {
  return a.node_of_point == b.node_of_point &&
         std::ranges::equal(a.nodes, b.nodes,
                            [](const FaultNode& one, const FaultNode& other) {
                              return one.minus_node == other.minus_node &&
                                     one.plus_node == other.plus_node;
                            }) &&
         std::ranges::equal(a.faces, b.faces, [](const FaultFace& one, const FaultFace& other) {
           return one.points == other.points && one.nodes == other.nodes &&
                  one.minus_cell == other.minus_cell && one.plus_cell == other.plus_cell;
         });
}

}  // namespace

void share_pairs(Mesh& mesh) {
  mesh.copies.clear();
  for (size_t f = 0; f < mesh.faults.size(); ++f)
    for (size_t k = 0; k < mesh.faults[f].nodes.size(); ++k) {
      const FaultNode& pair = mesh.faults[f].nodes[k];
      const int first = std::min(pair.minus_node, pair.plus_node);
      mesh.copies.push_back({pair.minus_node, first, {{to_int(f), to_int(k), -0.5}}});
      mesh.copies.push_back({pair.plus_node, first, {{to_int(f), to_int(k), 0.5}}});
    }
  std::ranges::sort(mesh.copies, {}, &NodeCopy::node);
}

std::vector<Problem> grid_size_problems(const GridLines& lines) {
  double n_cells = 1;
  for (const std::vector<double>& axis : lines) n_cells *= static_cast<double>(axis.size()) - 1;
  if (n_cells <= kMaxCells) return {};
  return {{"/mesh", 0, concat("the mesh would have ", n_cells, " cells, more than ", kMaxCells),
           "use larger cells, more growth, the half domain or plane strain"}};
}

Mesh cut_faults(StructuredGrid grid) {
  Mesh mesh = take_grid(grid);
  mesh.cells = grid_cells(grid);
  const std::vector<int> plus_of = number_plus_copies(grid);
  add_plus_copies(plus_of, mesh.nodes);
  split_cells(grid, plus_of, mesh);
  mesh.boundary = boundary_faces(grid, mesh);
  tie_faces(grid, plus_of, mesh);
  for (const GridFault& fault : grid.faults)
    mesh.faults.push_back(SurfaceBuilder(grid, fault, plus_of, mesh).build());
  share_pairs(mesh);
  return mesh;
}

std::optional<Mesh> cut_as(const Mesh& like, StructuredGrid grid) {
  // The last cell ends at the last point, the first one tells how long the rows are.
  const auto row = to_int(grid.n_lines(0)), layer = to_int(grid.n_lines(0) * grid.n_lines(1));
  const bool same_grid = like.cells.size() == grid.n_cells() && like.cells[0][3] == row &&
                         like.cells[0][4] == layer && like.faults.size() == grid.faults.size();
  if (!same_grid || like.material != grid.material) return std::nullopt;
  Mesh mesh = take_grid(grid);
  const std::vector<int> plus_of = number_plus_copies(grid);
  add_plus_copies(plus_of, mesh.nodes);
  if (mesh.nodes.size() != like.nodes.size()) return std::nullopt;
  mesh.tied_to = like.tied_to;
  for (size_t f = 0; f < grid.faults.size(); ++f) {
    mesh.faults.push_back(SurfaceBuilder(grid, grid.faults[f], plus_of, mesh).build());
    if (!same_topology(mesh.faults.back(), like.faults[f])) return std::nullopt;
  }
  mesh.copies = like.copies;
  return mesh;
}

}  // namespace faultsim
