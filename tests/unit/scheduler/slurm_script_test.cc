#include "campaign/scheduler/slurm_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

WaitingFamily family(std::size_t n_cases, double operator_seconds, double memory_bytes) {
  WaitingFamily waiting;
  waiting.predicted.operator_seconds = operator_seconds;
  waiting.predicted.memory_bytes = memory_bytes;
  waiting.cases.resize(n_cases);
  return waiting;
}

SlurmCampaign campaign(std::vector<WaitingFamily> waiting) {
  return {"sweep", "/scratch/my store", "/opt/bin/faultsweep", "/opt/bin/faultsim",
          std::move(waiting)};
}

TEST(SizeOfJob, IsEnoughForHalfAnHourOfMeasuredCases) {
  WaitingFamily measured = family(1000, 400, 2e9);
  measured.seconds_per_case = 5;
  const SlurmSize size = size_of_job({measured}, {});  // 5400 s
  EXPECT_EQ(size.n_workers, 3);
  EXPECT_DOUBLE_EQ(size.seconds, 400 + 5400 / 3.0);
  EXPECT_DOUBLE_EQ(size.memory_bytes, 2e9 / 0.9 + 4 * kRankBytes);
}

TEST(SizeOfJob, IsBounded) {
  EXPECT_EQ(size_of_job({family(1000000, 10, 1e9)}, {}).n_workers, kMostWorkers);
  EXPECT_EQ(size_of_job({family(2, 1e5, 1e9)}, {}).n_workers, 2) << "no more than cases";
  EXPECT_EQ(size_of_job({}, {}).n_workers, 1);
  SlurmRequest request;
  request.n_workers = 100;
  EXPECT_EQ(size_of_job({family(2, 1, 1e9)}, request).n_workers, 100);
}

TEST(SizeOfJob, CountsTheRanksOfANode) {
  SlurmRequest request;
  request.n_workers = 6;
  request.nodes = 2;  // 7 ranks: 4 and 3
  EXPECT_DOUBLE_EQ(size_of_job({family(9, 1, 3e9)}, request).memory_bytes,
                   3e9 / 0.9 + 4 * kRankBytes);
}

TEST(SizeOfJob, HasASetOfOperatorsPerWorkerWhereSaltCreeps) {
  WaitingFamily creeping = family(10, 100, 3e9);
  creeping.predicted.n_operators = 4;
  SlurmRequest request;
  request.n_workers = 2;
  const SlurmSize size = size_of_job({creeping, family(1, 1, 4e9)}, request);
  EXPECT_DOUBLE_EQ(size.memory_bytes, 2 * 3e9 / 0.9 + 3 * kRankBytes);
}

TEST(SlurmScript, AsksForTheJobAndRunsTheCampaign) {
  SlurmRequest request;
  request.n_workers = 4;
  request.partition = "long";
  const std::string script = slurm_script(campaign({family(10, 590, 2.1e9)}), request);
  EXPECT_THAT(script,
              AllOf(HasSubstr("#!/bin/bash\n"), HasSubstr("#SBATCH --job-name=sweep\n"),
                    HasSubstr("#SBATCH --nodes=1\n#SBATCH --ntasks=5\n"),
                    HasSubstr("#SBATCH --time=00:40:00\n"),  // 2 (590 + 600/4) s + 10 min
                    HasSubstr("#SBATCH --mem=4700M\n"), HasSubstr("#SBATCH --partition=long\n"),
                    HasSubstr("#SBATCH --signal=B:USR1@120\n")));
  EXPECT_THAT(script, HasSubstr("'/opt/bin/faultsweep' run sweep --store '/scratch/my store' "
                                "--simulator '/opt/bin/faultsim' --progress lines &\n"));
  EXPECT_THAT(script, Not(HasSubstr("account")));
  EXPECT_THAT(script, Not(HasSubstr("scontrol")));
}

TEST(SlurmScript, QueuesItselfAgainOnlyWhereAsked) {
  SlurmRequest request;
  request.resubmit = 3;
  EXPECT_THAT(slurm_script(campaign({}), request),
              AllOf(HasSubstr("\"${SLURM_RESTART_COUNT:-0}\" -lt 3 ]"),
                    HasSubstr("scontrol requeue \"$SLURM_JOB_ID\"")));
}

TEST(SlurmScript, RefusesTextThatWouldBeMoreThanAWord) {
  SlurmRequest request;
  request.account = "a\n#SBATCH --nodes=99";
  EXPECT_THROW(slurm_script(campaign({}), request), faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
