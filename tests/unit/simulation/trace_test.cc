#include "simulator/app/trace_text.h"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace faultsim {
namespace {

SubStepTrace example() {
  SubStepTrace trace;
  trace.from = 0.25;
  trace.to = 0.5;
  trace.n_nodes = 40;
  trace.verdict = "accepted";
  SearchHistory quick;
  quick.end = SearchEnd::opens;
  quick.passes = 1;
  quick.add({.residual = std::numeric_limits<double>::quiet_NaN(), .n_slip = 3, .n_changed = 3});
  SearchHistory newton;
  newton.end = SearchEnd::balanced;
  newton.passes = 2;
  newton.add({.residual = 1.5e4, .length = 1, .n_slip = 4, .n_open = 1, .n_changed = 5});
  newton.add({.residual = 0.03, .length = 0.5, .n_slip = 4, .n_open = 1});
  trace.searches = {{"plane strain", quick}, {"newton", newton}};
  return trace;
}

TEST(Trace, ShowsVerdictSearchesAndIterations) {
  EXPECT_EQ(trace_text(7, example()),
            "  step 7, load 0.25 to 0.5: accepted\n"
            "    plane strain: a node opens, 1 iterations over 1 active sets\n"
            "      iter   residual  length    slip    open  changed\n"
            "         1          -       1       3       0        3\n"
            "    newton: balanced, 2 iterations over 2 active sets\n"
            "      iter   residual  length    slip    open  changed\n"
            "         1    1.5e+04       1       4       1        5\n"
            "         2       0.03     0.5       4       1        0\n");
}

TEST(Trace, SaysWhereNothingMoved) {
  SubStepTrace trace;
  trace.verdict = "accepted";
  EXPECT_EQ(trace_text(1, trace), "  step 1, load 0 to 1: accepted, nothing moves\n");
}

TEST(Trace, NumbersTheIterationsThatAreKept) {
  SubStepTrace trace;
  trace.verdict = "failed";
  SearchHistory history;
  for (int i = 0; i < 200; ++i) history.add({.residual = 200.0 - i});
  trace.searches = {{"newton", history}};
  const std::string text = trace_text(3, trace);
  EXPECT_THAT(text, testing::HasSubstr("\n       200          1 "));
  EXPECT_THAT(text, testing::HasSubstr(" before these)\n"));
}

TEST(Trace, IsJsonWithoutNan) {
  const nlohmann::json json = trace_to_json(7, example());
  EXPECT_EQ(json["step"], 7);
  EXPECT_TRUE(json["searches"][0]["last"][0]["residual"].is_null());
  EXPECT_EQ(json["searches"][1]["last"][1]["residual"], 0.03);
  EXPECT_EQ(json["searches"][1]["end"], "balanced");
}

}  // namespace
}  // namespace faultsim
