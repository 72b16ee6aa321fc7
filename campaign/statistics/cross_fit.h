#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Predictions of an expensive model from what a cheap one says, none of which has seen the value
/// that it predicts.
namespace faultsweep {

/// Features of all members of a sample, made comparable: (x − mean) / deviation, over all members.
class StandardFeatures {
 public:
  /// @param columns    [feature][member]; those that are not finite everywhere, or do not vary, are
  ///                   left out.
  /// @param n_members  N, also where there is no column.
  StandardFeatures(std::span<const std::vector<double>> columns, std::size_t n_members);
  std::size_t n_members() const { return n_members_; }
  /// Of a fit: that of 1, then one for each feature that is used.
  std::size_t n_coefficients() const { return width_; }
  /// Which columns were left out, ascending.
  const std::vector<std::size_t>& left_out() const { return left_out_; }
  /// 1 and the features of a member: n_coefficients().
  std::span<const double> row(std::size_t member) const {
    return std::span(rows_).subspan(member * width_, width_);
  }

 private:
  std::size_t n_members_ = 0, width_ = 1;
  std::vector<double> rows_;  ///< N x width.
  std::vector<std::size_t> left_out_;
};

/// How a value y depends on the features x of its member, with b·x = b_0 + Σ b_j x_j.
enum class Dependence {
  line,      ///< E y = b·x.
  logistic,  ///< y is a flag, P(y = 1) = 1 / (1 + exp(−b·x)).
};

/// Coefficients b of the members that have a y, the first y.size(), but those of one fold (kFolds
/// leaves out nobody). They make greatest, by Newton's method with steps halved until they ascend,
///
///   Σ log P(y | x) − ½ Σ_j (b_j / 5)² − ½ (b_0 / 10)²   of flags,
///   −½ Σ (y − b·x)² − ½ Σ_j (b_j / 5)²                  of lines:
///
/// a normal prior, so that there are coefficients where flags separate completely, or features
/// depend on each other, which is hardly felt elsewhere: it lets the odds grow 150-fold over one
/// deviation of a feature.
/// @pre some member is not in the fold.
std::vector<double> fit(const StandardFeatures& x, std::span<const double> y, Dependence dependence,
                        std::size_t without_fold);
/// E y of a member with these features.
double predicted(std::span<const double> coefficients, std::span<const double> features,
                 Dependence dependence);

/// The i-th member is in the fold i mod kFolds: of a random sample each is a random one.
inline constexpr std::size_t kFolds = 10;
inline std::size_t fold_of(std::size_t member) { return member % kFolds; }

/// E y of all N members: of those with a y by the fit without their fold, of the others the mean
/// over the fits without each. @pre N ≥ y.size() ≥ kFolds.
std::vector<double> cross_fitted(const StandardFeatures& x, std::span<const double> y,
                                 Dependence dependence);

}  // namespace faultsweep
