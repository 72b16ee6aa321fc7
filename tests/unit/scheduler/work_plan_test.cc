#include "campaign/scheduler/work_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

FamilyWork family(std::int64_t first_case, int n, double operator_seconds, bool cached = false) {
  FamilyWork work;
  work.id = first_case;
  work.cases.resize(static_cast<std::size_t>(n));
  std::iota(work.cases.begin(), work.cases.end(), first_case);
  work.operator_seconds = operator_seconds;
  work.memory_bytes = 1e9;
  work.operator_cached = cached;
  return work;
}

/// A family whose salt creeps: 1 GB of operators per worker.
FamilyWork creeping(std::int64_t first_case, int n, double operator_seconds) {
  FamilyWork work = family(first_case, n, operator_seconds);
  work.creeps = true;
  return work;
}

TEST(WorkPlan, MoreWorkMayComeWhileThereIsSomeAndWhenAllIsDone) {
  WorkPlan plan({family(1, 1, 5)}, {.n_workers = 1});
  ASSERT_TRUE(plan.next(0)->builds_operator);
  plan.operator_ready(0, 5, false);
  FamilyWork more = family(1, 0, 5);
  more.cases = {2};
  plan.add({more, family(100, 1, 3)});
  EXPECT_EQ(plan.n_families(), 2);
  EXPECT_EQ(plan.n_waiting(), 2);
  plan.case_done(0, 1, 0.1);
  const Slice own = *plan.next(0);
  EXPECT_THAT(own.cases, ElementsAre(2));
  EXPECT_FALSE(own.builds_operator) << "the family is known, and its operator is there";
  plan.case_done(0, 2, 0.1);
  const Slice other = *plan.next(0);
  EXPECT_EQ(other.family, 1);
  EXPECT_TRUE(other.builds_operator);
  plan.operator_ready(0, 3, false);
  plan.case_done(0, 100, 0.1);
  EXPECT_TRUE(plan.is_finished());
  more.cases = {3};
  plan.add({more});
  EXPECT_FALSE(plan.is_finished());
  EXPECT_THAT(plan.next(0)->cases, ElementsAre(3));
}

TEST(WorkPlan, BuildersShareTheCoresThatCasesLeave) {
  WorkPlan alone({family(1, 5, 50)}, {.n_workers = 4});
  alone.next(0);
  EXPECT_EQ(alone.build_threads(0, 8), 8);  // the others have nothing to build
  WorkPlan plan({family(1, 500, 50), family(1000, 500, 9), family(2000, 5, 9)}, {.n_workers = 4});
  plan.next(0);
  EXPECT_EQ(plan.build_threads(0, 8), 2);  // three more are about to, for two families: 8 / 3
  plan.next(1);
  plan.next(2);
  EXPECT_EQ(plan.build_threads(2, 8), 2);
  EXPECT_EQ(plan.build_threads(2, 2), 1);
  plan.operator_ready(0, 50, false);  // runs cases now
  EXPECT_EQ(plan.build_threads(2, 7), 3);
  for (int worker = 0; worker < 4; ++worker) plan.place(worker, worker);
  EXPECT_EQ(plan.build_threads(2, 7), 7);  // a host of its own
}

/// As of the exact twins of a few cases: each has an operator of its own, for which there is room
/// once the one before is built.
TEST(WorkPlan, AFewLastCasesTakeNoCoreFromABuild) {
  WorkPlan plan({family(1, 1, 50), family(11, 1, 40), family(21, 9000, 60)},
                {.n_workers = 2, .memory_bytes = 1.5e9});
  EXPECT_EQ(plan.next(0)->family, 2);
  plan.operator_ready(0, 60, false);
  EXPECT_EQ(plan.next(1)->family, 0);
  EXPECT_EQ(plan.build_threads(1, 2), 1) << "thousands of cases are left";
  WorkPlan few({family(1, 1, 50), family(11, 1, 40)}, {.n_workers = 2, .memory_bytes = 1.5e9});
  few.next(0);
  few.operator_ready(0, 50, false);
  EXPECT_EQ(few.next(1)->family, 1);
  EXPECT_EQ(few.build_threads(1, 2), 2);
}

TEST(WorkPlan, TakesCachedFamiliesFirstThenTheLongest) {
  WorkPlan plan({family(100, 5, 1), family(200, 5, 50), family(300, 5, 9, true)}, {.n_workers = 3});
  EXPECT_EQ(plan.next(0)->family, 2);
  EXPECT_EQ(plan.next(1)->family, 1);
  EXPECT_EQ(plan.next(2)->family, 0);
}

TEST(WorkPlan, OneWorkerBuildsWhileOthersWaitForTheOperator) {
  WorkPlan plan({family(1, 10, 5)}, {.n_workers = 2});
  const auto slice = plan.next(0);
  ASSERT_TRUE(slice);
  EXPECT_TRUE(slice->builds_operator);
  EXPECT_EQ(slice->cases.size(), 1u);
  EXPECT_FALSE(plan.next(1));
  EXPECT_TRUE(plan.is_building(0));
  plan.operator_ready(0, 5, false);
  EXPECT_TRUE(plan.next(1));
}

TEST(WorkPlan, SlicesGrowWithFastCasesAndShrinkTowardsTheEnd) {
  WorkPlan plan({family(1, 1000, 1)}, {.n_workers = 2});
  const auto first = plan.next(0);
  plan.operator_ready(0, 1, false);
  plan.case_done(0, first->cases[0], 0.002);
  std::vector<std::size_t> sizes;
  int worker = 0;
  while (auto slice = plan.next(worker)) {
    sizes.push_back(slice->cases.size());
    for (const auto id : slice->cases) plan.case_done(worker, id, 0.002);
    worker = 1 - worker;
  }
  EXPECT_EQ(sizes.front(), 125u);  // 0.25 s of work
  EXPECT_EQ(sizes.back(), 1u);
  EXPECT_TRUE(std::is_sorted(sizes.rbegin(), sizes.rend()));
  EXPECT_EQ(std::accumulate(sizes.begin(), sizes.end(), 0u), 999u);
  EXPECT_TRUE(plan.is_finished());
}

TEST(WorkPlan, KeepsAWorkerAheadButDoesNotHoard) {
  WorkPlan plan({family(1, 1000, 1, true)}, {.n_workers = 1});
  const auto first = plan.next(0);
  ASSERT_EQ(first->cases.size(), 1u);
  EXPECT_FALSE(plan.next(0));  // how long a case takes is not known yet
  plan.case_done(0, first->cases[0], 0.01);
  const auto second = plan.next(0);
  EXPECT_EQ(second->cases.size(), 25u);
  EXPECT_FALSE(plan.next(0));
  for (int k = 0; k < 20; ++k) plan.case_done(0, second->cases[static_cast<std::size_t>(k)], 0.01);
  EXPECT_TRUE(plan.next(0));
}

TEST(WorkPlan, KeepsOneCaseAheadOfCasesOfASecondWhileOthersHaveEnough) {
  WorkPlan plan({family(1, 12, 1, true)}, {.n_workers = 2});
  const auto first = plan.next(0);
  plan.case_done(0, first->cases[0], 0.7);
  ASSERT_EQ(plan.next(0)->cases.size(), 1u);
  ASSERT_EQ(plan.next(0)->cases.size(), 1u);  // the one ahead
  EXPECT_FALSE(plan.next(0));
  for (std::int64_t id = 2; id <= 7; ++id) {
    plan.case_done(0, id, 0.7);
    EXPECT_EQ(plan.next(0).has_value(), id <= 6) << id;  // the last four are for whoever is free
  }
}

TEST(WorkPlan, KeepsNoneAheadOfLongCases) {
  WorkPlan plan({family(1, 100, 1, true)}, {.n_workers = 1});
  plan.case_done(0, plan.next(0)->cases[0], 3);
  EXPECT_TRUE(plan.next(0));
  EXPECT_FALSE(plan.next(0));
}

TEST(WorkPlan, BuildsTwoOperatorsAtOnceOnlyIfBothFit) {
  WorkPlan plan({family(1, 3, 5), family(11, 3, 4)}, {.n_workers = 2, .memory_bytes = 1.5e9});
  EXPECT_TRUE(plan.next(0));
  EXPECT_FALSE(plan.next(1));
  plan.operator_ready(0, 5, false);
  EXPECT_EQ(plan.next(1)->family, 1);
  WorkPlan roomy({family(1, 3, 5), family(11, 3, 4)}, {.n_workers = 2, .memory_bytes = 2.5e9});
  EXPECT_TRUE(roomy.next(0));
  EXPECT_TRUE(roomy.next(1));
}

TEST(WorkPlan, LearnsHowMuchMemoryOperatorsTake) {
  const WorkPlan::Limits limits{.n_workers = 2, .memory_bytes = 1.7e9};
  const auto many = {family(1, 1, 5), family(11, 1, 4), family(21, 1, 3), family(31, 1, 2)};
  WorkPlan plan(many, limits);
  EXPECT_TRUE(plan.next(0));
  EXPECT_FALSE(plan.next(1)) << "1 GB each is predicted";
  plan.operator_ready(0, 5, false, 0.8e9);
  EXPECT_TRUE(plan.next(1));
  plan.case_done(0, 1, 1);
  EXPECT_TRUE(plan.next(0)) << "0.84 GB each, as the first took 0.8";
  WorkPlan worse(many, limits);
  worse.learn_memory(1e9, 0.8e9);
  worse.learn_memory(1e9, 0.82e9);
  EXPECT_TRUE(worse.next(0));
  EXPECT_FALSE(worse.next(1)) << "the worst counts";
  for (const double size : {0.7e9, 2.1e9}) {
    WorkPlan other(many, limits);
    other.learn_memory(size, 0.1e9);
    EXPECT_TRUE(other.next(0));
    EXPECT_FALSE(other.next(1)) << "operators of another size say nothing";
  }
  WorkPlan cached(many, limits);
  EXPECT_TRUE(cached.next(0));
  cached.operator_ready(0, 5, true, 0.1e9);
  cached.case_done(0, 1, 1);
  EXPECT_TRUE(cached.next(0));
  EXPECT_FALSE(cached.next(1)) << "what was read was not built";
}

TEST(WorkPlan, ABuilderWhoseNeighbourFindsNoRoomHasItsCores) {
  WorkPlan plan({family(1, 1, 5), family(11, 1, 4)}, {.n_workers = 2, .memory_bytes = 1.5e9});
  plan.next(0);
  EXPECT_EQ(plan.build_threads(0, 2), 2);
  WorkPlan roomy({family(1, 1, 5), family(11, 1, 4)}, {.n_workers = 2, .memory_bytes = 2.5e9});
  roomy.next(0);
  EXPECT_EQ(roomy.build_threads(0, 2), 1);
}

TEST(WorkPlan, EachHostHasItsOwnMemory) {
  WorkPlan plan({family(1, 3, 5), family(11, 3, 4), family(21, 3, 3)},
                {.n_workers = 3, .memory_bytes = 1.5e9});
  plan.place(0, 1);
  plan.place(1, 2);
  plan.place(2, 2);
  EXPECT_EQ(plan.next(0)->family, 0);
  EXPECT_EQ(plan.next(1)->family, 1);
  EXPECT_FALSE(plan.next(2)) << "another operator is being built on its host";
  WorkPlan creep({creeping(1, 20, 5), creeping(101, 20, 4)},
                 {.n_workers = 2, .memory_bytes = 1.5e9});
  creep.place(0, 1);
  creep.place(1, 2);
  EXPECT_TRUE(creep.next(0));
  EXPECT_TRUE(creep.next(1)) << "what is held on another host takes nothing here";
}

TEST(WorkPlan, RetriesAsOftenAsAskedThenGivesUp) {
  WorkPlan plan({family(1, 1, 1, true)},
                {.n_workers = 1, .on_failure = FailureAction::retry, .retries = 2});
  for (int attempt = 0; attempt < 3; ++attempt) {
    const auto slice = plan.next(0);
    ASSERT_TRUE(slice) << attempt;
    EXPECT_EQ(plan.case_failed(0, 1, false), attempt < 2);
  }
  EXPECT_FALSE(plan.next(0));
  EXPECT_TRUE(plan.is_finished());
}

TEST(WorkPlan, AbortStopsAtTheFirstFailure) {
  WorkPlan plan({family(1, 5, 1, true)}, {.n_workers = 1, .on_failure = FailureAction::abort});
  plan.next(0);
  EXPECT_FALSE(plan.case_failed(0, 1, false));
  EXPECT_FALSE(plan.next(0));
  EXPECT_TRUE(plan.is_finished());
  EXPECT_EQ(plan.n_waiting(), 4);
}

TEST(WorkPlan, GivesUpAFamilyWhoseOperatorFailsTwice) {
  WorkPlan plan({family(1, 5, 1), family(11, 1, 0.5, true)}, {.n_workers = 1});
  EXPECT_EQ(plan.next(0)->family, 1);
  plan.case_done(0, 11, 0.1);
  EXPECT_EQ(plan.next(0)->cases.front(), 1);
  plan.case_failed(0, 1, true);
  EXPECT_THAT(plan.take_hopeless(), IsEmpty());
  EXPECT_EQ(plan.next(0)->cases.front(), 2);
  plan.case_failed(0, 2, true);
  EXPECT_THAT(plan.take_hopeless(), ElementsAre(3, 4, 5));
  EXPECT_TRUE(plan.is_finished());
}

TEST(WorkPlan, ReturnedCasesGoOutAgainInOrder) {
  WorkPlan plan({family(1, 10, 1, true)}, {.n_workers = 2});
  const auto first = plan.next(0);
  plan.case_done(0, 1, 0.1);
  const auto slice = plan.next(0);
  ASSERT_EQ(slice->cases.size(), 3u);
  plan.returned(0, slice->cases);
  EXPECT_EQ(plan.n_in_flight(), 0);
  EXPECT_EQ(plan.next(1)->cases, slice->cases);
}

TEST(WorkPlan, ARefusedBuilderLeavesTheFamilyToTheNextCase) {
  WorkPlan plan({family(1, 2, 1)}, {.n_workers = 2});
  EXPECT_TRUE(plan.next(0)->builds_operator);
  plan.case_failed(0, 1, false);
  const auto slice = plan.next(1);
  ASSERT_TRUE(slice);
  EXPECT_TRUE(slice->builds_operator);
}

/// Has the worker build the operators of its family and end its first case after `seconds`.
void build_and_run_one(WorkPlan& plan, int worker, double seconds) {
  const auto slice = plan.next(worker);
  ASSERT_TRUE(slice);
  ASSERT_TRUE(slice->builds_operator);
  ASSERT_EQ(slice->cases.size(), 1u);
  plan.operator_ready(worker, 5, false);
  plan.case_done(worker, slice->cases[0], seconds);
}

TEST(WorkPlan, ASecondWorkerJoinsACreepingFamilyWhenItFitsAndPays) {
  WorkPlan plan({creeping(1, 20, 5)}, {.n_workers = 2, .memory_bytes = 2.5e9});
  const auto first = plan.next(0);
  EXPECT_FALSE(plan.next(1)) << "nothing is known of its cases";
  plan.operator_ready(0, 5, false);
  EXPECT_FALSE(plan.next(1));
  plan.case_done(0, first->cases[0], 1);
  const auto joined = plan.next(1);  // 19 s wait, a build takes 5
  ASSERT_TRUE(joined);
  EXPECT_TRUE(joined->builds_operator);
  EXPECT_TRUE(plan.is_building(1));
  EXPECT_FALSE(plan.next(0)->builds_operator) << "it goes on with its own";
  EXPECT_FALSE(plan.is_building(0));
  plan.operator_ready(1, 5, false);
  plan.case_done(1, joined->cases[0], 1);
  EXPECT_FALSE(plan.next(1)->builds_operator);
}

TEST(WorkPlan, NobodyJoinsACreepingFamilyThatIsDoneBeforeTheBuildIs) {
  WorkPlan plan({creeping(1, 20, 25)}, {.n_workers = 2});
  build_and_run_one(plan, 0, 1);  // 19 s wait; builds take a fifth of what was predicted, 5 s
  EXPECT_TRUE(plan.next(1));
  WorkPlan slow({creeping(1, 20, 5)}, {.n_workers = 2});
  build_and_run_one(slow, 0, 0.2);  // 3.8 s wait
  EXPECT_FALSE(slow.next(1));
  WorkPlan third({creeping(1, 20, 5)}, {.n_workers = 3});
  build_and_run_one(third, 0, 0.5);  // 9.5 s wait: the second gains, the third does not
  EXPECT_TRUE(third.next(1));
  EXPECT_FALSE(third.next(2));
}

TEST(WorkPlan, TheMemoryOfACreepingFamilyCountsAsLongAsItIsHeld) {
  WorkPlan plan({creeping(1, 20, 5), family(101, 5, 2)}, {.n_workers = 2, .memory_bytes = 1.5e9});
  build_and_run_one(plan, 0, 1);
  EXPECT_FALSE(plan.next(1)) << "neither a second set nor the elastic operator fits";
  for (int k = 2; k <= 20; ++k) {
    EXPECT_FALSE(plan.take_release(0));
    ASSERT_EQ(plan.next(0)->cases, std::vector<std::int64_t>{k});
    plan.case_done(0, k, 1);
  }
  EXPECT_TRUE(plan.take_release(0));
  EXPECT_FALSE(plan.take_release(0)) << "once is enough";
  EXPECT_FALSE(plan.next(1)) << "the simulator has not ended yet";
  plan.released(0);
  EXPECT_EQ(plan.next(1)->family, 1);
}

TEST(WorkPlan, TheOtherWorkerTakesAnotherFamilyBesideACreepingOne) {
  WorkPlan plan({creeping(1, 20, 5), creeping(101, 20, 4)},
                {.n_workers = 2, .memory_bytes = 2.5e9});
  EXPECT_EQ(plan.next(0)->family, 0);
  EXPECT_EQ(plan.next(1)->family, 1);
}

TEST(WorkPlan, AWorkerLetsGoOfACreepingFamilyToBuildAnother) {
  WorkPlan plan({creeping(1, 1, 5), creeping(101, 2, 4)}, {.n_workers = 1, .memory_bytes = 1.5e9});
  build_and_run_one(plan, 0, 1);
  const auto slice = plan.next(0);
  ASSERT_TRUE(slice);
  EXPECT_EQ(slice->family, 1);
  EXPECT_TRUE(slice->builds_operator);
  EXPECT_FALSE(plan.take_release(0));
}

/// Two that hold the last family's operators, and a third family that needs the memory of both.
TEST(WorkPlan, IdleHoldersDoNotBlockALargeFamily) {
  FamilyWork large = creeping(201, 1, 1);
  large.memory_bytes = 2e9;
  WorkPlan plan({creeping(1, 1, 5), creeping(101, 1, 4), large},
                {.n_workers = 2, .memory_bytes = 2.5e9});
  const auto a = plan.next(0), b = plan.next(1);
  for (const int worker : {0, 1}) plan.operator_ready(worker, 1, false);
  plan.case_done(0, a->cases[0], 1);
  EXPECT_FALSE(plan.next(0));
  EXPECT_TRUE(plan.take_release(0));
  plan.case_done(1, b->cases[0], 1);
  plan.released(0);
  EXPECT_FALSE(plan.next(0)) << "worker 1 still holds 1 GB";
  EXPECT_EQ(plan.next(1)->family, 2) << "but may let go of it";
}

TEST(WorkPlan, ASecondSetThatCannotBeBuiltIsNoFaultOfTheCase) {
  WorkPlan plan({creeping(1, 20, 5)}, {.n_workers = 2, .on_failure = FailureAction::abort});
  build_and_run_one(plan, 0, 1);
  const auto joined = plan.next(1);
  ASSERT_TRUE(joined);
  EXPECT_TRUE(plan.case_failed(1, joined->cases[0], true)) << "it is tried again";
  EXPECT_FALSE(plan.stopped());
  EXPECT_FALSE(plan.next(1)) << "there is no room for two";
  EXPECT_THAT(plan.take_hopeless(), IsEmpty());
  for (int n = 0; n < 19; ++n) plan.case_done(0, plan.next(0)->cases.at(0), 1);
  EXPECT_TRUE(plan.is_finished());
}

TEST(WorkPlan, ACaseThatIsTriedAgainGoesToTheWorkerThatHoldsTheOperators) {
  WorkPlan plan({creeping(1, 2, 5)},
                {.n_workers = 2, .on_failure = FailureAction::retry, .retries = 1});
  build_and_run_one(plan, 0, 1);
  ASSERT_EQ(plan.next(0)->cases, std::vector<std::int64_t>{2});
  ASSERT_TRUE(plan.case_failed(0, 2, false));
  EXPECT_FALSE(plan.next(1)) << "to build them anew for 5 s would not pay for a case of 1 s";
  const auto again = plan.next(0);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->cases, std::vector<std::int64_t>{2});
  EXPECT_FALSE(again->builds_operator);
}

TEST(WorkPlan, GivesUpACreepingFamilyWhoseOperatorsFailTwice) {
  WorkPlan plan({creeping(1, 5, 1)}, {.n_workers = 1});
  for (int k = 1; k <= 2; ++k) {
    ASSERT_TRUE(plan.next(0)->builds_operator);
    EXPECT_FALSE(plan.case_failed(0, k, true));
  }
  EXPECT_THAT(plan.take_hopeless(), ElementsAre(3, 4, 5));
  EXPECT_TRUE(plan.is_finished());
}

/// Random outcomes: every case is decided exactly once, whatever happens, and what is held or built
/// at once fits.
TEST(WorkPlan, DecidesEveryCaseExactlyOnceUnderRandomTrouble) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    unsigned state = seed;
    const auto dice = [&](unsigned n) {
      state = state * 1664525u + 1013904223u;
      return (state >> 16) % n;
    };
    std::vector<FamilyWork> families;
    long n_cases = 0;
    for (int f = 0; f < 6; ++f) {
      const int n = 1 + static_cast<int>(dice(40));
      const bool creeps = dice(2) == 0;
      families.push_back(creeps ? creeping(1000 * f + 1, n, dice(10) / 10.0)
                                : family(1000 * f + 1, n, dice(10), dice(2) == 0));
      n_cases += n;
    }
    WorkPlan plan(
        families,
        {.n_workers = 3, .memory_bytes = 2e9, .on_failure = FailureAction::retry, .retries = 1});
    std::set<std::int64_t> decided;
    std::vector<std::deque<std::int64_t>> queues(3);
    std::vector<int> ladder(3, -1);  // the creeping family whose operators a worker holds
    for (int turn = 0; turn < 100000 && !plan.is_finished(); ++turn) {
      const int worker = static_cast<int>(dice(3));
      auto& queue = queues[static_cast<std::size_t>(worker)];
      if (const auto slice = plan.next(worker)) {
        queue.insert(queue.end(), slice->cases.begin(), slice->cases.end());
        int& held = ladder[static_cast<std::size_t>(worker)];
        const bool creeps = families[static_cast<std::size_t>(slice->family)].creeps;
        EXPECT_TRUE(!creeps || slice->builds_operator || held == slice->family);
        held = creeps ? slice->family : -1;
        EXPECT_LE(std::count_if(ladder.begin(), ladder.end(), [](int f) { return f >= 0; }), 2);
      }
      if (plan.take_release(worker)) {
        ladder[static_cast<std::size_t>(worker)] = -1;
        plan.released(worker);
      }
      if (queue.empty()) continue;
      const std::int64_t id = queue.front();
      queue.pop_front();
      const bool building = plan.is_building(worker);
      switch (dice(10)) {
        case 0:
          if (building) ladder[static_cast<std::size_t>(worker)] = -1;
          if (!plan.case_failed(worker, id, building)) {
            EXPECT_TRUE(decided.insert(id).second) << id;
          }
          break;
        case 1:
          queue.push_front(id);
          plan.returned(worker, {queue.begin(), queue.end()});
          if (building) ladder[static_cast<std::size_t>(worker)] = -1;
          queue.clear();
          break;
        default:
          if (building) plan.operator_ready(worker, 1, false);
          plan.case_done(worker, id, 0.01 * (1 + dice(5)));
          EXPECT_TRUE(decided.insert(id).second) << id;
      }
      for (const auto lost : plan.take_hopeless()) EXPECT_TRUE(decided.insert(lost).second) << lost;
    }
    EXPECT_EQ(static_cast<long>(decided.size()), n_cases) << "seed " << seed;
  }
}

}  // namespace
}  // namespace faultsweep
