#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <functional>

#include "simulator/cache/operator_cache.h"
#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "simulator/result_files/field_writer.h"
#include "tests/unit/cache/example_operator.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Runs body in a child process that may write files of at most max_bytes; returns its exit status
/// (body's answer, or more when it crashed while ending).
int run_with_small_disk(rlim_t max_bytes, const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {max_bytes, max_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    int status = 99;
    try {
      status = body();
    } catch (const StorageError& error) {
      status = std::string(error.what()).find("File too large") != std::string::npos ? 10 : 11;
    } catch (...) {
    }
    std::exit(status);  // runs HDF5's clean-up, which must not crash
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
}

class DiskFull : public testing::TestWithParam<rlim_t> {};

TEST_P(DiskFull, OperatorIsAStorageErrorAndNoFileIsLeft) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 150);
  EXPECT_EQ(run_with_small_disk(GetParam(),
                                [&] {
                                  write_operator(op, folder.path());
                                  return 0;
                                }),
            10);
  EXPECT_EQ(folder.n_entries(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Limits, DiskFull,
                         testing::Values(0, 100, 4096, 4200, 8192, 12000, 20000, 100000, 150000,
                                         200000));

TEST(DiskFullSlices, EveryLimitBelowTheSizeIsHandled) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  write_operator(op, folder.path() / "full");
  const auto size = std::filesystem::file_size(folder.path() / "full" / (op.fingerprint + ".h5"));
  const auto write = [&] {
    write_operator(op, folder.path() / "small");
    return 0;
  };
  for (rlim_t limit = 0; limit < size; limit += size / 23) {
    EXPECT_EQ(run_with_small_disk(limit, write), 10) << limit;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() / "small"), {}), 0);
  }
  EXPECT_EQ(run_with_small_disk(size, write), 0);
}

TEST(DiskFullText, IsAStorageErrorAndNoFileIsLeft) {
  const ScratchFolder folder;
  write_text(folder.path() / "result.json", "old");
  EXPECT_EQ(run_with_small_disk(10,
                                [&] {
                                  write_text(folder.path() / "result.json", "0123456789+");
                                  return 0;
                                }),
            10);
  EXPECT_EQ(folder.n_entries(), 1U);
  EXPECT_EQ(read_bytes(folder.path() / "result.json"), "old");
}

TEST(DiskFullFields, IsAStorageErrorAndNoFileIsLeft) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  EXPECT_EQ(run_with_small_disk(1000,
                                [&] {
                                  FieldWriter writer(folder.path(), op.geometry);
                                  writer.finish();
                                  return 0;
                                }),
            10);
  EXPECT_EQ(folder.n_entries(), 0U);
}

/// Writes an operator, changes its bytes, and expects it to be moved aside with a remark.
void expect_damage_seen(const std::function<void(std::string&)>& change, const char* why) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 30);
  write_operator(op, folder.path());
  const auto path = folder.path() / (op.fingerprint + ".h5");
  ASSERT_TRUE(read_operator(folder.path(), op.fingerprint).has_value());
  std::string bytes = read_bytes(path);
  change(bytes);
  std::ofstream(path, std::ios::binary) << bytes;
  // The clock of the file system may be too coarse to tell this change from the reading before.
  std::filesystem::last_write_time(
      path, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(10));
  std::string remark;
  EXPECT_FALSE(read_operator(folder.path(), op.fingerprint, &remark).has_value());
  EXPECT_THAT(remark, AllOf(HasSubstr("is damaged"), HasSubstr(why), HasSubstr(".damaged")));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(path.string() + ".damaged"));
  EXPECT_TRUE(list_operators(folder.path()).empty());
  write_operator(op, folder.path());  // built again
  EXPECT_TRUE(read_operator(folder.path(), op.fingerprint).has_value());
  EXPECT_EQ(prune_operators(folder.path(), 0, op.fingerprint), bytes.size());
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".damaged"));
}

TEST(DamagedOperator, OneBitOfH) {
  expect_damage_seen([](std::string& bytes) { bytes[bytes.size() - 50] ^= 4; }, "checksum");
}
TEST(DamagedOperator, OneBitOfTheMetadata) {
  expect_damage_seen([](std::string& bytes) { bytes[5000] ^= 1; }, "checksum");
}
TEST(DamagedOperator, CutOff) {
  expect_damage_seen([](std::string& bytes) { bytes.resize(bytes.size() - 8); }, "checksum");
}
TEST(DamagedOperator, CutOffAtTheStart) {
  expect_damage_seen([](std::string& bytes) { bytes.resize(100); }, "only 100 bytes");
}
TEST(DamagedOperator, Empty) {
  expect_damage_seen([](std::string& bytes) { bytes.clear(); }, "only 0 bytes");
}
TEST(DamagedOperator, SomethingElse) {
  expect_damage_seen([](std::string& bytes) { bytes.assign(9000, 'x'); }, "not an operator file");
}

TEST(DamagedOperator, AnotherOneUnderThisName) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  write_operator(op, folder.path());
  std::filesystem::rename(folder.path() / (op.fingerprint + ".h5"), folder.path() / "wrong.h5");
  std::string remark;
  EXPECT_FALSE(read_operator(folder.path(), "wrong", &remark).has_value());
  EXPECT_THAT(remark, HasSubstr("it holds the operator " + op.fingerprint));
}

TEST(DamagedOperator, OtherFormatVersionIsLeftAlone) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  write_operator(op, folder.path());
  const auto path = folder.path() / (op.fingerprint + ".h5");
  std::string bytes = read_bytes(path);
  bytes.replace(bytes.find("operator 3"), 10, "operator 1");
  std::ofstream(path, std::ios::binary) << bytes;
  std::string remark;
  EXPECT_FALSE(read_operator(folder.path(), op.fingerprint, &remark).has_value());
  EXPECT_THAT(remark, HasSubstr("another format version"));
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(DamagedOperator, WhatIsNoFileIsMovedAsideAndBuiltAgain) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  const std::filesystem::path path = folder.path() / (op.fingerprint + ".h5");
  const std::filesystem::path aside = path.string() + ".damaged";
  for (const bool is_folder : {true, false}) {
    if (is_folder) {
      std::filesystem::create_directories(path / "within");
    } else {
      ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);  // must not be waited for
    }
    std::string remark;
    EXPECT_FALSE(read_operator(folder.path(), op.fingerprint, &remark).has_value());
    EXPECT_THAT(remark, AllOf(HasSubstr("it is not a regular file"), HasSubstr(".damaged")));
    EXPECT_TRUE(std::filesystem::exists(aside));
    write_operator(op, folder.path());
    EXPECT_TRUE(read_operator(folder.path(), op.fingerprint).has_value());
    std::filesystem::remove(path);
    std::filesystem::remove_all(aside);
  }
}

}  // namespace
}  // namespace faultsim
