#include "python/bindings/kept_fields.h"

namespace faultsim::python {
namespace {

template <typename Matrix, typename T>
void append(const Matrix& values, std::vector<T>& all) {
  all.insert(all.end(), values.data(), values.data() + values.size());
}

/// Of step k, if there is any.
template <typename T>
const T* part(const std::vector<T>& all, std::size_t k, std::size_t n_steps) {
  return all.data() + k * (all.size() / n_steps);
}

Eigen::Matrix3Xd vectors(const std::vector<double>& all, std::size_t k, std::size_t n_steps) {
  return Eigen::Map<const Eigen::Matrix3Xd>(part(all, k, n_steps), 3,
                                            static_cast<Eigen::Index>(all.size() / n_steps / 3));
}

template <typename T>
Eigen::Matrix<T, Eigen::Dynamic, 1> numbers(const std::vector<T>& all, std::size_t k,
                                            std::size_t n_steps) {
  return Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, 1>>(
      part(all, k, n_steps), static_cast<Eigen::Index>(all.size() / n_steps));
}

}  // namespace

void KeptFields::add_step(const StepResult& step, const FaultFields& fields) {
  n_nodes_ = static_cast<int>(fields.critical_index.size());
  steps_.push_back(step.step);
  times_.push_back(step.time);
  append(fields.traction, traction);
  append(fields.jump, jump);
  append(fields.creep_traction, creep_traction);
  append(fields.critical_index, critical_index);
  append(fields.static_critical_index, static_critical_index);
  append(fields.fault_pressure_change, fault_pressure_change);
  append(fields.state, state);
}

FaultFields KeptFields::step(std::size_t k) const {
  const std::size_t n = steps_.size();
  return {.traction = vectors(traction, k, n),
          .jump = vectors(jump, k, n),
          .critical_index = numbers(critical_index, k, n),
          .static_critical_index = numbers(static_critical_index, k, n),
          .state = numbers(state, k, n),
          .fault_pressure_change = numbers(fault_pressure_change, k, n),
          .creep_traction = vectors(creep_traction, k, n)};
}

FieldRecorder KeptFields::recorder(const FaultGeometry& geometry) const {
  FieldRecorder recorder(geometry);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    StepResult step;
    step.step = steps_[k];
    step.time = times_[k];
    recorder.add_step(step, this->step(k));
  }
  return recorder;
}

}  // namespace faultsim::python
