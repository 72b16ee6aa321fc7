#include "simulator/what_if/resident_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <random>

#include "simulator/reading/read_scene.h"
#include "simulator/result/result_bytes.h"

namespace faultsim {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

JsonDocument field() {
  JsonDocument document = parse_json(starter_scene("field"), "field.json");
  set_value(document, "/tier", "screening");
  return document;
}

/// All of a result but how long it took.
std::string bits(CaseResult result) {
  result.seconds = 0;
  for (StepResult& step : result.steps) step.seconds = 0;
  return result_to_bytes(result);
}

/// What was told last of each question.
struct Told {
  std::mutex mutex;
  std::map<long, QuestionState> last;
  void operator()(long number, const QuestionProgress& progress) {
    const std::lock_guard lock(mutex);
    const auto found = last.find(number);
    EXPECT_TRUE(found == last.end() || QuestionProgress{found->second}.is_open()) << number;
    last[number] = progress.state;
  }
};

/// Step by step, where nothing lies between the words; most runs are over before 100 ms.
TEST(ResidentCase, SaysHowFarARunIs) {
  for (const auto between : {0ms, 100'000ms}) {
    std::vector<std::string> said;
    ResidentCase resident({}, 1, between);
    resident.listen([&](long, const QuestionProgress& how) {
      if (how.state == QuestionState::running && !how.says.empty()) said.push_back(how.says);
    });
    resident.ask(1, field(), {});
    const QuestionProgress end = resident.wait(1, 60s);
    ASSERT_EQ(end.state, QuestionState::done);
    if (between > 0ms) {
      EXPECT_THAT(said, IsEmpty());
      continue;
    }
    ASSERT_EQ(said.size(), end.shown->result.steps.size());
    EXPECT_EQ(said.back(), end.shown->result.steps.back().stage + ", 100 %");
    EXPECT_THAT(said.front(), Not(HasSubstr(" 100 %")));
  }
}

TEST(ResidentCase, ShowsTheLastOfManyQuestionsToTheLastBit) {
  Told told;
  ResidentCase resident({}, 2);
  resident.listen(std::ref(told));
  std::mt19937 random(3);
  const auto between = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
  };
  Changes changes;
  long last = 0;
  for (int k = 0; k < 200; ++k) {
    changes = {{"friction_angle", concat(between(15, 35), " deg")},
               {"ratio_across", concat(between(0.4, 0.8))}};
    if (k % 50 == 7) changes.push_back({"offset", k % 100 == 7 ? "40 m" : "80 m"});
    resident.ask(last = 10 + k, field(), changes);
  }
  const QuestionProgress end = resident.wait(last, 60s);
  ASSERT_EQ(end.state, QuestionState::done);
  EXPECT_EQ(resident.progress(10).state, QuestionState::superseded);
  Simulation fresh = Simulation::from_text(field().value.dump());
  EXPECT_EQ(bits(end.shown->result), bits(fresh.run(changes)));
  EXPECT_EQ(end.shown->result.identity, fresh.identity());
  Simulation of_document = Simulation::from_text(end.shown->document.value.dump());
  EXPECT_EQ(of_document.identity(), fresh.identity()) << "the scene that is shown is the one asked";
  EXPECT_EQ(end.shown->fields.steps().size(), end.shown->result.steps.size());
  const std::lock_guard lock(told.mutex);
  EXPECT_EQ(told.last.size(), 200U);
  EXPECT_EQ(told.last.at(last), QuestionState::done);
  for (const auto& [number, state] : told.last) {
    EXPECT_FALSE(QuestionProgress{state}.is_open()) << "question " << number << " is left open";
  }
}

TEST(ResidentCase, RefusesAWrongQuestionAndGoesOnWithTheOneBefore) {
  ResidentCase resident({});
  constexpr long good = 1;
  resident.ask(good, field(), {{"friction_angle", "20 deg"}});
  try {
    resident.ask(2, field(), {{"friction_angle", "20 bar"}, {"biot", "7"}});
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("friction_angle"));
    EXPECT_THAT(error.what(), HasSubstr("biot"));
  }
  EXPECT_EQ(resident.wait(good, 60s).state, QuestionState::done);
}

/// While salt creeps there is time to ask again.
TEST(ResidentCase, CallsOffWhatIsUnderWay) {
  ResidentCase resident({});
  JsonDocument creeping = field();
  for (const char* change : {"salt", "reservoir"}) {
    set_value(creeping, concat("/materials/", change, "/viscosity"), "1e17 Pa s");
  }
  constexpr long slow = 1, quick = 2;
  resident.ask(slow, std::move(creeping), {});
  while (resident.progress(slow).state == QuestionState::building) std::this_thread::yield();
  EXPECT_EQ(resident.progress(slow).state, QuestionState::running);
  resident.ask(quick, field(), {});
  EXPECT_EQ(resident.progress(slow).state, QuestionState::superseded);
  EXPECT_EQ(resident.wait(slow, 0ms).state, QuestionState::superseded);
  EXPECT_EQ(resident.wait(quick, 60s).state, QuestionState::done);
}

/// Dragging what keeps the operator does not keep it from being built.
TEST(ResidentCase, GoesOnWithABuildThatTheNewestQuestionNeeds) {
  ResidentCase resident({});
  JsonDocument fine = field();
  set_value(fine, "/mesh/dip", "4 m");
  constexpr long first = 1, second = 2;
  resident.ask(first, fine, {});
  while (resident.progress(first).state == QuestionState::running) std::this_thread::yield();
  ASSERT_EQ(resident.progress(first).state, QuestionState::building);
  resident.ask(second, fine, {{"friction_angle", "20 deg"}});
  EXPECT_EQ(resident.progress(second).state, QuestionState::building);
  const QuestionProgress end = resident.wait(second, 60s);
  ASSERT_EQ(end.state, QuestionState::done);
  EXPECT_EQ(resident.progress(first).state, QuestionState::superseded);
  resident.ask(3, field(), {{"offset", "60 m"}});  // is ended with its thread
}

}  // namespace
}  // namespace faultsim
