#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "campaign/store/store.h"

namespace faultsweep::serve {

/// Readers of a store that stay open between requests: what SQLite has read of 10^5 cases takes
/// longer to read again than to sort. Used from several threads at once.
class OpenStores {
 public:
  explicit OpenStores(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// A reader for one request: it sees one state of the store, the one of its first query.
  class Lease {
   public:
    ~Lease();  ///< after an exception the reader is closed, as is one that sees no changes.
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    const Store& operator*() const { return *store_; }

   private:
    friend class OpenStores;
    Lease(OpenStores& owner, std::unique_ptr<Store> store);

    OpenStores& owner_;
    std::unique_ptr<Store> store_;
    int exceptions_;  ///< that were on their way when it was made.
  };
  /// Opens one where none is free, and all anew where another file has the store's name. Throws
  /// StorageError as Store::open_reader.
  Lease take();

  using FileId = std::pair<dev_t, ino_t>;
  /// Which file has the store's name now.
  FileId file_id() const;

 private:
  std::filesystem::path folder_;
  std::mutex mutex_;
  FileId opened_ = {};                        ///< the file of `free_`.
  std::vector<std::unique_ptr<Store>> free_;  ///< each holds no state.
};

}  // namespace faultsweep::serve
