// Whether cases of several designs are independent draws, hence shares of them probabilities.
#include <gmock/gmock.h>

#include "campaign/answers/curves.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/render/render.h"
#include "tests/unit/answers/answers_fixture.h"

namespace faultsweep {
namespace {

using faultsim::InputError;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRowsOfGroup = 160;

class SamplesOfGroups : public AnswersTest {
 protected:
  void SetUp() override {
    AnswersTest::SetUp();
    s_.parameters = {{"group", faultsim::Dimension::number, true},
                     {"strength", faultsim::Dimension::number, false}};
  }
  static json group(const std::string& name, const std::string& kind, const json& keys = {}) {
    json parameters = json::array();
    parameters.push_back({{"name", "strength"}});
    json one = {{"name", name},
                {"kind", kind},
                {"seed", 1},
                {"samples", kRowsOfGroup},
                {"parameters", parameters},
                {"scene", {{"tier", "screening"}}}};
    if (!keys.is_null()) one.update(keys);
    return one;
  }
  /// Each group has kRowsOfGroup cases, of which half slide.
  /// @param n_shared  so many rows of the second group are cases of the first.
  void submit_groups(const std::vector<json>& groups, int n_shared = 0) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (int k = 0; k < kRowsOfGroup; ++k) {
        const bool is_shared = g == 1 && k < n_shared;
        if (!is_shared) add_case(groups[g].at("name"), (k + 0.5) / kRowsOfGroup);
        const auto position = is_shared ? k + 1 : static_cast<long>(s_.cases.size());
        s_.design_rows.push_back({static_cast<int>(g), k + 1, position});
      }
    }
    s_.spec_resolved = json{{"groups", groups}, {"exclude", json::array()}}.dump();
    store_->submit(s_);
    campaign_ = store_->campaign("");
    record();
  }
  void add_case(const std::string& group, double strength) {
    const std::size_t n = s_.cases.size();
    s_.cases.push_back({"identity-" + std::to_string(n),
                        0,
                        0,
                        "{}",
                        {{0, std::nullopt, group}, {1, strength, std::to_string(strength)}}});
    RunRecord run;
    run.case_id = static_cast<long>(n) + 1;
    run.status = RunStatus::completed;
    run.result = testing::made_up_result(strength);
    runs_.push_back(run);
  }
  bool is_random(const std::string& where = "", const std::string& by = "") {
    return probability({.condition = "F1.slides", .where = where, .by = by}).sampling.is_random;
  }
  std::string remark() { return sampling_of(*store_, campaign_).remark; }
};

TEST_F(SamplesOfGroups, WithTheSameSeedAreNotIndependent) {
  submit_groups({group("a", "monte-carlo"), group("b", "monte-carlo")});
  const Probability both = probability({.condition = "F1.slides"});
  EXPECT_FALSE(both.sampling.is_random);
  EXPECT_EQ(both.shares.at(0).bounds.low, 0.5) << "no sample, no bounds";
  EXPECT_EQ(both.shares[0].bounds.high, 0.5);
  const std::string text = render_text(to_answer(both), 1000);
  EXPECT_THAT(text, HasSubstr("The cases do not vary independently: groups a and b have the same "
                              "seed. So shares are of these cases, not probabilities."));
  EXPECT_THAT(text, Not(HasSubstr("confidence")));
  // Each group alone is a sample.
  EXPECT_TRUE(is_random("group = 'b'"));
  EXPECT_TRUE(is_random("", "group"));
  EXPECT_FALSE(is_random("strength > 0.1"));
  EXPECT_FALSE(is_random("", "strength"));
}

TEST_F(SamplesOfGroups, WithTheSameSeedHaveNoBoundsInAnyAnswer) {
  submit_groups({group("a", "monte-carlo"), group("b", "monte-carlo")});
  const Quantiles quantiles =
      find_quantiles(*store_, campaign_, {.metrics = "F1.chi_bar", .at = {0.5}});
  EXPECT_FALSE(quantiles.metrics.at(0).values.at(0).low);
  EXPECT_FALSE(probability_curves(*store_, campaign_, {CurveAxis::step}).sampling.is_random);
  try {
    analyse_sensitivity(*store_, campaign_, {});
    ADD_FAILURE() << "it gave intervals";
  } catch (const InputError& wrong) {
    EXPECT_THAT(wrong.what(), HasSubstr("do not vary independently: groups a and b have the same"));
  }
  EXPECT_NO_THROW(analyse_sensitivity(*store_, campaign_, {.cases = {.where = "group = 'a'"}}));
  const Posterior p =
      find_posterior(*store_, campaign_, {{"F1.chi_bar = 0.5 +- 0.2"}, {"F1.slides"}, "", 0.95});
  EXPECT_NEAR(p.probabilities.at(0).after.value, 0.5, 0.01);
  EXPECT_NEAR(p.probabilities[0].after.bounds.low, p.probabilities[0].after.value, 1e-12);
  EXPECT_NEAR(p.probabilities[0].after.bounds.high, p.probabilities[0].after.value, 1e-12);
  EXPECT_FALSE(p.parameters.at(0).after.at(1).low);
  EXPECT_THAT(render_text(to_answer(p), 1000), Not(HasSubstr("confidence")));
}

TEST_F(SamplesOfGroups, OfOtherSeedsAreASample) {
  submit_groups({group("a", "monte-carlo"), group("b", "latin-hypercube", {{"seed", 2}})});
  EXPECT_TRUE(is_random());
  EXPECT_EQ(remark(), "");
}

TEST_F(SamplesOfGroups, OfOneSeedThatGoesOnAreASample) {
  submit_groups({group("a", "monte-carlo"), group("b", "monte-carlo", {{"first", kRowsOfGroup}})});
  EXPECT_TRUE(is_random());
}

TEST_F(SamplesOfGroups, OfOneSeedThatOverlapAreNot) {
  submit_groups(
      {group("a", "monte-carlo"), group("b", "monte-carlo", {{"first", kRowsOfGroup - 1}})});
  EXPECT_FALSE(is_random());
}

/// SampleRows counts rows A and B of a sobol design only where it is all of the campaign.
TEST_F(SamplesOfGroups, OfASobolDesignAreNone) {
  submit_groups({group("a", "monte-carlo"), group("b", "sobol", {{"seed", 2}})});
  EXPECT_FALSE(is_random());
  EXPECT_FALSE(is_random("", "group"));
  EXPECT_TRUE(is_random("group = 'a'"));
  EXPECT_FALSE(is_random("group = 'b'"));
  EXPECT_THAT(remark(), HasSubstr("group b is a sobol design"));
}

TEST_F(SamplesOfGroups, OfOneFileAreNotIndependent) {
  submit_groups({group("a", "samples", {{"fingerprint", "f"}}),
                 group("b", "samples", {{"fingerprint", "f"}})});
  EXPECT_FALSE(is_random());
  EXPECT_THAT(remark(), HasSubstr("groups a and b have the same file"));
}

TEST_F(SamplesOfGroups, OfTwoFilesAreASample) {
  submit_groups({group("a", "samples", {{"fingerprint", "f"}}),
                 group("b", "samples", {{"fingerprint", "g"}})});
  EXPECT_TRUE(is_random());
}

/// A case of both groups has the name of the first: the second's name does not select its sample.
TEST_F(SamplesOfGroups, AreNotToldApartByNameWhereTheyShareCases) {
  submit_groups({group("a", "monte-carlo"), group("b", "monte-carlo")}, 1);
  EXPECT_FALSE(is_random("group = 'b'"));
  EXPECT_FALSE(is_random("", "group"));
}

TEST_F(SamplesOfGroups, ThatAreChosenAreNone) {
  submit_groups({group("a", "grid"), group("b", "monte-carlo")});
  EXPECT_FALSE(is_random());
  EXPECT_THAT(remark(), HasSubstr("not drawn at random"));
  EXPECT_TRUE(is_random("group = 'b'"));
}

/// Four angles, each with the same 40 cohesions: four independent draws, not 160.
TEST_F(SamplesOfGroups, OfANestedDesignShareDraws) {
  const json inner = group("", "monte-carlo");
  json nested = group("", "nested");
  nested["designs"] = json::array({inner, inner});
  submit_groups({nested});
  EXPECT_FALSE(is_random());
  EXPECT_FALSE(is_random("strength > 0.1"));
  EXPECT_THAT(remark(), HasSubstr("in a nested design each row of one design goes with every row"));
  EXPECT_THROW(analyse_sensitivity(*store_, campaign_, {}), InputError);
}

}  // namespace
}  // namespace faultsweep
