#include "simulator/loading/episodes.h"

#include <algorithm>
#include <utility>

namespace faultsim {

EpisodeTracker::EpisodeTracker(const FaultMeter& meter, std::vector<std::string> fault_names,
                               bool plane_strain)
    : meter_(meter), names_(std::move(fault_names)), plane_strain_(plane_strain) {
  running_.resize(names_.size());
}

void EpisodeTracker::close(std::optional<Running>& running) {
  if (running && running->activated) {
    Episode& episode = running->episode;
    if (!plane_strain_) episode.magnitude = moment_magnitude(episode.moment);
    done_.push_back(std::move(episode));
  }
  running.reset();
}

void EpisodeTracker::add(const StepResult& step, const ContactState& state,
                         const Eigen::VectorXd& before) {
  if (step.stage != stage_) {
    for (auto& running : running_) close(running);
    stage_ = step.stage;
  }
  const auto& dp = step.pressure_change;
  const double pressure = dp.empty() ? 0 : *std::min_element(dp.begin(), dp.end());
  constexpr double kSame = 1.0;  // Pa
  const bool recovered = pressure > lowest_pressure_ + kSame;
  lowest_pressure_ = std::min(lowest_pressure_, pressure);
  for (std::size_t f = 0; f < running_.size(); ++f) {
    const FaultMetrics& fault = step.faults[f];
    auto& running = running_[f];
    if (fault.slipping_area == 0 && fault.open_area == 0) {
      close(running);
      continue;
    }
    if (!running) {
      running.emplace();
      running->episode.stage = step.stage;
      running->episode.fault = names_[f];
      running->episode.first_step = step.step;
      running->episode.pressure_change = pressure;
      running->episode.after_recovery = recovered;
      running->reference = before;
    }
    Episode& episode = running->episode;
    episode.last_step = step.step;
    episode.moment += fault.moment_step;
    const FaultMeter::Activation slip = meter_.activation(state, &running->reference)[f];
    episode.activated_area = std::max(episode.activated_area, slip.area);
    episode.max_slip = std::max(episode.max_slip, slip.max_slip);
    running->activated = running->activated || slip.activated;
  }
}

std::vector<Episode> EpisodeTracker::finish() {
  for (auto& running : running_) close(running);
  std::stable_sort(done_.begin(), done_.end(),
                   [](const Episode& a, const Episode& b) { return a.first_step < b.first_step; });
  return std::exchange(done_, {});
}

bool unexpected_reactivation(std::span<const Episode> episodes) {
  bool seen = false;
  for (const Episode& episode : episodes) {
    if (episode.after_recovery && seen) return true;
    seen = seen || !episode.after_recovery;
  }
  return false;
}

}  // namespace faultsim
