#include "simulator/result_files/xdmf.h"

#include <string_view>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string escape(const std::string& text) {
  constexpr std::string_view kSpecial = "&<>\"";
  constexpr const char* kEscapes[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
  std::string result;
  for (const char c : text) {
    const std::size_t k = kSpecial.find(c);
    if (k != std::string_view::npos) {
      result += kEscapes[k];
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

std::string join(const std::vector<std::size_t>& numbers) { return joined(numbers, " "); }

/// A whole dataset.
std::string item(const std::string& h5_name, const XdmfData& data) {
  return concat("<DataItem Format=\"HDF\" NumberType=\"", data.integer ? "Int" : "Float",
                "\" Precision=\"", data.integer ? 4 : 8, "\" Dimensions=\"", join(data.shape),
                "\">", escape(h5_name), ":", data.path, "</DataItem>");
}

/// One step of a dataset in time, by its place in the file.
std::string step_item(const std::string& h5_name, const XdmfData& data, std::size_t step) {
  FAULTSIM_DEMAND(step < data.offsets.size(), data.path, " has no step ", step);
  return concat("<DataItem Format=\"Binary\" NumberType=\"", data.integer ? "Int" : "Float",
                "\" Precision=\"", data.integer ? 4 : 8, "\" Endian=\"Little\" Seek=\"",
                data.offsets[step], "\" Dimensions=\"", join(data.shape), "\">", escape(h5_name),
                "</DataItem>");
}

void write_grid(std::string& out, const std::string& h5_name, const XdmfGrid& grid,
                std::size_t step) {
  const bool counted = grid.topology == "Polyline" || grid.topology == "Polyvertex";
  out += concat("      <Grid Name=\"", escape(grid.name), "\" GridType=\"Uniform\">\n");
  out += concat("        <Topology TopologyType=\"", grid.topology, "\" NumberOfElements=\"",
                grid.cells.shape[0], "\"");
  if (counted) out += concat(" NodesPerElement=\"", grid.cells.shape[1], "\"");
  out += concat(">", item(h5_name, grid.cells), "</Topology>\n");
  out += concat("        <Geometry GeometryType=\"XYZ\">", item(h5_name, grid.points),
                "</Geometry>\n");
  for (const XdmfAttribute& attribute : grid.attributes) {
    out += concat("        <Attribute Name=\"", escape(attribute.name), "\" AttributeType=\"",
                  attribute.vector ? "Vector" : "Scalar", "\" Center=\"",
                  attribute.on_cells ? "Cell" : "Node", "\">",
                  attribute.data.offsets.empty() ? item(h5_name, attribute.data)
                                                 : step_item(h5_name, attribute.data, step),
                  "</Attribute>\n");
  }
  out += "      </Grid>\n";
}

}  // namespace

std::string xdmf_text(const std::string& h5_name, const std::string& title,
                      const std::vector<XdmfGrid>& grids, const std::vector<double>& times) {
  const std::string name = escape(title);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
      "<Xdmf Version=\"3.0\">\n  <Domain>\n";
  const bool temporal = !times.empty();
  if (temporal) {
    out += concat("   <Grid Name=\"", name,
                  "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  }
  for (std::size_t step = 0; step < (temporal ? times.size() : 1); ++step) {
    out += concat("    <Grid Name=\"", name,
                  "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n");
    if (temporal) out += concat("      <Time Value=\"", times[step], "\"/>\n");
    for (const XdmfGrid& grid : grids) write_grid(out, h5_name, grid, step);
    out += "    </Grid>\n";
  }
  if (temporal) out += "   </Grid>\n";
  return out + "  </Domain>\n</Xdmf>\n";
}

}  // namespace faultsim
