#pragma once

#include <filesystem>
#include <memory>

#include "simulator/result_files/field_source.h"

namespace faultsim {

/// What FieldWriter wrote, read back as it is asked for.
class FieldReader : public FieldSource {
 public:
  /// Throws StorageError when the file cannot be read or is no such file.
  explicit FieldReader(const std::filesystem::path& file);
  ~FieldReader() override;
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  const std::vector<int>& steps() const override;
  const std::vector<double>& times() const override;
  const std::vector<StoredFault>& faults() const override;  ///< by name of their groups.
  StoredFields fields(std::size_t fault, std::size_t entry) const override;
  Eigen::VectorXd critical_index(std::size_t fault, std::size_t entry) const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
