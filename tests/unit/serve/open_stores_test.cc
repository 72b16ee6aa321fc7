#include "campaign/serve/open_stores.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

namespace faultsweep::serve {
namespace {

/// A reader in a process of its own, which may not write in the folder.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& folder) {
    EXPECT_EQ(pipe(questions_) + pipe(answers_), 0);
    child_ = fork();
    close(child_ != 0 ? questions_[0] : questions_[1]);
    close(child_ != 0 ? answers_[1] : answers_[0]);
    if (child_ != 0) return;
    constexpr unsigned kNobody = 65534;
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) _exit(1);
    OpenStores stores(folder);
    for (char asked = 0; read(questions_[0], &asked, 1) == 1;) {
      int n = -1;
      try {
        n = static_cast<int>((*stores.take()).campaigns().size());
      } catch (const std::exception&) {  // -1
      }
      if (write(answers_[1], &n, sizeof n) != sizeof n) break;
    }
    _exit(0);
  }
  ~Reader() {
    close(questions_[1]);
    close(answers_[0]);
    waitpid(child_, nullptr, 0);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  int n_campaigns() {
    int n = -2;
    EXPECT_EQ(write(questions_[1], "?", 1), 1);
    EXPECT_EQ(read(answers_[0], &n, sizeof n), static_cast<ssize_t>(sizeof n));
    return n;
  }

 private:
  int questions_[2] = {}, answers_[2] = {};
  pid_t child_ = 0;
};

Submission campaign_named(const std::string& name) {
  Submission s;
  s.name = name;
  s.spec_given = s.spec_resolved = "{}";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1, 1, 1, 1}};
  s.cases = {{"case of " + name, 0, 0, "{}", {}}};
  return s;
}

/// SQLite takes the file of a folder that cannot be written for one that never changes.
TEST(OpenStores, SeeWhatIsWrittenLaterInAFolderThatTheyMayNotWrite) {
  std::string name = ::testing::TempDir() + "open_stores_XXXXXX";
  const std::filesystem::path folder = mkdtemp(name.data());
  { Store::open_writer(folder).submit(campaign_named("first")); }
  { Store::open_owner(folder).checkpoint(); }
  std::filesystem::permissions(folder, std::filesystem::perms(0555));
  {
    Reader reader(folder);
    EXPECT_EQ(reader.n_campaigns(), 1);
    std::filesystem::permissions(folder, std::filesystem::perms(0755));
    Store owner = Store::open_owner(folder);
    owner.submit(campaign_named("second"));
    if (geteuid() != 0) std::filesystem::permissions(folder, std::filesystem::perms(0555));
    EXPECT_EQ(reader.n_campaigns(), 2) << "while it is written";
    owner.checkpoint();
    EXPECT_EQ(reader.n_campaigns(), 2);
    std::filesystem::permissions(folder, std::filesystem::perms(0755));
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace faultsweep::serve
