#include "campaign/reports/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ExactNumber, ReadsBackAsTheSameBitsInTheFewestDigits) {
  EXPECT_EQ(exact_number(0.1), "0.1");
  EXPECT_EQ(exact_number(1e15), "1e+15");
  EXPECT_EQ(exact_number(-0.0), "-0");
  EXPECT_EQ(exact_number(std::nan("")), "nan");
  std::mt19937_64 random(7);
  for (int k = 0; k < 1000; ++k) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(exact_number(value).c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value));
  }
}

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_field("plain 1.5"), "plain 1.5");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("#1"), "\"#1\"") << "no comment";
  EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_name("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_name(std::string("a\x1b[31m\a\0b", 9)), "a\\u001b[31m\\u0007\\u0000b");
  EXPECT_EQ(csv_name("\xE2\x80\xAE"
                     "exe \xff"),
            "\\u202eexe \\xff");
  EXPECT_EQ(csv_name("=1+1"), "'=1+1");
  EXPECT_EQ(csv_name("@SUM(A1,2)"), "\"'@SUM(A1,2)\"");
  EXPECT_EQ(csv_name("-2+3|cmd"), "'-2+3|cmd");
  EXPECT_EQ(csv_name("+A1"), "'+A1");
  EXPECT_EQ(csv_name("-"), "'-");
  for (const char* number : {"-5", "+1.5e3 bar", "-100 bar", "-2 kg/m3", "-1e-9"})
    EXPECT_EQ(csv_name(number), number);
  EXPECT_EQ(csv_cell(Cell(-0.5)), "-0.5");
  EXPECT_EQ(csv_cell(Cell(std::string("=A1"))), "'=A1");
}

TEST(OneWord, HasNoBlanksAndIsNeverEmpty) {
  EXPECT_EQ(one_word("-100 bar"), "-100_bar");
  EXPECT_EQ(one_word(""), "_");
  EXPECT_EQ(one_word("a\tb\"c"), "a_b_c");
}

TEST(ColumnName, HasTheUnitThatTheViewsHave) {
  EXPECT_EQ(column_name("moment", Dimension::moment), "moment_nm");
  EXPECT_EQ(column_name("event_magnitude", Dimension::number), "event_magnitude_mw");
  EXPECT_EQ(column_name("friction_angle", Dimension::angle), "friction_angle_rad");
  EXPECT_EQ(column_name("chi_bar", Dimension::number), "chi_bar");
  EXPECT_EQ(column_name("F2.max_slip in gas_storage", Dimension::length),
            "F2.max_slip_in_gas_storage_m");
  const MetricInfo moment{"moment", Dimension::moment, false, ""};
  const MetricInfo slip{"max_slip", Dimension::length, false, ""};
  EXPECT_EQ(column_name(moment, true), "moment_nm_per_m");
  EXPECT_EQ(column_name(slip, true), "max_slip_m");
}

TEST(ChooseMetrics, KeepsTheOrderAndNamesTheNearest) {
  const auto chosen = choose_metrics(Selection{}, "max_slip, moment", false, false);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].name, "max_slip");
  EXPECT_EQ(chosen[1].name, "moment");
  try {
    choose_metrics(Selection{}, "momemt", true, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'moment'?"));
  }
  EXPECT_EQ(choose_metrics(Selection{}, "", true, true).size(), metric_catalogue().size());
}

TEST(ChooseMetrics, ListsHoldNamesWithCommasAndQuotes) {
  Selection selection;
  selection.faults = {{1, "F2"}, {2, "north, old"}, {3, R"(5" 'b', c)"}, {4, " in \"x"}};
  selection.stages = {{5, ""}, {6, "first, 'year'"}, {7, "a in b"}};
  std::string list;
  std::vector<std::string> expected;
  for (const auto& [name, metric] : known_metrics(selection)) {
    list += (list.empty() ? "" : " , ") + metric.spelled;
    expected.push_back(name);
  }
  const auto chosen = choose_metrics(selection, list, true, true);
  ASSERT_EQ(chosen.size(), expected.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) EXPECT_EQ(chosen[k].name, expected[k]);
  EXPECT_EQ(choose_metrics(selection, "moment, \"north, old\".slides,", true, true).size(), 2u);
  EXPECT_THROW(choose_metrics(selection, "north, old.slides", true, true), InputError);
  EXPECT_THROW(choose_metrics(selection, "\"north, old.slides", true, true), InputError);
}

/// Lines of a CSV file as fields, as RFC 4180 has it.
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quoted && c == '"' && k + 1 < text.size() && text[k + 1] == '"') {
      rows.back().back() += text[++k];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<double> column_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> numbers;
  for (std::string word; file >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

class ExportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "export_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    s_.name = "sweep";
    s_.source = "sweep.json";
    s_.rank_by = "activated_area";
    s_.scenes = {{"scene.json", "{}"}};
    s_.families = {{"family-a", 1000, 100, 1, 1}};
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  void add_case(const CaseParameters& values) {
    s_.cases.push_back({"identity-" + std::to_string(s_.cases.size()), 0, 0, "{}", values});
  }
  void record(long case_id, std::optional<faultsim::CaseResult> result,
              RunStatus status = RunStatus::completed) {
    RunRecord run;
    run.case_id = case_id;
    run.status = status;
    run.reason = status == RunStatus::completed ? "" : "over 10 s, \"killed\"";
    run.result = std::move(result);
    store_->record_runs(campaign_.id, {run});
  }
  /// Of the parameters, those whose names begin with "derived" are not in the design.
  void submit() {
    nlohmann::json varied = nlohmann::json::array();
    for (const StoredParameter& one : s_.parameters) {
      if (!one.name.starts_with("derived")) varied.push_back({{"name", one.name}});
    }
    s_.spec_resolved = nlohmann::json{{"groups", {{{"parameters", varied}}}}}.dump();
    const std::int64_t id = store_->submit(s_).campaign;
    campaign_ = store_->campaign("");
    EXPECT_EQ(campaign_.id, id);
  }
  /// Five cases: offset and rule; 3 unstable, 4 hung, 5 not run.
  void submit_sweep() {
    s_.parameters = {{"rule", Dimension::number, true}, {"offset", Dimension::length, false}};
    const char* rules[] = {"mean", "-100 bar, \"low\"", "mean", "min", "min"};
    for (int k = 0; k < 5; ++k) {
      add_case({{0, std::nullopt, rules[k]}, {1, 100.0 * k / 3, std::to_string(k) + "/3 hm"}});
    }
    submit();
    record(1, testing::made_up_result(1.0 / 3));
    record(2, testing::made_up_result(0.9));
    auto unstable = testing::made_up_result(0.95);
    unstable.outcome = faultsim::Outcome::unstable;
    unstable.reason = "slip outran, step 7";
    record(3, unstable);
    record(4, std::nullopt, RunStatus::hung);
  }
  std::string run(ExportRequest request) {
    return export_campaign(*store_, store_->campaign(""), request);
  }
  ExportRequest to(ExportFormat format, const char* file) const {
    ExportRequest request;
    request.format = format;
    request.target = folder_ / file;
    return request;
  }
  /// The rows of a CSV export by the names of their columns.
  std::vector<std::map<std::string, std::string>> csv(const ExportRequest& request) {
    said_ = run(request);
    const auto rows = read_csv(text_of(request.target));
    std::vector<std::map<std::string, std::string>> named;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].size(), rows[0].size());
      named.emplace_back();
      for (std::size_t k = 0; k < rows[0].size(); ++k) named.back()[rows[0][k]] = rows[i][k];
      EXPECT_EQ(named.back().size(), rows[0].size()) << "two columns of one name";
    }
    return named;
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  Submission s_;
  CampaignInfo campaign_;
  std::string said_;
};

TEST_F(ExportTest, CsvHasEveryCaseWithItsBitsAndGapsAreEmpty) {
  submit_sweep();
  const auto rows = csv(to(ExportFormat::csv, "cases.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_THAT(said_, HasSubstr("5 cases of sweep, 2 without a result, 1 with a history that ends"));
  EXPECT_EQ(rows[1].at("rule"), "'-100 bar, \"low\"") << "not a formula";
  EXPECT_EQ(rows[1].at("offset"), "1/3 hm");
  EXPECT_EQ(std::strtod(rows[1].at("offset_m").c_str(), nullptr), 100.0 / 3);
  EXPECT_EQ(std::strtod(rows[0].at("chi_bar").c_str(), nullptr), 1.0 / 3);
  EXPECT_EQ(std::strtod(rows[1].at("moment_nm").c_str(), nullptr),
            testing::made_up_result(0.9).whole.moment);
  EXPECT_EQ(rows[1].at("activated_fault"), "F1");
  EXPECT_EQ(rows[1].at("slides"), "1");
  EXPECT_EQ(rows[0].at("activation_step"), "");
  EXPECT_EQ(rows[2].at("outcome"), "unstable");
  EXPECT_EQ(rows[2].at("rank_class"), "2");
  EXPECT_EQ(rows[2].at("reason"), "slip outran, step 7");
  EXPECT_EQ(rows[3].at("state"), "failed");
  EXPECT_EQ(rows[3].at("reason"), "hung: over 10 s, \"killed\"");
  EXPECT_EQ(rows[3].at("moment_nm"), "");
  EXPECT_EQ(rows[4].at("state"), "waiting");
  EXPECT_EQ(rows[0].count("creep_shear_max_pa"), 0u) << "nothing creeps";
}

TEST_F(ExportTest, CsvTakesTheMetricsStageAndCasesAskedFor) {
  submit_sweep();
  ExportRequest request = to(ExportFormat::csv, "cases.csv");
  request.metrics = "moment,creep_shear_max";
  request.where = "offset > 30 m and rule != \"min\"";
  request.stage = "gas_storage";
  const auto rows = csv(request);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("case"), "2");
  EXPECT_EQ(std::strtod(rows[0].at("moment_nm").c_str(), nullptr),
            testing::made_up_result(0.9).stages[2].moment);
  EXPECT_EQ(rows[0].at("creep_shear_max_pa"), "");
  EXPECT_EQ(rows[0].count("chi_bar"), 0u);
  request.stage = "storage";
  EXPECT_THROW(run(request), InputError);
}

TEST_F(ExportTest, AFailedExportLeavesNoFile) {
  submit_sweep();
  ExportRequest request = to(ExportFormat::csv, "cases.csv");
  request.where = "offset > 3 bar";
  EXPECT_THROW(run(request), InputError);
  request.where = "";
  request.metrics = "nonsense";
  EXPECT_THROW(run(request), InputError);
  request.metrics = "";
  request.target = folder_ / "store" / "campaign.sqlite" / "cases.csv";
  EXPECT_THROW(run(request), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cases.csv"));
}

TEST_F(ExportTest, ParametersCalledLikeAColumnDoNotHideIt) {
  s_.parameters = {{"outcome", Dimension::number, false}};
  add_case({{0, 7.0, "7"}});
  submit();
  record(1, testing::made_up_result(0.9));
  const auto rows = csv(to(ExportFormat::csv, "cases.csv"));
  EXPECT_EQ(rows[0].at("outcome"), "converged");
  EXPECT_EQ(rows[0].at("parameter_outcome"), "7");
}

TEST_F(ExportTest, HistoriesAreRowsOfCaseFaultAndStep) {
  submit_sweep();
  record(5, testing::made_up_result_with_events(0.7));
  ExportRequest request = to(ExportFormat::csv, "histories.csv");
  request.histories = true;
  const auto rows = csv(request);
  ASSERT_EQ(rows.size(), 4u * 2 * 13);
  const auto result = testing::made_up_result(0.9);
  const auto& row = rows[26 + 13 + 5];  // case 2, fault F2, step 5
  EXPECT_EQ(row.at("case"), "2");
  EXPECT_EQ(row.at("fault"), "F2");
  EXPECT_EQ(row.at("step"), "5");
  EXPECT_EQ(row.at("stage"), "cushion_gas_injection");
  EXPECT_EQ(std::strtod(row.at("chi_bar").c_str(), nullptr), result.steps[5].faults[1].chi_bar);
  EXPECT_EQ(row.at("time_steps"), "");
  EXPECT_EQ(nlohmann::json::parse(row.at("pressure_change_pa")).size(), 2u);
  const auto creeping = testing::made_up_result_with_events(0.7);
  EXPECT_EQ(std::strtod(rows.back().at("creep_shear_max_pa").c_str(), nullptr),
            creeping.steps[12].creep->faults[1].shear_max);
  request.stage = "gas_storage";
  EXPECT_EQ(csv(request).size(), 4u * 2 * 4);
  request.format = ExportFormat::dakota;
  EXPECT_THROW(run(request), InputError);
}

/// As Dakota reads annotated tabular files: labels discarded, then words by operator>>.
TEST_F(ExportTest, DakotaReadsEveryRow) {
  submit_sweep();
  ExportRequest request = to(ExportFormat::dakota, "points.dat");
  request.metrics = "chi_bar,moment";
  EXPECT_THAT(run(request),
              HasSubstr("2 of 5 cases of sweep; left out, as Dakota cannot read NaN: 2 "
                        "without a result, 1 whose history ends early, 0 without "
                        "one of the parameters"));
  std::ifstream file(request.target);
  std::string header;
  std::getline(file, header);
  EXPECT_EQ(header, "%eval_id interface offset_m rule chi_bar moment_nm");
  std::vector<std::size_t> ids;
  std::vector<std::string> words;
  std::vector<double> moments;
  while (file >> std::ws && !file.eof()) {
    std::size_t id = 0;
    std::string interface, word;
    double offset = 0, chi = 0, moment = 0;
    ASSERT_TRUE(file >> id >> interface >> offset >> word >> chi >> moment);
    ids.push_back(id);
    words.push_back(word);
    moments.push_back(moment);
  }
  EXPECT_THAT(ids, ElementsAre(1, 2));
  EXPECT_THAT(words, ElementsAre("mean", "-100_bar,__low_"));
  EXPECT_EQ(moments[1], testing::made_up_result(0.9).whole.moment);
  request.metrics = "activation_step";
  EXPECT_THAT(run(request), HasSubstr("1 without activation_step"));
}

TEST_F(ExportTest, DakotaRefusesWordsThatBecomeOne) {
  s_.parameters = {{"rule", Dimension::number, true}};
  for (const char* word : {"a b", "a_b"}) {
    add_case({{0, std::nullopt, word}});
  }
  submit();
  EXPECT_THROW(run(to(ExportFormat::dakota, "points.dat")), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "points.dat"));
}

TEST_F(ExportTest, SalibGetsLevelsForWordsAndNanForWhatIsNoFullHistory) {
  s_.n_excluded = 3;
  submit_sweep();
  const std::string said = run(to(ExportFormat::salib, "salib"));
  EXPECT_THAT(said, HasSubstr("NaN in Y: 2 without a result, 1 whose history ends early"));
  EXPECT_THAT(said, HasSubstr("need every row"));
  EXPECT_THAT(said, HasSubstr("3 rows of the designs are excluded by the spec"));
  const auto problem = nlohmann::json::parse(text_of(folder_ / "salib" / "problem.json"));
  EXPECT_EQ(problem["num_vars"], 2);
  EXPECT_EQ(problem["names"], nlohmann::json({"rule", "offset_m"}));
  EXPECT_EQ(problem["bounds"], nlohmann::json({{0, 2}, {0.0, 400.0 / 3}}));
  EXPECT_EQ(problem["levels"]["rule"], nlohmann::json({"mean", "-100 bar, \"low\"", "min"}));
  const auto x = column_of(folder_ / "salib" / "X.txt");
  ASSERT_EQ(x.size(), 10u);
  EXPECT_EQ(x[2], 1) << "in the order of the spec, which decides whose indices they are";
  EXPECT_EQ(x[3], 100.0 / 3);
  const auto y = column_of(folder_ / "salib" / "Y_chi_bar.txt");
  ASSERT_EQ(y.size(), 5u);
  EXPECT_EQ(y[0], 1.0 / 3);
  for (const int k : {2, 3, 4}) EXPECT_TRUE(std::isnan(y[static_cast<std::size_t>(k)]));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "salib" / "Y_activation_step.txt"));
  for (const auto& output : problem["outputs"]) {
    EXPECT_EQ(column_of(folder_ / "salib" / output["file"]).size(), 5u);
    EXPECT_EQ(output["n_nan"], 3);
  }
  ExportRequest nowhere;
  nowhere.format = ExportFormat::salib;
  EXPECT_THROW(run(nowhere), InputError);
}

/// First-order Sobol' indices with the estimator and row order of SALib.analyze.sobol (A, AB_1 ..
/// AB_D, B per sample; Saltelli et al. 2010), from the files alone.
std::vector<double> first_order(const std::filesystem::path& folder) {
  const auto problem = nlohmann::json::parse(text_of(folder / "problem.json"));
  const auto n_vars = problem["num_vars"].get<std::size_t>();
  const auto y = column_of(folder / "Y_moment.txt");
  const std::size_t step = n_vars + 2, n = y.size() / step;
  EXPECT_EQ(y.size() % step, 0u);
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (const double one : {y[i * step], y[i * step + step - 1]}) {
      mean += one / (2.0 * static_cast<double>(n));
      square += one * one / (2.0 * static_cast<double>(n));
    }
  }
  std::vector<double> indices;
  for (std::size_t j = 0; j < n_vars; ++j) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double a = y[i * step], ab = y[i * step + 1 + j], b = y[i * step + step - 1];
      sum += (b - mean) * (ab - a) / static_cast<double>(n);
    }
    indices.push_back(sum / (square - mean * mean));
  }
  return indices;
}

/// f = 4 x1 + 2 x2 + 3 x1 x3 on {0, 1, 2, 3}³: 64 cases for 5 x 4096 rows of a design, so that
/// nearly all rows are merged and the order of cases says nothing about that of rows.
TEST_F(ExportTest, SobolIndicesFromTheFilesAreThoseOfTheFunction) {
  const auto f = [](const std::array<int, 3>& x) { return 4 * x[0] + 2 * x[1] + 3 * x[0] * x[2]; };
  s_.parameters = {{"x1", Dimension::number, false},
                   {"derived_sum", Dimension::number, false},
                   {"x2", Dimension::length, false},
                   {"x3", Dimension::angle, false}};
  std::map<std::array<int, 3>, long> positions;
  for (int k = 63; k >= 0; --k) {
    const std::array<int, 3> x = {k / 16, k / 4 % 4, k % 4};
    add_case({{0, x[0], ""}, {1, x[0] + x[1], ""}, {2, x[1], ""}, {3, x[2], ""}});
    positions[x] = static_cast<long>(s_.cases.size());
  }
  std::mt19937 random(3);
  long row = 0;
  for (int i = 0; i < 4096; ++i) {
    std::array<int, 3> a{}, b{};
    for (int* one : {&a[0], &a[1], &a[2], &b[0], &b[1], &b[2]})
      *one = static_cast<int>(random() % 4);
    s_.design_rows.push_back({0, ++row, positions[a]});
    for (std::size_t j = 0; j < 3; ++j) {
      std::array<int, 3> ab = a;
      ab[j] = b[j];
      s_.design_rows.push_back({0, ++row, positions[ab]});
    }
    s_.design_rows.push_back({0, ++row, positions[b]});
  }
  submit();
  for (const auto& [x, position] : positions) {
    auto result = testing::made_up_result(0.9, 3);
    result.whole.moment = f(x);
    record(position, result);
  }
  ExportRequest request = to(ExportFormat::salib, "salib");
  request.metrics = "moment";
  EXPECT_THAT(run(request), HasSubstr("20480 rows of sweep in the order of the design"));
  // Var of 0..3 is 5/4, mean 3/2: V1 = (4 + 3·3/2)² 5/4, V2 = 2² 5/4, V3 = (3·3/2)² 5/4,
  // V13 = 3² (5/4)².
  const double v1 = 8.5 * 8.5 * 1.25, v2 = 4 * 1.25, v3 = 4.5 * 4.5 * 1.25, v13 = 9 * 1.25 * 1.25;
  const double v = v1 + v2 + v3 + v13;
  const std::vector<double> indices = first_order(folder_ / "salib");
  ASSERT_EQ(indices.size(), 3u);
  EXPECT_NEAR(indices[0], v1 / v, 0.03);
  EXPECT_NEAR(indices[1], v2 / v, 0.03);
  EXPECT_NEAR(indices[2], v3 / v, 0.03);
  // X has the same order: f of it is Y.
  const auto x = column_of(folder_ / "salib" / "X.txt");
  const auto y = column_of(folder_ / "salib" / "Y_moment.txt");
  ASSERT_EQ(x.size(), 3 * y.size());
  for (std::size_t k = 0; k < y.size(); ++k) {
    const auto at = [&](std::size_t j) { return static_cast<int>(x[3 * k + j]); };
    ASSERT_EQ(f({at(0), at(1), at(2)}), y[k]) << "row " << k;
  }
}

}  // namespace
}  // namespace faultsweep
