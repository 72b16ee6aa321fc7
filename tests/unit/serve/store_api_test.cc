// What a made-up store says over HTTP, without sockets.
#include "campaign/serve/store_api.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "campaign/render/render.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/reports/status_report.h"
#include "campaign/serve/sliders.h"
#include "simulator/files/json_text.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kBaseScene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";

/// Forty cases, the last ten without a result; F1 slides above a strength of 0.5 (made_up_result).
class StoreApiTest : public ::testing::Test {
 protected:
  static constexpr int kCases = 40, kResults = 30;

  void SetUp() override {
    std::string name = ::testing::TempDir() + "serve_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    Submission s;
    s.name = "sweep";
    s.source = (folder_ / "secret" / "spec.json").string();
    s.spec_given = "{}";
    s.spec_resolved = json{{"groups",
                            {{{"kind", "monte-carlo"},
                              {"scene", json::object()},
                              {"parameters", {{{"name", "strength"}}, {{"name", "offset"}}}}}}}}
                          .dump();
    std::ostringstream scene;
    scene << std::ifstream(kBaseScene).rdbuf();
    s.scenes = {{(folder_ / "scene.json").string(), scene.str()}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    s.parameters = {{"strength", faultsim::Dimension::number, false},
                    {"offset", faultsim::Dimension::length, false}};
    s.keep_fields = KeepFields::stages;
    for (int k = 0; k < kCases; ++k) {
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, strength(k), std::to_string(strength(k))},
                          {1, 7.0 * (k % 11), std::to_string(7 * (k % 11)) + " m"}}});
    }
    store_->submit(s);
    record(0, kResults);
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// Results of cases from `first` (index) on, before `end`.
  void record(int first, int end) {
    std::vector<RunRecord> runs;
    for (int k = first; k < end; ++k) {
      RunRecord run;
      run.case_id = k + 1;
      run.status = RunStatus::completed;
      run.has_fields = true;
      run.result = testing::made_up_result(strength(k));
      runs.push_back(run);
    }
    store_->record_runs(store_->campaign("sweep").id, runs);
  }
  /// Not in the order of the cases.
  static double strength(int k) { return ((k * 17) % kCases + 0.5) / kCases; }

  HttpResponse get(const std::string& target) const {
    return StoreApi(folder_ / "store").answer(parse_target(target));
  }
  json json_at(const std::string& target) const {
    const HttpResponse response = get(target);
    EXPECT_EQ(response.status, 200) << target << response.body;
    EXPECT_EQ(response.type, "application/json");
    return json::parse(response.body);
  }
  /// The error with which a target is refused.
  json error_at(const std::string& target, int status) const {
    const HttpResponse response = get(target);
    EXPECT_EQ(response.status, status) << target << response.body;
    EXPECT_EQ(response.type, "application/json");
    const json error = json::parse(response.body).value("error", json::object());
    for (const char* key : {"place", "cause", "cure"})
      EXPECT_NE(error.value(key, ""), "") << target << ": " << key;
    return error;
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(StoreApiTest, ListsItsRoutesAndEachOfThemAnswers) {
  const json listed = json_at("/api");
  for (const json& route : listed.at("routes")) {
    std::string path = route.at("path");
    for (const auto& [braces, value] :
         {std::pair("{campaign}", "sweep"), std::pair("{case}", "5")}) {
      const std::size_t at = path.find(braces);
      if (at != std::string::npos) path.replace(at, std::string(braces).size(), value);
    }
    const HttpResponse response = get(path);
    // 400: what the made-up campaign lacks (limits, fields), or what was not said (seen, metrics);
    // 503: there is no simulator here
    EXPECT_THAT(response.status, AnyOf(200, 400, path.ends_with("what-if") ? 503 : 200))
        << path << response.body;
    EXPECT_EQ(response.remark, "") << path;
    if (response.status == 200) {
      EXPECT_EQ(response.type, route.at("type")) << path;
    }
  }
  EXPECT_THAT(listed.at("routes").size(), ::testing::Ge(20u));
}

/// One value, four renderings: the same bytes as of the command.
TEST_F(StoreApiTest, AnswersAreThoseOfTheCommands) {
  const CampaignInfo campaign = store_->campaign("sweep");
  const auto text = [](const Answer& answer) { return faultsim::json_text(render_json(answer)); };
  RankRequest request;
  request.by = "max_slip";
  request.where = "strength > 0.2";
  request.stage = "gas_storage";
  request.top = 7;
  request.skip = 7;
  EXPECT_EQ(get("/api/campaigns/sweep/ranking?by=max_slip&where=strength+%3E+0.2&stage=gas_storage"
                "&rows=7&page=2")
                .body,
            text(to_answer(make_ranking(*store_, campaign, request))));
  EXPECT_EQ(get("/api/campaigns").body, text(campaigns_answer(*store_)));
  EXPECT_EQ(get("/api/metrics").body, text(metrics_answer()));
  std::string shown = text(to_answer(
      shown_case(*store_, campaign, store_->stored_case(campaign.id, "5"), {.fault = "F2"})));
  const std::string folder = (folder_ / "store").string();  // the one thing that is not told
  for (std::size_t at; (at = shown.find(folder)) != std::string::npos;)
    shown.replace(at, folder.size(), "STORE");
  EXPECT_EQ(get("/api/campaigns/sweep/cases/5?fault=F2").body, shown);
}

/// The page may run its own scripts and ask its own server; nothing else may do either.
TEST_F(StoreApiTest, ThePageRunsItsOwnScriptsOnly) {
  const HttpResponse page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_THAT(page.policy, ::testing::MatchesRegex(
                               "default-src 'none'; script-src 'sha256-[^ ]+' 'sha256-[^ ]+'; .*"));
  EXPECT_THAT(page.policy, HasSubstr("connect-src 'self'"));
  EXPECT_THAT(page.policy, Not(HasSubstr("script-src 'unsafe")));
  EXPECT_THAT(get("/api").policy, Not(HasSubstr("script-src")));
}

/// One value, two renderings; heads know what the ranking is sorted by.
TEST_F(StoreApiTest, AnswersAreRenderedAsPartsOfAPageToo) {
  const HttpResponse response = get("/api/campaigns/sweep/ranking?rows=7&as=html");
  const Store reader = Store::open_reader(folder_ / "store");
  RankRequest request;
  request.top = 7;
  request.skip = 0;
  EXPECT_EQ(response.body,
            render_html(to_answer(make_ranking(reader, reader.campaign("sweep"), request))));
  EXPECT_EQ(response.type, "text/html; charset=utf-8");
  EXPECT_THAT(response.body, HasSubstr("<th data-key=\"strength\" data-by=\"strength\">"));
  EXPECT_THAT(response.body, HasSubstr("data-by=\"max_slip\">slip, m</th>"));
  EXPECT_THAT(response.body, HasSubstr("<th data-key=\"case\">"));
  error_at("/api/campaigns/sweep/ranking?as=xml", 400);
}

/// A page gets the steps of a case with what its slider changes.
TEST_F(StoreApiTest, StepsOfACaseComeWithTheirSlider) {
  const std::string part = get("/api/campaigns/sweep/cases/5/steps").body;
  EXPECT_THAT(part, HasSubstr("data-case=\"5\""));
  EXPECT_THAT(part, HasSubstr("<input type=\"range\""));
  EXPECT_THAT(part, HasSubstr("\"step\":1"));
}

/// A scene may name files; no request may. @return the problem's cause.
std::string refused_change(const std::vector<serve::Slider>& sliders, const json& changes) {
  try {
    serve::require_allowed(sliders, changes);
  } catch (const HttpError& error) {
    return error.problem().cause;
  }
  return "";
}

TEST(Sliders, HaveTheRangesOfTheSpecAndLetNothingElseBeChanged) {
  std::ostringstream text;
  text << std::ifstream(kBaseScene).rdbuf();
  const json spec = {
      {"groups",
       {{{"parameters",
          {{{"name", "friction_angle"},
            {"range",
             {{"pointers", {"/friction/friction_angle"}}, {"from_si", 0.2}, {"to_si", 0.6}}}},
           {{"name", "salt_stiffness"},
            {"range",
             {{"pointers", {"/materials/salt/youngs_modulus"}},
              {"from_si", 2e10},
              {"to_si", 8e10},
              {"spacing", "log"}}}},
           {{"name", "rule"},
            {"choices",
             {{{"text", "min"}, {"changes", {{"/fault_pressure/rule", "min"}}}},
              {{"text", "max"}, {"changes", {{"/fault_pressure/rule", "max"}}}}}}}}}}}}};
  const std::vector sliders = serve::sliders_of(json::parse(text.str()), spec.dump());
  ASSERT_GT(sliders.size(), 5u);
  EXPECT_EQ(sliders[0].name, "friction angle");
  EXPECT_EQ(sliders[0].unit, "deg");
  EXPECT_NEAR(sliders[0].from, 0.2 * 180 / M_PI, 1e-6);
  EXPECT_NEAR(sliders[0].to, 0.6 * 180 / M_PI, 1e-6);
  EXPECT_TRUE(sliders[0].keeps_operator);
  EXPECT_FALSE(sliders[1].keeps_operator);
  EXPECT_TRUE(sliders[1].is_log);
  EXPECT_EQ(sliders[2].choices.size(), 2u);
  for (std::size_t k = 3; k < sliders.size(); ++k) {
    EXPECT_TRUE(sliders[k].keeps_operator) << sliders[k].name;
    EXPECT_FALSE(sliders[k].of_campaign);
    EXPECT_LE(sliders[k].from, sliders[k].value) << sliders[k].name;
    EXPECT_LT(sliders[k].from, sliders[k].to) << sliders[k].name;
  }
  EXPECT_EQ(refused_change(sliders, {{"/friction/friction_angle", "22 deg"}}), "");
  EXPECT_EQ(refused_change(sliders, {{"/fault_pressure/rule", "max"}}), "");
  for (const json& changes :
       {json{{"/fault_pressure/rule", "csv"}}, json{{"/pressure_field/file", "/etc/passwd"}},
        json{{"/friction/friction_angle", "/etc/passwd"}},
        json{{"/friction/friction_angle", json::array()}}, json{{"", json::object()}}})
    EXPECT_THAT(refused_change(sliders, changes), HasSubstr("cannot be changed")) << changes;
}

TEST_F(StoreApiTest, PagesOfARankingMakeTheWholeRanking) {
  for (const std::string order : {"", "&by=chi_bar&order=ascending", "&fault=F2", "&by=offset"}) {
    RankRequest all;
    if (order.find("chi_bar") != std::string::npos) all.by = "chi_bar";
    if (order.find("offset") != std::string::npos) all.by = "offset";
    if (order.find("F2") != std::string::npos) all.fault = "F2";
    all.ascending = order.find("ascending") != std::string::npos;
    all.top = 0;
    const CampaignInfo campaign = store_->campaign("sweep");
    const json whole = render_json(to_answer(make_ranking(*store_, campaign, all))).at("cases");
    ASSERT_EQ(whole.size(), kResults);
    json pages = json::array();
    for (int page = 1; page <= 5; ++page) {
      const json one =
          json_at("/api/campaigns/sweep/ranking?rows=7&page=" + std::to_string(page) + order);
      EXPECT_EQ(one.at("rows"), kResults);
      EXPECT_EQ(one.at("skipped"), 7 * (page - 1));
      for (const json& row : one.at("cases")) pages.push_back(row);
    }
    EXPECT_EQ(pages, whole) << order;
    const json behind = json_at("/api/campaigns/sweep/ranking?rows=7&page=9" + order);
    EXPECT_EQ(behind.at("cases").size(), 0);
    EXPECT_THAT(behind.at("headline").at(0).get<std::string>(), HasSubstr("none after row 56"));
  }
}

TEST_F(StoreApiTest, ARunningCampaignIsSeenAsItGrows) {
  EXPECT_EQ(json_at("/api/campaigns/sweep").at("done"), kResults);
  StoreApi api(folder_ / "store");
  const auto done = [&] {
    const HttpResponse response = api.answer(parse_target("/api/campaigns/sweep"));
    return response.status == 200 ? json::parse(response.body).at("done").get<long>() : -1;
  };
  const auto ranked = [&] {  // counts are kept until something is added
    return json::parse(api.answer(parse_target("/api/campaigns/sweep/ranking")).body).at("rows");
  };
  EXPECT_EQ(done(), kResults);
  EXPECT_EQ(ranked(), kResults);
  EXPECT_EQ(ranked(), kResults);
  record(kResults, kResults + 3);
  EXPECT_EQ(done(), kResults + 3);
  EXPECT_EQ(ranked(), kResults + 3);
}

TEST_F(StoreApiTest, DrawsCampaignsAndCases) {
  for (const char* drawing : {"map.svg?x=offset&y=strength", "probability.svg?of=slides",
                              "cases/5/history.svg?cursor=yes&step=3", "cases/5/section.svg",
                              "cases/5/thickness.svg", "cases/5/slip.svg?fault=F2"}) {
    const HttpResponse response = get(std::string("/api/campaigns/sweep/") + drawing);
    EXPECT_EQ(response.status, 200) << drawing << response.body;
    EXPECT_EQ(response.type, "image/svg+xml");
    EXPECT_EQ(faultsim::figure::xml_problem(response.body), "") << drawing;
  }
  EXPECT_NE(get("/api/campaigns/sweep/cases/5/section.svg?step=2").body,
            get("/api/campaigns/sweep/cases/5/section.svg?step=9").body);
}

TEST_F(StoreApiTest, RefusesWithPlaceCauseAndCure) {
  EXPECT_EQ(error_at("/nothing", 404).at("place"), "path");
  EXPECT_EQ(error_at("/api/campaigns/sweep/ranking/x", 404).at("place"), "path");
  EXPECT_THAT(error_at("/api/campaigns/sweeep", 404).at("cure").get<std::string>(),
              HasSubstr("sweep"));
  EXPECT_EQ(error_at("/api/campaigns/sweep/cases/41", 404).at("place"), "case");
  EXPECT_EQ(error_at("/api/campaigns/sweep/cases/x/history.svg", 404).at("place"), "case");
  EXPECT_THAT(error_at("/api/campaigns/sweep/ranking?wher=1", 400).at("cure").get<std::string>(),
              HasSubstr("where"));
  EXPECT_EQ(error_at("/api/campaigns/sweep/ranking?where=offset+%3E", 400).at("place"),
            "expression");
  EXPECT_EQ(error_at("/api/campaigns/sweep/ranking?stage=nowhere", 400).at("place"), "stage");
  EXPECT_EQ(error_at("/api/campaigns/sweep/ranking?by=a&by=b", 400).at("place"), "by");
  for (const std::string rows :
       {"0", "1001", "-1", "1e2", "", "x", "9999999999999999999999", "7%20"}) {
    EXPECT_EQ(error_at("/api/campaigns/sweep/ranking?rows=" + rows, 400).at("place"), "rows")
        << rows;
  }
  EXPECT_EQ(error_at("/api/campaigns/sweep/ranking?order=up", 400).at("place"), "order");
  EXPECT_EQ(error_at("/api/campaigns/sweep/probability?confidence=nan", 400).at("place"),
            "confidence");
  EXPECT_EQ(error_at("/api/campaigns/sweep/sensitivity?by_step=perhaps", 400).at("place"),
            "by_step");
  EXPECT_EQ(error_at("/api/campaigns/sweep/cases/35/history.svg", 400).at("place"), "case");
}

/// Also where the answers of the commands name the folder: fields, the spec's file, a lost store.
TEST_F(StoreApiTest, NoPathOfTheMachineIsInAnyResponse) {
  const std::string here = folder_.string();
  for (const char* target :
       {"/api/campaigns/sweep", "/api/campaigns/sweep/cases/5",
        "/api/campaigns/sweep/cases/5/explanation", "/api/campaigns/sweep/cases/5/profiles.svg"}) {
    EXPECT_THAT(get(target).body, Not(HasSubstr(here))) << target;
  }
  EXPECT_THAT(json_at("/api/campaigns/sweep").at("source"), "spec.json");
  EXPECT_THAT(get("/api/campaigns/sweep/cases/5").body, HasSubstr("STORE/fields/sweep/5"));
  StoreApi lost(folder_ / "other");
  const HttpResponse response = lost.answer(parse_target("/api/campaigns"));
  EXPECT_EQ(response.status, 503);
  EXPECT_THAT(response.body, Not(HasSubstr(here)));
  EXPECT_THAT(response.remark, HasSubstr((folder_ / "other").string()));
  EXPECT_THROW(lost.require_store(), StorageError);
  EXPECT_NO_THROW(StoreApi(folder_ / "store").require_store());
}

/// Another store in the place of one that is open.
TEST_F(StoreApiTest, AnotherFileInItsPlaceIsSeen) {
  StoreApi api(folder_ / "store");
  const HttpRequest request = parse_target("/api/campaigns/sweep/cases/39");
  EXPECT_EQ(api.answer(request).status, 200);
  store_.reset();
  std::filesystem::rename(folder_ / "store", folder_ / "before");
  EXPECT_EQ(api.answer(request).status, 503);
  Submission s;
  s.name = "another";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  s.cases = {{"identity", 0, 0, "{}", {}}};
  Store::open_writer(folder_ / "store").submit(s);
  EXPECT_EQ(api.answer(request).status, 404);
  EXPECT_EQ(api.answer(parse_target("/api/campaigns/another")).status, 200);
}

TEST_F(StoreApiTest, ADamagedStoreIsAResponseToo) {
  store_.reset();
  std::filesystem::resize_file(folder_ / "store" / "campaign.sqlite", 5000);
  std::filesystem::remove(folder_ / "store" / "campaign.sqlite-wal");
  const HttpResponse response = get("/api/campaigns/sweep/ranking");
  EXPECT_THAT(response.status, AnyOf(500, 503));
  EXPECT_TRUE(json::parse(response.body).contains("error"));
  EXPECT_NE(response.remark, "");
}

/// Parameters of all kinds with values that are mostly wrong: every one has an answer.
TEST_F(StoreApiTest, RandomRequestsAreAnswered) {
  std::mt19937 dice(36);
  const auto one_of = [&](const std::vector<std::string>& words) {
    return words[dice() % words.size()];
  };
  const std::vector<std::string> values = {"",
                                           "1",
                                           "-1",
                                           "0.95",
                                           "F1",
                                           "F2",
                                           "gas_storage",
                                           "chi_bar",
                                           "strength > 0.5",
                                           "yes",
                                           "offset",
                                           "((((((",
                                           "\" or 1=1 --",
                                           "F2.slides in gas_storage",
                                           "1e999",
                                           "nan",
                                           "slides;",
                                           "'; DROP TABLE cases; --",
                                           "strength / 0 > 1",
                                           "\u202e",
                                           "max_slip",
                                           "F2 did not slide before 8 yr +- 0.5 yr",
                                           std::string(3000, 'x'),
                                           "ascending",
                                           "2147483648"};
  std::vector<json> routes = json_at("/api").at("routes");
  std::set<int> statuses;
  StoreApi api(folder_ / "store");
  constexpr int kRequests = 1200;
  for (int k = 0; k < kRequests; ++k) {
    const json& route = routes[dice() % routes.size()];
    HttpRequest request;
    std::istringstream path(route.at("path").get<std::string>().substr(1));
    for (std::string part; std::getline(path, part, '/');) {
      if (part == "{campaign}") part = dice() % 8 == 0 ? one_of(values) : "sweep";
      if (part == "{case}") part = dice() % 2 == 0 ? one_of(values) : std::to_string(dice() % 45);
      request.path.push_back(part);
    }
    for (const auto& [name, meaning] : route.at("parameters").items())
      if (dice() % 4 == 0) request.query.emplace_back(name, one_of(values));
    if (dice() % 32 == 0) request.query.emplace_back(one_of(values), one_of(values));
    const HttpResponse response = api.answer(request);
    statuses.insert(response.status);
    ASSERT_THAT(response.status, AnyOf(200, 400, 404, 503))
        << k << response.body << response.remark;
    if (response.status != 200) {
      ASSERT_TRUE(json::parse(response.body).contains("error"));
    }
    ASSERT_EQ(response.remark, "");
    ASSERT_EQ(response.body.find(folder_.string()), std::string::npos) << k;
  }
  EXPECT_THAT(statuses, ::testing::ElementsAre(200, 400, 404, 503));
}

}  // namespace
}  // namespace faultsweep
