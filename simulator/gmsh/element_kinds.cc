#include "simulator/gmsh/element_kinds.h"

#include <algorithm>
#include <array>

namespace faultsim {
namespace {

struct ShapeOfKinds {
  ElementShape shape;
  int dimension, n_corners;
  const char *one, *many;
};
constexpr ShapeOfKinds kPoint{ElementShape::point, 0, 1, "point", "points"};
constexpr ShapeOfKinds kLine{ElementShape::line, 1, 2, "line", "lines"};
constexpr ShapeOfKinds kTriangle{ElementShape::triangle, 2, 3, "triangle", "triangles"};
constexpr ShapeOfKinds kQuadrangle{ElementShape::quadrangle, 2, 4, "quadrangle", "quadrangles"};
constexpr ShapeOfKinds kTetrahedron{ElementShape::tetrahedron, 3, 4, "tetrahedron", "tetrahedra"};
constexpr ShapeOfKinds kHexahedron{ElementShape::hexahedron, 3, 8, "hexahedron", "hexahedra"};
constexpr ShapeOfKinds kPrism{ElementShape::other, 3, 6, "prism", "prisms"};
constexpr ShapeOfKinds kPyramid{ElementShape::other, 3, 5, "pyramid", "pyramids"};

constexpr ElementKind kind_of(int type, const ShapeOfKinds& of, int n_nodes, bool is_read = false) {
  return {type, of.dimension, n_nodes, of.n_corners, is_read, of.shape, of.one, of.many};
}

/// Those of the manual of Gmsh, "MSH file format", and quadrangles of third to fifth order.
constexpr std::array kKinds{kind_of(1, kLine, 2),
                            kind_of(2, kTriangle, 3, true),
                            kind_of(3, kQuadrangle, 4, true),
                            kind_of(4, kTetrahedron, 4, true),
                            kind_of(5, kHexahedron, 8, true),
                            kind_of(6, kPrism, 6),
                            kind_of(7, kPyramid, 5),
                            kind_of(8, kLine, 3),
                            kind_of(9, kTriangle, 6, true),
                            kind_of(10, kQuadrangle, 9),
                            kind_of(11, kTetrahedron, 10, true),
                            kind_of(12, kHexahedron, 27),
                            kind_of(13, kPrism, 18),
                            kind_of(14, kPyramid, 14),
                            kind_of(15, kPoint, 1),
                            kind_of(16, kQuadrangle, 8),
                            kind_of(17, kHexahedron, 20),
                            kind_of(18, kPrism, 15),
                            kind_of(19, kPyramid, 13),
                            kind_of(20, kTriangle, 9),
                            kind_of(21, kTriangle, 10),
                            kind_of(22, kTriangle, 12),
                            kind_of(23, kTriangle, 15),
                            kind_of(24, kTriangle, 15),
                            kind_of(25, kTriangle, 21),
                            kind_of(26, kLine, 4),
                            kind_of(27, kLine, 5),
                            kind_of(28, kLine, 6),
                            kind_of(29, kTetrahedron, 20),
                            kind_of(30, kTetrahedron, 35),
                            kind_of(31, kTetrahedron, 56),
                            kind_of(36, kQuadrangle, 16),
                            kind_of(37, kQuadrangle, 25),
                            kind_of(38, kQuadrangle, 36),
                            kind_of(92, kHexahedron, 64),
                            kind_of(93, kHexahedron, 125)};

}  // namespace

const ElementKind* element_kind(std::int64_t type) {
  const auto* found = std::ranges::find(kKinds, type, &ElementKind::type);
  return found == kKinds.end() ? nullptr : found;
}

}  // namespace faultsim
