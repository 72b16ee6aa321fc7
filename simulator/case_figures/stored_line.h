#pragma once

#include <cstddef>
#include <vector>

#include "simulator/case_figures/chosen.h"

/// Where in the fields of a case a chart looks.
namespace faultsim::case_figures {

/// The chosen fault in the file of fields (index in FieldSource::faults). @pre the picture has
/// fields. Throws InputError where this fault was not kept.
std::size_t stored_fault(const Chosen& chosen);

/// The entry (index in FieldSource::steps) of the chosen step; where it was not kept and nobody
/// asked for it, the last one before, to which `chosen` is moved. Throws InputError where it was
/// asked for, or no step was kept.
std::size_t stored_entry(Chosen& chosen);

/// Split points of the line down dip at y (m, along strike), by depth.
std::vector<std::size_t> column_through(const StoredFault& fault, double y);

/// The split point with the largest χ, the first of them in the file's order. Throws InputError
/// where the fault has none.
std::size_t most_critical(const StoredFault& fault, const StoredFields& fields);

double shear_at(const StoredFields& fields, Eigen::Index k);  ///< |τ| at a point, Pa.

}  // namespace faultsim::case_figures
