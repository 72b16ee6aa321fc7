#pragma once

#include <array>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

/// What METIS does to a process, and how it is put up with.
namespace faultsim {

/// METIS 5.1 catches SIGABRT and SIGTERM as it begins, by a handler that crashes in any thread but
/// its own, and the process may have some that nobody here started (those of BLAS). So what was is
/// put back as soon as METIS has taken it; and once more in the end, because METIS then puts back
/// handlers that serve once: the next signal would end the process by its default.
class KeptSignalActions {
 public:
  KeptSignalActions() {
    for (std::size_t i = 0; i < kTaken.size(); ++i) sigaction(kTaken[i], nullptr, &before_[i]);
    watch_ = std::jthread([this](const std::stop_token& end) {
      while (!end.stop_requested() && !is_taken()) std::this_thread::yield();
      put_back();
    });
  }
  ~KeptSignalActions() {
    watch_.request_stop();
    watch_.join();
    put_back();
  }
  KeptSignalActions(const KeptSignalActions&) = delete;
  KeptSignalActions& operator=(const KeptSignalActions&) = delete;

 private:
  /// SIGTERM is the last that it takes.
  bool is_taken() const {
    struct sigaction now = {};
    sigaction(SIGTERM, nullptr, &now);
    return now.sa_handler != before_.back().sa_handler;
  }
  void put_back() const {
    for (std::size_t i = 0; i < kTaken.size(); ++i) sigaction(kTaken[i], &before_[i], nullptr);
  }

  static constexpr std::array kTaken = {SIGABRT, SIGTERM};
  std::array<struct sigaction, kTaken.size()> before_ = {};
  std::jthread watch_;
};

/// Throws Interrupted when `stop` says so.
void require_no_stop(const std::function<bool()>& stop);

/// The one turn in the process: METIS seeds rand() and draws from it, and sets handlers of signals.
/// @param stop  asked while it waits (require_no_stop()).
std::unique_lock<std::mutex> turn_of_metis(const std::function<bool()>& stop);

}  // namespace faultsim
