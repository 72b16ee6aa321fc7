#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "campaign/scheduler/job_runner.h"

/// Messages between the manager (rank 0) and its workers, as bytes. Both ends are the same binary
/// on like machines, so numbers go as they are in memory; the version is checked with the greeting.
namespace faultsweep {

namespace message {

// From worker to manager.
struct Hello {
  std::string host;
  int cores = 1;  ///< that the worker may use there; other workers may have the same.
};
struct Trouble {  ///< the worker cannot go on: the simulator cannot be run.
  std::string text;
};

// From manager to worker.
struct Work {
  FamilyTask task;
  std::vector<std::pair<std::int64_t, BaseScene>> scenes;  ///< with their ids.
  std::vector<CaseInput> cases;  ///< of base scenes sent with this or an earlier message.
};

// Either way.
enum class Signal : std::uint8_t {
  drain,     ///< finish the case under way, hand back the others, say `drained`.
  drained,   ///< nothing is under way any more.
  release,   ///< end the simulator: what it holds is of no use any more.
  released,  ///< it has ended.
  quit,
};

}  // namespace message

using Message =
    std::variant<message::Hello, JobEvents, message::Trouble, message::Work, message::Signal>;

inline bool is(const Message& message, message::Signal signal) {
  const auto* one = std::get_if<message::Signal>(&message);
  return one != nullptr && *one == signal;
}

std::string encode(const Message& message);
/// Throws InternalError on bytes that are not a message.
Message decode(std::string_view bytes);

/// Where messages come from and go to, by rank: MPI, or a test. The manager is rank 0.
class Link {
 public:
  virtual ~Link() = default;
  virtual int size() const = 0;  ///< ranks, the manager included.
  virtual void send(int to, const Message& message) = 0;
  struct Received {
    int from = 0;
    Message message;
  };
  /// A message that has arrived; nothing = none.
  virtual std::optional<Received> receive() = 0;
};

}  // namespace faultsweep
