#include "simulator/common/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace faultsim {
namespace {

std::atomic<bool> caught = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

std::atomic<int> code_at_end = static_cast<int>(ExitCode::interrupted);
static_assert(std::atomic<int>::is_always_lock_free, "read by a signal handler");

extern "C" void end_now(int) { _exit(code_at_end); }

extern "C" void remember_signal(int number) {
  if (caught.exchange(true)) end_now(number);  // asked twice
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

void end_on_signals(ExitCode code) {
  code_at_end = static_cast<int>(code);
  on_stop_signals(end_now);
  std::signal(SIGXFSZ, SIG_IGN);
}

StopToken stop_on_signals() {
  on_stop_signals(remember_signal);
  return StopToken(caught);
}

}  // namespace faultsim
