#pragma once

#include "simulator/operators/prepare_operator.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {

/// What programs within the project see of a Simulation beside what is public: documents, the scene
/// as it was read, the operator. Not installed, as are the types here.
struct Inside {
  /// Holds another scene. An operator that is the same is kept, and goes on being used.
  static void hold(Simulation& simulation, JsonDocument document);
  /// The same, of a scene that is read already.
  static void hold(Simulation& simulation, LoadedScene loaded);
  /// Holds a scene that is nothing without changes: it is read with the next ones.
  static void hold_base(Simulation& simulation, JsonDocument document);
  /// Simulation::change() by values as they stand in documents.
  /// @param values  an object of values by JSON pointer; its source is what messages call the case.
  static void change_values(Simulation& simulation, const JsonDocument& values);

  /// The scene at hand: held, with the last changes.
  static const LoadedScene& scene(const Simulation& simulation);
  /// The operator at hand. @pre !simulation.needs_operator()
  static const PreparedOperator& prepared(const Simulation& simulation);
};

}  // namespace faultsim
