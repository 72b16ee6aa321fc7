#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "simulator/operators/field_loads.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/surface/field_surface.h"
#include "simulator/surface/operator_surface.h"

namespace faultsim {

/// Where the operators of scenes come from, one scene after the other: exact ones out of the cache
/// or the factor, interpolated ones out of a surface, and with them what flow results do. What a
/// scene has in common with the one before is kept.
class OperatorSource {
 public:
  struct Made {
    PreparedOperator prepared;
    bool is_new = false;  ///< an operator was read or built, not put together from what was there.
  };
  /// Whether the scene's operator can be put together at once, without files or factors.
  bool is_at_hand(const LoadedScene& loaded, bool keep_bulk) const;
  /// What cases of the scene run on. Throws InputError (a flow result that does not fit, a surface
  /// that does not reach its tolerance), ResourceError, Interrupted.
  /// @param keep_bulk  with factors, for displacements of the whole mesh.
  Made prepare(const LoadedScene& loaded, const CachePolicy& cache, bool keep_bulk,
               const RunContext& context);
  /// One that has what this has, but for factors, which one thread uses at a time.
  OperatorSource for_another_thread() const;

 private:
  /// The loads of one field, and what is to be said of it.
  struct KnownLoads {
    std::string key;  ///< field_loads_key.
    FieldLoads loads;
    std::vector<std::string> warnings;
  };
  /// The operator of a family, the cells that fields act on, and the loads of some fields.
  struct Cells {
    std::string key;  ///< operator_key of the family.
    PreparedOperator prepared;
    std::shared_ptr<const InfluenceBlock> block;
    std::shared_ptr<const BulkProblem> problem;
    std::deque<KnownLoads> loads;  ///< the newest first.
    const KnownLoads* find(const std::string& wanted) const;
  };
  bool has_cells(const LoadedScene& loaded, bool keep_bulk) const;
  Made from_surface(const LoadedScene& loaded, const CachePolicy& cache, const RunContext& context);
  void add_fields(const LoadedScene& loaded, const CachePolicy& cache, const RunContext& context,
                  Made& made);
  Made with_fields(const LoadedScene& loaded, const CachePolicy& cache, bool keep_bulk,
                   const RunContext& context);
  static Cells cells_of(const LoadedScene& loaded, const CachePolicy& cache, bool keep_bulk,
                        const RunContext& context);

  std::shared_ptr<const OperatorSurface> surface_;
  std::string surface_key_;
  std::shared_ptr<const FieldSurface> fields_;  ///< the last flow result on surface_.
  std::string fields_key_;
  Cells cells_;
};

/// Scenes with the same key run on the same prepared operator, loads of fields and all.
std::string operator_case_key(const LoadedScene& loaded);

}  // namespace faultsim
