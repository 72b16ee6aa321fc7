#pragma once

#include <string>
#include <vector>

#include "simulator/flow/flow_mapping.h"
#include "simulator/loads/field_history.h"
#include "simulator/operators/influence.h"
#include "simulator/result/field_integral.h"

namespace faultsim {

/// A flow result on the faults of a scene.
struct FieldLoads {
  std::shared_ptr<const FieldHistory> history;  ///< at the reports that the scene takes.
  FlowMapping mapping;                          ///< of the pressure field, if there is one.
  double coverage = 1;  ///< share of the compartments' volume that is covered, [0, 1]; of pressure
                        ///< and temperature the smaller one.
  std::vector<FieldIntegral> integrals;  ///< per field and compartment.
  std::vector<std::string> notes;        ///< what became of the cells of each compartment.
};

/// The cells that fields act on, and what stress in them does to closed faults.
struct FieldCells {
  const FaultOperator& op;
  const Mesh& mesh;             ///< of the operator.
  const InfluenceBlock& block;  ///< all cells of the compartments; P and O may be empty:
  CreepLadder* bulk = nullptr;  ///< then the factor is asked, a forward substitution per report.
                                ///< Where it is there, the history has forces; where there is
                                ///< neither, its `locked` and `observed` stay empty.
};

/// Maps the scene's fields onto the cells and condenses them: s_c = f_c (b Δp_c + 3 K α_T ΔT_c)
/// with the share f_c of the cell in its compartment, one product (or substitution) per report from
/// the reference on; Δp_f of a fault node is its fault's rule on the pairs of cells beside it, as
/// for compartments. Neither strength nor friction is looked at, so that samples of them share it;
/// what is looked at is told by field_loads_key().
/// @pre the scene has a flow result; in a half domain it is symmetric about y = 0.
/// @throws InputError as map_load() does.
FieldLoads field_loads(const Scene& scene, const FieldCells& cells, int n_threads = 1);

/// Scenes of one operator with the same key have the same field loads.
std::string field_loads_key(const Scene& scene);

}  // namespace faultsim
