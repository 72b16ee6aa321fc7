#pragma once

#include "simulator/common/words.h"
#include "simulator/coupled/leading_block.h"

namespace faultsim {

/// How S = Cᵀ (K + E)⁻¹ (C − F) is approximated (model section 11).
enum class SchurKind {
  exact,        ///< S itself: one solve with K + E per multiplier, dense LU.
  fsai_direct,  ///< Cᵀ GᵀG (C − F), factorised.
  fsai_fsai,    ///< Cᵀ GᵀG C, inverted by a second FSAI.
  bds,          ///< block diagonal: per node Cᵀ K_k⁻¹ (C − F), K_k on the cells around it.
  lsc,  ///< S⁻¹ ≈ (CᵀC)⁻¹ Cᵀ (K + E)(C − F) (CᵀC)⁻¹, nothing to factorise.
  rac   ///< not S, but multipliers with springs in series: see augmented.h.
};
constexpr auto words(SchurKind) {
  return std::array{"exact", "fsai+dir", "fsai+fsai", "bds", "lsc", "rac"};
}

/// z ≈ S⁻¹ r, a fixed linear map.
/// @pre j outlives it.
/// @param kind  any but rac (InternalError); all but lsc on one rank only.
/// @param fsai  of K + E, and of the second one.
/// Throws ResourceError when memory is short or the approximation is singular.
LinearMap schur_complement(SchurKind kind, const SaddlePoint& j, const FsaiOptions& fsai);

}  // namespace faultsim
