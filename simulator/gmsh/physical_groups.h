#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulator/gmsh/file_problems.h"
#include "simulator/gmsh/gmsh_content.h"

namespace faultsim {

/// Which physical groups the surfaces and volumes of a file belong to, and what they are called.
/// Tells what is wrong with them.
class PhysicalGroups {
 public:
  PhysicalGroups(const GmshContent& content, FileProblems& problems);

  /// Numbers of the groups of a surface (2) or volume (3), ascending; none where it is not listed.
  const std::vector<std::int64_t>& of(int dimension, std::int64_t entity) const;
  /// "reservoir"; "physical volume 7" where it has no name.
  std::string name(int dimension, std::int64_t group) const;

 private:
  void check_names(int dimension);
  void check_entities();
  void check_volume(const ElementBlock& first, std::int64_t n_cells);

  const GmshContent& content_;
  FileProblems& problems_;
};

}  // namespace faultsim
