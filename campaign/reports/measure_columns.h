#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "campaign/render/answer.h"
#include "simulator/result/measures.h"

/// The measures of stages and faults (simulator/result/measures.h) as columns of answers.
namespace faultsweep {

/// All of them, in the order of for_each_measure; keys and units are those of JSON and SI, what has
/// no heading of its own on screens is `data`.
/// @param per_metre  of strike: of plane strain. Changes units and keys ("_per_m") of areas,
///                   potencies and moments.
std::vector<AnswerColumn> measure_columns(bool per_metre);
/// The values, in that order.
std::vector<AnswerCell> measure_cells(const faultsim::Measures& measures);
/// The place of a measure in that order, by its name as a metric or its synonym: "max_slip",
/// "slip"; none where no measure is called so.
std::optional<std::size_t> measure_called(std::string_view name);

}  // namespace faultsweep
