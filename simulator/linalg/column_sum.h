#pragma once

#include <cstddef>
#include <span>

#include "simulator/linalg/blas_kernel.h"

namespace faultsim {

/// y += Σ_i f_i c_i over columns c_i that stand anywhere in memory, in their order: for each four
/// of them y + (((f₀ c₀ + f₁ c₁) + f₂ c₂) + f₃ c₃). Entry by entry, no sum is split and no product
/// fused, so vectors of any width give the same bits, and parts those of the whole; the widest that
/// the processor has are used. What limits it is reading the columns.
/// @param first  of the entries of the columns that are added to y; y.size() of them.
void add_columns(std::span<const double* const> columns, std::span<const double> factors,
                 std::size_t first, std::span<double> y);
/// The same by vectors of `set`, for tests and measurements. @pre the processor has them.
void add_columns_by(VectorSet set, std::span<const double* const> columns,
                    std::span<const double> factors, std::size_t first, std::span<double> y);

}  // namespace faultsim
