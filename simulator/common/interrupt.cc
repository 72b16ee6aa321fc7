#include "simulator/common/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "simulator/common/errors.h"
#include "simulator/common/exit_code.h"

namespace faultsim {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void end_now(int) { _exit(static_cast<int>(ExitCode::interrupted)); }

extern "C" void remember_signal(int number) {
  if (caught_signal != 0) end_now(number);  // asked twice
  caught_signal = number;
}

void on_stop_signals(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(number, nullptr, &before);
    if (number == SIGHUP && before.sa_handler == SIG_IGN) continue;  // nohup
    sigaction(number, &action, nullptr);
  }
}

}  // namespace

void end_on_signals() {
  on_stop_signals(end_now);
  std::signal(SIGXFSZ, SIG_IGN);
}

void catch_interrupts() { on_stop_signals(remember_signal); }

bool interrupted() { return caught_signal != 0; }

void throw_if_interrupted(const char* doing) {
  if (interrupted())
    throw Interrupted(concat("stopped by signal ", int{caught_signal}, " while ", doing));
}

}  // namespace faultsim
