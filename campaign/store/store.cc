#include "campaign/store/store.h"

#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "campaign/common/names.h"
#include "campaign/store/checksums.h"
#include "campaign/store/migrations.h"
#include "campaign/store/result_rows.h"
#include "campaign/store/sqlite.h"

namespace faultsweep {
namespace {

constexpr const char* kFileName = "campaign.sqlite";

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw StorageError(concat("cannot make the store folder ", folder.string(), ": ",
                              error ? error.message() : "it is not a folder",
                              "; choose another --store"));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw StorageError(concat("cannot write in the store folder ", folder.string(), ": ",
                              std::strerror(errno), "; choose another --store"));
  }
}

/// A migration makes the checksums anew: what they are to find must be found before.
void require_sound_checksums(Connection& connection) {
  if (!Checksums::exist(connection)) return;
  const std::vector<std::string> problems = Checksums(connection).problems();
  if (problems.empty()) return;
  throw StorageError(concat("the store ", connection.path().string(), " is damaged: ",
                            problems.front(), "; ", kDamageCure, ", nothing was changed"));
}

std::unique_ptr<Connection> open_for_writing(const std::filesystem::path& folder,
                                             Connection::Mode mode, bool assume_network,
                                             std::string& remark) {
  make_folder(folder);
  auto connection = std::make_unique<Connection>(folder / kFileName, mode);
  const int version =
      stored_version(*connection, store_migrations());  // before anything is changed
  if (assume_network || is_network_file_system(file_system_type(folder))) {
    connection->execute("PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL");
    remark = concat(
        "the store ", folder.string(),
        " is on a network file system, which is slower, and safe only with one host at a time; "
        "prefer a local disk");
  } else {
    connection->execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
  }
  if (version > 0 && version < store_migrations().back().version)
    require_sound_checksums(*connection);
  migrate(*connection, store_migrations());
  if (!Checksums(*connection).are_current()) {
    Transaction transaction(*connection);
    Checksums(*connection).seal_all();
    transaction.commit();
  }
  return connection;
}

}  // namespace

long file_system_type(const std::filesystem::path& folder) {
  struct statfs info = {};
  return statfs(folder.c_str(), &info) == 0 ? static_cast<long>(info.f_type) : 0;
}

bool is_network_file_system(long f_type) {
  // NFS, SMB, CIFS, SMB2, AFS, Lustre, GPFS, Ceph, BeeGFS, OCFS2, PanFS, 9P, FUSE (sshfs and its
  // kin; a local FUSE file system is treated alike: slower, but right).
  constexpr std::array<unsigned long, 13> kNetwork = {
      0x6969,     0x517B,     0xFF534D42, 0xFE534D42, 0x5346414F, 0x0BD00BD0, 0x47504653,
      0x00C36400, 0x19830326, 0x7461636F, 0xAAD7AAEA, 0x01021997, 0x65735546};
  return std::ranges::find(kNetwork, static_cast<std::uint32_t>(f_type)) != kNetwork.end();
}

Store::Store(std::filesystem::path folder, std::unique_ptr<Connection> connection,
             std::string remark)
    : folder_(std::move(folder)),
      connection_(std::move(connection)),
      checksums_(std::make_unique<Checksums>(*connection_)),
      remark_(std::move(remark)) {}
Store::Store(Store&&) noexcept = default;
Store::~Store() = default;

Store Store::open_writer(const std::filesystem::path& folder, bool assume_network) {
  std::string remark;
  auto connection = open_for_writing(folder, Connection::Mode::read_write, assume_network, remark);
  return Store(folder, std::move(connection), std::move(remark));
}

Store Store::open_owner(const std::filesystem::path& folder) {
  std::string remark;
  auto connection = open_for_writing(folder, Connection::Mode::owner, false, remark);
  return Store(folder, std::move(connection), std::move(remark));
}

Store Store::open_reader(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kFileName;
  if (!std::filesystem::exists(file)) {
    throw StorageError(concat("there is no store at ", folder.string(),
                              "; make one with `faultsweep submit SPEC.json` or name another with "
                              "--store"));
  }
  auto connection = std::make_unique<Connection>(file, Connection::Mode::read_only);
  check_version(*connection, store_migrations());
  return Store(folder, std::move(connection), "");
}

void Store::hold_state() const { connection_->execute("BEGIN"); }
void Store::let_state_go() const { connection_->execute("COMMIT"); }
bool Store::sees_changes() const { return !connection_->is_immutable(); }

void Store::wait_for_locks(double seconds) { connection_->wait_for_locks(seconds); }
void Store::checkpoint() { connection_->checkpoint(); }

std::int64_t Store::name_id(const std::string& name) {
  const auto known = names_.find(name);
  if (known != names_.end()) return known->second;
  connection_->run("INSERT INTO names (name) VALUES (?) ON CONFLICT DO NOTHING", name);
  return names_[name] = connection_->row<std::int64_t>("SELECT id FROM names WHERE name = ?", name);
}

}  // namespace faultsweep
