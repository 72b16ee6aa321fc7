#include "simulator/common/named_mesh.h"

#include "simulator/common/fingerprint.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

template <typename Value>
std::string of_values(const std::vector<Value>& values) {
  return concat(values.size(), ":", fingerprint(values.data(), values.size() * sizeof(Value)),
                "\n");
}

std::string of_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += concat(name.size(), ":", name, "\n");
  return text;
}

}  // namespace

std::string fingerprint_of(const NamedMesh& mesh) {
  return fingerprint(concat(mesh.corners_per_cell, "\n", of_values(mesh.nodes),
                            of_values(mesh.cells), of_values(mesh.cell_group),
                            of_names(mesh.cell_groups), of_values(mesh.facets),
                            of_values(mesh.facet_group), of_names(mesh.facet_groups)));
}

}  // namespace faultsim
