#include "campaign/answers/local_slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "campaign/common/names.h"

namespace faultsweep {

double ParameterSpace::Column::standard_deviation() const {
  if (is_words) return 0;
  double n = 0, mean = 0, squares = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++n;
    const double before = value - mean;
    mean += before / n;
    squares += before * (value - mean);
  }
  return n > 1 ? std::sqrt(squares / (n - 1)) : 0;
}

std::vector<double> distances_from(const ParameterSpace& space, std::size_t here) {
  std::vector<double> squares(space.size(), 0);
  for (const ParameterSpace::Column& column : space.columns) {
    const double deviation = column.standard_deviation();
    const double own = column.values[here];
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const double value = column.values[k];
      if (std::isfinite(value) != std::isfinite(own)) {
        squares[k] += 1;
      } else if (column.is_words) {
        squares[k] += std::isfinite(own) && value != own ? 1 : 0;
      } else if (std::isfinite(own) && deviation > 0) {
        squares[k] += std::pow((value - own) / deviation, 2);
      }
    }
  }
  for (double& one : squares) one = std::sqrt(one);
  return squares;
}

std::vector<std::size_t> nearest(const std::vector<double>& distances, std::size_t here,
                                 std::size_t k) {
  std::vector<std::size_t> order;
  for (std::size_t one = 0; one < distances.size(); ++one)
    if (one != here && std::isfinite(distances[one])) order.push_back(one);
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
  order.resize(std::min(order.size(), k));
  return order;
}

namespace {

using Matrix = std::vector<std::vector<double>>;

Matrix zeros(std::size_t n) { return Matrix(n, std::vector<double>(n, 0.0)); }

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c = zeros(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a.size(); ++k)
      for (std::size_t j = 0; j < a.size(); ++j) c[i][j] += a[i][k] * b[k][j];
  return c;
}

/// The inverse of a symmetric positive definite matrix of which only the lower half is read, by
/// Cholesky's factors; none where a pivot is less than `least` of the diagonal entry that it comes
/// from: that column is a combination of those before it.
std::optional<Matrix> inverse(const Matrix& a, double least) {
  const std::size_t n = a.size();
  Matrix factor = zeros(n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double rest = a[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      if (i == j && !(rest > least * a[j][j])) return std::nullopt;
      factor[i][j] = i == j ? std::sqrt(rest) : rest / factor[j][j];
    }
  }
  Matrix inverted = zeros(n);
  for (std::size_t column = 0; column < n; ++column) {
    std::vector<double> x(n, 0.0);
    x[column] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
      x[i] /= factor[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) x[i] -= factor[k][i] * x[k];
      x[i] /= factor[i][i];
    }
    for (std::size_t i = 0; i < n; ++i) inverted[i][column] = x[i];
  }
  return inverted;
}

/// The cases that differ from the one asked about in numbers only, and have a y.
std::vector<double> comparable_distances(const ParameterSpace& space, const std::vector<double>& y,
                                         std::size_t here) {
  std::vector<double> distances = distances_from(space, here);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    bool same = std::isfinite(y[k]);
    for (const ParameterSpace::Column& column : space.columns) {
      const double value = column.values[k], own = column.values[here];
      same = same && std::isfinite(value) == std::isfinite(own) &&
             (!column.is_words || !std::isfinite(own) || value == own);
    }
    if (!same) distances[k] = std::numeric_limits<double>::quiet_NaN();
  }
  return distances;
}

/// Rows [1, z], with z the differences from the case asked about in standard deviations.
struct Rows {
  std::vector<std::vector<double>> x;
  std::vector<double> y, weights;
};

double tricube(double share) { return std::pow(1 - std::pow(share, 3), 3); }

Rows rows_of(const ParameterSpace& space, const std::vector<double>& y, std::size_t here,
             const std::vector<std::size_t>& cases, const std::vector<double>& distances,
             const std::vector<Slope>& slopes) {
  constexpr double kBeyond = 1.05;  // of the farthest: it keeps some weight
  const double reach = kBeyond * distances[cases.back()];
  Rows rows;
  for (const std::size_t k : cases) {
    std::vector<double> row = {1};
    for (const Slope& one : slopes) {
      const std::vector<double>& values = space.columns[one.column].values;
      row.push_back((values[k] - values[here]) / one.deviation);
    }
    rows.x.push_back(std::move(row));
    rows.y.push_back(y[k] - y[here]);
    rows.weights.push_back(reach > 0 ? tricube(distances[k] / reach) : 1);
  }
  return rows;
}

/// XᵀWX for power 1, XᵀW²X for power 2.
Matrix moments(const Rows& rows, int power) {
  Matrix sums = zeros(rows.x.front().size());
  for (std::size_t r = 0; r < rows.x.size(); ++r) {
    const double weight = std::pow(rows.weights[r], power);
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (std::size_t j = 0; j < sums.size(); ++j)
        sums[i][j] += weight * rows.x[r][i] * rows.x[r][j];
  }
  return sums;
}

/// b = M⁻¹ XᵀWy with M = XᵀWX. With equal variances σ² of the y, cov b = σ² M⁻¹ N M⁻¹ where
/// N = XᵀW²X, and E rᵀWr = σ² (Σw − tr M⁻¹N) of the residuals r, which gives σ².
void fit(const Rows& rows, const Matrix& inverted, LocalPlane& plane) {
  const std::size_t n = inverted.size();
  std::vector<double> right(n, 0.0), b(n, 0.0);
  for (std::size_t r = 0; r < rows.x.size(); ++r)
    for (std::size_t i = 0; i < n; ++i) right[i] += rows.weights[r] * rows.x[r][i] * rows.y[r];
  for (std::size_t i = 0; i < n; ++i)
    b[i] = std::inner_product(inverted[i].begin(), inverted[i].end(), right.begin(), 0.0);
  double squares = 0, freedom = 0;
  for (std::size_t r = 0; r < rows.x.size(); ++r) {
    const double misfit =
        rows.y[r] - std::inner_product(b.begin(), b.end(), rows.x[r].begin(), 0.0);
    squares += rows.weights[r] * misfit * misfit;
    freedom += rows.weights[r];
  }
  const Matrix share = product(inverted, moments(rows, 2));
  const Matrix covariance = product(share, inverted);
  for (std::size_t i = 0; i < n; ++i) freedom -= share[i][i];
  plane.scatter = std::sqrt(squares / freedom);
  for (std::size_t k = 0; k < plane.slopes.size(); ++k) {
    plane.slopes[k].per_deviation = b[k + 1];
    plane.slopes[k].error = plane.scatter * std::sqrt(covariance[k + 1][k + 1]);
  }
}

/// Parameters with numbers that vary over the campaign and that the case has.
std::vector<Slope> numbers_of(const ParameterSpace& space, std::size_t here) {
  std::vector<Slope> numbers;
  for (std::size_t k = 0; k < space.columns.size(); ++k) {
    const double deviation = space.columns[k].standard_deviation();
    if (deviation > 0 && std::isfinite(space.columns[k].values[here]))
      numbers.push_back({k, 0, 0, deviation});
  }
  return numbers;
}

}  // namespace

LocalPlane local_plane(const ParameterSpace& space, const std::vector<double>& y,
                       std::size_t here) {
  constexpr std::size_t kFewest = 20, kPerUnknown = 3;
  constexpr double kCollinear = 1e-3;  // of its variance is left beside the other parameters
  LocalPlane plane;
  plane.slopes = numbers_of(space, here);
  const std::size_t wanted = std::max(kFewest, kPerUnknown * (plane.slopes.size() + 1));
  const auto refuse = [&](std::string reason) {
    plane.slopes.clear();
    plane.reason = std::move(reason);
    return plane;
  };
  if (plane.slopes.empty()) return refuse("no parameter with numbers varies");
  if (!std::isfinite(y[here])) return refuse("the case has no value");
  const std::vector<double> distances = comparable_distances(space, y, here);
  const std::vector<std::size_t> cases = nearest(distances, here, wanted);
  if (cases.size() < wanted) {
    return refuse(concat("slopes of ", plane.slopes.size(), " parameters need ", wanted,
                         " cases with the same words, and there are ", cases.size()));
  }
  const Rows rows = rows_of(space, y, here, cases, distances, plane.slopes);
  const auto inverted = inverse(moments(rows, 1), kCollinear);
  if (!inverted) return refuse("its nearest cases do not vary the parameters independently");
  plane.n_cases = cases.size();
  plane.radius = distances[cases.back()];
  fit(rows, *inverted, plane);
  return plane;
}

}  // namespace faultsweep
