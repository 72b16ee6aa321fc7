#include "simulator/contact/moving_block.h"

namespace faultsim {

MovingBlock::MovingBlock(const ContactProblem& problem)
    : problem_(problem), place_(static_cast<std::size_t>(problem.n_nodes()), -1) {}

void MovingBlock::clear() {
  for (const int k : node_) place_[k] = -1;
  node_.clear();
  dofs_.clear();
  own_.clear();
  before_.clear();
}

void MovingBlock::add(const std::vector<int>& nodes) {
  for (const int k : nodes) {
    place_[k] = n_nodes();
    const auto n_before = static_cast<Eigen::Index>(dofs_.size());
    node_.push_back(k);
    for (const int dof : problem_.nodes[k].dof) dofs_.push_back(dof);
    Eigen::MatrixX3f columns = Eigen::MatrixX3f::Zero(n_before + kDofs, kDofs);
    for (int c = 0; c < problem_.nodes[k].n_dofs; ++c) {
      const double* h = problem_.compliance.column(problem_.nodes[k].dof[c]).data();
      for (Eigen::Index r = 0; r < n_before + kDofs; ++r) {
        const int dof = dofs_[r];
        if (dof >= 0) columns(r, c) = static_cast<float>(h[dof]);
      }
    }
    own_.emplace_back(columns.bottomRows<kDofs>());
    before_.emplace_back(columns.topRows(n_before));
  }
}

void MovingBlock::multiply(const std::vector<int>& places, const Eigen::VectorXf& x,
                           Eigen::VectorXf& z) const {
  z.setZero(n_vector());
  for (const int place : places) {
    const Eigen::Index first = kDofs * place;
    const Eigen::Vector3f own = x.segment<kDofs>(first);
    const auto others = before_[place].multiply({own[0], own[1], own[2]}, x.data(), z.data());
    z.segment<kDofs>(first) += own_[place] * own + Eigen::Vector3f(others[0], others[1], others[2]);
  }
}

}  // namespace faultsim
