#pragma once

#include <cholmod.h>

#include "simulator/linalg/factor_run.h"
#include "simulator/linalg/supernodes.h"

namespace faultsim {

enum class FactorEnd { complete, not_positive_definite, stopped };

struct FactorOutcome {
  FactorEnd end = FactorEnd::complete;
  /// Not positive definite: the first column, in the order of the factor, whose pivot is not > 0.
  SuiteSparse_long column = -1;
};

/// The factor as plain arrays; its values are null before they are computed.
Supernodes supernodes_of(const cholmod_factor& factor);

/// The numerical half of a supernodal Cholesky factorisation A = L Lᵀ: fills factor->x of a
/// factor that CHOLMOD has analysed.
///
/// Left-looking by *panels* of at most kPanelWidth columns of a supernode: a panel takes what
/// earlier columns owe it, in ascending order, and is then factorised by itself. Threads take
/// panels in an order in which nobody waits for a panel that nobody has taken; each waits for the
/// columns that its own needs. What is summed, in which order and by which BLAS call is given by
/// the structure alone, so the bits are the same for every number of threads. (A BLAS that is given
/// several threads cuts its products elsewhere and gives other bits: all its kernels do.)
///
/// Scheme: left-looking supernodal (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35(3), 2008), with
/// panels as the unit of work (Hogg, Reid and Scott, SIAM J. Sci. Comput. 32(6), 2010).
///
/// @param lower   A in the order of the factor: lower triangle, packed, sorted columns.
/// @param factor  analysed, supernodal L Lᵀ; its values are allocated here.
/// @pre BLAS computes with one thread.
/// Throws ResourceError when memory is short.
FactorOutcome factorise_supernodes(const cholmod_sparse& lower, cholmod_factor* factor,
                                   cholmod_common* common, const FactorRun& run);

}  // namespace faultsim
