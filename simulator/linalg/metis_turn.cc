#include "simulator/linalg/metis_turn.h"

#include <chrono>

#include "simulator/common/errors.h"

namespace faultsim {

void require_no_stop(const std::function<bool()>& stop) {
  if (stop && stop()) throw Interrupted("stopped while ordering the unknowns");
}

std::unique_lock<std::mutex> turn_of_metis(const std::function<bool()>& stop) {
  static std::mutex mutex;
  std::unique_lock turn(mutex, std::try_to_lock);
  while (!turn.owns_lock()) {
    require_no_stop(stop);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    turn.try_lock();
  }
  return turn;
}

}  // namespace faultsim
