#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace faultsim {

/// A fault of a faults.h5 as a surface.
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

/// What FieldWriter wrote, read back as it is asked for.
class FieldReader {
 public:
  /// Throws StorageError when the file cannot be read or is no such file.
  explicit FieldReader(const std::filesystem::path& file);
  ~FieldReader();
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  const std::vector<int>& steps() const;           ///< load steps that it holds, ascending.
  const std::vector<double>& times() const;        ///< s, of those.
  const std::vector<StoredFault>& faults() const;  ///< by name of their groups.
  /// @param fault  index in faults();  @param entry  index in steps().
  StoredFields fields(std::size_t fault, std::size_t entry) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
