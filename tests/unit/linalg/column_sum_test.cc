#include "simulator/linalg/column_sum.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

namespace faultsim {
namespace {

/// Columns of a matrix in an order of their own, with factors and a y to add to.
struct Columns {
  Columns(int n_columns, int n)
      : matrix(Eigen::MatrixXd::Random(n, n_columns + 3)), y(Eigen::VectorXd::Random(n)) {
    for (int i = 0; i < n_columns; ++i) {
      const int column = (7 * i + 2) % (n_columns + 3);
      at.push_back(matrix.col(column).data());
      which.push_back(column);
      factors.push_back(1.0 / (i + 3) - 0.2);
    }
  }
  Eigen::VectorXd by(VectorSet set) const {
    Eigen::VectorXd sum = y;
    add_columns_by(set, at, factors, 0, {sum.data(), static_cast<std::size_t>(sum.size())});
    return sum;
  }
  /// One entry after the other, as the header says it.
  Eigen::VectorXd by_definition() const {
    Eigen::VectorXd sum = y;
    for (Eigen::Index r = 0; r < y.size(); ++r) {
      const auto term = [&](std::size_t i) { return factors[i] * matrix(r, which[i]); };
      std::size_t i = 0;
      for (; i + 4 <= at.size(); i += 4) {
        double four = term(i) + term(i + 1);
        four += term(i + 2);
        four += term(i + 3);
        sum[r] += four;
      }
      for (; i < at.size(); ++i) sum[r] += term(i);
    }
    return sum;
  }

  Eigen::MatrixXd matrix;
  Eigen::VectorXd y;
  std::vector<const double*> at;
  std::vector<int> which;
  std::vector<double> factors;
};

TEST(ColumnSum, IsItsDefinitionToTheLastBitByEveryWidth) {
  for (const int n_columns : {0, 1, 3, 4, 7, 8, 9, 12, 31}) {
    for (const int n : {0, 1, 7, 8, 33, 250}) {
      const Columns columns(n_columns, n);
      const auto expected = columns.by_definition();
      for (const VectorSet set : enumerators<VectorSet>()) {
        if (set > vector_set_of_processor()) continue;
        EXPECT_EQ(columns.by(set), expected)
            << n_columns << " columns of " << n << ", " << to_string(set);
      }
    }
  }
}

TEST(ColumnSum, PartsAreThoseOfTheWhole) {
  const Columns columns(21, 100);
  const auto whole = columns.by_definition();
  for (const auto& [first, n] : {std::pair{0, 100}, {3, 41}, {99, 1}, {50, 0}}) {
    Eigen::VectorXd part = columns.y.segment(first, n);
    add_columns(columns.at, columns.factors, static_cast<std::size_t>(first),
                {part.data(), static_cast<std::size_t>(n)});
    EXPECT_EQ(part, whole.segment(first, n)) << first;
  }
}

}  // namespace
}  // namespace faultsim
