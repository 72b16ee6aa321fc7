#pragma once

#include <filesystem>
#include <memory>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

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

}  // namespace faultsim
