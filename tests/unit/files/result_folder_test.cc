// A folder holds one result, whole, or says that it does not; and nothing but results is replaced.
#include "simulator/files/result_folder.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"
#include "tests/unit/files/scratch_folder.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kFiles = 12;

std::string file_name(int k) { return concat("file", k, ".txt"); }

ResultFolder::Request request_for(const fs::path& folder, std::vector<fs::path> inputs = {}) {
  return {.option = "-o",
          .folder = folder,
          .made_by = "faultsim test",
          .names = {file_name(0), file_name(1)},
          .inputs = std::move(inputs)};
}

/// Every file of a result says of which it is.
void write_result(const fs::path& folder, const std::string& tag, int n_files = kFiles) {
  ResultFolder result(request_for(folder));
  for (int k = 0; k < n_files; ++k) write_text(result.path() / file_name(k), tag);
  result.commit();
}

/// What a folder holds: the tag of a whole result, "incomplete" where it says so, "nothing", or
/// "MIXED".
std::string state_of(const fs::path& folder) {
  if (!fs::exists(folder)) return "nothing";
  if (fs::exists(folder / "INCOMPLETE")) return "incomplete";
  const auto contents = contents_of(folder);
  if (!contents) return fs::exists(folder / file_name(0)) ? "MIXED" : "nothing";
  std::string tag;
  std::size_t n_found = 1;  // contents.json
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.rfind("file", 0) != 0) continue;
    ++n_found;
    const std::string text = read_bytes(entry.path());
    if (!contents->holds(name) || (!tag.empty() && text != tag)) return "MIXED";
    tag = text;
  }
  return n_found == contents->files.size() ? tag : "MIXED";
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ResultFolder, IsReplacedByACompleteResultOnly) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  write_result(folder, "first");
  EXPECT_EQ(state_of(folder), "first");
  write_text(folder / "notes.md", "the user's own");
  {
    ResultFolder abandoned(request_for(folder));
    write_text(abandoned.path() / file_name(0), "second");
    EXPECT_EQ(state_of(folder), "first");
  }
  EXPECT_EQ(state_of(folder), "first");
  EXPECT_FALSE(fs::exists(folder / "incomplete"));
  write_result(folder, "third", 2);
  EXPECT_EQ(state_of(folder), "third") << "files of the longer result are gone";
  EXPECT_EQ(read_bytes(folder / "notes.md"), "the user's own");
}

TEST(ResultFolder, KeepsAnUnfinishedResultApart) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  for (const char* held : {"incomplete", "first"}) {
    {
      ResultFolder stopped(request_for(folder));
      write_text(stopped.path() / file_name(0), "part");
      stopped.keep_unfinished();
    }
    EXPECT_EQ(state_of(folder), held);
    EXPECT_EQ(read_bytes(folder / "incomplete" / file_name(0)), "part");
    EXPECT_THAT(read_bytes(folder / "incomplete" / "INCOMPLETE"), HasSubstr("not completed"));
    write_result(folder, "first");
    EXPECT_EQ(state_of(folder), "first");
    EXPECT_FALSE(fs::exists(folder / "incomplete"));
  }
}

TEST(ResultFolder, RemovesTheMarkerThatAKilledProcessWasWriting) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  write_result(folder, "first");
  const pid_t child = fork();
  if (child == 0) {
    PendingFile marker(folder / "INCOMPLETE");
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  ASSERT_EQ(std::distance(fs::directory_iterator(folder), {}), kFiles + 2);
  write_result(folder, "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), kFiles + 1);
}

/// SIGKILL at some 150 moments of replacing one result by another, and of making the first.
TEST(ResultFolder, AKilledProcessLeavesOneResultOrSaysThatThereIsNone) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  std::map<std::string, int> seen;
  useconds_t longest = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const std::string before = state_of(folder), tag = concat("result ", trial);
    const pid_t child = fork();
    if (child == 0) {
      try {
        write_result(folder, tag);
      } catch (const std::exception&) {
        _exit(1);
      }
      _exit(0);
    }
    if (trial % 10 == 0) {  // undisturbed, to have a result to replace
      int status = 0;
      waitpid(child, &status, 0);
      ASSERT_EQ(status, 0);
      ASSERT_EQ(state_of(folder), tag);
      longest = 6000;
      continue;
    }
    usleep(longest * static_cast<useconds_t>((trial * 31) % 97) / 97);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string after = state_of(folder);
    ASSERT_TRUE(after == before || after == tag || after == "incomplete" ||
                (before == "nothing" && after == "nothing"))
        << after << " after trial " << trial << " on " << before;
    ++seen[after == before ? "earlier" : after == tag ? "new" : after];
  }
  EXPECT_GT(seen["earlier"] + seen["incomplete"], 0);
  write_result(folder, "last");
  EXPECT_EQ(state_of(folder), "last");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), kFiles + 1);
}

TEST(ResultFolder, ReplacesNothingThatIsNoResultOfItsKind) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  fs::create_directory(folder);
  write_text(folder / file_name(1), "the user's own");
  const auto open = [&] { ResultFolder refused(request_for(folder)); };
  EXPECT_THAT(refusal(open), HasSubstr("file1.txt would be replaced and is not a result"));
  fs::remove(folder / file_name(1));
  fs::create_directory(folder / "incomplete");
  write_text(folder / "incomplete" / "thesis.txt", "the user's own");
  EXPECT_THAT(refusal(open), HasSubstr("is in the way"));
  fs::remove_all(folder / "incomplete");
  write_result(folder, "first");
  ResultFolder::Request other = request_for(folder);
  other.made_by = "faultsim other";
  EXPECT_THAT(refusal([&] { ResultFolder refused(other); }),
              HasSubstr("holds a result of `faultsim test`"));
  EXPECT_EQ(state_of(folder), "first");
}

TEST(ResultFolder, ReplacesNoInputAndMakesTheLastFolderOnly) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  write_result(folder, "first");
  EXPECT_THAT(refusal([&] { ResultFolder refused(request_for(folder, {folder / file_name(7)})); }),
              HasSubstr("file7.txt is read by this command"));
  EXPECT_THAT(refusal([&] { ResultFolder refused(request_for(scratch.path() / "a" / "b")); }),
              HasSubstr("does not exist"));
  EXPECT_FALSE(fs::exists(scratch.path() / "a"));
  EXPECT_THAT(refusal([&] { ResultFolder refused(request_for(folder / file_name(0))); }),
              HasSubstr("is not a folder"));
  EXPECT_THAT(refusal([&] { ResultFolder refused(request_for("-")); }), HasSubstr("no"));
}

TEST(ResultFolder, TwoAtATimeAreRefused) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  ResultFolder first(request_for(folder));
  EXPECT_THROW(ResultFolder second(request_for(folder)), StorageError);
  write_text(first.path() / file_name(0), "first");
  first.commit();
  EXPECT_EQ(state_of(folder), "first");
}

/// A list that was tampered with reaches nothing outside of its folder.
TEST(ResultFolder, BelievesNoListThatLeadsOutside) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "out";
  fs::create_directory(folder);
  write_text(scratch.path() / "precious", "x");
  write_text(folder / "contents.json",
             R"({"format": 1, "made_by": "faultsim test", "files": ["../precious"]})");
  write_text(folder / "INCOMPLETE", "entry: ../precious\nentry: /etc/passwd\nentry: ..\n");
  EXPECT_NE(refusal([&] { ResultFolder refused(request_for(folder)); }), "");
  fs::remove(folder / "contents.json");
  write_result(folder, "first");
  EXPECT_EQ(read_bytes(scratch.path() / "precious"), "x");
}

class OutputTarget : public testing::Test {
 protected:
  std::string refused(const fs::path& target, FileKind kind = FileKind::text,
                      const std::vector<fs::path>& inputs = {}) const {
    return refusal([&] { require_writable_file("-o", target, kind, inputs); });
  }
  fs::path file(const std::string& name, const std::string& text) const {
    write_text(scratch_.path() / name, text);
    return scratch_.path() / name;
  }
  const ScratchFolder scratch_;
};

TEST_F(OutputTarget, MayBeNewOrAFileOfItsKind) {
  EXPECT_EQ(refused(scratch_.path() / "new.csv"), "");
  EXPECT_EQ(refused(file("old.csv", "case,chi\n")), "");
  EXPECT_EQ(refused(file("empty", ""), FileKind::hdf5), "");
  EXPECT_THAT(refused(file("scene.json", " {\"format\": 1}")), HasSubstr("is a JSON file"));
  EXPECT_THAT(refused(file("x.sqlite", "SQLite format 3")), HasSubstr("is an SQLite database"));
  EXPECT_THAT(refused(file("notes.md", "notes"), FileKind::hdf5), HasSubstr("is a text file"));
}

TEST_F(OutputTarget, IsNoInputByAnyName) {
  const fs::path table = file("table.csv", "time,west\n");
  fs::create_symlink(table, scratch_.path() / "link.csv");
  fs::create_hard_link(table, scratch_.path() / "hard.csv");
  for (const char* name : {"table.csv", "link.csv", "hard.csv", "../table.csv"}) {
    fs::path target = scratch_.path() / name;
    if (name[0] == '.') target = scratch_.path() / ".." / scratch_.path().filename() / "table.csv";
    EXPECT_THAT(refused(target, FileKind::text, {table}), HasSubstr("is read by this command"))
        << name;
  }
}

TEST_F(OutputTarget, IsARegularFileInAFolderThatExists) {
  EXPECT_THAT(refused("/dev/full"), HasSubstr("not a regular file"));
  EXPECT_THAT(refused(scratch_.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refused(scratch_.path() / "no" / "x.csv"), HasSubstr("does not exist"));
  EXPECT_THAT(refused("/dev/null/x.csv"), HasSubstr("not a folder"));
  ASSERT_EQ(mkfifo((scratch_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refused(scratch_.path() / "pipe"), HasSubstr("not a regular file"));
  fs::create_symlink("nowhere", scratch_.path() / "dangling");
  EXPECT_THAT(refused(scratch_.path() / "dangling"), HasSubstr("is a broken link"));
  EXPECT_THROW(PendingFile("/dev/full"), StorageError);
}

TEST_F(OutputTarget, LiesInNoStoreAndInNoResult) {
  fs::create_directories(scratch_.path() / "store" / "fields");
  write_text(scratch_.path() / "store" / "campaign.sqlite", "SQLite format 3");
  for (const char* name : {"store/x.csv", "store/campaign.sqlite", "store/fields/x.csv"}) {
    EXPECT_THAT(refused(scratch_.path() / name), HasSubstr("lies in the store")) << name;
  }
  EXPECT_THAT(refusal([&] { ResultFolder no(request_for(scratch_.path() / "store")); }),
              HasSubstr("lies in the store"));
  write_result(scratch_.path() / "out", "first");
  EXPECT_THAT(refused(scratch_.path() / "out" / file_name(0)),
              HasSubstr("belongs to a result of `faultsim test`"));
}

TEST_F(OutputTarget, ALinkIsWrittenWhereItLeads) {
  const fs::path data = file("data.csv", "old");
  fs::create_symlink(data, scratch_.path() / "latest.csv");
  EXPECT_EQ(refused(scratch_.path() / "latest.csv"), "");
  write_text(scratch_.path() / "latest.csv", "new");
  EXPECT_TRUE(fs::is_symlink(scratch_.path() / "latest.csv"));
  EXPECT_EQ(read_bytes(data), "new");
}

TEST_F(OutputTarget, StandardOutputHasItsNames) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    EXPECT_TRUE(is_standard_output(name)) << name;
    EXPECT_THAT(refused(name), HasSubstr("is not the name of a file")) << name;
  }
  EXPECT_FALSE(is_standard_output("./-"));
}

TEST_F(OutputTarget, FilesThatADocumentNamesAreKnown) {
  const fs::path table = file("table.csv", "x"), scene = file("scene.json", "{}");
  const auto document = nlohmann::json::parse(
      R"({"title": "table", "compartments": {"west": {"csv": "table.csv"}}, "x": ["no.csv", ""]})");
  EXPECT_EQ(files_named_in(document, scene), (std::vector<fs::path>{scene, table}));
}

}  // namespace
}  // namespace faultsim
