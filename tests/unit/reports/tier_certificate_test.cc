#include "campaign/reports/tier_certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/reports/renderings.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Cases 1, 2, ... by their scores; of NaN without a full history.
Ranking ranked(const std::vector<double>& scores, bool ascending = false) {
  Ranking ranking;
  ranking.request.by = "chi_bar";
  ranking.request.ascending = ascending;
  for (const double score : scores) {
    RankedCase row;
    row.position = std::ssize(ranking.rows) + 1;
    row.score = score;
    row.rank_class = std::isnan(score) ? 3 : static_cast<int>(row.position % 2);
    ranking.rows.push_back(row);
  }
  return ranking;
}

std::vector<long> places(const TierCertificate& certificate) {
  std::vector<long> positions;
  for (const CertifiedCase& one : certificate.cases) positions.push_back(one.before->position);
  return positions;
}

/// Four of six were run, as cases 1 to 4: 2, 5, 1 and 4.
class FourOfSix : public ::testing::Test {
 protected:
  TierCertificate of(double sign) {
    const bool ascending = sign < 0;
    before_ = ranked({sign * 0.7, sign * 0.9, sign * 0.3, sign * 0.6, sign * 0.8, NAN}, ascending);
    after_ = ranked({sign * 0.88, sign * 0.91, sign * 0.65, NAN}, ascending);
    return tier_certificate(before_, {1, 2, 3, 4}, after_);
  }
  Ranking before_, after_;
};

TEST_F(FourOfSix, AreRankedByTheOtherTier) {
  const TierCertificate found = of(1);
  EXPECT_THAT(places(found), ElementsAre(5, 2, 1, 4)) << "the last has no full history there";
  EXPECT_EQ(found.next, 0.3);
  EXPECT_EQ(found.n_without, 1);
  EXPECT_NEAR(found.largest_rise(), 0.11, 1e-12);
  EXPECT_NEAR(found.changes().first, -0.05, 1e-12);
  EXPECT_NEAR(*found.margin(found.cases[0]), 0.61, 1e-12);
  EXPECT_FALSE(found.margin(found.cases[3]));
  EXPECT_EQ(found.n_certain(), 3);
}

/// The smallest first is the same as the largest of the opposite.
TEST_F(FourOfSix, AreTheSameTheOtherWayRound) {
  const std::vector<long> expected = places(of(1));
  const double rise = of(1).largest_rise();
  const TierCertificate found = of(-1);
  EXPECT_EQ(places(found), expected);
  EXPECT_EQ(found.largest_rise(), rise);
  EXPECT_EQ(found.n_certain(), 3);
  EXPECT_NEAR(*found.margin(found.cases[0]), 0.61, 1e-12);
}

TEST(TierCertificate, CountsThoseThatNoOtherCanPassWithoutRisingFurther) {
  const Ranking before = ranked({0.9, 0.85, 0.8, 0.78});
  const Ranking after = ranked({0.97, 0.86, 0.82});  // rises of 0.07, 0.01, 0.02; 0.78 + 0.07
  const TierCertificate found = tier_certificate(before, {1, 2, 3}, after);
  EXPECT_EQ(found.n_certain(), 2);
  const Answer answer = to_answer(found, before);
  EXPECT_THAT(answer.headline[1], HasSubstr("2 of the 3 cases run come before all"));
  EXPECT_THAT(answer.headline[2], HasSubstr("changed by 0.01 to 0.07"));
  EXPECT_EQ(answer.facts.at("certain"), 2);
  testing::expect_the_same_numbers(answer);
  testing::expect_to_fit(answer);
}

TEST(TierCertificate, PromisesNothingWhereOneMayPassThemAll) {
  const Ranking before = ranked({0.5, 0.49, 0.48}), after = ranked({0.5, 0.6});
  const TierCertificate found = tier_certificate(before, {1, 2}, after);
  EXPECT_EQ(found.n_certain(), 1) << "0.6 is more than 0.48 and the rise of 0.11";
  const Ranking flat = ranked({0.4, 0.5});
  const TierCertificate none = tier_certificate(before, {1, 2}, flat);
  EXPECT_EQ(none.n_certain(), 1);
  const Ranking lower = ranked({0.3, 0.2});
  EXPECT_EQ(tier_certificate(before, {1, 2}, lower).n_certain(), 0);
  EXPECT_THAT(to_answer(tier_certificate(before, {1, 2}, lower), before).headline[1],
              HasSubstr("None of the 2 cases run is sure to come before"));
}

TEST(TierCertificate, NeedsNoPromiseWhereAllWereRun) {
  const Ranking before = ranked({0.5, 0.4}), after = ranked({0.3, 0.6});
  const TierCertificate found = tier_certificate(before, {1, 2}, after);
  EXPECT_FALSE(found.next);
  EXPECT_EQ(found.n_certain(), 2);
  EXPECT_THAT(places(found), ElementsAre(2, 1));
}

TEST(TierCertificate, ComparesNoAreaPerMetreWithATotal) {
  Ranking before = ranked({5, 4}), after = ranked({3, 2});
  before.kinds.plane_strain = after.kinds.total = true;
  EXPECT_NO_THROW(tier_certificate(before, {1, 2}, after));
  before.extensive = "moment";
  EXPECT_THROW(tier_certificate(before, {1, 2}, after), faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
