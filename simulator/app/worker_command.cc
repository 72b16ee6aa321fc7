#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/app/commands.h"
#include "simulator/app/load_scene.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/process_memory.h"
#include "simulator/common/stopwatch.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/loading/field_keeper.h"
#include "simulator/loading/run_case.h"
#include "simulator/output/write_result.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kProtocolVersion = 2;  // schemas/worker_protocol.md

/// JSON lines over two descriptors.
class Channel {
 public:
  Channel(int requests, int replies) : requests_(requests), replies_(replies) {}

  /// The next line, or nothing at end of file.
  std::optional<std::string> next() {
    while (true) {
      if (const std::size_t end = buffer_.find('\n', scanned_); end != std::string::npos) {
        std::string line = buffer_.substr(0, end);
        buffer_.erase(0, end + 1);
        scanned_ = 0;
        return line;
      }
      scanned_ = buffer_.size();
      std::array<char, 65536> block;
      const ssize_t n = read(requests_, block.data(), block.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return std::nullopt;
      buffer_.append(block.data(), static_cast<std::size_t>(n));
    }
  }

  void say(const json& message) {
    const std::string line = message.dump() + "\n";
    std::size_t sent = 0;
    while (sent < line.size()) {
      const ssize_t n = write(replies_, line.data() + sent, line.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw StorageError("the campaign no longer listens");
      sent += static_cast<std::size_t>(n);
    }
  }

 private:
  int requests_, replies_;
  std::string buffer_;
  std::size_t scanned_ = 0;
};

double peak_bytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Serves the requests of one family; the operator of the last scene stays in memory.
class Worker {
 public:
  Worker(const WorkerArguments& arguments)
      : channel_(arguments.requests, arguments.replies),
        cache_{arguments.cache, static_cast<std::uint64_t>(arguments.cache_size),
               arguments.node_cache} {}

  void serve() {
    channel_.say({{"event", "hello"},
                  {"version", kProtocolVersion},
                  {"numerics_version", kNumericsVersion}});
    while (const auto line = channel_.next()) {
      const json request = json::parse(*line);
      const json& run = request.at("run");
      const Stopwatch watch;
      json reply = {{"event", "done"}, {"run", run}};
      try {
        JsonDocument document{request.value("source", "case"), request.at("scene"), {}};
        const LoadedScene loaded = load_scene(std::move(document));
        demand_identity(request, loaded.scene);
        need_operator(run, loaded);
        channel_.say({{"event", "started"}, {"run", run}});
        run_one(request, loaded.scene, reply);
      } catch (const InputError& error) {
        reply["error"] = error.what();
        reply["exit_code"] = static_cast<int>(ExitCode::input);
      } catch (const Error& error) {  // disk or memory: the next case may well fit
        reply["error"] = error.what();
        reply["exit_code"] = static_cast<int>(ExitCode::world);
      }
      reply["seconds"] = watch.seconds();
      channel_.say(reply);
    }
  }

 private:
  /// Refuses a scene that is not the case's: its result would be stored under another's name.
  static void demand_identity(const json& request, const Scene& scene) {
    if (!request.contains("identity")) return;
    const auto wanted = request["identity"].get<std::string>();
    if (has_identity(scene, wanted)) return;
    throw InputError(
        request.value("source", "case"),
        {{"", 0,
          concat("the scene has the identity ", case_identity(scene).substr(0, 12), ", its case ",
                 wanted.substr(0, 12)),
          "a file that it names has changed since it was submitted; submit the campaign again"}});
  }

  /// A result goes out only with the fields that were asked for.
  void run_one(const json& request, const Scene& scene, json& reply) {
    SilentMonitor silent;
    if (!request.contains("fields")) {
      reply["result"] = result_to_json(run_case(scene, prepared_, silent));
      return;
    }
    const json& wanted = request["fields"];
    FieldKeeper keeper(wanted.at("folder").get<std::string>(),
                       field_steps_from_string(wanted.at("steps").get<std::string>()), scene,
                       prepared_.op->geometry, prepared_.ladder != nullptr);
    const CaseResult result = run_case(
        scene, prepared_, silent,
        [&](const StepResult& step, const FaultFields& fields) { keeper.add(step, fields); });
    reply["fields"] = {{"steps", keeper.finish()}};
    reply["result"] = result_to_json(result);
  }

  void need_operator(const json& run, const LoadedScene& loaded) {
    std::string key = loaded.plan.family;
    for (const Fault& fault : loaded.scene.faults) key += "/" + fault.name;
    for (const ObservationPoint& point : loaded.scene.output.observation_points) {
      key += concat("/", point.name, point.position[0], ",", point.position[1], ",",
                    point.position[2]);
    }
    if (prepared_.op && key == key_) return;
    const Stopwatch watch;
    prepared_ = {};  // frees the old operator before the new one is built
    SilentMonitor silent;
    prepared_ = prepare_operator(loaded.scene, loaded.plan, cache_, false, silent);
    key_ = key;
    const FaultOperator& op = *prepared_.op;
    channel_.say({{"event", "operator"},
                  {"run", run},
                  {"fingerprint", op.fingerprint},
                  {"from_cache", prepared_.from_cache},
                  {"seconds", watch.seconds()},
                  {"unknowns", op.n_unknowns},
                  {"jump_unknowns", op.geometry.n_dofs},
                  {"bytes", 8.0 * static_cast<double>(op.h.size())},
                  {"peak_bytes", peak_bytes()},
                  {"remark", prepared_.remark}});
  }

  Channel channel_;
  CachePolicy cache_;
  PreparedOperator prepared_;
  std::string key_;
};

}  // namespace

ExitCode worker_command(const WorkerArguments& arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a worker never outlives its rank, however that dies
  if (getppid() == 1) return ExitCode::interrupted;  // the parent died before the line above
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);  // who ended it shows in the campaign
  take_blas_buffer();             // the limit counts it, and must not keep it from being had
  if (arguments.memory_limit > 0) limit_memory(arguments.memory_limit);
  Worker(arguments).serve();
  return ExitCode::done;
}

}  // namespace faultsim
