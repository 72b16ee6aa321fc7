#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
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
struct Events {
  JobEvents events;
};
struct Trouble {  ///< the worker cannot go on: the simulator cannot be run.
  std::string text;
};
struct Drained {  ///< nothing is under way any more.
};
struct Released {  ///< the simulator has ended.
};

// From manager to worker.
struct Work {
  struct Item {
    std::int64_t case_id = 0;
    std::int64_t scene = 0;  ///< key of a base scene sent with this or an earlier message.
    long position = 0;
    std::string changes;
    std::string identity = "";
  };
  FamilyTask task;
  std::map<std::int64_t, BaseScene> scenes;
  std::vector<Item> items;
};
struct Drain {  ///< finish the case under way, hand back the others, say Drained.
};
struct Release {  ///< end the simulator: what it holds is of no use any more.
};
struct Quit {};

}  // namespace message

using Message =
    std::variant<message::Hello, message::Events, message::Trouble, message::Drained, message::Work,
                 message::Drain, message::Quit, message::Release, message::Released>;

std::string encode(const Message& message);
/// Throws InternalError on bytes that are not a message.
Message decode(std::string_view bytes);

}  // namespace faultsweep
