#include "campaign/scheduler/messenger.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "simulator/common/errors.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

namespace {
constexpr int kTag = 1;
}

struct Messenger::Transfer {
  int from = 0;  ///< of one that comes in.
  std::string bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

Messenger::Messenger(int& argc, char**& argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Messenger::~Messenger() {
  if (!finished_) std::fflush(nullptr);
}

void Messenger::send(int to, const Message& message) {
  auto outgoing = std::make_unique<Transfer>();
  outgoing->bytes = encode(message);
  FAULTSIM_DEMAND(outgoing->bytes.size() < (1u << 30), outgoing->bytes.size());
  MPI_Isend(outgoing->bytes.data(), static_cast<int>(outgoing->bytes.size()), MPI_BYTE, to, kTag,
            MPI_COMM_WORLD, &outgoing->request);
  outbox_.push_back(std::move(outgoing));
  is_flushed();
}

bool Messenger::is_flushed() {
  outbox_.remove_if([](const std::unique_ptr<Transfer>& outgoing) {
    int done = 0;
    MPI_Test(&outgoing->request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  });
  return outbox_.empty();
}

/// Begins to receive what is announced. A message above the eager limit (4 kB between ranks of a
/// host) comes only when its sender looks at MPI again: a blocking receive would spin until then.
void Messenger::accept() {
  constexpr std::size_t kMostAtOnce = 64;
  while (inbox_.size() < kMostAtOnce) {
    int there = 0;
    MPI_Message announced;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &there, &announced, &status);
    if (there == 0) return;
    int n_bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &n_bytes);
    auto incoming = std::make_unique<Transfer>();
    incoming->from = status.MPI_SOURCE;
    incoming->bytes.resize(n_bytes);
    MPI_Imrecv(incoming->bytes.data(), n_bytes, MPI_BYTE, &announced, &incoming->request);
    inbox_.push_back(std::move(incoming));
  }
}

std::optional<Messenger::Received> Messenger::receive() {
  if (!outbox_.empty()) is_flushed();
  accept();
  if (inbox_.empty()) return std::nullopt;
  int done = 0;
  MPI_Test(&inbox_.front()->request, &done, MPI_STATUS_IGNORE);
  if (done == 0) return std::nullopt;
  const std::unique_ptr<Transfer> incoming = std::move(inbox_.front());
  inbox_.pop_front();
  return Received{incoming->from, decode(incoming->bytes)};
}

bool Messenger::finish(double patience) {
  IdleSleep idle;
  const faultsim::Stopwatch watch;
  // Nobody reads any more, but what is never received is never sent either: it is thrown away.
  const auto wait = [&] {
    while (receive()) idle.reset();
    idle.sleep();
    return watch.seconds() < patience;
  };
  while (!is_flushed()) {
    if (!wait()) return false;
  }
  MPI_Request barrier = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &barrier);
  for (int done = 0; done == 0;) {
    MPI_Test(&barrier, &done, MPI_STATUS_IGNORE);
    if (done == 0 && !wait()) return false;
  }
  finished_ = true;
  MPI_Finalize();
  return true;
}

void Messenger::abort(int code) {
  std::fflush(nullptr);
  MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

void IdleSleep::sleep() {
  std::this_thread::sleep_for(std::chrono::microseconds(microseconds_));
  microseconds_ = std::min(2 * microseconds_, longest_);
}

}  // namespace faultsweep
