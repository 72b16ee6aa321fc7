#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// The whole result as JSON per schemas/result.schema.json (units in key names: "moment_nm",
/// "time_s", ...). No NaN: null. The same result gives the same text.
nlohmann::json result_to_json(const CaseResult& result);
/// Reads it back (all fields that are written). Throws StorageError on a wrong format version.
CaseResult result_from_json(const nlohmann::json& document);

/// Writes fault fields as they come: FOLDER/faults.h5 (chunked by step, gzip, units as attributes)
/// and FOLDER/faults.xmf that ParaView opens: one surface grid per fault and step with traction and
/// slip in the fault frame and globally, χ, χ_s, state, Δp_f and, where salt creeps, t'_creep. Only
/// base names are referenced. Of a half domain the whole faults are written: the other half is the
/// mirror image, with strike components of the other sign.
/// Files get a temporary name until finish(); an abandoned writer leaves nothing.
class FieldWriter {
 public:
  FieldWriter(const std::filesystem::path& folder, const FaultGeometry& geometry,
              bool creep = false);
  ~FieldWriter();
  FieldWriter(const FieldWriter&) = delete;
  FieldWriter& operator=(const FieldWriter&) = delete;
  void add_step(const StepResult& step, const FaultFields& fields);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Displacements of the whole mesh at named steps: FOLDER/volume.h5 + volume.xmf.
/// @param nodes  m (3 x n);  @param cells  VTK hexahedra;  @param displacement  per entry 3 x n, m.
struct VolumeSnapshot {
  std::string name;
  double time;
  Eigen::Matrix3Xd displacement;
};
void write_volume(const std::filesystem::path& folder, const Eigen::Matrix3Xd& nodes,
                  const std::vector<std::array<int, 8>>& cells, const std::vector<int>& material,
                  const std::vector<VolumeSnapshot>& snapshots);

/// Writes text to path by a temporary name and rename. Throws StorageError.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace faultsim
