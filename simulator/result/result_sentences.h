#pragma once

#include <string>
#include <vector>

#include "simulator/result/result.h"

/// What became of a case, as sentences for its readers; "" where there is nothing to say.
namespace faultsim {

/// What slides, and how far; what comes nearest where nothing does, and up to which load step where
/// the history ends early.
std::string sliding_sentence(const CaseResult& result);
/// Pressures on both sides of a fault and in it: "west -40 bar (to 191 bar), in the fault -40 bar,
/// at 2080 m depth".
std::string pressures_text(const SidePressures& sides, double depth);
/// What is not to be taken for certain.
std::vector<std::string> unresolved_sentences(const CaseResult& result);
/// The evidence of an unexpected reactivation.
std::string unexpected_sentence(const CaseResult& result);
/// How creep was stepped, and the most that it changed on each fault.
std::string creep_sentence(const CaseResult& result);

}  // namespace faultsim
