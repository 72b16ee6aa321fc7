#include "campaign/reports/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "campaign/query/parameters.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/reports/renderings.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using ::testing::HasSubstr;

TEST(RelativeDifference, IsToTheLargerOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(relative_difference(4, 5), 0.2);
  EXPECT_EQ(relative_difference(-1, 1), 2);
  EXPECT_EQ(relative_difference(0, -0.0), 0);
  EXPECT_EQ(relative_difference(nan, nan), 0);
  EXPECT_TRUE(std::isinf(relative_difference(nan, 0)));
}

/// Two stores; campaigns of cases with an offset each, and results of a strength each.
class CompareTest : public ::testing::Test {
 protected:
  struct Made {
    std::string identity;
    double offset;
    double strength;  ///< < 0: not run; > 9: crashed.
    bool plane_strain = false;
  };
  void SetUp() override {
    std::string name = ::testing::TempDir() + "compare_XXXXXX";
    folder_ = mkdtemp(name.data());
    for (const char* store : {"one", "two"}) {
      stores_.push_back(std::make_unique<Store>(Store::open_owner(folder_ / store)));
    }
  }
  void TearDown() override {
    stores_.clear();
    std::filesystem::remove_all(folder_);
  }
  CampaignInfo submit(std::size_t store, const std::string& name, const std::vector<Made>& cases) {
    Submission s;
    s.name = s.spec_resolved = name;
    s.rank_by = "activated_area";
    s.parameters = {{"offset", Dimension::length, false},
                    {name + "_only", Dimension::number, true}};
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    for (const Made& one : cases) {
      s.cases.push_back(
          {one.identity,
           0,
           0,
           "{}",
           {{0, one.offset, std::to_string(one.offset) + " m"}, {1, std::nullopt, name}}});
    }
    Store& target = *stores_[store];
    const std::int64_t id = target.submit(s).campaign;
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const StoredCase stored = target.stored_case(id, std::to_string(k + 1));
      if (stored.has_result || cases[k].strength < 0) continue;
      RunRecord run;
      run.case_id = stored.id;
      if (cases[k].strength < 9) {
        run.status = RunStatus::completed;
        run.result = testing::made_up_result(cases[k].strength);
        run.result->plane_strain = cases[k].plane_strain;
      }
      target.record_runs(id, {run});
    }
    return target.campaign(name);
  }
  Comparison compare(const CampaignInfo& a, std::size_t store_b, const CampaignInfo& b,
                     double tolerance = 1e-9) {
    CompareRequest request;
    request.tolerance = tolerance;
    return compare_campaigns(*stores_[0], a, *stores_[store_b], b, request);
  }
  const std::vector<Made> base_ = {
      {"aaaaaa", 0, 0.2}, {"bbbbbb", 10, 0.9}, {"cccccc", 20, 0.7}, {"dddddd", 30, 0.4}};

  std::filesystem::path folder_;
  std::vector<std::unique_ptr<Store>> stores_;
};

TEST_F(CompareTest, TheSameNumbersInAnotherStoreAgree) {
  const Comparison c = compare(submit(0, "sweep", base_), 1, submit(1, "sweep", base_));
  EXPECT_EQ(c.n_by_identity, 4);
  EXPECT_EQ(c.n_by_parameters + c.n_only_a + c.n_only_b + c.n_same_result + c.n_without, 0);
  EXPECT_EQ(c.pairs.size(), 4u);
  EXPECT_EQ(c.count(&ComparedPair::identical), 4);
  EXPECT_EQ(c.tau_b, 1.0);
  EXPECT_EQ(c.n_top_shared, 4);
  EXPECT_TRUE(c.agrees());
  EXPECT_THAT(render_text(to_answer(c), 1000),
              HasSubstr("agree within the tolerance of 1e-09 in all 4 cases compared; 4 are "
                        "identical bit for bit in outcome and all metrics."));
}

TEST_F(CompareTest, RefusesToMixPerMetreWithTotals) {
  auto plane = base_;
  for (Made& one : plane) one.plane_strain = true;
  const CampaignInfo a = submit(0, "sweep", base_), b = submit(1, "sweep", plane);
  try {
    compare(a, 1, b);
    FAIL() << "a number per metre was compared with a total";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("activated_area cannot be compared: case 1 of A is 3D, a "
                                        "total; case 1 of B is plane strain, per metre of strike"));
  }
  CompareRequest request;
  request.metrics = "chi_bar,max_slip";
  EXPECT_TRUE(compare_campaigns(*stores_[0], a, *stores_[1], b, request).agrees());
  // Of one kind, and of cases of their own: results are shared by identity.
  auto total = base_;
  for (Made& one : plane) one.identity += "-plane";
  for (Made& one : total) one.identity += "-total";
  const auto unit_of_moments = [](const Comparison& c) {
    const auto json = render_json(to_answer(c));
    for (const auto& one : json["metrics"])
      if (one["name"] == "moment") return one["unit"].get<std::string>();
    return std::string("no moment");
  };
  EXPECT_EQ(unit_of_moments(compare(submit(0, "plane", plane), 1, b)), "N m/m");
  EXPECT_EQ(unit_of_moments(compare(a, 1, submit(1, "total", total))), "N m");
}

TEST_F(CompareTest, FindsTheCaseThatDiffersAndByHowMuch) {
  auto other = base_;
  other[2].strength = 0.7 * (1 + 1e-6);
  const CampaignInfo a = submit(0, "sweep", base_), b = submit(1, "sweep", other);
  const Comparison c = compare(a, 1, b);
  EXPECT_FALSE(c.agrees());
  EXPECT_EQ(c.n_beyond(), 1);
  EXPECT_EQ(c.count(&ComparedPair::identical), 3);
  EXPECT_EQ(c.pairs[0].a, 3);
  for (const MetricDifference& m : c.metrics) {
    if (m.metric.name == "chi_bar") {
      EXPECT_NEAR(m.max_relative, 1e-6, 1e-11);
      EXPECT_NEAR(m.max_absolute, 0.7e-6, 1e-11);
      EXPECT_EQ(m.worst_a, 3);
      EXPECT_EQ(m.n_compared, 4);
      EXPECT_EQ(m.n_beyond, 1);
    }
    if (m.metric.name == "activation_step") {
      EXPECT_EQ(m.n_compared, 2);
    }
  }
  EXPECT_TRUE(compare(a, 1, b, 1e-5).agrees());
  const auto json = render_json(to_answer(c));
  EXPECT_EQ(json["worst"][0]["case_a"], 3);
  EXPECT_EQ(json["agrees"], false);
}

TEST_F(CompareTest, CountsFlipsOutcomesAndWhatIsMissing) {
  auto other = base_;
  other[3].strength = 0.6;               // activated
  other[1].strength = 10;                // crashed
  other[0].strength = -1;                // not run
  other.push_back({"eeeeee", 40, 0.5});  // only in B
  const Comparison c = compare(submit(0, "sweep", base_), 1, submit(1, "sweep", other));
  EXPECT_EQ(c.n_only_b, 1);
  EXPECT_EQ(c.n_without, 1);
  EXPECT_EQ(c.pairs.size(), 3u);
  EXPECT_EQ(c.count(&ComparedPair::flipped), 1);
  EXPECT_EQ(c.count(&ComparedPair::outcome_differs), 1);
  EXPECT_EQ(c.pairs[0].a, 4) << "the flip comes first";
  EXPECT_EQ(c.pairs[1].outcome_b, "crashed");
  EXPECT_FALSE(compare(c.a, 1, c.b, 1e9).agrees()) << "an outcome is beyond every tolerance";
  EXPECT_EQ(compare(c.a, 1, c.b, 1e9).n_beyond(), 2) << "a flip is, too";
  const std::string text = render_text(to_answer(c), 1000);
  EXPECT_THAT(text, HasSubstr("1 have different outcomes, 1 slide in one only"));
  testing::expect_the_same_numbers(to_answer(c));
  testing::expect_to_fit(to_answer(c));
  EXPECT_THAT(text, HasSubstr("only in B: 1"));
}

TEST_F(CompareTest, MatchesOtherScenesByTheParametersTheyShare) {
  const CampaignInfo a = submit(0, "coarse", base_);
  const CampaignInfo b = submit(0, "fine",
                                {{"bbbbbb", 0, 0.9},     // the same case, under another offset
                                 {"ffffff", 20, 0.72},   // by parameters
                                 {"gggggg", 30, 0.39},   // by parameters
                                 {"hhhhhh", 50, 0.6}});  // in B only
  const Comparison c = compare(a, 0, b, 0.05);
  EXPECT_EQ(c.n_by_identity, 1);
  EXPECT_EQ(c.n_same_result, 1) << "one store, one result";
  EXPECT_EQ(c.n_by_parameters, 2);
  EXPECT_EQ(c.n_only_a, 1);
  EXPECT_EQ(c.n_only_b, 1);
  EXPECT_EQ(c.shared_parameters, std::vector<std::string>{"offset"});
  EXPECT_EQ(c.pairs.size(), 2u);
  EXPECT_EQ(c.n_ranked, 2);
  EXPECT_EQ(c.tau_b, 1.0);
}

TEST_F(CompareTest, DoesNotGuessBetweenCasesWithTheSameParameters) {
  const CampaignInfo a = submit(0, "coarse", {{"aaaaaa", 10, 0.2}, {"bbbbbb", 20, 0.9}});
  const CampaignInfo b =
      submit(1, "fine", {{"ffffff", 10, 0.2}, {"gggggg", 10, 0.3}, {"hhhhhh", 20, 0.9}});
  const Comparison c = compare(a, 1, b);
  EXPECT_EQ(c.n_by_parameters, 1);
  EXPECT_EQ(c.n_ambiguous, 2);
  EXPECT_EQ(c.n_only_a, 1);
  EXPECT_EQ(c.n_only_b, 2);
}

TEST_F(CompareTest, NothingComparedIsNoAgreement) {
  const CampaignInfo a = submit(0, "sweep", base_);
  const Comparison self = compare(a, 0, a);
  EXPECT_EQ(self.n_same_result, 4);
  EXPECT_FALSE(self.agrees());
  EXPECT_THAT(render_text(to_answer(self)), HasSubstr("COMPARED NOTHING"));
  const Comparison strange = compare(a, 1, submit(1, "other", {{"zzzzzz", 77, 0.5}}));
  EXPECT_EQ(strange.n_only_a, 4);
  EXPECT_FALSE(strange.agrees());
  CompareRequest request;
  request.metrics = "nonsense";
  EXPECT_THROW(compare_campaigns(*stores_[0], a, *stores_[0], a, request), InputError);
}

TEST_F(CompareTest, TellsHowFarTheOrderIsTheSame) {
  // Only the order of the two activated ones is turned: one of six pairs of cases.
  auto other = base_;
  std::swap(other[1].strength, other[2].strength);
  const Comparison c = compare(submit(0, "sweep", base_), 1, submit(1, "sweep", other));
  EXPECT_NEAR(*c.tau_b, 4.0 / 6, 1e-15);
}

}  // namespace
}  // namespace faultsweep
