#include "simulator/app/together.h"

#include <fcntl.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <optional>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Takes the standard streams from a process that others speak for, until it has to speak itself.
class Silence {
 public:
  Silence() : errors_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  void end() const {
    if (errors_ >= 0) dup2(errors_, STDERR_FILENO);
  }

 private:
  int errors_;  // open until the process ends: what it says last may be an error
};

ExitCode code_of(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error) != nullptr) return ExitCode::input;
  if (dynamic_cast<const Interrupted*>(&error) != nullptr) return ExitCode::interrupted;
  if (dynamic_cast<const Error*>(&error) != nullptr) return ExitCode::world;
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return ExitCode::world;
  return ExitCode::bug;
}

}  // namespace

void require_started_alone(const char* command) {
  if (started_with() == 1) return;
  if (started_as() > 0) Silence();  // for good: its end puts nothing back
  throw InputError(concat("faultsim ", command),
                   concat("it was started as ", started_with(), " processes but runs in one"),
                   "start it without mpirun; only run --path coupled shares its work");
}

ExitCode together(const std::function<void(const Ranks&)>& prepare,
                  const std::function<ExitCode()>& work) {
  if (started_with() == 1) {
    prepare(Ranks());
    return work();
  }
  const Ranks ranks = Ranks::of_the_job();
  if (ranks.size() == 1) {
    if (started_as() > 0) Silence();
    throw InputError(
        "faultsim run",
        concat("it was started as ", started_with(), " processes that do not know each other"),
        "start them with mpirun; within a Slurm job it takes the job's hosts");
  }
  std::optional<Silence> silence;
  if (ranks.rank() > 0) silence.emplace();
  ExitCode code = ExitCode::done;
  std::exception_ptr wrong;
  try {
    prepare(ranks);
  } catch (const std::exception& error) {
    wrong = std::current_exception();
    code = code_of(error);
  }
  const auto worst = static_cast<ExitCode>(ranks.largest(static_cast<int>(code)));
  const int speaker = ranks.size() - ranks.largest(wrong ? ranks.size() - ranks.rank() : 0);
  if (silence && ranks.rank() == speaker) silence->end();  // only some hosts see a wrong file, say
  if (wrong) std::rethrow_exception(wrong);
  if (worst != ExitCode::done) return worst;
  try {
    return work();
  } catch (const std::exception& error) {
    if (silence) silence->end();
    ranks.abort(error.what(), static_cast<int>(code_of(error)));
  }
}

}  // namespace faultsim
