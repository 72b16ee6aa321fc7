#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace faultsim {

/// A fault as a surface.
struct StoredFault {
  std::string name;
  Eigen::Matrix3Xd points;              ///< m, x y z.
  std::vector<std::vector<int>> faces;  ///< points of each: four, or in plane strain two.
  std::vector<int> split;               ///< per point: 1 = the sides can move apart.
};

/// Its fields at one load step, per point; signs as in schemas/result_layout.md.
struct StoredFields {
  Eigen::Matrix3Xd traction;              ///< effective (normal, strike, dip), Pa.
  Eigen::Matrix3Xd slip;                  ///< opening, slip along strike, slip down dip, m.
  Eigen::VectorXd critical_index;         ///< χ.
  Eigen::VectorXd fault_pressure_change;  ///< Δp_f, Pa.
  std::vector<int> state;                 ///< FaultState.
};

/// The fields of a case on its faults, load step by load step: read from a file (FieldReader), or
/// kept as the case ran (FieldRecorder).
class FieldSource {
 public:
  virtual ~FieldSource() = default;
  virtual const std::vector<int>& steps() const = 0;     ///< load steps that it holds, ascending.
  virtual const std::vector<double>& times() const = 0;  ///< s, of those.
  virtual const std::vector<StoredFault>& faults() const = 0;
  /// @param fault  index in faults();  @param entry  index in steps().
  virtual StoredFields fields(std::size_t fault, std::size_t entry) const = 0;
  /// χ alone, without the effort for the others.
  virtual Eigen::VectorXd critical_index(std::size_t fault, std::size_t entry) const {
    return fields(fault, entry).critical_index;
  }
};

}  // namespace faultsim
