// Charts and the page of a made-up campaign, with names that would break a page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/query/parameters.h"
#include "simulator/common/base64.h"
#include "simulator/figure/palette.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsweep {
namespace {

using faultsim::concat;
using faultsim::Dimension;
using faultsim::InputError;
using faultsim::figure::xml_problem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNasty = "</script><b onload=\"x()\">&'";
constexpr const char* kScene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Cases whose results follow from `strength` alone (made_up_result: F1 slides above 0.5).
class FiguresTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "figures_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// @param change  of the result of each case.
  void submit(
      int n, int n_results,
      const std::function<void(int, faultsim::CaseResult&)>& change = [](int, auto&) {}) {
    Submission s;
    s.name = kNasty;
    s.source = "/somebody/secret/spec.json";
    s.spec_given = kNasty;
    s.scenes = {{kScene, text_of(kScene)}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    s.parameters = {{"strength", Dimension::number, false},
                    {"offset", Dimension::length, false},
                    {"rule", Dimension::number, true}};
    for (int k = 0; k < n; ++k) {
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, strength(k, n), std::to_string(strength(k, n))},
                          {1, 7.0 * (k % 11), std::to_string(7 * (k % 11)) + " m"},
                          {2, std::nullopt, k % 2 == 0 ? kNasty : "min"}}});
    }
    json parameters = json::array({{{"name", "strength"}}, {{"name", "offset"}}});
    s.spec_resolved =
        json{{"groups", {{{"kind", "monte-carlo"}, {"parameters", parameters}}}}}.dump();
    store_->submit(s);
    campaign_ = store_->campaign("");
    std::vector<RunRecord> runs;
    for (int k = 0; k < n_results; ++k) {
      RunRecord run;
      run.case_id = k + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(strength(k, n));
      change(k, *run.result);
      runs.push_back(run);
    }
    store_->record_runs(campaign_.id, runs);
    campaign_ = store_->campaign("");
  }
  static double strength(int k, int n) { return (k + 0.5) / n; }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

TEST_F(FiguresTest, TheMapHasEachCaseWithAResultAndSaysWhatParametersThereAre) {
  submit(40, 30);
  const std::string svg = draw_outcome_map(*store_, campaign_, {});
  EXPECT_EQ(xml_problem(svg), "");
  EXPECT_THAT(svg, HasSubstr("What became of 30 cases"));
  EXPECT_THAT(svg, HasSubstr("offset, m"));
  EXPECT_EQ(xml_problem(draw_outcome_map(*store_, campaign_, {"rule", "strength"})), "");
  EXPECT_THROW(draw_outcome_map(*store_, campaign_, {"offsett", ""}), InputError);
}

/// Every case that holds is a circle at its strength, in the row of its rule.
TEST_F(FiguresTest, TheMapHasEachCaseAtItsParameters) {
  submit(40, 40);
  const std::string svg = draw_outcome_map(*store_, campaign_, {"strength", "rule"});
  const faultsim::figure::ReadScale x = faultsim::figure::read_scale(svg, true);
  std::map<std::string, double> rows;  // word of the axis -> y
  for (const auto& one : faultsim::figure::elements_of(svg, "text", "text-anchor", "end"))
    rows[one.text] = one.number("y") - 4;
  ASSERT_TRUE(rows.contains("min"));
  auto dots = faultsim::figure::elements_of(svg, "circle", "r", "3.4");
  ASSERT_EQ(dots.size(), 20u) << "half of them hold";
  std::sort(dots.begin(), dots.end(),
            [](const auto& a, const auto& b) { return a.number("cx") < b.number("cx"); });
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(x.value(dots[static_cast<std::size_t>(k)].number("cx")), strength(k, 40), 1e-3);
    const double off = std::abs(dots[static_cast<std::size_t>(k)].number("cy") - rows.at("min"));
    EXPECT_EQ(off < 1, k % 2 == 1) << k;
  }
}

/// Of what the map's axes say there is one way: that of the tables.
TEST_F(FiguresTest, TheMapHasTheUnitsOfTheTablesAndNamesInsteadOfPointers) {
  Submission s;
  s.name = "units";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  s.parameters = {{"cohesion", Dimension::pressure, false},
                  {"/pressure_field/file", Dimension::number, true}};
  s.cases = {{"a", 0, 0, "{}", {{0, 3e5, "0.3 MPa"}, {1, std::nullopt, "one.csv"}}},
             {"b", 0, 0, "{}", {{0, 6e5, "0.6 MPa"}, {1, std::nullopt, "two.csv"}}},
             {"c", 0, 0, "{}", {{0, 6e5, "0.6 MPa"}, {1, std::nullopt, "two.csv"}}}};
  s.spec_resolved = json{{"groups", {{{"kind", "list"}, {"parameters", json::array()}}}}}.dump();
  store_->submit(s);
  campaign_ = store_->campaign("");
  std::vector<RunRecord> runs(3);
  for (std::size_t k = 0; k < 3; ++k) {
    runs[k].case_id = static_cast<long>(k) + 1;
    runs[k].status = RunStatus::completed;
    runs[k].result = testing::made_up_result(k == 2 ? 0.8 : 0.2);
  }
  store_->record_runs(campaign_.id, runs);
  const std::string svg = draw_outcome_map(*store_, store_->campaign(""), {});
  for (const char* text : {">cohesion, MPa<", ">pressure field: file<", ">0.3<", ">0.6<",
                           ">one.csv<", ">50<", "What became of 3 cases of units"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST_F(FiguresTest, ACampaignOfOneParameterHasAMapOfOneRow) {
  Submission s;
  s.name = "one";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  s.parameters = {{"offset", Dimension::length, false}};
  s.cases = {{"a", 0, 0, "{}", {{0, 0.0, "0 m"}}}, {"b", 0, 0, "{}", {{0, 100.0, "100 m"}}}};
  s.spec_resolved = json{{"groups", {{{"kind", "list"}, {"parameters", json::array()}}}}}.dump();
  store_->submit(s);
  const std::string none = draw_outcome_map(*store_, store_->campaign(""), {});
  EXPECT_THAT(none, HasSubstr("has a result yet"));
  RunRecord run;
  run.case_id = 2;
  run.status = RunStatus::completed;
  run.result = testing::made_up_result(0.8);
  store_->record_runs(store_->campaign("").id, {run});
  const std::string svg = draw_outcome_map(*store_, store_->campaign(""), {});
  EXPECT_EQ(xml_problem(svg), "");
  EXPECT_THAT(svg, HasSubstr("What became of 1 case of one"));
  EXPECT_THAT(svg, HasSubstr("offset, m"));
}

/// The elements are the first rows; the data have every one.
TEST_F(FiguresTest, ThePageHoldsEveryCase) {
  submit(1500, 1500);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(page, HasSubstr("The first 100 of 1500 rows."));
  const std::string tag = "data-rows-of=\"cases\">";
  const std::size_t begin = page.find(tag) + tag.size();
  const json data = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data.at("rows"), 1500);
  std::string riskiest_first;  // the larger its strength, the more slides, and strength grows
  for (int k = 1500; k > 0; --k)
    riskiest_first += {static_cast<char>(k % 256), static_cast<char>(k / 256)};
  EXPECT_EQ(data.at("columns").at(1).at("at"), faultsim::base64(riskiest_first));
  EXPECT_THAT(page, Not(HasSubstr("<b onload")));
}

TEST_F(FiguresTest, BarsAreThoseOfTheirParametersTheLargestFirst) {
  Sensitivity s;
  s.campaign.name = "sweep";
  s.request.confidence = 0.9;
  s.parameters = {"small", "large", "middle"};
  MetricSensitivity metric;
  metric.metric.name = "chi_bar";
  metric.standard_deviation = 1;
  metric.first_order = {
      {0.1, 0.01, {0.05, 0.15}}, {0.6, 0.02, {0.5, 0.7}}, {0.3, 0.02, {0.2, 0.4}}};
  s.metrics = {metric};
  const std::string svg = faultsim::figure::draw(chart_of(s));
  EXPECT_THAT(svg, HasSubstr("90 %"));
  const faultsim::figure::ReadScale x = faultsim::figure::read_scale(svg, true);
  std::map<std::string, double> lengths;
  std::vector<std::string> names;
  const auto bars =
      faultsim::figure::elements_of(svg, "rect", "fill", faultsim::figure::fault_stroke(0).colour);
  for (const auto& one : faultsim::figure::elements_of(svg, "text", "text-anchor", "end"))
    names.push_back(one.text);
  ASSERT_EQ(bars.size(), 3u);
  EXPECT_EQ(names, (std::vector<std::string>{"large", "middle", "small"}));
  const double expected[] = {0.6, 0.3, 0.1};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(x.per_px * bars[k].number("width"), expected[k], 1e-3) << k;
  // With total indices these order the bars, and both stand there.
  s.frozen = s.parameters;
  for (const double total : {0.9, 0.65, 0.35})
    s.metrics[0].sobol.push_back({s.metrics[0].first_order[s.metrics[0].sobol.size()],
                                  {total, 0.01, {total - 0.05, total + 0.05}}});
  const std::string both = faultsim::figure::draw(chart_of(s));
  names.clear();
  for (const auto& one : faultsim::figure::elements_of(both, "text", "text-anchor", "end"))
    names.push_back(one.text);
  EXPECT_EQ(names, (std::vector<std::string>{"small", "large", "middle"}));
  auto totals =
      faultsim::figure::elements_of(both, "rect", "fill", faultsim::figure::fault_stroke(4).colour);
  ASSERT_EQ(totals.size(), 4u) << "one is of the key";
  EXPECT_NEAR(x.per_px * totals[1].number("width"), 0.9, 1e-3);
}

/// The share is of the cases that are known.
TEST_F(FiguresTest, IntervalsSayOfHowManyCasesTheyAre) {
  Probability p;
  p.campaign.name = "sweep";
  p.request.confidence = 0.95;
  Share share;
  share.label = "F1.slides";
  share.counts = {.n = 40, .n_yes = 19, .n_holds = 19, .n_unknown = 2};
  share.bounds = {0.3, 0.7};
  p.shares = {share};
  const std::string svg = faultsim::figure::draw(chart_of(p));
  EXPECT_THAT(svg, HasSubstr(">19 of 38, 2 unknown<"));
  const faultsim::figure::ReadScale x = faultsim::figure::read_scale(svg, true);
  EXPECT_NEAR(x.value(faultsim::figure::elements_of(svg, "circle", "r", "4.5").at(0).number("cx")),
              0.5, 1e-3);
}

TEST_F(FiguresTest, OutcomesAreCountedAsTheStoreHasThem) {
  submit(40, 40);
  const auto counts = count_outcomes(*store_, campaign_);
  const auto of = [&](faultsim::figure::CaseClass kind) {
    return counts[static_cast<std::size_t>(kind)];
  };
  using faultsim::figure::CaseClass;
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0L), 40);
  EXPECT_EQ(of(CaseClass::slides) + of(CaseClass::event), 20);
}

TEST_F(FiguresTest, ThePageSaysTheAnswerAndHasNothingThatBreaksOut) {
  submit(40, 40);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(
      page,
      HasSubstr("A fault slides in 20 of 40 cases, 50 % (33.8 to 66.2 %). Most often it is F1 in "
                "primary_production: 20 of 40 cases, 50 % (33.8 to 66.2 %). No case has a "
                "slip event. Bounds have a confidence of 95 %."));
  EXPECT_THAT(page, Not(HasSubstr("<b onload")));
  EXPECT_THAT(page, Not(HasSubstr("/somebody/secret")));  // no paths of the machine
  EXPECT_THAT(page, Not(HasSubstr("src=")));              // nothing is loaded
  EXPECT_EQ(page, report_page(*store_, campaign_, {.program = "faultsweep test"}));
  for (std::size_t at = page.find("<svg"); at != std::string::npos;
       at = page.find("<svg", at + 1)) {
    EXPECT_EQ(xml_problem(page.substr(at, page.find("</svg>", at) + 6 - at)), "");
  }
}

/// The hex digits that `sha256sum` gives of a text.
std::string sha256_of(const std::filesystem::path& folder, const std::string& text) {
  const std::filesystem::path file = folder / "script", sum = folder / "sum";
  std::ofstream(file) << text;
  EXPECT_EQ(std::system(concat("sha256sum <", file.string(), " >", sum.string()).c_str()), 0);
  std::string hex;
  std::ifstream(sum) >> hex;
  return hex;
}

TEST_F(FiguresTest, ThePageMayLoadNothingAndRunItsOwnScriptOnly) {
  submit(40, 40);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  const std::string tag = "<script>";
  const std::size_t begin = page.find(tag) + tag.size();
  EXPECT_EQ(page.find(tag, begin), std::string::npos) << "one script that runs";
  const std::string hex =
      sha256_of(folder_, page.substr(begin, page.find("</script>", begin) - begin));
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  EXPECT_THAT(page, HasSubstr("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                              "'none'; script-src 'sha256-" +
                              faultsim::base64(bytes) + "'; style-src 'unsafe-inline'; "));
  EXPECT_LT(page.find("Content-Security-Policy"), page.find("<style"));
  std::string rest = page;  // without the name of SVG, which is never fetched
  for (const std::string name = "http://www.w3.org/2000/svg"; rest.find(name) != std::string::npos;)
    rest.erase(rest.find(name), name.size());
  for (const char* request :
       {"http:", "https:", "//www", "src=", "url(", "@import", "fetch(", "XMLHttpRequest"})
    EXPECT_THAT(rest, Not(HasSubstr(request)));
}

TEST_F(FiguresTest, WordsBesideNumbersAreShownWhole) {
  Submission s;
  s.name = "words";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  s.parameters = {{"cut", Dimension::pressure, false},
                  {"steps", Dimension::number, true},
                  {"depth", Dimension::length, false}};
  s.cases = {
      {"a",
       0,
       0,
       "{}",
       {{0, -1e7, "-100 bar"},
        {1, std::nullopt, "load steps as given"},
        {2, 2000.0, "2000.00001 m"}}},
      {"b",
       0,
       0,
       "{}",
       {{0, std::nullopt, "mean of both"}, {1, std::nullopt, "infill 2"}, {2, 2100.0, "2100 m"}}}};
  s.spec_resolved = json{{"groups", {{{"kind", "list"}, {"parameters", json::array()}}}}}.dump();
  store_->submit(s);
  campaign_ = store_->campaign("");
  std::vector<RunRecord> runs(2);
  for (std::size_t k = 0; k < 2; ++k) {
    runs[k].case_id = static_cast<long>(k) + 1;
    runs[k].status = RunStatus::completed;
    runs[k].result = testing::made_up_result(0.8);
  }
  runs[0].result->whole.faults[0].activation_resolved = false;
  runs[0].result->whole.activation_resolved = false;
  store_->record_runs(campaign_.id, runs);
  campaign_ = store_->campaign("");
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(page, HasSubstr(">depth, m</th>"));
  EXPECT_THAT(page, HasSubstr("<td data-value=\"2000\">2000</td>"));
  EXPECT_THAT(page, HasSubstr("data-table=\"cases\" data-filter=\"rows-cases\">"));
  EXPECT_THAT(page, HasSubstr("<p id=\"rows-cases\""));
  EXPECT_THAT(page, HasSubstr(">cut</th>"));
  for (const char* label : {"-100 bar", "mean of both", "load steps as given", "infill 2"})
    EXPECT_THAT(page, HasSubstr(concat("<td>", label, "</td>")));
  EXPECT_THAT(page,
              HasSubstr("A fault slides in 2 of 2 cases, 100 % (50 to 100 %: 1 undecided by "
                        "the cells). Most often it is F1 in primary_production: 2 of 2 cases, "
                        "100 %. No case has a slip event."));
}

/// Nobody may read that 13 of 24 slide where 20 of the 24 hang on the cells.
TEST_F(FiguresTest, TheFirstSentenceOfAPageSaysHowManyAreUndecided) {
  submit(24, 24, [](int k, faultsim::CaseResult& result) {
    result.whole.activation_resolved = k >= 20;
    for (faultsim::FaultStageMetrics& fault : result.whole.faults)
      fault.activation_resolved = k >= 20;
  });
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  const std::size_t answer = page.find("class=\"answer\">");
  ASSERT_NE(answer, std::string::npos);
  const std::string first = page.substr(answer, page.find("</p>", answer) - answer);
  EXPECT_THAT(first, HasSubstr("12 of 24 cases, 50 %"));
  EXPECT_THAT(first, HasSubstr("20 undecided by the cells"));
  EXPECT_EQ(
      count_outcomes(*store_,
                     campaign_)[static_cast<std::size_t>(faultsim::figure::CaseClass::undecided)],
      20);
}

/// Not where its files would be, as the page is read elsewhere.
TEST_F(FiguresTest, APageSaysWhyACaseHasNoFields) {
  submit(4, 4);
  const auto page = [&] {
    return report_page(*store_, campaign_, {.program = "faultsweep test", .top = 4});
  };
  EXPECT_THAT(page(), HasSubstr("which were not kept (keep_fields: stages in the spec "));
  store_->want_fields(campaign_.id, {1, 2, 3});
  RunRecord gone;
  gone.case_id = 1;
  gone.status = RunStatus::completed;
  gone.result = store_->stored_case(campaign_.id, "1").result;
  gone.fields_only = gone.has_fields = true;
  RunRecord failed;
  failed.case_id = 2;
  failed.fields_only = true;
  failed.reason = "disk full";
  store_->record_runs(campaign_.id, {gone, failed});
  const std::string said = page();
  for (const char* why : {"which are gone.", "which could not be written: faultsweep show ",
                          "which are not written yet: faultsweep run ", "which were not kept "})
    EXPECT_THAT(said, HasSubstr(why));
  EXPECT_THAT(said, Not(HasSubstr(folder_.string())));
}

TEST_F(FiguresTest, APageWithoutResultsSaysSo) {
  submit(5, 0);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(page, HasSubstr("None of the 5 cases has a full history yet"));
  EXPECT_THAT(page, HasSubstr("No case has a result yet."));
}

TEST_F(FiguresTest, ACaseWithoutAResultIsRefused) {
  submit(2, 1);
  const StoredCase waiting = store_->stored_case(campaign_.id, "2");
  EXPECT_THROW(StoredPicture(*store_, campaign_, waiting), InputError);
}

}  // namespace
}  // namespace faultsweep
