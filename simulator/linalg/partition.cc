#include "simulator/linalg/partition.h"

#include <metis.h>

#include "simulator/common/errors.h"
#include "simulator/linalg/metis_turn.h"

namespace faultsim {

std::vector<int> partition(const VertexCells& cells, int n_parts) {
  const auto n_cells = static_cast<idx_t>(cells.begin.size() - 1);
  if (n_parts == 1 || n_cells == 0) return std::vector<int>(cells.n_vertices, 0);
  std::vector<idx_t> begin(cells.begin.begin(), cells.begin.end()),
      vertices(cells.vertices.begin(), cells.vertices.end()),
      weight(cells.weight.begin(), cells.weight.end()), of_cell(n_cells),
      of_vertex(cells.n_vertices);
  std::vector<idx_t> options(METIS_NOPTIONS);
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_NUMBERING] = 0;
  idx_t n_elements = n_cells, n_vertices = cells.n_vertices, parts = n_parts, cut = 0;
  const std::unique_lock turn = turn_of_metis(nullptr);
  const KeptSignalActions kept;
  const int done = METIS_PartMeshNodal(&n_elements, &n_vertices, begin.data(), vertices.data(),
                                       weight.data(), nullptr, &parts, nullptr, options.data(),
                                       &cut, of_cell.data(), of_vertex.data());
  if (done == METIS_ERROR_MEMORY) throw ResourceError("no memory to divide the mesh between ranks");
  if (done == METIS_ERROR) throw Interrupted("stopped while dividing the mesh between ranks");
  FAULTSIM_DEMAND(done == METIS_OK, "METIS_PartMeshNodal returns ", done);
  return {of_vertex.begin(), of_vertex.end()};
}

}  // namespace faultsim
