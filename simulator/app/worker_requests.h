#pragma once

#include <atomic>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace faultsim {

/// What a worker is asked, read as it comes, so that a cancellation is seen while a case runs. A
/// thread of its own reads the descriptor until end of file; the process may end before it does.
class WorkerRequests {
 public:
  /// @param descriptor  JSON lines, see schemas/worker_protocol.md.
  explicit WorkerRequests(int descriptor);
  ~WorkerRequests();
  WorkerRequests(const WorkerRequests&) = delete;
  WorkerRequests& operator=(const WorkerRequests&) = delete;

  /// The next request but cancellations, nothing at end of file. Where it is a run, `stop` is its
  /// own from now on: set as soon as it is cancelled, or at once if it was already. Throws
  /// InputError after the last one before a line that is not a request (request_check.h).
  std::optional<nlohmann::json> next();
  const std::atomic<bool>& stop() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace faultsim
