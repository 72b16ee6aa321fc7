#include <string>

#include "simulator/app/program.h"

namespace faultsim {
namespace {

void add_threads(CLI::App* command, int& threads, const std::string& what,
                 const std::string& unless_given) {
  command
      ->add_option("--threads", threads,
                   what + " (default: " + unless_given + "); same bits with any")
      ->check(CLI::Range(1, 1024));
}

}  // namespace

void add_json(CLI::App* command, bool& json) {
  command->add_flag("--json", json, "machine-readable output on stdout");
}

void add_changes(CLI::App* command, SceneArguments& arguments) {
  command->add_option("--set", arguments.set, "change a value: /json/pointer=value or alias=value")
      ->type_name("POINTER=VALUE")
      ->allow_extra_args(false);
  command->add_option("--tier", arguments.tier,
                      "screening, demonstration, standard, reference or custom");
}

CLI::Option* add_scene(CLI::App* command, SceneArguments& arguments) {
  CLI::Option* scene =
      command->add_option("scene", arguments.file, "scene file (JSON)")->required();
  add_changes(command, arguments);
  add_json(command, arguments.json);
  return scene;
}

void add_operator(CLI::App* command, OperatorArguments& arguments, const char* threads_are) {
  command->add_option("--cache", arguments.cache,
                      "operator cache (default: the user's cache folder)");
  command->add_flag("--no-cache", arguments.no_cache, "neither read nor write cached operators");
  add_threads(command, arguments.threads, threads_are, "all cores");
}

void add_descriptors(CLI::App* command, WorkerArguments& arguments, const char* threads_are) {
  command->add_option("--requests", arguments.requests, "descriptor to read from")->required();
  command->add_option("--replies", arguments.replies, "descriptor to write to")->required();
  command->add_option("--cache", arguments.cache, "operator cache");
  command->add_option("--node-cache", arguments.node_cache,
                      "copies of cached operators on this host's own disk");
  command->add_option("--cache-size", arguments.cache_size, "bytes");
  add_threads(command, arguments.threads, threads_are, "1");
}

}  // namespace faultsim
