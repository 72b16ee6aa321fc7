#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "simulator/app/program.h"
#include "simulator/app/request_check.h"
#include "simulator/app/worker_requests.h"
#include "simulator/app/write_all.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/process_memory.h"
#include "simulator/common/stopwatch.h"
#include "simulator/documents/json_document.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/loading/field_keeper.h"
#include "simulator/loading/run_case.h"
#include "simulator/result/result_bytes.h"
#include "simulator/result_files/field_bytes.h"
#include "simulator/scene/identity.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kProtocolVersion = 4;  // schemas/worker_protocol.md

double peak_bytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Tells what is being done for an operator whenever it is something else.
class BuildMonitor final : public Monitor {
 public:
  explicit BuildMonitor(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
  void progress(double, const std::string& what) override {
    if (what != told_) tell_(told_ = what);
  }
  void note(const std::string&) override {}

 private:
  std::function<void(const std::string&)> tell_;
  std::string told_;
};

/// Serves the requests of one family; the operator of the last scene stays in memory.
class Worker {
 public:
  explicit Worker(const WorkerArguments& arguments)
      : requests_(arguments.requests),
        replies_(arguments.replies),
        context_{silent_, StopToken(requests_.stop()), arguments.threads} {
    simulation_.keep_operators(
        {arguments.cache, static_cast<std::uint64_t>(arguments.cache_size), arguments.node_cache});
  }

  void serve() {
    say({{"event", "hello"},
         {"version", kProtocolVersion},
         {"result_layout", result_layout()},
         {"numerics_version", kNumericsVersion}});
    while (auto request = requests_.next()) {
      if (request->contains("scene")) {
        const auto number = request->at("base").get<std::int64_t>();
        bases_[number] = std::move((*request)["scene"]);
        if (number == held_) held_.reset();
      } else {
        answer(*request);
      }
    }
  }

 private:
  /// @param bytes  what follows the line as it is.
  void say(const json& message, const std::string& bytes = "") {
    write_all(replies_, message.dump() + "\n" + bytes);
  }

  void answer(const json& request) {
    const json& run = request.at("run");
    const Stopwatch watch;
    json reply = {{"event", "done"}, {"run", run}};
    const auto fail = [&](const Error& error, ExitCode code) {
      reply["error"] = error.what();
      reply["exit_code"] = static_cast<int>(code);
    };
    std::string bytes;
    try {
      require_run(request, bases_);
      take_scene(request);
      require_identity(request);
      prepare(run);
      say({{"event", "started"}, {"run", run}});
      bytes = run_one(request, reply);
    } catch (const InputError& error) {
      fail(error, ExitCode::input);
    } catch (const Interrupted& error) {
      fail(error, ExitCode::interrupted);
    } catch (const Error& error) {  // disk or memory: the next case may well fit
      fail(error, ExitCode::world);
    }
    reply["seconds"] = watch.seconds();
    say(reply, bytes);
  }

  /// The base scene with the request's changes put in.
  void take_scene(const json& request) {
    const auto base = request.at("base").get<std::int64_t>();
    const auto source = request.value("source", "case");
    if (base != held_) Inside::hold_base(simulation_, {source, bases_.at(base), {}});
    held_ = base;
    Inside::change_values(simulation_, {source, request.at("changes"), {}});
  }

  /// Refuses a scene that is not the case's: its result would be stored under another's name.
  void require_identity(const json& request) const {
    if (!request.contains("identity")) return;
    const auto wanted = request["identity"].get<std::string>();
    const std::string identity = simulation_.identity();
    if (identity == wanted || has_identity(Inside::scene(simulation_).scene, wanted)) return;
    throw InputError(request.value("source", "case"),
                     "the scene is not the one that was submitted: a file that it names, or the "
                     "program, has changed since",
                     "submit the campaign again");
  }

  void prepare(const json& run) {
    const Stopwatch watch;
    BuildMonitor monitor([&](const std::string& what) {
      say({{"event", "building"}, {"run", run}, {"what", what}});
    });
    if (!simulation_.prepare({monitor, context_.stop, context_.n_threads})) return;
    const PreparedOperator& prepared = Inside::prepared(simulation_);
    const double n_jump = prepared.op->geometry.n_dofs;
    say({{"event", "operator"},
         {"run", run},
         {"fingerprint", prepared.op->fingerprint},
         {"from_cache", prepared.from_cache},
         {"seconds", watch.seconds()},
         {"unknowns", prepared.op->n_unknowns},
         {"jump_unknowns", prepared.op->geometry.n_dofs},
         {"bytes", 8.0 * n_jump * n_jump},
         {"peak_bytes", peak_bytes()},
         {"remark", prepared.remark}});
  }

  /// The result, and after it the fields that go with it, unless a folder was given for them.
  std::string run_one(const json& request, json& reply) {
    const FaultGeometry& geometry = Inside::prepared(simulation_).op->geometry;
    const Scene& scene = Inside::scene(simulation_).scene;
    const json wanted = request.value("fields", json());
    std::optional<FieldKeeper> files;
    std::optional<FieldSelection> selection;
    std::optional<FieldBytes> in_line;
    RunWatch watch;
    if (wanted.contains("folder")) {
      files.emplace(wanted["folder"].get<std::string>(), steps_of(wanted), scene, geometry,
                    Inside::scene(simulation_).plan.creep.active);
      watch.step = [&](const StepResult& step, const FaultFields& f) { files->add(step, f); };
    } else if (!wanted.is_null()) {
      in_line.emplace(geometry);
      selection.emplace(steps_of(wanted), scene,
                        [&](const StepResult&, const FaultFields& f) { in_line->add(f); });
      watch.step = [&](const StepResult& step, const FaultFields& f) { selection->add(step, f); };
    }
    const CaseResult result = simulation_.run(context_, watch);
    if (result.outcome == Outcome::interrupted) throw Interrupted(result.reason);
    json fields;  // written before the reply announces anything: the disk may be full
    if (files) fields = {{"steps", files->finish()}};
    if (selection) {
      fields = {{"steps", selection->finish()},
                {"n_nodes", geometry.nodes.size()},
                {"bytes", in_line->bytes().size()}};
    }
    std::string bytes = result_to_bytes(result);
    reply["result_bytes"] = bytes.size();
    if (!fields.is_null()) reply["fields"] = fields;
    return in_line ? bytes + in_line->bytes() : bytes;
  }

  /// @pre the request was checked.
  static FieldSteps steps_of(const json& wanted) {
    return named<FieldSteps>(wanted.at("steps").get<std::string>()).value();
  }

  WorkerRequests requests_;
  int replies_;
  SilentMonitor silent_;
  RunContext context_;
  Simulation simulation_;
  std::map<std::int64_t, json> bases_;  ///< base scenes by the number that the campaign gave them.
  std::optional<std::int64_t> held_;    ///< of the one that the simulation holds.
};

ExitCode worker_command(const WorkerArguments& arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a worker never outlives its rank, however that dies
  if (getppid() == 1) return ExitCode::interrupted;  // the parent died before the line above
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);  // who ended it shows in the campaign
  take_blas_buffer();             // the limit counts it, and must not keep it from being had
  if (arguments.memory_limit > 0) limit_memory(arguments.memory_limit);
  try {
    Worker(arguments).serve();
  } catch (const InputError& error) {  // of a line; what was asked before it has been answered
    std::fprintf(stderr, "faultsim: %s\n", error.what());
    return ExitCode::input;
  }
  return ExitCode::done;
}

}  // namespace

void add_worker(Program& program) {
  auto [command, a] = program.add(
      "worker", "serve cases to faultsweep (schemas/worker_protocol.md)", worker_command);
  add_descriptors(command, a, kBuilding);
  command->add_option("--memory-limit", a.memory_limit, "bytes of private memory");
  command->footer("Example: faultsim worker --requests 0 --replies 1 <requests >replies");
}

}  // namespace faultsim
