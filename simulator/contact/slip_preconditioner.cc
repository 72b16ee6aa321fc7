#include "simulator/contact/slip_preconditioner.h"

#include <algorithm>

namespace faultsim {
namespace {

Eigen::Vector2d across_of(const Eigen::Vector2d& along) { return {-along[1], along[0]}; }

}  // namespace

SlipPreconditioner::SlipPreconditioner(int n_dofs, const MovingBlock& block)
    : block_(block), place_(static_cast<std::size_t>(n_dofs), -1) {}

void SlipPreconditioner::clear() {
  for (const Joined& one : joined_) place_[one.dof] = -1;
  joined_.clear();
  factor_.clear();
}

/// The direction of slip is that in which the normal traction pulls: weight[0] of the two
/// equations.
void SlipPreconditioner::find_movers(const std::vector<TangentUnknown>& unknowns) {
  movers_.clear();
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const TangentUnknown& one = unknowns[u];
    const bool two = one.component == 1 && u + 1 < unknowns.size() &&
                     unknowns[u + 1].node == one.node &&
                     (u == 0 || unknowns[u - 1].node != one.node);
    Mover mover{one.node, one.dof, static_cast<int>(u), 1, {1, 0}, 0};
    const Eigen::Vector2d pull(one.weight[0], two ? unknowns[u + 1].weight[0] : 0);
    if (two && pull.norm() > 0) {
      mover.n = 2;
      mover.along = pull.normalized();
      mover.across = own_across(unknowns, mover);
      ++u;
    }
    movers_.push_back(mover);
  }
}

double SlipPreconditioner::own_across(const std::vector<TangentUnknown>& unknowns,
                                      const Mover& mover) const {
  const Eigen::Matrix3f& h = block_.own(block_.place(mover.node));
  const Eigen::Vector2d p = across_of(mover.along);
  double sum = 0;
  for (int d = 0; d < 2; ++d) {
    const int dof = unknowns[mover.first + d].component;
    for (int c = 0; c < 2; ++c) {
      const TangentUnknown& row = unknowns[mover.first + c];
      sum += p[c] * p[d] *
             (row.own[d] + row.weight[0] * h(0, dof) + row.weight[1] * h(1, dof) +
              row.weight[2] * h(2, dof));
    }
  }
  return sum;
}

SlipPreconditioner::Joined SlipPreconditioner::join(const std::vector<TangentUnknown>& unknowns,
                                                    const Mover& mover) const {
  Joined joined{mover.dof, block_.place(mover.node), {0, 0, 0}, {0, 0, 0}, 0};
  for (int c = 0; c < mover.n; ++c) {
    const TangentUnknown& one = unknowns[mover.first + c];
    const double d = mover.along[c];
    joined.motion[one.component] = static_cast<float>(d);
    for (int a = 0; a < 3; ++a)
      joined.weight[a] += static_cast<float>(d * one.weight[static_cast<std::size_t>(a)]);
    if (mover.n == 1 && one.component > 0)
      joined.own = static_cast<float>(one.own[one.component - 1]);
    for (int e = 0; mover.n == 2 && e < 2; ++e)
      joined.own += static_cast<float>(d * one.own[e] * mover.along[e]);
  }
  return joined;
}

/// Entries of M between q and the unknowns from `first` on whose nodes are before q's in the block,
/// M_pq and M_qp, or are q's own.
void SlipPreconditioner::fill(GrowingLu<float>::Block& m, int q, int first) {
  const Joined& one = joined_[q];
  const auto is_before = [&](const Joined& other) { return other.place < one.place; };
  if (std::any_of(joined_.begin() + first, joined_.end(), is_before)) {
    const auto triple = [](const Eigen::Vector3f& v) {
      return ShortColumns::Triple{v[0], v[1], v[2]};
    };
    block_.before(one.place).combine(triple(one.motion), at_motion_);
    block_.before(one.place).combine(triple(one.weight), at_weight_);
  }
  for (int p = first; p < static_cast<int>(joined_.size()); ++p) {
    const Joined& other = joined_[p];
    const int row = MovingBlock::kDofs * other.place;
    if (other.place < one.place) {
      m(p, q) = other.weight.dot(at_motion_.segment<3>(row));
      m(q, p) = other.motion.dot(at_weight_.segment<3>(row));
    } else if (other.place == one.place) {
      m(p, q) = other.weight.dot(block_.own(one.place) * one.motion) + (p == q ? one.own : 0);
      m(q, p) = one.weight.dot(block_.own(one.place) * other.motion) + (p == q ? one.own : 0);
    }
  }
}

bool SlipPreconditioner::cover(const std::vector<TangentUnknown>& unknowns) {
  find_movers(unknowns);
  const int old = size();
  for (const Mover& mover : movers_) {
    int& place = place_[mover.dof];
    if (place >= 0) continue;
    place = static_cast<int>(joined_.size());
    joined_.push_back(join(unknowns, mover));
  }
  const int n = static_cast<int>(joined_.size());
  if (n == old) return true;
  GrowingLu<float>::Block m = factor_.border(n - old);
  for (int q = 0; q < n; ++q) fill(m, q, q < old ? old : 0);
  if (factor_.grow(n - old)) return true;
  clear();
  return false;
}

/// What rests is passed over: its rows see nothing, and what the factor makes of it is dropped.
void SlipPreconditioner::apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  side_.setZero(size());
  for (const Mover& mover : movers_)
    side_[place_[mover.dof]] =
        static_cast<float>(mover.along.head(mover.n).dot(x.segment(mover.first, mover.n)));
  factor_.solve(side_);
  y.resize(x.size());
  for (const Mover& mover : movers_) {
    const double slip = side_[place_[mover.dof]];
    y.segment(mover.first, mover.n) = slip * mover.along.head(mover.n);
    if (mover.n == 1) continue;
    const Eigen::Vector2d p = across_of(mover.along);
    y.segment<2>(mover.first) += p.dot(x.segment<2>(mover.first)) / mover.across * p;
  }
}

}  // namespace faultsim
