#include "simulator/cache/operator_cache.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>

#include "simulator/cache/operator_tables.h"
#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "tests/unit/cache/example_operator.h"

namespace faultsim {
namespace {

using testing::ElementsAre;

/// Compares all tables, bit by bit for numbers.
void expect_same(const FaultOperator& a, const FaultOperator& b) {
  std::vector<std::string> texts[2];
  int i = 0;
  for (const auto* op : {&a, &b}) {
    operator_tables(*op, TableGatherer([&](const char* path, const auto& values, auto&&, auto&&) {
      std::string text = path;
      for (const auto& value : values) text += concat(' ', value);
      texts[i].push_back(text);
    }));
    ++i;
  }
  EXPECT_EQ(texts[0], texts[1]);
  ASSERT_EQ(a.h().rows(), b.h().rows());
  EXPECT_TRUE(a.h() == b.h());
}

std::filesystem::path file_of(const ScratchFolder& folder, const FaultOperator& op) {
  return folder.path() / (op.fingerprint + ".h5");
}

/// Sets when an operator was used last, in seconds before now.
void set_age(const std::filesystem::path& path, int seconds) {
  std::filesystem::last_write_time(
      path, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(seconds));
}

TEST(OperatorFile, ComesBackBitForBit) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 150);
  write_operator(op, folder.path() / "cache");
  std::string remark;
  const auto copy = read_operator(folder.path() / "cache", op.fingerprint, &remark);
  ASSERT_TRUE(copy.has_value()) << remark;
  expect_same(op, *copy);
  EXPECT_EQ(copy->geometry.nodes[1].pressure.size(), 1U);
  EXPECT_EQ(copy->geometry.faults[1].name, "F2 <east> & co/1");
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(copy->h().data()) % 64, 0U);
}

TEST(OperatorFile, HIsMappedFromTheFileAndOutlivesItsName) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 100);
  write_operator(op, folder.path());
  std::optional<FaultOperator> copy = read_operator(folder.path(), op.fingerprint);
  ASSERT_TRUE(copy.has_value());
  const FaultOperator shared = *copy;  // a copy shares the mapping
  EXPECT_EQ(shared.h().data(), copy->h().data());
  copy.reset();
  std::filesystem::remove(file_of(folder, op));
  EXPECT_TRUE(shared.h() == op.h());
}

TEST(OperatorFile, WithoutDofsIsFine) {
  const ScratchFolder folder;
  FaultOperator op;
  op.fingerprint = "none";
  op.observed.per_jump.resize(0, 0);
  op.compliance = std::make_shared<DenseCompliance>(Eigen::MatrixXd(0, 0));
  write_operator(op, folder.path());
  const auto copy = read_operator(folder.path(), "none");
  ASSERT_TRUE(copy.has_value());
  EXPECT_EQ(copy->h().size(), 0);
}

TEST(OperatorFile, EqualOperatorsGiveEqualBytes) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 20);
  write_operator(op, folder.path() / "1");
  write_operator(op, folder.path() / "2");
  const std::string bytes = read_bytes(folder.path() / "1" / (op.fingerprint + ".h5"));
  EXPECT_GT(bytes.size(), 4096U);
  EXPECT_TRUE(bytes == read_bytes(folder.path() / "2" / (op.fingerprint + ".h5")));
}

TEST(OperatorFile, AbsentIsNothing) {
  const ScratchFolder folder;
  std::string remark;
  EXPECT_FALSE(read_operator(folder.path(), "absent", &remark).has_value());
  EXPECT_FALSE(read_operator(folder.path() / "nowhere", "absent", &remark).has_value());
  EXPECT_EQ(remark, "");
}

TEST(OperatorFile, NaNIsRefused) {
  const ScratchFolder folder;
  FaultOperator op = example_operator("a");
  op.loads.traction(2, 1) = std::nan("");
  EXPECT_THROW(write_operator(op, folder.path()), InternalError);
  FaultOperator other = example_operator("a");
  Eigen::MatrixXd h = other.h();
  h(1, 0) = std::nan("");
  other.compliance = std::make_shared<DenseCompliance>(h);
  EXPECT_THROW(write_operator(other, folder.path()), InternalError);
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(OperatorFile, TwoProcessesWriteTheSameOneAtOnce) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a", 200);
  std::vector<pid_t> children;
  for (int i = 0; i < 2; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      int status = 0;
      try {
        for (int k = 0; k < 5; ++k) {
          write_operator(op, folder.path());
          if (!read_operator(folder.path(), op.fingerprint).has_value()) status = 1;
        }
      } catch (...) {
        status = 2;
      }
      _exit(status);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(folder.n_entries(), 1U);
  const auto copy = read_operator(folder.path(), op.fingerprint);
  ASSERT_TRUE(copy.has_value());
  expect_same(op, *copy);
}

TEST(OperatorCache, ListsMostRecentlyUsedFirst) {
  const ScratchFolder folder;
  EXPECT_TRUE(list_operators(folder.path() / "nowhere").empty());
  std::vector<FaultOperator> ops;
  for (const char* key : {"a", "b", "c"}) ops.push_back(example_operator(key));
  for (const FaultOperator& op : ops) write_operator(op, folder.path());
  set_age(file_of(folder, ops[0]), 100);
  set_age(file_of(folder, ops[1]), 300);
  set_age(file_of(folder, ops[2]), 200);
  ASSERT_TRUE(read_operator(folder.path(), ops[1].fingerprint).has_value());
  const std::vector<CacheEntry> entries = list_operators(folder.path());
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].fingerprint, ops[1].fingerprint);
  EXPECT_EQ(entries[1].fingerprint, ops[0].fingerprint);
  EXPECT_EQ(entries[2].fingerprint, ops[2].fingerprint);
  EXPECT_EQ(entries[0].bytes, std::filesystem::file_size(file_of(folder, ops[1])));
  EXPECT_GT(entries[0].last_used, entries[1].last_used + 50);
}

TEST(OperatorCache, PrunesLeastRecentlyUsedButNeverTheKeptOne) {
  const ScratchFolder folder;
  std::vector<FaultOperator> ops;
  for (const char* key : {"a", "b", "c", "d"}) ops.push_back(example_operator(key));
  for (std::size_t i = 0; i < ops.size(); ++i) {
    write_operator(ops[i], folder.path());
    set_age(file_of(folder, ops[i]), 1000 - 100 * static_cast<int>(i));
  }
  const std::uint64_t bytes = std::filesystem::file_size(file_of(folder, ops[0]));
  EXPECT_EQ(prune_operators(folder.path(), 4 * bytes, ops[0].fingerprint), 0U);
  EXPECT_EQ(prune_operators(folder.path(), 3 * bytes - 1, ops[0].fingerprint), 2 * bytes);
  EXPECT_TRUE(std::filesystem::exists(file_of(folder, ops[0])));
  EXPECT_FALSE(std::filesystem::exists(file_of(folder, ops[1])));
  EXPECT_FALSE(std::filesystem::exists(file_of(folder, ops[2])));
  EXPECT_TRUE(std::filesystem::exists(file_of(folder, ops[3])));
  EXPECT_EQ(prune_operators(folder.path(), 0, ops[0].fingerprint), bytes);
  EXPECT_EQ(folder.n_entries(), 1U);
  EXPECT_EQ(prune_operators(folder.path() / "nowhere", 0, ""), 0U);
}

TEST(OperatorCache, PruneRemovesWhatDeadProcessesLeft) {
  const ScratchFolder folder;
  const FaultOperator op = example_operator("a");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) _exit(0);
  int status = -1;
  waitpid(child, &status, 0);
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  std::string plain(host);
  for (char& c : plain) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  const auto leave = [&](pid_t process) {
    const auto path =
        folder.path() / concat(".", op.fingerprint, ".h5.", plain, ".", process, ".0.tmp");
    std::ofstream(path) << "12345";
    return path;
  };
  const auto dead = leave(child), alive = leave(getpid());
  EXPECT_EQ(prune_operators(folder.path(), 1 << 20, ""), 5U);
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(alive));
}

TEST(OperatorCache, WorksWhileOthersPruneAndWrite) {
  const ScratchFolder folder;
  const FaultOperator a = example_operator("a", 50), b = example_operator("b", 50);
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      int status = 0;
      try {
        for (int k = 0; k < 10; ++k) {
          if (i == 0) {
            prune_operators(folder.path(), 0, "");
            continue;
          }
          const FaultOperator& mine = i == 1 ? a : b;
          write_operator(mine, folder.path());
          std::string remark;
          const auto copy = read_operator(folder.path(), mine.fingerprint, &remark);
          if (!remark.empty() || (copy && !(copy->h() == mine.h()))) status = 1;
        }
      } catch (...) {
        status = 2;
      }
      _exit(status);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
}

TEST(WriteText, ReplacesTheFileAndLeavesNothingElse) {
  const ScratchFolder folder;
  const auto path = folder.path() / "result.json";
  write_text(path, "first");
  write_text(path, "second");
  EXPECT_EQ(read_bytes(path), "second");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
  EXPECT_THROW(write_text(path / "below_a_file", "x"), StorageError);
}

}  // namespace
}  // namespace faultsim
