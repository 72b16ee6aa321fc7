#pragma once

#include <string>
#include <utility>
#include <vector>

#include "simulator/simulation/inside.h"

namespace faultsim::python {

/// A scene as a document: not read yet.
struct SceneDocument {
  JsonDocument document;
};

inline Changes changes_of(const std::vector<std::pair<std::string, std::string>>& values) {
  Changes changes;
  for (const auto& [parameter, value] : values) changes.push_back({parameter, value});
  return changes;
}

}  // namespace faultsim::python
