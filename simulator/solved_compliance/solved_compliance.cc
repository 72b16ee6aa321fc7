#include "simulator/solved_compliance/solved_compliance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/text.h"

namespace faultsim {

SolvedCompliance::SolvedCompliance(std::shared_ptr<const StuckBulk> bulk, double memory_limit)
    : bulk_(std::move(bulk)),
      memory_limit_(memory_limit),
      columns_(static_cast<std::size_t>(bulk_->jump_diagonal().size())) {}

Compliance::Column SolvedCompliance::column(int j) const {
  Kept& kept = columns_[static_cast<std::size_t>(j)];
  kept.step = step_;
  kept.turn = turn_++;
  if (kept.values.size() == 0) {
    make_room();
    // What a unit jump does is taken back by forces on the jumps that are left when r has given
    // way.
    StuckBulk::Response response =
        bulk_->respond(bulk_->jump_forces(Eigen::VectorXd::Unit(size(), j)));
    const double k = bulk_->jump_diagonal()[j];
    error_bound_ = std::max(error_bound_, response.report.energy_error / std::sqrt(k));
    // Zero up to rounding where a block that nothing else holds moves as a whole.
    FAULTSIM_DEMAND(response.jumps.allFinite() && response.jumps[j] > -1e-9 * k, "column ", j,
                    " of H, diagonal ", response.jumps[j]);
    kept.values = std::move(response.jumps);
    ++n_kept_;
    ++n_made_;
  }
  return {kept.values.data(), kept.values.size()};
}

/// For one column more.
void SolvedCompliance::make_room() const {
  while (bytes_per_column() * (n_kept_ + 1) > memory_limit_) {
    Kept* oldest = nullptr;
    for (Kept& one : columns_) {
      if (one.values.size() == 0 || one.step == step_) continue;
      if (oldest == nullptr || one.turn < oldest->turn) oldest = &one;
    }
    if (oldest == nullptr) {
      throw ResourceError(concat("not enough memory: more than ", n_kept_, " of ", size(),
                                 " jumps move in one load step, and their columns of H may take ",
                                 formatted("%.2g GB", memory_limit_ / 1e9),
                                 "; choose larger cells (/mesh), or shorter load steps"));
    }
    oldest->values = Eigen::VectorXd();
    --n_kept_;
  }
}

SolvedCompliance::Product SolvedCompliance::product(const Eigen::VectorXd& g) const {
  StuckBulk::Response response = bulk_->respond(bulk_->jump_forces(g));
  return {std::move(response.jumps), response.report.energy_error};
}

}  // namespace faultsim
