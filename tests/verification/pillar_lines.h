#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "simulator/simulation/simulation.h"

namespace faultsweep {

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell.substr(cell.find_first_not_of(' ')));
  }
  return cells;
}

/// Changes of a line of samples.csv.
inline faultsim::Changes changes_of(const std::string& header, const std::string& line) {
  const std::vector<std::string> names = cells_of(header), values = cells_of(line);
  faultsim::Changes changes;
  for (std::size_t k = 1; k < names.size(); ++k) {  // behind its name
    const std::size_t open = names[k].find(" [");
    const std::string unit = open == std::string::npos
                                 ? ""
                                 : " " + names[k].substr(open + 2, names[k].size() - open - 3);
    changes.push_back({names[k].substr(0, open), values[k] + unit});
  }
  return changes;
}

}  // namespace faultsweep
