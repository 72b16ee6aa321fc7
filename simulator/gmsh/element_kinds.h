#pragma once

#include <cstdint>

namespace faultsim {

/// Shapes of elements that matter here.
enum class ElementShape { point, line, triangle, quadrangle, tetrahedron, hexahedron, other };

/// A kind of elements of MSH files.
struct ElementKind {
  int type;       ///< its number in files.
  int dimension;  ///< 0 to 3.
  int n_nodes;
  int n_corners;  ///< the first of its nodes.
  bool is_read;   ///< as a cell or facet.
  ElementShape shape;
  const char* one;   ///< "tetrahedron".
  const char* many;  ///< "tetrahedra".
};

/// The kind of a type; null where the type is not known.
const ElementKind* element_kind(std::int64_t type);

}  // namespace faultsim
