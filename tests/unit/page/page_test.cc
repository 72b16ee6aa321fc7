// A run as one page, and its scene read back from it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "simulator/common/errors.h"
#include "simulator/documents/json_document.h"
#include "simulator/page/run_page.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_sentences.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

const char* const kScene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";

/// Two steps of one stage; F2 slides in it, and whether F3 does is open.
CaseResult small_result() {
  CaseResult result;
  result.title = "a <small> case";
  result.identity = "0123";
  result.outcome = Outcome::converged;
  result.fault_names = {"F1", "F2", "F3"};
  result.region_names = {"west", "east"};
  for (int k = 0; k < 2; ++k) {
    StepResult step;
    step.step = k;
    step.stage = k == 0 ? "initial" : "primary_production";
    step.time = 1e8 * k;
    step.outcome = Outcome::converged;
    step.pressure_change = {-1e7 * k, -5e6 * k};
    step.faults.resize(3);
    step.faults[1].chi_bar = 0.5 + 0.5 * k;
    result.steps.push_back(step);
  }
  StageMetrics stage;
  stage.stage = "primary_production";
  stage.first_step = stage.last_step = 1;
  stage.faults.resize(3);
  for (std::size_t f = 0; f < 3; ++f) stage.faults[f].fault = result.fault_names[f];
  stage.faults[1].activated = true;
  stage.faults[1].max_slip = 0.0123;
  stage.faults[1].activation = FaultOnset{.step = 1, .depth = 2080, .pressures = {}};
  stage.faults[2].activation_resolved = false;
  result.stages = {stage};
  result.whole = stage;
  result.whole.activated = true;
  result.warnings = {"a warning & what follows"};
  return result;
}

std::string page_of(const CaseResult& result, const std::string& scene_text) {
  const Scene scene = read_scene(parse_json(scene_text, "scene"));
  return run_page({result, scene, nullptr, {}}, scene_text, "faultsim 1.2 (commit 345)");
}

std::string field_text() { return read_json_file(kScene).value.dump(); }

TEST(RunPage, SaysWhatBecameOfTheRun) {
  const CaseResult result = small_result();
  const std::string page = page_of(result, field_text());
  EXPECT_THAT(page, HasSubstr("<title>a &lt;small&gt; case</title>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"answer\">" + sliding_sentence(result) + "</p>"));
  EXPECT_THAT(
      page,
      HasSubstr(
          "<td class=\"words\">F2</td><td>0</td><td class=\"words\">slides</td><td>12.3</td>"));
  EXPECT_THAT(
      page, HasSubstr("<td class=\"words\">F3</td><td>0</td><td class=\"words\">unresolved</td>"));
  EXPECT_THAT(page, HasSubstr("step 1, " + pressures_text({}, 2080)));
  EXPECT_THAT(page, HasSubstr("a warning &amp; what follows"));
  EXPECT_THAT(page, HasSubstr("The cells are those of tier standard. Measured in plane strain "
                              "against small ones: χ̄ within 0.018 (rms 0.005)"));
  EXPECT_THAT(page, HasSubstr("faultsim 1.2 (commit 345)"));
  EXPECT_THAT(page, HasSubstr("No fields of this run were kept"));
  EXPECT_EQ(page, page_of(result, field_text())) << "the same bytes again";
}

/// No more digits than are known, however large; names without their dashes.
TEST(RunPage, HasStagesAsReadersSayThem) {
  CaseResult result = small_result();
  result.stages[0].faults[1].moment = 9920794;
  const std::string page = page_of(result, field_text());
  EXPECT_THAT(page, HasSubstr("<td>9,920,000</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"words\">primary production</td>"));
}

TEST(RunPage, AsksForNothing) {
  std::string page = page_of(small_result(), field_text());
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'sha256-"));
  const std::string name = "http://www.w3.org/2000/svg";  // is never fetched
  while (page.find(name) != std::string::npos) page.erase(page.find(name), name.size());
  for (const char* word : {"http://", "https://", "src=", "onclick", "onload", "javascript:"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

/// A box has no section across it, so no slider; the script finds none and goes on.
TEST(RunPage, OfABoxHasItsHistoryAlone) {
  const std::string page = page_of(small_result(), starter_scene("box"));
  EXPECT_THAT(page, Not(HasSubstr("<div data-case")));
  EXPECT_THAT(page, Not(HasSubstr("<div class=\"slider\"")));
  EXPECT_THAT(page, HasSubstr("<svg"));
}

/// What cannot be drawn is said, and leaves nothing half open that would stop the script.
TEST(RunPage, WithoutStepsSaysWhy) {
  CaseResult result = small_result();
  result.steps.clear();
  result.outcome = Outcome::unconverged;
  result.reason = "the first step found no equilibrium";
  const std::string page = page_of(result, field_text());
  EXPECT_THAT(page, HasSubstr("unconverged: the first step found no equilibrium"));
  EXPECT_THAT(page, Not(HasSubstr("<div data-case")));
  EXPECT_THAT(page, HasSubstr("class=\"faint\""));
}

class PageFile : public testing::Test {
 protected:
  void SetUp() override { path_ = testing::TempDir() + "page_test.html"; }
  void TearDown() override { std::filesystem::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  std::string path_;
};

/// Also where a title would end the element.
TEST_F(PageFile, IsASceneAgain) {
  nlohmann::json scene = nlohmann::json::parse(field_text());
  scene["title"] = "</script><script>alert(1)</script>";
  const std::string page = page_of(small_result(), scene.dump());
  write(page);
  const JsonDocument read = read_json_file(path_);
  EXPECT_EQ(read.value, scene);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  // A message about the scene names its line in the page.
  std::istringstream lines(page);
  std::string line;
  for (int n = read.line_of("/tier"); n > 0; --n) std::getline(lines, line);
  EXPECT_THAT(line, HasSubstr("\"tier\""));
}

TEST_F(PageFile, WithoutASceneIsRefused) {
  write("<!DOCTYPE html><title>something else</title>");
  try {
    read_json_file(path_);
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the page contains no scene"));
  }
}

}  // namespace
}  // namespace faultsim
