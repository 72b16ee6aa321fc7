#include "simulator/flow/column_dips.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

/// A neighbour, seen from a column: how far away, and how much deeper.
struct Step {
  Eigen::Vector2d away;
  double down;
};

/// How many lie near a plane; a little less where it is steep.
double fit_of(const Eigen::Vector2d& dip, const std::vector<Step>& steps, double near) {
  constexpr double kFlatter = 1e-3;
  double fit = -kFlatter * dip.norm();
  for (const Step& step : steps) {
    const double off = (step.down - dip.dot(step.away)) / near;
    fit += 1 / (1 + off * off);
  }
  return fit;
}

/// The plane that fits all steps best of those through one of the first n, along it, and of those
/// through two of them, m down per m.
Eigen::Vector2d best_dip(const std::vector<Step>& steps, std::size_t n, double near) {
  constexpr double kOneLine = 0.1;  // sine of the angle between them
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double most = fit_of(best, steps, near);
  const auto consider = [&](const Eigen::Vector2d& dip) {
    const double fit = fit_of(dip, steps, near);
    if (fit <= most) return;
    most = fit;
    best = dip;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Step& one = steps[i];
    consider(one.down / one.away.squaredNorm() * one.away);
    for (std::size_t k = 0; k < i; ++k) {
      const Step& other = steps[k];
      Eigen::Matrix2d away;
      away << one.away.transpose(), other.away.transpose();
      const double area = away.determinant();
      if (std::abs(area) < kOneLine * one.away.norm() * other.away.norm()) continue;
      consider(away.inverse() * Eigen::Vector2d(one.down, other.down));
    }
  }
  return best;
}

/// The plane of least squares through those near it; as it is in a direction in which none is.
Eigen::Vector2d refined(Eigen::Vector2d dip, const std::vector<Step>& steps, std::size_t n,
                        double near) {
  constexpr int kRounds = 3;  // others may lie near then
  constexpr double kTiny = 1e-9;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const double off = steps[i].down - dip.dot(steps[i].away);
      if (std::abs(off) > near) continue;
      a += steps[i].away * steps[i].away.transpose();
      b += off * steps[i].away;
    }
    if (a.trace() <= 0) return dip;
    a += kTiny * a.trace() * Eigen::Matrix2d::Identity();
    dip += a.ldlt().solve(b);
  }
  return dip;
}

class DipFinder {
 public:
  DipFinder(const std::vector<CellColumn>& columns, const std::vector<CellPillar>& pillars)
      : columns_(columns) {
    for (const CellColumn& column : columns) {
      std::vector<int>& around = around_.emplace_back();
      for (const int pillar : column.pillars)
        around.insert(around.end(), pillars[pillar].columns.begin(), pillars[pillar].columns.end());
      std::ranges::sort(around);
      drop_repeated(around);
    }
  }

  Eigen::Vector2d dip(std::size_t c) const {
    std::vector<Step> steps;
    std::vector<int> next;
    for (const int other : around_[c]) {
      add_step(c, other, steps);
      next.insert(next.end(), around_[other].begin(), around_[other].end());
    }
    const std::size_t n = steps.size();
    std::ranges::sort(next);
    drop_repeated(next);
    for (const int other : next) {
      if (!std::ranges::binary_search(around_[c], other)) add_step(c, other, steps);
    }
    const double near = kMeets * columns_[c].height();
    return refined(best_dip(steps, n, near), steps, n, near);
  }

 private:
  void add_step(std::size_t c, int other, std::vector<Step>& steps) const {
    const CellColumn &from = columns_[c], &to = columns_[other];
    const CommonDepth depth = common_depth(from, to);
    if (&from == &to || !depth.is_any) return;
    const Eigen::Vector2d away = to.axis(depth.other) - from.axis(depth.own);
    if (away.squaredNorm() > 0) steps.push_back({away, depth.other - depth.own});
  }

  const std::vector<CellColumn>& columns_;
  std::vector<std::vector<int>> around_;  ///< per column, itself among them.
};

}  // namespace

void find_dips(std::vector<CellColumn>& columns, const std::vector<CellPillar>& pillars) {
  const DipFinder finder(columns, pillars);
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].dip = finder.dip(c);
}

}  // namespace faultsim
