#include "simulator/corner_point/straight_trace.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace faultsim::corner_point {
namespace {

/// Pieces between knots, fitted to the middles of a chain's edges.
class TraceFit {
 public:
  explicit TraceFit(const std::vector<Eigen::Vector2d>& chain) : middles_(middles_of(chain)) {
    double at = 0;
    for (std::size_t e = 0; e < middles_.size(); ++e) {
      const double edge = (chain[e + 1] - chain[e]).norm();
      weight_.push_back(edge);
      place_.push_back(at + edge / 2);
      at += edge;
    }
    knots_ = {0, at};
  }

  std::vector<Eigen::Vector2d> within(double tolerance) {
    std::vector<Eigen::Vector2d> line = fitted();
    // With a knot at each middle the line meets them all, so that many are enough.
    for (std::size_t round = 0; round < middles_.size(); ++round) {
      const std::size_t worst = farthest(line);
      if (nearest_on_line(line, middles_[worst]).distance <= tolerance) break;
      if (!add_best_knot(piece_of(place_[worst])) && !add_knot(worst)) break;
      line = fitted();
    }
    return line;
  }

 private:
  std::size_t piece_of(double place) const {
    const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, place);
    return static_cast<std::size_t>(next - knots_.begin()) - 1;
  }

  /// Of places in a piece, some edges from its ends, that with which the line misses least.
  bool add_best_knot(std::size_t piece) {
    constexpr std::size_t kFewest = 4, kMostTried = 32;  // edges on either side; places
    std::vector<double> inside;
    for (const double place : place_) {
      if (place > knots_[piece] && place < knots_[piece + 1]) inside.push_back(place);
    }
    if (inside.size() < 2 * kFewest) return false;
    const std::size_t n = inside.size() - 2 * kFewest + 1, step = n / kMostTried + 1;
    const std::vector<double> before = knots_;
    std::vector<double> best;
    double least = 0;
    for (std::size_t e = 0; e < n; e += step) {
      knots_ = before;
      knots_.insert(knots_.begin() + static_cast<std::ptrdiff_t>(piece) + 1, inside[kFewest + e]);
      const std::vector<Eigen::Vector2d> line = fitted();
      const double missed = nearest_on_line(line, middles_[farthest(line)]).distance;
      if (!best.empty() && missed >= least) continue;
      best = knots_;
      least = missed;
    }
    knots_ = best;
    return true;
  }

  /// At the middle of an edge, or at the next one to it that has none yet.
  bool add_knot(std::size_t middle) {
    const auto n = static_cast<std::ptrdiff_t>(middles_.size());
    for (std::ptrdiff_t away = 0; away < n; ++away) {
      for (const std::ptrdiff_t sign : {1, -1}) {
        const std::ptrdiff_t e = static_cast<std::ptrdiff_t>(middle) + sign * away;
        if (e < 0 || e >= n) continue;
        const double place = place_[static_cast<std::size_t>(e)];
        const auto next = std::ranges::lower_bound(knots_, place);
        if (next != knots_.end() && *next == place) continue;
        knots_.insert(next, place);
        return true;
      }
    }
    return false;
  }

  /// Σ w |(1 − s) v_k + s v_{k+1} − middle|² → min, and, where that leaves knots free (a piece
  /// with too few middles), a little of Σ |v_k − chain|² as well.
  std::vector<Eigen::Vector2d> fitted() const {
    const auto n = static_cast<Eigen::Index>(knots_.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
    double sum = 0;
    for (std::size_t e = 0; e < middles_.size(); ++e) {
      const std::size_t k = piece_of(place_[e]);
      const double s = (place_[e] - knots_[k]) / (knots_[k + 1] - knots_[k]);
      const auto row = static_cast<Eigen::Index>(k);
      const Eigen::Vector2d share(1 - s, s);
      normal.block<2, 2>(row, row) += weight_[e] * share * share.transpose();
      right.middleRows<2>(row) += weight_[e] * share * middles_[e].transpose();
      sum += weight_[e];
    }
    constexpr double kLittle = 1e-9;
    for (Eigen::Index k = 0; k < n; ++k) {
      normal(k, k) += kLittle * sum;
      right.row(k) += kLittle * sum * chain_at(knots_[static_cast<std::size_t>(k)]).transpose();
    }
    const Eigen::MatrixX2d solution = normal.ldlt().solve(right);
    std::vector<Eigen::Vector2d> line;
    for (Eigen::Index k = 0; k < n; ++k) line.emplace_back(solution.row(k).transpose());
    return line;
  }

  /// Between the middles beside a place; beyond the outermost ones, on.
  Eigen::Vector2d chain_at(double place) const {
    if (middles_.size() == 1) return middles_[0];
    const auto next = std::upper_bound(place_.begin() + 1, place_.end() - 1, place);
    const auto e = static_cast<std::size_t>(next - place_.begin());
    const double s = (place - place_[e - 1]) / (place_[e] - place_[e - 1]);
    return (1 - s) * middles_[e - 1] + s * middles_[e];
  }

  std::size_t farthest(const std::vector<Eigen::Vector2d>& line) const {
    std::size_t worst = 0;
    double distance = -1;
    for (std::size_t e = 0; e < middles_.size(); ++e) {
      const double here = nearest_on_line(line, middles_[e]).distance;
      if (here <= distance) continue;
      distance = here;
      worst = e;
    }
    return worst;
  }

  std::vector<Eigen::Vector2d> middles_;
  std::vector<double> weight_, place_;  ///< per middle: m of its edge; m along the chain.
  std::vector<double> knots_;           ///< m along the chain, ascending.
};

}  // namespace

std::vector<Eigen::Vector2d> straight_trace(const std::vector<Eigen::Vector2d>& chain,
                                            double tolerance) {
  if (chain.size() == 2) return chain;
  return TraceFit(chain).within(tolerance);
}

PlaceOnLine nearest_on_line(const std::vector<Eigen::Vector2d>& line,
                            const Eigen::Vector2d& point) {
  PlaceOnLine best;
  double before = 0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Eigen::Vector2d piece = line[k + 1] - line[k];
    const double length = piece.norm();
    const double s =
        length == 0 ? 0 : std::clamp((point - line[k]).dot(piece) / (length * length), 0.0, 1.0);
    const Eigen::Vector2d at = line[k] + s * piece;
    const double distance = (point - at).norm();
    if (k == 0 || distance < best.distance)
      best = {at, before + s * length, distance, static_cast<int>(k)};
    before += length;
  }
  return best;
}

Eigen::Vector2d tangent_of(const std::vector<Eigen::Vector2d>& line, double along, double reach) {
  const double length = line_length(line);
  const auto point_at = [&](double place) -> Eigen::Vector2d {
    std::size_t k = 0;
    double left = std::clamp(place, 0.0, length);
    while (k + 2 < line.size() && left > (line[k + 1] - line[k]).norm()) {
      left -= (line[k + 1] - line[k]).norm();
      ++k;
    }
    return line[k] + left * (line[k + 1] - line[k]).normalized();
  };
  return (point_at(along + reach) - point_at(along - reach)).normalized();
}

double line_length(const std::vector<Eigen::Vector2d>& line) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) sum += (line[k + 1] - line[k]).norm();
  return sum;
}

std::vector<Eigen::Vector2d> middles_of(const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> middles;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    middles.emplace_back((points[k] + points[k + 1]) / 2);
  return middles;
}

}  // namespace faultsim::corner_point
