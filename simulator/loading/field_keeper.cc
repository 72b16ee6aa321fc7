#include "simulator/loading/field_keeper.h"

#include "simulator/common/errors.h"
#include "simulator/output/atomic_file.h"

namespace faultsim {

FieldSteps field_steps_from_string(const std::string& text) {
  FAULTSIM_DEMAND(text == "stages" || text == "all", "steps of fields: ", text);
  return text == "all" ? FieldSteps::all : FieldSteps::stages;
}

FieldKeeper::FieldKeeper(const std::filesystem::path& folder, FieldSteps which, const Scene& scene,
                         const FaultGeometry& geometry, bool creep)
    : which_(which), history_(load_steps(scene)), writer_(folder, geometry, creep) {
  create_folders(folder);
  remove_abandoned_temporaries(folder);
}

void FieldKeeper::add(const StepResult& step, const FaultFields& fields) {
  if (which_ == FieldSteps::all || is_stage_end(history_, static_cast<std::size_t>(step.step))) {
    write(step, fields);
    last_.reset();
  } else {
    last_ = Step{step, fields};
  }
}

void FieldKeeper::write(const StepResult& step, const FaultFields& fields) {
  writer_.add_step(step, fields);
  written_.push_back(step.step);
}

std::vector<int> FieldKeeper::finish() {
  if (last_) write(last_->result, last_->fields);
  writer_.finish();
  return written_;
}

}  // namespace faultsim
