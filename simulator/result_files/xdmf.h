#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace faultsim {

/// Text of an XDMF 3 file beside an HDF5 file: what ParaView needs to draw the datasets.
/// Only the base name of the HDF5 file is referenced, so that the pair can be moved.
///
/// A step of a field is referenced by its place in the file (Binary with Seek): of ParaView 5.11's
/// readers only "XDMF Reader" takes a hyperslab of a dataset, the two Xdmf3 ones, of which one is
/// the default, drop the array. See docs/decisions/0009-fields-in-paraview.md.

/// A dataset of the HDF5 file by path and shape.
struct XdmfData {
  std::string path;
  std::vector<std::size_t> shape;
  bool integer = false;  ///< 4 bytes, else 8.
  /// Of a field in time: where the numbers of each step begin in the file, bytes; the shape is that
  /// of a step.
  std::vector<std::uint64_t> offsets = {};
};

struct XdmfAttribute {
  std::string name;
  XdmfData data;
  bool on_cells = false;
  bool vector = false;
};

struct XdmfGrid {
  std::string name;
  std::string topology;  ///< "Quadrilateral", "Polyline", "Hexahedron", "Polyvertex".
  XdmfData cells;        ///< n_cells x nodes per cell.
  XdmfData points;       ///< n_points x 3.
  std::vector<XdmfAttribute> attributes;
};

/// A temporal collection whose steps are spatial collections of the grids; without times one
/// spatial collection.
/// @param times  s, one per step.
std::string xdmf_text(const std::string& h5_name, const std::string& title,
                      const std::vector<XdmfGrid>& grids, const std::vector<double>& times);

}  // namespace faultsim
