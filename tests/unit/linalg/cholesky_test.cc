#include "simulator/linalg/cholesky.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Sparse = TrailingCholesky::SparseMatrix;

/// A 3D lattice with three unknowns per point and some trailing unknowns tied to chosen points:
/// the lower triangle of a positive definite matrix and its grouping.
struct Lattice {
  Sparse lower;
  UnknownGroups groups;
};

Lattice make_lattice(int n, int copies, int n_last, bool shuffle_trailing = false) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Lattice lattice;
  lattice.groups.n = copies * n * n * n;
  const int n_bulk = 3 * lattice.groups.n;
  std::vector<Eigen::Triplet<double, long>> entries;
  std::vector<double> row_sum(static_cast<std::size_t>(n_bulk + n_last), 0.1);
  const auto couple = [&](int i, int j, double value) {
    entries.emplace_back(std::max(i, j), std::min(i, j), value);
    row_sum[static_cast<std::size_t>(i)] += std::abs(value);
    row_sum[static_cast<std::size_t>(j)] += std::abs(value);
  };
  const auto couple_points = [&](int a, int b) {
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) couple(3 * a + c, 3 * b + d, uniform(random));
  };
  for (int p = 0; p < lattice.groups.n; ++p) {
    const int x = p % n, y = p / n % n, z = p / n / n % n;
    if (x + 1 < n) couple_points(p, p + 1);
    if (y + 1 < n) couple_points(p, p + n);
    if (z + 1 < n) couple_points(p, p + n * n);
    for (int c = 0; c < 3; ++c) lattice.groups.of.push_back(p);
  }
  for (int g = 0; g < n_last; ++g) {
    // Dealt to the copies in turn, so that neighbours among the trailing ones are in other bodies.
    const int copy = shuffle_trailing ? g % copies : g * copies / std::max(n_last, 1);
    const int base = copy * n * n * n;
    for (int k = 0; k < 4; ++k) couple(3 * (base + (5 * g + k) % (n * n * n)), n_bulk + g, 1.0);
  }
  for (int i = 0; i < n_bulk + n_last; ++i) {
    entries.emplace_back(i, i, row_sum[static_cast<std::size_t>(i)]);
  }
  lattice.lower.resize(n_bulk + n_last, n_bulk + n_last);
  lattice.lower.setFromTriplets(entries.begin(), entries.end());
  return lattice;
}

Eigen::MatrixXd dense(const Sparse& lower) {
  Eigen::MatrixXd full = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  return full;
}

struct Blocks {
  Eigen::MatrixXd rr, gr, gg;
  Eigen::MatrixXd schur() const { return gg - gr * rr.llt().solve(gr.transpose()); }
};

Blocks split(const Sparse& lower, int n_last) {
  const Eigen::MatrixXd k = dense(lower);
  const Eigen::Index n = k.rows() - n_last;
  return {k.topLeftCorner(n, n), k.bottomLeftCorner(n_last, n),
          k.bottomRightCorner(n_last, n_last)};
}

void expect_schur_complement(const Lattice& lattice, int n_last) {
  TrailingCholesky factor(lattice.lower, n_last, lattice.groups);
  ASSERT_EQ(factor.failed_column(), -1);
  const Eigen::MatrixXd l = factor.trailing_factor();
  const Eigen::MatrixXd h = lower_times_transpose(l);
  const Eigen::MatrixXd exact = split(lattice.lower, n_last).schur();
  EXPECT_LT((h - exact).norm(), 1e-12 * exact.norm());
  EXPECT_EQ(h, h.transpose());
  EXPECT_EQ(Eigen::MatrixXd(l.triangularView<Eigen::StrictlyUpper>()).norm(), 0);
}

TEST(TrailingCholesky, TrailingBlockIsTheFactorOfTheSchurComplement) {
  expect_schur_complement(make_lattice(5, 1, 12), 12);
}

TEST(TrailingCholesky, OrdersALargerGraphByMetis) {
  expect_schur_complement(make_lattice(9, 1, 30), 30);
}

TEST(TrailingCholesky, KeepsTrailingUnknownsInPlaceInDisconnectedBodies) {
  expect_schur_complement(make_lattice(4, 3, 13), 13);
  expect_schur_complement(make_lattice(4, 3, 13, true), 13);
}

TEST(TrailingCholesky, SolvesWithoutTrailingUnknowns) {
  const Lattice lattice = make_lattice(4, 2, 0);
  TrailingCholesky factor(lattice.lower, 0, lattice.groups);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(lattice.lower.rows());
  EXPECT_LT((factor.solve(dense(lattice.lower) * x) - x).norm(), 1e-12 * x.norm());
  EXPECT_EQ(factor.trailing_factor().size(), 0);
  EXPECT_EQ(factor.expand(dense(lattice.lower) * x, Eigen::VectorXd()).size(), x.size());
}

TEST(TrailingCholesky, CondensesAndExpandsOneLoad) {
  const int n_last = 10;
  const Lattice lattice = make_lattice(5, 2, n_last);
  const Blocks blocks = split(lattice.lower, n_last);
  TrailingCholesky factor(lattice.lower, n_last, lattice.groups);
  const Eigen::VectorXd f = Eigen::VectorXd::Random(lattice.lower.rows());
  const Eigen::VectorXd g = Eigen::VectorXd::Random(n_last);
  const Eigen::VectorXd f_r = f.head(f.size() - n_last);
  const Eigen::VectorXd load = f.tail(n_last) - blocks.gr * blocks.rr.llt().solve(f_r);
  EXPECT_LT((factor.condensed(factor.forward(f)) - load).norm(), 1e-12 * load.norm());
  const Eigen::VectorXd r = blocks.rr.llt().solve(f_r - blocks.gr.transpose() * g);
  const Eigen::VectorXd x = factor.expand(f, g);
  EXPECT_LT((x.head(r.size()) - r).norm(), 1e-12 * r.norm());
  EXPECT_EQ(x.tail(n_last), g);
  const Eigen::VectorXd q = Eigen::VectorXd::Random(f.size());
  const double product = factor.forward(q).head(r.size()).dot(factor.forward(f).head(r.size()));
  const double exact = q.head(r.size()).dot(blocks.rr.llt().solve(f_r));
  EXPECT_NEAR(product, exact, 1e-12 * std::abs(exact));
}

TEST(TrailingCholesky, NamesTheUnknownWhereTheMatrixIsNotPositiveDefinite) {
  Lattice lattice = make_lattice(5, 1, 4);
  lattice.lower.coeffRef(200, 200) = -1;
  EXPECT_EQ(TrailingCholesky(lattice.lower, 4, lattice.groups).failed_column(), 200);
}

TEST(TrailingCholesky, SeesASingularMatrixThatRoundingMadePositive) {
  // A chain of springs that nothing holds: the last pivot is rounding.
  const int n = 50;
  Sparse k(n, n);
  std::vector<Eigen::Triplet<double, long>> entries;
  for (int i = 0; i + 1 < n; ++i) {
    const double stiffness = 1 + 0.3 * i;
    entries.emplace_back(i, i, stiffness);
    entries.emplace_back(i + 1, i + 1, stiffness);
    entries.emplace_back(i + 1, i, -stiffness);
  }
  k.setFromTriplets(entries.begin(), entries.end());
  std::vector<int> group;
  for (int i = 0; i < n; ++i) group.push_back(i);
  EXPECT_GE(TrailingCholesky(k, 0, {group, n}).failed_column(), 0);
}

TEST(TrailingCholesky, GivesTheSameBitsTwice) {
  const Lattice lattice = make_lattice(8, 1, 20);
  const Eigen::VectorXd f = Eigen::VectorXd::Random(lattice.lower.rows());
  TrailingCholesky first(lattice.lower, 20, lattice.groups);
  TrailingCholesky second(lattice.lower, 20, lattice.groups);
  EXPECT_EQ(first.trailing_factor(), second.trailing_factor());
  EXPECT_EQ(first.solve(f), second.solve(f));
  EXPECT_GT(first.statistics().bytes, 0);
}

/// Wide enough for panels that are cut, and for several threads.
struct Cube : Lattice {
  Cube() : Lattice(make_lattice(18, 1, 300)) { set_blas_threads(1); }
  TrailingCholesky factor(const FactorRun& run) const {
    return TrailingCholesky(lower, 300, groups, run);
  }
};

TEST(TrailingCholesky, GivesTheSameBitsWithAnyNumberOfThreads) {
  const Cube cube;
  const Eigen::VectorXd f = Eigen::VectorXd::Random(cube.lower.rows());
  TrailingCholesky one = cube.factor({.n_threads = 1});
  const Eigen::VectorXd x = one.solve(f);
  const Eigen::VectorXd residual = f - cube.lower.selfadjointView<Eigen::Lower>() * x;
  EXPECT_LT(residual.norm(), 1e-12 * f.norm());
  for (const int n_threads : {2, 3, 8}) {
    TrailingCholesky several = cube.factor({.n_threads = n_threads});
    EXPECT_EQ(several.trailing_factor(), one.trailing_factor()) << n_threads;
    EXPECT_EQ(several.solve(f), x) << n_threads;
  }
}

TEST(TrailingCholesky, NamesTheFirstColumnWithoutPivotWhateverTheThreads) {
  Cube cube;
  for (const int unknown : {2500, 9000, 17000}) cube.lower.coeffRef(unknown, unknown) = -1;
  const int first = cube.factor({.n_threads = 1}).failed_column();
  EXPECT_GE(first, 0);
  for (int repetition = 0; repetition < 5; ++repetition) {
    EXPECT_EQ(cube.factor({.n_threads = 4}).failed_column(), first);
  }
}

TEST(TrailingCholesky, TellsHowFarItIsAndStopsWhenAsked) {
  const Cube cube;
  std::vector<double> told;
  cube.factor({.n_threads = 2, .progress = [&](double done) { told.push_back(done); }});
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  ASSERT_FALSE(told.empty());
  EXPECT_GT(told.back(), 0.5);
  EXPECT_LE(told.back(), 1 + 1e-12);
  std::atomic<int> asked = 0;
  EXPECT_THROW(cube.factor({.n_threads = 2, .stop = [&] { return ++asked > 20; }}), Interrupted);
  EXPECT_LT(asked, 40);
}

TEST(Blas, IsOpenBlasAndSaysHowManyThreads) {
  EXPECT_EQ(blas_complaint(), "");
  set_blas_threads(1);
  EXPECT_THAT(blas_description(), testing::MatchesRegex("OpenBLAS [0-9.]+ [A-Za-z0-9]+, 1 thread"));
}

TEST(Blas, LowerTimesTransposeAgreesWithEigenAcrossBlocks) {
  for (int n : {1, 127, 128, 129, 300}) {
    const Eigen::MatrixXd l = Eigen::MatrixXd::Random(n, n).triangularView<Eigen::Lower>();
    const Eigen::MatrixXd product = lower_times_transpose(l);
    EXPECT_LT((product - l * l.transpose()).norm(), 1e-13 * product.norm());
    EXPECT_EQ(product, product.transpose());
  }
}

TEST(Blas, LowerTimesTransposeHasTheSameBitsByEveryNumberOfThreads) {
  for (int n : {5, 1500}) {
    const Eigen::MatrixXd l = Eigen::MatrixXd::Random(n, n).triangularView<Eigen::Lower>();
    const Eigen::MatrixXd product = lower_times_transpose(l);
    EXPECT_EQ(lower_times_transpose(l, 2), product);
    EXPECT_EQ(lower_times_transpose(l, 5), product);
  }
}

/// Loads of a few entries near each point of the lattice, on trailing unknowns too.
std::vector<SparseLoad> sparse_loads(int n_unknowns, int n_loads) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<SparseLoad> loads(n_loads);
  for (int k = 0; k < n_loads; ++k) {
    for (int i = 0; i < 5; ++i) {
      loads[k].emplace_back((37 * k + 211 * i) % n_unknowns, uniform(random));
    }
  }
  return loads;
}

TEST(CondenseSparse, IsTheCondensedLoadOfEachColumn) {
  for (const int copies : {1, 2}) {
    const Lattice lattice = make_lattice(6, copies, 20);
    TrailingCholesky factor(lattice.lower, 20, lattice.groups);
    const auto n = static_cast<int>(lattice.lower.rows());
    const std::vector<SparseLoad> loads = sparse_loads(n, 150);  // three blocks, one not full
    std::vector<double> shares;
    const Eigen::MatrixXd condensed =
        factor.condense(loads, [&](double share) { shares.push_back(share); });
    for (std::size_t k = 0; k < loads.size(); ++k) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
      for (const auto& [unknown, value] : loads[k]) f[unknown] = value;
      const Eigen::VectorXd expected = factor.condensed(factor.forward(f));
      EXPECT_LT((condensed.col(k) - expected).norm(), 1e-13 * f.norm()) << k;
    }
    EXPECT_EQ(shares.size(), 3u);
    EXPECT_EQ(shares.back(), 1);
  }
}

TEST(CondenseSparse, AColumnHasTheSameBitsWhateverElseIsAsked) {
  const Lattice lattice = make_lattice(9, 1, 40);
  TrailingCholesky factor(lattice.lower, 40, lattice.groups);
  std::vector<SparseLoad> loads = sparse_loads(static_cast<int>(lattice.lower.rows()), 130);
  const auto condensed = [&] { return factor.condense(loads, [](double) {}); };
  const Eigen::MatrixXd all = condensed();
  EXPECT_EQ(condensed(), all);
  const std::vector<SparseLoad> kept = loads;
  for (int k = 0; k < 130; k += 7) {
    loads = {kept[k]};
    EXPECT_EQ(condensed().col(0), all.col(k)) << k;
    loads = {kept[(k + 50) % 130], kept[(k + 1) % 130], kept[k]};
    EXPECT_EQ(condensed().col(2), all.col(k)) << k;
  }
}

TEST(CondenseSparse, OfNothingIsNothing) {
  const Lattice lattice = make_lattice(3, 1, 4);
  TrailingCholesky factor(lattice.lower, 4, lattice.groups);
  EXPECT_EQ(factor.condense(std::vector<SparseLoad>{}, [](double) {}).cols(), 0);
  EXPECT_EQ(factor.condense(std::vector<SparseLoad>(1), [](double) {}), Eigen::Vector4d::Zero());
}

/// Values of two matrices of one pattern: the second takes the order and structure of the first,
/// and has the bits that it has without. Another pattern is analysed anew.
TEST(TrailingCholesky, OneAnalysisServesAllMatricesOfAPattern) {
  Lattice first = make_lattice(5, 1, 12), second = first;
  second.lower *= 3.7;
  FactorAnalysis analysis;
  const auto factor = [&](const Lattice& of, FactorAnalysis* kept) {
    TrailingCholesky cholesky(of.lower, 12, of.groups, {.analysis = kept});
    EXPECT_EQ(cholesky.failed_column(), -1);
    return cholesky.trailing_factor();
  };
  EXPECT_EQ(factor(first, &analysis), factor(first, nullptr));
  EXPECT_EQ(analysis.n_made(), 1);
  EXPECT_EQ(factor(second, &analysis), factor(second, nullptr));
  EXPECT_EQ(factor(first, &analysis), factor(first, nullptr)) << "a third time";
  EXPECT_EQ(analysis.n_made(), 1);
  const Lattice other = make_lattice(4, 1, 12);
  EXPECT_EQ(factor(other, &analysis), factor(other, nullptr));
  EXPECT_EQ(analysis.n_made(), 2);
  // The same matrix with other unknowns at its end.
  UnknownGroups groups = other.groups;
  for (int g = 0; g < 6; ++g) groups.of.push_back(groups.n++);
  TrailingCholesky fewer(other.lower, 6, groups, {.analysis = &analysis});
  EXPECT_EQ(fewer.trailing_factor().rows(), 6);
  EXPECT_EQ(analysis.n_made(), 3);
}

}  // namespace
}  // namespace faultsim
