#include "simulator/common/interrupt.h"

#include <csignal>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void remember_signal(int number) {
  if (caught_signal != 0) {  // asked twice: end now
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  caught_signal = number;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = remember_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return caught_signal != 0; }

void throw_if_interrupted(const char* doing) {
  if (interrupted())
    throw Interrupted(concat("stopped by signal ", int{caught_signal}, " while ", doing));
}

}  // namespace faultsim
