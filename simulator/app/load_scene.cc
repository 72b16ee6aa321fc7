#include "simulator/app/load_scene.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "simulator/app/screen.h"
#include "simulator/common/interrupt.h"
#include "simulator/common/machine.h"
#include "simulator/loading/pressure_warnings.h"
#include "simulator/output/output_target.h"
#include "simulator/plan/geometry_check.h"
#include "simulator/scene/csv_tables.h"

namespace faultsim {
namespace {

std::filesystem::path user_cache() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"))
    return std::filesystem::path(xdg) / "faultsim";
  if (const char* home = std::getenv("HOME"))
    return std::filesystem::path(home) / ".cache" / "faultsim";
  return {};
}

/// Throws them, if there are any, with the lines of what they are about.
void throw_problems(const JsonDocument& document, std::vector<Problem> problems) {
  if (problems.empty()) return;
  for (Problem& problem : problems) {
    if (problem.line == 0) problem.line = document.line_of(problem.pointer);
  }
  throw InputError(document.source, std::move(problems));
}

}  // namespace

LoadedScene load_scene(JsonDocument document) {
  LoadedScene loaded{std::move(document), {}, {}};
  std::vector<Problem> problems;
  loaded.scene = read_scene(loaded.document, problems);
  if (problems.empty()) loaded.plan = make_plan(loaded.scene, problems);
  throw_problems(loaded.document, std::move(problems));
  return loaded;
}

void check_geometry(const LoadedScene& loaded) {
  throw_problems(loaded.document, geometry_problems(loaded.scene, loaded.plan));
}

LoadedScene load_scene(const SceneArguments& arguments) {
  JsonDocument document = read_json_file(arguments.file);
  if (!arguments.tier.empty()) set_value(document, "/tier", arguments.tier);
  for (const std::string& change : arguments.set) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos) {
      throw InputError("--set", {{"", 0, "\"" + change + "\" has no \"=\"",
                                  "write --set /json/pointer=value or --set alias=value"}});
    }
    set_value(document, resolve_parameter(document, change.substr(0, equals)),
              change.substr(equals + 1));
  }
  embed_tables(document);  // what is read now is what runs, and what is written beside the result
  LoadedScene loaded = load_scene(std::move(document));
  loaded.plan.warnings = pressure_warnings(loaded.scene);
  return loaded;
}

std::vector<std::filesystem::path> input_files(const LoadedScene& loaded) {
  return files_named_in(loaded.document.value, loaded.document.source);
}

nlohmann::json remarks_to_json(const LoadedScene& loaded) {
  nlohmann::json remarks = nlohmann::json::array();
  for (const Remark& remark : loaded.scene.remarks) {
    remarks.push_back({{"pointer", remark.pointer},
                       {"line", loaded.document.line_of(remark.pointer)},
                       {"what", remark.what}});
  }
  return remarks;
}

std::string remarks_to_text(const LoadedScene& loaded) {
  std::string text;
  for (const Remark& remark : loaded.scene.remarks) {
    const int line = loaded.document.line_of(remark.pointer);
    text += "warning: " + loaded.document.source + (line > 0 ? concat(":", line) : std::string()) +
            ": " + remark_text(remark) + "\n";
  }
  return text;
}

CachePolicy cache_policy(const OperatorArguments& arguments) {
  CachePolicy policy;
  if (!arguments.no_cache) {
    policy.folder = arguments.cache.empty() ? user_cache() : arguments.cache;
  }
  return policy;
}

BuildOptions build_options(const OperatorArguments& arguments) {
  return {.n_threads = arguments.threads > 0 ? arguments.threads : usable_cores()};
}

PreparedOperator prepare_on_screen(const LoadedScene& loaded, const OperatorArguments& arguments,
                                   bool quiet) {
  ScreenMonitor monitor(quiet);
  PreparedOperator prepared = prepare_operator(loaded.scene, loaded.plan, cache_policy(arguments),
                                               false, monitor, build_options(arguments));
  if (!prepared.remark.empty()) monitor.note(prepared.remark);
  monitor.clear();
  throw_if_interrupted("building the operator");
  return prepared;
}

}  // namespace faultsim
