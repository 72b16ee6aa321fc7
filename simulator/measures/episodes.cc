#include "simulator/measures/episodes.h"

#include <algorithm>
#include <tuple>

namespace faultsim {

EpisodeTracker::EpisodeTracker(const FaultMeter& meter, const FaultNeighbours& neighbours,
                               std::vector<std::string> fault_names, bool plane_strain)
    : meter_(meter),
      neighbours_(neighbours),
      names_(std::move(fault_names)),
      plane_strain_(plane_strain),
      lowest_(names_.size(), 0),
      running_(names_.size()) {}

void EpisodeTracker::close(std::size_t fault) {
  std::optional<Running>& running = running_[fault];
  if (running && running->place >= 0) {
    Episode& episode = running->episode;
    episode.depth = neighbours_.depth(running->place);
    episode.pressures = neighbours_.at(running->place, episode.depth, running->pressure);
    if (!plane_strain_) episode.magnitude_if_at_once = moment_magnitude(episode.moment);
    done_.emplace_back(fault, std::move(episode));
  }
  running.reset();
}

void EpisodeTracker::add(const StepResult& step, const NodalState& nodal, const ContactState& state,
                         const Eigen::VectorXd& before, const PressureChanges& now) {
  if (step.stage != stage_) {
    for (std::size_t f = 0; f < running_.size(); ++f) close(f);
    stage_ = step.stage;
  }
  constexpr double kSame = 1.0;  // Pa
  for (std::size_t f = 0; f < running_.size(); ++f) {
    const double pressure = neighbours_.lowest(static_cast<int>(f), step.pressure_change);
    const bool recovered = lowest_[f] < -kSame && pressure > lowest_[f] + kSame;
    lowest_[f] = std::min(lowest_[f], pressure);
    const FaultMetrics& fault = step.faults[f];
    auto& running = running_[f];
    const bool is_quiet = fault.slipping_area == 0 && fault.open_area == 0;
    if (is_quiet || (running && running->episode.after_recovery != recovered)) close(f);
    if (is_quiet) continue;
    if (!running) {
      running.emplace();
      running->episode.stage = step.stage;
      running->episode.fault = names_[f];
      running->episode.first_step = step.step;
      running->episode.after_recovery = recovered;
      if (!before.isZero(0)) running->reference = before;
      running->pressure = now;
    }
    Episode& episode = running->episode;
    episode.last_step = step.step;
    episode.moment += fault.moment_step;
    const Activation slip =
        meter_.activation(static_cast<int>(f), nodal, state, running->reference);
    episode.activated_area = std::max(episode.activated_area, slip.area);
    episode.max_slip = std::max(episode.max_slip, slip.max_slip);
    if (slip.activated) running->place = slip.place;
  }
}

std::vector<Episode> EpisodeTracker::finish() {
  for (std::size_t f = 0; f < running_.size(); ++f) close(f);
  std::ranges::sort(done_, [](const auto& a, const auto& b) {
    return std::tie(a.second.first_step, a.first) < std::tie(b.second.first_step, b.first);
  });
  std::vector<Episode> episodes;
  for (auto& [fault, episode] : done_) episodes.push_back(std::move(episode));
  done_.clear();
  return episodes;
}

std::optional<Reactivation> unexpected_reactivation(std::span<const Episode> episodes) {
  for (std::size_t k = 0; k < episodes.size(); ++k) {
    if (!episodes[k].after_recovery) continue;
    for (std::size_t i = k; i-- > 0;) {
      const Episode& earlier = episodes[i];
      if (earlier.fault == episodes[k].fault && !earlier.after_recovery)
        return Reactivation{static_cast<int>(k) + 1, static_cast<int>(i) + 1};
    }
  }
  return std::nullopt;
}

}  // namespace faultsim
