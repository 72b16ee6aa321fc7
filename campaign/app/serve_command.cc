#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "campaign/app/commands.h"
#include "campaign/serve/http_server.h"
#include "campaign/serve/store_api.h"
#include "simulator/common/interrupt.h"
#include "simulator/common/machine.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {
namespace {

constexpr int kUsualPort = 8642;

struct ServeArguments {
  int port = kUsualPort;
  std::string duration;  ///< "10 min"; "" = without end.
};

/// Seconds; none = without end.
std::optional<double> seconds_of(const std::string& duration) {
  if (duration.empty()) return std::nullopt;
  const faultsim::ParsedQuantity parsed = faultsim::parse_quantity(duration, Dimension::time);
  if (!parsed.ok) throw InputError("--for", parsed.what, parsed.cure);
  return parsed.value;
}

void say_address(const HttpServer& server, bool as_json) {
  if (as_json) {
    print_json({{"address", server.address()}, {"port", server.port()}});
  } else {
    print_text(server.address() + "\n");
  }
  std::fflush(stdout);  // whoever waits for the address reads a pipe
}

/// For what-if; nothing where there is none.
std::filesystem::path simulator_if_there() {
  const std::filesystem::path binary = simulator_binary();
  return access(binary.c_str(), X_OK) == 0 ? binary : std::filesystem::path();
}

ExitCode serve_store(const StoreArguments& common, const ServeArguments& arguments) {
  const std::optional<double> duration = seconds_of(arguments.duration);
  Store::open_reader(common.store);  // which says what is wrong with it
  StoreApi api(common.store, simulator_if_there(), faultsim::usable_cores());
  const faultsim::Stopwatch watch;
  HttpServer* running = nullptr;
  ServerSettings settings;
  settings.port = arguments.port;
  const faultsim::StopToken stop = faultsim::stop_on_signals();
  std::signal(SIGPIPE, SIG_IGN);  // a simulator that has ended shows as EPIPE, and is begun anew
  settings.watch = [&] {
    api.require_store();
    if (stop.requested() || (duration && watch.seconds() >= *duration)) running->stop();
  };
  settings.remark = [said = std::string()](const std::string& remark) mutable {
    if (remark != said) say(remark);  // each request of a page that waits meets the same
    said = remark;
  };
  HttpServer server(std::move(settings),
                    [&](const HttpRequest& request) { return api.answer(request); });
  running = &server;
  say_address(server, common.json);
  say("Reading ", common.store.string(), " for this machine only. Ctrl-C stops it.");
  server.run();
  api.close();
  return ExitCode::done;
}

}  // namespace

void add_serving(Program& program) {
  auto [command, a] = program.add(
      "serve", "answers and charts of a store over HTTP, for this machine only", serve_store);
  command->add_option("store", program.common.store,
                      "its folder (default FAULTSWEEP_STORE or ./faultsweep-store)");
  constexpr int kLastPort = 65535;
  command->add_option("--port", a.port, "default 8642; 0 = any free port")
      ->check(CLI::Range(0, kLastPort));
  command->add_option("--for", a.duration, "stops after this time: \"30 min\"; default: at Ctrl-C");
  add_store(command, program.common);
  add_json(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep serve\n"
      "  faultsweep serve runs/store --port 0 --json\n"
      "It prints its address once it listens, and changes nothing in the store. The page follows\n"
      "a running campaign, and its what-if runs a case with other values on an operator kept in\n"
      "memory. GET /api lists what can be requested.");
}

}  // namespace faultsweep
