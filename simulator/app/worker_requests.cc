#include "simulator/app/worker_requests.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "simulator/app/request_check.h"

namespace faultsim {

using nlohmann::json;

struct WorkerRequests::Shared {
  std::mutex mutex;
  std::condition_variable came;
  std::deque<json> waiting;
  json running;  ///< number of the run that was handed out last.
  std::atomic<bool> stop = false;
  bool ended = false;
  std::exception_ptr trouble;  ///< a line that is not a request.

  void take(json request);
  void read_all(int descriptor);
};

/// A cancelled run that still waits is handed out as cancelled; one that is done is none of ours.
void WorkerRequests::Shared::take(json request) {
  const std::lock_guard lock(mutex);
  if (!request.contains("cancel")) {
    waiting.push_back(std::move(request));
    came.notify_one();
    return;
  }
  const json& run = request["cancel"];
  if (run == running) stop = true;
  for (json& other : waiting) {
    if (other.contains("run") && other["run"] == run) other["cancelled"] = true;
  }
}

void WorkerRequests::Shared::read_all(int descriptor) {
  std::string buffer;
  std::array<char, 65536> block;
  int number = 0;  // of the line
  try {
    while (true) {
      const ssize_t n = read(descriptor, block.data(), block.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      buffer.append(block.data(), static_cast<std::size_t>(n));
      std::size_t begin = 0;
      for (std::size_t end; (end = buffer.find('\n', begin)) != std::string::npos; begin = end + 1)
        take(request_of_line(buffer.substr(begin, end - begin), ++number));
      buffer.erase(0, begin);
    }
  } catch (...) {
    trouble = std::current_exception();
  }
  const std::lock_guard lock(mutex);
  ended = true;
  came.notify_one();
}

WorkerRequests::WorkerRequests(int descriptor) : shared_(std::make_shared<Shared>()) {
  std::thread([shared = shared_, descriptor] {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are for the thread that works
    shared->read_all(descriptor);
  }).detach();
}

WorkerRequests::~WorkerRequests() = default;

std::optional<json> WorkerRequests::next() {
  Shared& shared = *shared_;
  std::unique_lock lock(shared.mutex);
  shared.came.wait(lock, [&] { return shared.ended || !shared.waiting.empty(); });
  if (shared.waiting.empty()) {
    if (shared.trouble) std::rethrow_exception(shared.trouble);
    return std::nullopt;
  }
  json request = std::move(shared.waiting.front());
  shared.waiting.pop_front();
  if (request.contains("run")) {
    shared.running = request["run"];
    shared.stop = request.value("cancelled", false);
  }
  return request;
}

const std::atomic<bool>& WorkerRequests::stop() const { return shared_->stop; }

}  // namespace faultsim
