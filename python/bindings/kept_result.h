#pragma once

#include <memory>
#include <optional>
#include <string>

#include "python/bindings/kept_fields.h"
#include "simulator/scene/scene.h"

namespace faultsim::python {

/// A case that was run, with all that its arrays and charts refer to: it outlives its simulation.
struct KeptResult {
  CaseResult result;
  std::shared_ptr<const FaultGeometry> geometry;  ///< null where the result was stored.
  std::shared_ptr<const Scene> scene;
  std::optional<KeptFields> fields;  ///< none where they were not to be kept.

  /// A chart of case_figures as SVG. Throws InputError for a chart, fault, step or field that is
  /// not there.
  std::string drawn(const std::string& chart, const std::string& fault, std::optional<int> step,
                    const std::string& show) const;
  /// χ̄ and others of each fault at the end of each load step, by their key in result.json.
  /// @returns n_steps x n_faults; throws InputError for another key.
  Eigen::MatrixXd history(const std::string& key) const;
};

}  // namespace faultsim::python
