// What is said of indices, as one value in four renderings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/answers/sensitivity.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Estimate index_of(double value, double half) {
  return {value, half / 1.96, {value - half, value + half}};
}

/// A sample of 1024 rows with a metric for each list of first-order indices, ± 0.03.
Sensitivity indices(const std::vector<std::vector<double>>& first_order) {
  Sensitivity s;
  s.campaign.name = "sweep";
  s.sampling.is_random = true;
  s.sample.n_rows = 1024;
  for (std::size_t p = 0; p < first_order.at(0).size(); ++p)
    s.parameters.push_back("parameter_" + std::to_string(p));
  for (std::size_t m = 0; m < first_order.size(); ++m) {
    MetricSensitivity metric;
    metric.metric.name = "F" + std::to_string(m + 1) + ".chi_bar";
    metric.n = 1024;
    metric.mean = 0.7, metric.standard_deviation = 0.1;
    for (const double one : first_order[m]) metric.first_order.push_back(index_of(one, 0.03));
    s.metrics.push_back(std::move(metric));
  }
  return s;
}

TEST(SensitivityAnswer, BeginsWithWhatMattersMost) {
  const Answer answer = to_answer(indices({{0.21, 0.614}, {0.3, 0.31}, {0.01, 0.02}}));
  testing::expect_same_renderings(answer);
  ASSERT_EQ(answer.headline.size(), 3u);
  EXPECT_EQ(answer.headline[0],
            "F1.chi_bar depends most on parameter_1: 0.61 of its variance (0.58 to 0.64), then on "
            "parameter_0, 0.21.");
  EXPECT_THAT(answer.headline[1], HasSubstr("not told apart from parameter_0, 0.3."));
  EXPECT_THAT(answer.headline[2], HasSubstr("No parameter certainly explains any of F3.chi_bar"));
}

TEST(SensitivityAnswer, HasTheDigitsThatTheErrorAllows) {
  const std::string text = render_text(to_answer(indices({{0.21049, 0.61411}, {0.5, 0.1}})), 1000);
  EXPECT_THAT(text, HasSubstr("0.61 ± 0.03"));
  EXPECT_THAT(text, HasSubstr("0.21 ± 0.03"));
  EXPECT_THAT(text, Not(HasSubstr("0.614")));
}

/// The columns of least weight go first, and what is left out is named.
TEST(SensitivityAnswer, KeepsWhatMattersOnANarrowScreen) {
  std::vector<double> many(14, 0.01), others(14, 0.02);
  many[11] = 0.6, others[3] = 0.5;
  const Answer answer = to_answer(indices({many, others}));
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 80);
  const std::string shown = text.substr(0, text.find("Not shown on 80 columns"));
  EXPECT_LT(shown.size(), text.size());
  EXPECT_THAT(shown.substr(shown.find("metric ")), HasSubstr("parameter_11"));
  EXPECT_THAT(shown.substr(shown.find("metric ")), HasSubstr("parameter_3"));
  EXPECT_EQ(render_json(answer).at("indices").size(), 28u);
}

/// Few base samples are no footnote: their number stands beside the totals.
TEST(SensitivityAnswer, SaysOfHowManyBaseSamplesTotalsAre) {
  Sensitivity s = indices({{0.2, 0.6}, {0.2, 0.6}});
  s.frozen = s.parameters;
  s.n_base_samples = 512;
  for (std::size_t m = 0; m < 2; ++m) {
    s.metrics[m].sobol = {{index_of(0.2, 0.1), index_of(0.35, 0.1)},
                          {index_of(0.6, 0.1), index_of(0.8, 0.1)}};
    s.metrics[m].n_base_samples = m == 0 ? 512 : 29;
  }
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 60), HasSubstr("29 of 512"));
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("the indices are those of these few only"));
  EXPECT_EQ(render_json(answer).at("indices").back().at("base_samples"), 29);
}

TEST(SensitivityAnswer, NothingThatVariesIsAnAnswerToo) {
  Sensitivity s = indices({{0, 0}});
  s.metrics[0].standard_deviation = 0;
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer), HasSubstr("The same in all cases: F1.chi_bar."));
  EXPECT_EQ(answer.headline.at(0), "None of these metrics varies.");
}

}  // namespace
}  // namespace faultsweep
