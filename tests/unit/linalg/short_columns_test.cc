#include "simulator/linalg/short_columns.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

using Triple = ShortColumns::Triple;

/// Columns whose entries fall as those of H do, by 1e4 from the last row to the first.
Eigen::MatrixX3f falling(int rows) {
  Eigen::MatrixX3f columns = Eigen::MatrixX3f::Random(rows, 3);
  for (int r = 0; r < rows; ++r)
    columns.row(r) *=
        1e8F * std::pow(10.0F, -4 * static_cast<float>(rows - r) / static_cast<float>(rows));
  return columns;
}

/// x and y over the rows, and what beyond them there must be room for.
struct Vectors {
  explicit Vectors(int rows)
      : x(Eigen::VectorXf::Random(ShortColumns::padded(rows))),
        y(1e8F * Eigen::VectorXf::Random(ShortColumns::padded(rows))) {}
  Eigen::VectorXf x, y;
};

constexpr Triple kFactors = {0.7F, -1.3F, 0.2F};
const Eigen::Vector3f kF(0.7F, -1.3F, 0.2F);

TEST(ShortColumns, MultiplyAsThePieceOfASymmetricMatrixThatTheyAre) {
  for (const int rows : {0, 1, 15, 16, 63, 64, 65, 300}) {
    const Eigen::MatrixX3f columns = falling(rows);
    const ShortColumns short_columns(columns);
    Vectors v(rows);
    const Eigen::VectorXf expected = v.y.head(rows) + columns * kF;
    const Eigen::Vector3f sums = columns.transpose() * v.x.head(rows);
    const Eigen::VectorXf beyond = v.y.tail(v.y.size() - rows);
    const Triple got = short_columns.multiply(kFactors, v.x.data(), v.y.data());
    for (int r = 0; r < rows; ++r) {
      const int first = r / ShortColumns::kScaled * ShortColumns::kScaled;
      const int n = std::min(ShortColumns::kScaled, rows - first);
      const float largest = columns.middleRows(first, n).cwiseAbs().maxCoeff();
      EXPECT_NEAR(v.y[r], expected[r], 2.2F / 65536 * largest + 16) << r << " of " << rows;
    }
    EXPECT_EQ(v.y.tail(v.y.size() - rows), beyond) << rows;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], sums[c], 1e-4F * 1e8F) << rows;
  }
}

TEST(ShortColumns, GiveTheSameBitsByEveryWidth) {
  for (const int rows : {1, 16, 65, 300}) {
    const ShortColumns columns(falling(rows));
    const Vectors given(rows);
    Vectors sse = given;
    const Triple expected =
        columns.multiply_by(VectorSet::sse, kFactors, sse.x.data(), sse.y.data());
    for (const VectorSet set : enumerators<VectorSet>()) {
      if (set > vector_set_of_processor()) continue;
      Vectors v = given;
      EXPECT_EQ(columns.multiply_by(set, kFactors, v.x.data(), v.y.data()), expected)
          << rows << " rows, " << to_string(set);
      EXPECT_EQ(v.y, sse.y) << rows << " rows, " << to_string(set);
    }
  }
}

TEST(ShortColumns, GiveTheSameBitsBlockAfterBlock) {
  for (const int rows : {1, 64, 65, 300}) {
    const ShortColumns columns(falling(rows));
    Vectors whole(rows), parts = whole;
    const Triple expected = columns.multiply(kFactors, whole.x.data(), whole.y.data());
    ShortColumns::Lanes lanes;
    for (int first = 0, last = 0; first < columns.n_blocks(); first = last) {
      last = std::min(first + 2, columns.n_blocks());
      columns.multiply_blocks(first, last, kFactors, parts.x.data(), parts.y.data(), lanes,
                              columns);
    }
    EXPECT_EQ(lanes.total(), expected) << rows;
    EXPECT_EQ(parts.y, whole.y) << rows;
  }
}

TEST(ShortColumns, HoldTheirLargestEntriesOfEachScale) {
  Eigen::MatrixX3f columns = Eigen::MatrixX3f::Zero(130, 3);
  columns(3, 0) = 5e7F;
  columns(70, 0) = -2e3F;
  columns(129, 2) = 1;
  const ShortColumns short_columns(columns);
  Eigen::VectorXf sum;
  for (int c = 0; c < 3; ++c) {
    Triple one{};
    one[c] = 1;
    short_columns.combine(one, sum);
    EXPECT_TRUE(sum.head(130).isApprox(columns.col(c), 1e-6F)) << c;
  }
}

}  // namespace
}  // namespace faultsim
