#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace faultsim {

/// Text of an XDMF 3 file beside an HDF5 file: what ParaView needs to draw the datasets.
/// Only the base name of the HDF5 file is referenced, so that the pair can be moved.

/// A dataset of the HDF5 file by path and shape; the shape of a field in time starts with the
/// number of steps.
struct XdmfData {
  std::string path;
  std::vector<std::size_t> shape;
  bool integer = false;
};

struct XdmfAttribute {
  std::string name;
  XdmfData data;
  bool on_cells = false;
  bool vector = false;
  bool in_time = false;  ///< the first dimension is the step.
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
