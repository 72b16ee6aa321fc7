#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <map>
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
#include "simulator/output/result_bytes.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kProtocolVersion = 3;  // schemas/worker_protocol.md

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

  /// @param bytes  what follows the line as it is.
  void say(const json& message, const std::string& bytes = "") {
    const std::string line = message.dump() + "\n" + bytes;
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
               arguments.node_cache},
        build_{.n_threads = arguments.threads} {}

  void serve() {
    channel_.say({{"event", "hello"},
                  {"version", kProtocolVersion},
                  {"result_layout", result_layout()},
                  {"numerics_version", kNumericsVersion}});
    while (const auto line = channel_.next()) {
      json request = json::parse(*line);
      if (request.contains("scene")) {
        bases_[request.at("base").get<std::int64_t>()] = std::move(request["scene"]);
      } else {
        answer(request);
      }
    }
  }

 private:
  void answer(const json& request) {
    const json& run = request.at("run");
    const Stopwatch watch;
    json reply = {{"event", "done"}, {"run", run}};
    std::string result;
    try {
      const LoadedScene loaded = load_scene(scene_of(request));
      demand_identity(request, loaded.scene);
      need_operator(run, loaded);
      channel_.say({{"event", "started"}, {"run", run}});
      result = result_to_bytes(run_one(request, loaded.scene, reply));
      reply["result_bytes"] = result.size();
    } catch (const InputError& error) {
      reply["error"] = error.what();
      reply["exit_code"] = static_cast<int>(ExitCode::input);
    } catch (const Error& error) {  // disk or memory: the next case may well fit
      reply["error"] = error.what();
      reply["exit_code"] = static_cast<int>(ExitCode::world);
    }
    reply["seconds"] = watch.seconds();
    channel_.say(reply, result);
  }

  /// The base scene with the request's changes put in.
  JsonDocument scene_of(const json& request) const {
    JsonDocument document{request.value("source", "case"), bases_.at(request.at("base")), {}};
    for (const auto& [pointer, value] : request.at("changes").items()) {
      try {
        document.value[json::json_pointer(pointer)] = value;
      } catch (const json::exception&) {
        throw InputError(document.source, {{pointer, 0, "the base scene has no place for it", ""}});
      }
    }
    return document;
  }

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
  CaseResult run_one(const json& request, const Scene& scene, json& reply) {
    SilentMonitor silent;
    if (!request.contains("fields")) return run_case(scene, prepared_, silent);
    const json& wanted = request["fields"];
    FieldKeeper keeper(wanted.at("folder").get<std::string>(),
                       field_steps_from_string(wanted.at("steps").get<std::string>()), scene,
                       prepared_.op->geometry, prepared_.ladder != nullptr);
    CaseResult result = run_case(
        scene, prepared_, silent,
        [&](const StepResult& step, const FaultFields& fields) { keeper.add(step, fields); });
    reply["fields"] = {{"steps", keeper.finish()}};
    return result;
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
    prepared_ = prepare_operator(loaded.scene, loaded.plan, cache_, false, silent, build_);
    key_ = key;
    const FaultOperator& op = *prepared_.op;
    channel_.say({{"event", "operator"},
                  {"run", run},
                  {"fingerprint", op.fingerprint},
                  {"from_cache", prepared_.from_cache},
                  {"seconds", watch.seconds()},
                  {"unknowns", op.n_unknowns},
                  {"jump_unknowns", op.geometry.n_dofs},
                  {"bytes", 8.0 * op.geometry.n_dofs * op.geometry.n_dofs},
                  {"peak_bytes", peak_bytes()},
                  {"remark", prepared_.remark}});
  }

  Channel channel_;
  CachePolicy cache_;
  BuildOptions build_;
  PreparedOperator prepared_;
  std::string key_;
  std::map<std::int64_t, json> bases_;  ///< base scenes by the number that the campaign gave them.
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
