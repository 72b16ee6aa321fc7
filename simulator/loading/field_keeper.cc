#include "simulator/loading/field_keeper.h"

#include <utility>

#include "simulator/files/atomic_file.h"

namespace faultsim {

FieldSelection::FieldSelection(FieldSteps which, const Scene& scene, StepObserver sink)
    : which_(which), history_(load_steps(scene)), sink_(std::move(sink)) {}

void FieldSelection::add(const StepResult& step, const FaultFields& fields) {
  if (which_ == FieldSteps::all || is_stage_end(history_, static_cast<std::size_t>(step.step))) {
    hand_on(step, fields);
    last_.reset();
  } else {
    last_ = Step{step, fields};
  }
}

void FieldSelection::hand_on(const StepResult& step, const FaultFields& fields) {
  sink_(step, fields);
  done_.push_back(step.step);
}

std::vector<int> FieldSelection::finish() {
  if (last_) hand_on(last_->result, last_->fields);
  return done_;
}

FieldKeeper::FieldKeeper(const std::filesystem::path& folder, FieldSteps which, const Scene& scene,
                         const FaultGeometry& geometry, bool creep)
    : writer_(folder, geometry, creep),
      selection_(which, scene, [this](const StepResult& step, const FaultFields& fields) {
        writer_.add_step(step, fields);
      }) {
  create_folders(folder);
  remove_abandoned_temporaries(folder);
}

std::vector<int> FieldKeeper::finish() {
  const std::vector<int> steps = selection_.finish();
  writer_.finish();
  return steps;
}

}  // namespace faultsim
