#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simulator/case_figures/chosen.h"
#include "simulator/model/dip_lines.h"

/// Where in the fields of a case a chart looks.
namespace faultsim::case_figures {

/// The chosen fault in the file of fields (index in FieldSource::faults). @pre the picture has
/// fields. Throws InputError where this fault was not kept.
std::size_t stored_fault(const Chosen& chosen);

/// The entry (index in FieldSource::steps) of the chosen step; where it was not kept and nobody
/// asked for it, the last one before, to which `chosen` is moved. Throws InputError where it was
/// asked for, or no step was kept.
std::size_t stored_entry(Chosen& chosen);

/// The chosen fault in the case before the change, where its fields were kept.
struct OriginalFault {
  std::size_t fault = 0;  ///< index in its FieldSource::faults.
  const CoulombLaw& friction;
};
/// None where the picture has no original, or that has no fields of such a fault.
std::optional<OriginalFault> original_fault(const Chosen& chosen);
/// The entry of the original's fields that is the same load step at the same time; none where there
/// is none. @pre original_fault. @param entry  of the picture's own fields.
std::optional<std::size_t> original_entry(const Chosen& chosen, std::size_t entry);
/// The split point that is nearest to a place, the first of equals; none where no point is split.
std::optional<Eigen::Index> nearest_split(const StoredFault& fault, const Eigen::Vector3d& place);
/// Two places that differ by less are one, m.
inline constexpr double kSamePlace = 1e-3;

/// Which way is along strike on a fault, which may bend, and its lines down dip.
DipLines dip_lines(const StoredFault& fault);
/// Where the line down dip through a point meets the surface between points that are split.
std::vector<DipCrossing> split_line(const StoredFault& fault, const DipLines& lines,
                                    Eigen::Index point);
/// "along strike", and which way if that is not along y: "along strike, 40° from y towards x".
std::string along_strike_words(const DipLines& lines);

/// Split points of the line down dip at y (m) of a fault that strikes along y, by depth.
std::vector<std::size_t> column_through(const StoredFault& fault, double y);

/// The split point with the largest χ, the first of them in the file's order. Throws InputError
/// where the fault has none.
std::size_t most_critical(const StoredFault& fault, const Eigen::VectorXd& chi);

double shear_at(const StoredFields& fields, Eigen::Index k);  ///< |τ| at a point, Pa.

}  // namespace faultsim::case_figures
