#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "campaign/common/names.h"
#include "campaign/store/clock.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {
namespace {

constexpr double kSilentSeconds = 60;  // 60 heartbeats of 1 s missed

/// Start time of a process in clock ticks since boot (field 22 of stat); 0 when there is none.
std::int64_t process_started(std::int64_t pid) {
  std::ifstream file(concat("/proc/", pid, "/stat"));
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::size_t end_of_name = text.rfind(')');
  if (end_of_name == std::string::npos) return 0;
  std::istringstream fields(text.substr(end_of_name + 1));
  std::string field;
  constexpr int kFieldsAfterName = 20;  // state is field 3, the start time field 22
  for (int k = 0; k < kFieldsAfterName; ++k) {
    if (!(fields >> field)) return 0;
    if (k == 0 && (field == "Z" || field == "X")) return 0;  // dead, only not yet reaped
  }
  return std::stoll(field);
}

bool is_alive(const std::string& host, std::int64_t pid, std::int64_t started, double heartbeat) {
  if (host == host_name()) return process_started(pid) == started;
  return seconds_since_1970() - heartbeat < kSilentSeconds;
}

}  // namespace

/// As it was when first asked: a host that is renamed meanwhile is the same.
std::string host_name() {
  static const std::string known = [] {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return std::string(name);
  }();
  return known;
}

std::optional<OwnerInfo> Store::dead_owner() const {
  const auto before = owner();
  if (!before || !before->alive) return before;
  throw StorageError(concat("the store ", folder_.string(), " is managed by process ", before->pid,
                            " on ", before->host,
                            "; wait for it, stop it, or use another --store"));
}

void Store::claim_ownership(std::int64_t campaign, int n_workers) {
  Transaction transaction(*connection_);
  if (const auto before = dead_owner()) {
    record_event(campaign, "takeover",
                 concat("the manager with process id ", before->pid, " on ", before->host,
                        " died; taken over"));
  }
  connection_->run(
      "INSERT OR REPLACE INTO owner (id, host, pid, pid_started, heartbeat_at, campaign_id,"
      " n_workers, progress) VALUES (1, ?, ?, ?, ?, ?, ?, '{}')",
      host_name(), getpid(), process_started(getpid()), seconds_since_1970(), campaign, n_workers);
  transaction.commit();
}

void Store::heartbeat(const std::string& progress) {
  connection_->run(
      "UPDATE owner SET heartbeat_at = ?, progress = ?"
      " WHERE id = 1 AND host = ? AND pid = ? AND pid_started = ?",
      seconds_since_1970(), progress, host_name(), getpid(), process_started(getpid()));
  if (connection_->changes() == 1) return;
  const auto now = owner();
  throw StorageError(
      concat("the store ", folder_.string(), " was taken over by ",
             now ? concat("process ", now->pid, " on ", now->host) : "another process",
             " because this one seemed to be dead: it was suspended or could not write for ",
             kSilentSeconds, " s, or the clocks of the hosts differ; what is stored is intact"));
}

/// From the kernel's list: to open the file and ask would drop the locks of this process.
std::vector<std::string> Store::lock_holders() const {
  std::vector<std::string> files;  // ":inode", as they end in the list
  for (const char* end : {"", "-wal", "-shm"}) {
    struct stat info = {};
    if (stat((connection_->path().string() + end).c_str(), &info) == 0)
      files.push_back(concat(":", info.st_ino));
  }
  std::vector<std::string> holders;
  std::ifstream locks("/proc/locks");  // 7: POSIX ADVISORY WRITE 1234 fd:00:2531452 0 EOF
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advice, access, file;
    std::int64_t pid = 0;
    if (!(words >> number >> kind >> advice >> access >> pid >> file)) continue;  // "->" waits
    const bool is_ours =
        std::ranges::any_of(files, [&](const std::string& inode) { return file.ends_with(inode); });
    if (access != "WRITE" || !is_ours || pid <= 0 || pid == getpid()) continue;
    std::ifstream name(concat("/proc/", pid, "/comm"));
    std::string program;
    std::getline(name, program);
    const std::string holder = program.empty() ? concat(pid) : concat(pid, " (", program, ")");
    if (!faultsim::contains(holders, holder)) holders.push_back(holder);
  }
  return holders;
}

void Store::release_ownership() {
  connection_->run("DELETE FROM owner WHERE id = 1 AND pid = ? AND host = ?", getpid(),
                   host_name());
}

std::optional<OwnerInfo> Store::owner() const {
  Statement query = connection_->prepared(
      "SELECT host, pid, heartbeat_at, coalesce(campaign_id, 0), n_workers, progress, pid_started"
      " FROM owner WHERE id = 1");
  if (!query.step()) return std::nullopt;
  OwnerInfo info;
  std::int64_t started = 0;
  query.read(info.host, info.pid, info.heartbeat_at, info.campaign, info.n_workers, info.progress,
             started);
  info.alive = is_alive(info.host, info.pid, started, info.heartbeat_at);
  return info;
}

}  // namespace faultsweep
