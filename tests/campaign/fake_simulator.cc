// A stand-in for `faultsim` that speaks schemas/worker_protocol.md and answers at once with a
// made-up result. The scene's title says what to do: one of the words of `obey`, or anything else
// for a result whose strength is the scene's number "strength" (default: from the number in the
// title).
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulator/common/fingerprint.h"
#include "simulator/result/result_bytes.h"
#include "tests/campaign/made_up_result.h"

namespace {

using nlohmann::json;

struct Channel {
  int requests = -1, replies = -1;
  std::string cache;
};

void write_all(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(descriptor, text.data() + at, text.size() - at);
    if (n <= 0) std::_Exit(0);  // nobody listens any more
    at += static_cast<std::size_t>(n);
  }
}

void reply(const Channel& channel, const json& value) {
  write_all(channel.replies, value.dump() + "\n");
}

[[noreturn]] void use_up_memory() {
  try {
    std::vector<std::string> hoard;
    for (int k = 0; k < 4096; ++k) hoard.emplace_back(std::size_t{1} << 24, 'x');
  } catch (const std::bad_alloc&) {
  }
  std::fprintf(stderr, "faultsim: out of memory\n");
  std::_Exit(4);
}

/// Does what the word says; true if the case is then answered as usual.
bool obey(const Channel& channel, const std::string& title, const json& run) {
  if (title == "crash") std::raise(SIGSEGV);
  if (title == "killed") std::raise(SIGKILL);
  if (title == "hang") pause();
  if (title == "exit") std::_Exit(7);
  if (title == "allocate") use_up_memory();
  if (title == "garbage") write_all(channel.replies, "Residual norm 1.2e-3\n");
  if (title == "half") {
    write_all(channel.replies, "{\"event\": \"do");
    std::_Exit(0);
  }
  if (title == "wrong run") reply(channel, {{"event", "started"}, {"run", 123456789}});
  if (title == "refuse") {
    reply(channel,
          {{"event", "done"}, {"run", run}, {"error", "friction angle < 0"}, {"exit_code", 2}});
    return false;
  }
  if (title == "noise") {
    for (int k = 0; k < 20000; ++k) std::printf("line %d of a library that likes to talk\n", k);
    std::fflush(stdout);
  }
  if (title == "slow") usleep(100000);
  if (title == "environment") {
    for (char** entry = environ; *entry != nullptr; ++entry) std::fprintf(stderr, "%s\n", *entry);
    std::_Exit(7);
  }
  return true;
}

void serve(const Channel& channel, const json& request, bool& has_operator) {
  static std::map<int, json> bases;
  if (request.contains("scene")) {
    bases[request.at("base")] = request["scene"];
    return;
  }
  const json& run = request.at("run");
  json scene = bases.at(request.at("base"));
  for (const auto& [pointer, value] : request.at("changes").items()) {
    scene[json::json_pointer(pointer)] = value;
  }
  const std::string title = scene.value("title", "");
  const std::string family = scene.value("family", "only");
  if (title == "refuse early") {
    reply(channel, {{"event", "done"}, {"run", run}, {"error", "no such layer"}, {"exit_code", 2}});
    return;
  }
  // As faultsim does: the first case's time has the operator's in it.
  const double operator_seconds = has_operator ? 0 : 7;
  if (!has_operator) {
    if (title == "operator crash") std::abort();
    if (title == "operator hang") pause();
    const std::string fingerprint = faultsim::fingerprint(family);
    bool cached = false;
    if (!channel.cache.empty()) {
      const std::string file = channel.cache + "/" + fingerprint + ".h5";
      cached = std::filesystem::exists(file);
      std::filesystem::create_directories(channel.cache);
      std::ofstream(file) << family;
    }
    reply(channel, {{"event", "building"}, {"run", run}, {"what", "operator 3 of a surface"}});
    if (!cached) usleep(static_cast<useconds_t>(1e6 * scene.value("operator_seconds", 0.0)));
    reply(channel, {{"event", "operator"},
                    {"run", run},
                    {"fingerprint", fingerprint},
                    {"from_cache", cached},
                    {"seconds", operator_seconds},
                    {"unknowns", 1000},
                    {"jump_unknowns", 100},
                    {"bytes", 80000},
                    {"peak_bytes", 1000000}});
    has_operator = true;
  }
  reply(channel, {{"event", "started"}, {"run", run}});
  if (!obey(channel, title, run)) return;
  usleep(static_cast<useconds_t>(1e6 * scene.value("seconds", 0.0)));
  json done = {{"event", "done"}, {"run", run}, {"seconds", 0.001 + operator_seconds}};
  if (request.contains("fields") && title != "no fields") {
    const std::filesystem::path folder = request["fields"].at("folder").get<std::string>();
    std::filesystem::create_directories(folder);
    for (const char* file : {"faults.h5", "faults.xmf"}) {
      std::ofstream(folder / file) << request["fields"].at("steps").get<std::string>();
    }
    done["fields"] = {{"steps", {0}}};
  }
  const auto result =
      faultsweep::testing::made_up_result(scene.value("strength", 0.3), scene.value("steps", 12));
  std::string bytes = faultsim::result_to_bytes(result);
  done["result_bytes"] = bytes.size();
  if (title == "damaged") bytes[bytes.size() / 2] ^= 0x10;
  if (title == "cut off") bytes.resize(bytes.size() / 2);
  write_all(channel.replies, done.dump() + "\n" + bytes);
  if (title == "cut off") std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Channel channel;
  for (int k = 2; k + 1 < argc; k += 2) {
    if (std::strcmp(argv[k], "--requests") == 0) channel.requests = std::atoi(argv[k + 1]);
    if (std::strcmp(argv[k], "--replies") == 0) channel.replies = std::atoi(argv[k + 1]);
    if (std::strcmp(argv[k], "--cache") == 0) channel.cache = argv[k + 1];
    if (std::strcmp(argv[k], "--memory-limit") == 0) {
      const auto bytes = static_cast<rlim_t>(std::atoll(argv[k + 1]));
      const rlimit limit = {bytes, bytes};
      setrlimit(RLIMIT_DATA, &limit);
    }
  }
  if (argc < 2 || std::strcmp(argv[1], "worker") != 0) return 2;
  if (const char* failure = std::getenv("FAKE_SIMULATOR_START")) return std::atoi(failure);
  if (const char* once = std::getenv("FAKE_SIMULATOR_KILLED_ONCE")) {
    if (!std::filesystem::exists(once)) {
      std::ofstream(once) << "killed";
      raise(SIGKILL);
    }
  }
  const bool other = std::getenv("FAKE_SIMULATOR_OTHER_BUILD") != nullptr;
  reply(channel, {{"event", "hello"},
                  {"version", 4},
                  {"result_layout", other ? "other" : faultsim::result_layout()},
                  {"numerics_version", 1}});
  std::FILE* requests = fdopen(channel.requests, "r");
  char* line = nullptr;
  std::size_t capacity = 0;
  bool has_operator = false;
  while (getline(&line, &capacity, requests) > 0) {
    serve(channel, json::parse(line), has_operator);
  }
  return 0;
}
