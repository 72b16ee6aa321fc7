#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "simulator/app/program.h"
#include "simulator/app/what_if_reply.h"
#include "simulator/app/write_all.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/common/errors.h"
#include "simulator/documents/json_document.h"
#include "simulator/documents/schema.h"
#include "simulator/what_if/resident_case.h"
#include "what_if_message_schema_text.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kWhatIfVersion = 1;  // schemas/what_if_protocol.md

/// What a question is about, until it is answered.
struct Asked {
  std::vector<CaseChartRequest> charts = {};
  bool has_changes = false;
  long scene = 0;  ///< number of the scene.
};

const char* name_of(QuestionState state) {
  switch (state) {
    case QuestionState::building:
      return "building";
    case QuestionState::running:
      return "running";
    case QuestionState::done:
      return "done";
    case QuestionState::failed:
      return "failed";
    case QuestionState::superseded:
      return "superseded";
  }
  return "";
}

/// A line of the protocol. Throws InputError where it is none.
/// @param last  number of the question before, 0 where there was none.
json message_of(const std::string& line, long last) {
  static const Schema schema(json::parse(embedded::what_if_message_schema_text));
  const JsonDocument message = parse_json(line, "question");
  std::vector<Problem> problems = check_schema(message, schema);
  if (problems.empty() && !message.value.contains("scene") &&
      message.value.value("ask", 0L) <= last) {
    problems.push_back({"/ask", 1, "neither a scene nor a question with a number of its own",
                        concat("write {\"ask\": ", last + 1, ", \"changes\": {...}}")});
  }
  if (!problems.empty()) throw InputError("question", problems);
  return message.value;
}

/// Values by JSON pointer as changes.
Changes changes_of(const json& values) {
  Changes changes;
  for (const auto& [pointer, value] : values.items())
    changes.push_back({pointer, value.is_string() ? value.get<std::string>() : value.dump()});
  return changes;
}

/// Throws InputError where there is no such chart.
std::vector<CaseChartRequest> charts_of(const json& question) {
  std::vector<CaseChartRequest> wanted;
  CaseChartRequest request;
  request.with_cursor = question.value("cursor", false);
  request.fault = question.value("fault", "");
  if (question.contains("step")) request.step = question.at("step").get<int>();
  request.show = field_shown("show", question.value("show", "chi"));
  for (const json& name : question.value("charts", json::array())) {
    const CaseChartInfo* info = case_chart_named(name.get<std::string>());
    if (info == nullptr)
      throw InputError("charts", name.dump() + " is not a chart of a case", "faultsim plot --help");
    request.chart = info->chart;
    wanted.push_back(request);
  }
  return wanted;
}

/// Answers questions until there are no more.
class WhatIf {
 public:
  explicit WhatIf(const WorkerArguments& arguments)
      : replies_(arguments.replies),
        resident_({arguments.cache, static_cast<std::uint64_t>(arguments.cache_size),
                   arguments.node_cache},
                  arguments.threads) {
    resident_.listen([this](long number, const QuestionProgress& how) { tell(number, how); });
    say({{"event", "hello"}, {"version", kWhatIfVersion}});
  }

  void take(const json& message) {
    if (message.contains("scene")) {
      base_ = {message.value("source", "case"), message.at("scene"), {}};
      const std::lock_guard lock(mutex_);
      ++scene_;
      original_ = nullptr;
      return;
    }
    const long number = message.at("ask").get<long>();
    const json changes = message.value("changes", json::object());
    try {
      {
        Asked asked = {charts_of(message), !changes.empty()};
        const std::lock_guard lock(mutex_);
        asked.scene = scene_;
        asked_[number] = std::move(asked);
      }
      resident_.ask(number, base_, changes_of(changes));
    } catch (const InputError& error) {
      forget(number);
      say({{"ask", number}, {"state", "refused"}, {"problems", what_if_problems(error)}});
    }
  }

 private:
  /// What the question is about; nothing where it was refused before that was known.
  Asked forget(long number) {
    const std::lock_guard lock(mutex_);
    auto node = asked_.extract(number);
    return node ? std::move(node.mapped()) : Asked();
  }
  /// The case before the question's changes, nullptr where there is none; the shown case becomes
  /// that of later questions where it has none.
  std::shared_ptr<const ShownCase> original_of(const Asked& asked,
                                               const std::shared_ptr<const ShownCase>& shown) {
    const std::lock_guard lock(mutex_);
    if (asked.scene != scene_) return nullptr;
    if (asked.has_changes) return original_;
    original_ = shown;
    return nullptr;
  }
  void tell(long number, const QuestionProgress& how) {
    json reply = {{"ask", number}, {"state", name_of(how.state)}};
    if (!how.says.empty()) reply["says"] = how.says;
    if (!how.is_open()) {
      const Asked asked = forget(number);
      if (how.shown != nullptr) {
        const auto original = original_of(asked, how.shown);
        reply.update(what_if_reply(*how.shown, original.get(), asked.charts));
      }
    }
    say(reply);
  }
  void say(const json& message) {
    const std::lock_guard lock(writing_);
    try {
      write_all(replies_, message.dump(-1, ' ', false, json::error_handler_t::replace) + "\n");
    } catch (const StorageError&) {  // whoever asked is gone, and with it all that is to be done
      std::_Exit(static_cast<int>(ExitCode::world));
    }
  }

  int replies_;
  JsonDocument base_;
  std::mutex mutex_, writing_;
  std::map<long, Asked> asked_;                ///< questions that are open.
  long scene_ = 0;                             ///< number of the present scene.
  std::shared_ptr<const ShownCase> original_;  ///< the present scene without changes.
  ResidentCase resident_;                      ///< the last member: its thread uses the others.
};

ExitCode what_if_command(const WorkerArguments& arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives the one who asks
  if (getppid() == 1) return ExitCode::interrupted;
  std::signal(SIGPIPE, SIG_IGN);
  WhatIf what_if(arguments);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(fdopen(arguments.requests, "r"),
                                                             std::fclose);
  if (file == nullptr) throw InputError("--requests", "is not an open descriptor", "give one");
  char* line = nullptr;
  std::size_t size = 0;
  long last = 0;
  while (getline(&line, &size, file.get()) > 0) {
    const json message = message_of(line, last);
    last = message.value("ask", last);
    what_if.take(message);
  }
  std::free(line);
  return ExitCode::done;
}

}  // namespace

void add_what_if(Program& program) {
  auto [command, a] = program.add(
      "what-if", "answer the newest question about a scene (schemas/what_if_protocol.md)",
      what_if_command);
  add_descriptors(command, a, kBuildingAndCase);
  command->footer("Example: faultsim what-if --requests 0 --replies 1 <questions >answers");
}

}  // namespace faultsim
