#pragma once

#include <string>

#include "simulator/case_figures/case_figures.h"

namespace faultsim {

/// A run as one page: what became of it in sentences, its stages and faults as a table, its charts,
/// what the numbers leave open, and where they come from, with the scene to run it again
/// (read_json_file takes such pages).
/// @param scene    the document as it was run, JSON.
/// @param program  with version and commit.
std::string run_page(const CasePicture& picture, const std::string& scene,
                     const std::string& program);

}  // namespace faultsim
