#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <utility>

#include "simulator/app/commands.h"
#include "simulator/common/exit_code.h"

namespace faultsim {

/// The command line, to which commands add themselves.
struct Program {
  CLI::App app{"faultsim: 3D fault reactivation in compartmentalised gas reservoirs", "faultsim"};
  ExitCode code = ExitCode::done;  ///< of the command that was given.

  /// A command with arguments of its own, which its options are to fill; `run` gets them where it
  /// is given, and none of its subcommands.
  /// @param parent  whose subcommand it is; null = the program's.
  template <typename Arguments>
  std::pair<CLI::App*, Arguments&> add(const char* name, const char* description,
                                       ExitCode (*run)(const Arguments&),
                                       CLI::App* parent = nullptr) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = (parent != nullptr ? parent : &app)->add_subcommand(name, description);
    command->callback([this, run, arguments, command] {
      if (command->get_subcommands().empty()) code = run(*arguments);
    });
    return {command, *arguments};
  }
};

/// Commands in the order in which the help lists them.
void add_init(Program& program);                       ///< with from-grid.
void add_from_grid(Program& program, CLI::App* init);  ///< init from-grid.
void add_looking(Program& program);                    ///< validate, plan, parameters, mesh.
void add_run(Program& program);
void add_diagnose(Program& program);
void add_export_contact(Program& program);
void add_influence(Program& program);
void add_plot(Program& program);
void add_report(Program& program);
void add_worker(Program& program);
void add_what_if(Program& program);
void add_solver_study(Program& program);
void add_environment(Program& program);

/// What those commands take that other programs talk to.
struct WorkerArguments {
  int requests = 0;  ///< descriptor to read from.
  int replies = 1;   ///< descriptor to write to.
  std::filesystem::path cache;
  std::filesystem::path node_cache;  ///< CachePolicy::node_folder.
  double cache_size = 20e9;          ///< bytes.
  double memory_limit = 0;           ///< bytes of private memory; 0 = not limited.
  int threads = 1;                   ///< of a factorisation.
};

/// What --threads are: the beginning of its help.
inline constexpr const char* kBuilding = "for building an operator";
inline constexpr const char* kBuildingAndCase = "for operators, up to 4 for a case";

/// Options that several commands have.
void add_json(CLI::App* command, bool& json);
/// What changes a scene: --set, --tier.
void add_changes(CLI::App* command, SceneArguments& arguments);
/// The scene file, what changes it, and --json. @returns the scene file.
CLI::Option* add_scene(CLI::App* command, SceneArguments& arguments);
/// Where operators are kept, and the threads that build them.
void add_operator(CLI::App* command, OperatorArguments& arguments,
                  const char* threads_are = kBuilding);
/// All of WorkerArguments but the limit of memory.
void add_descriptors(CLI::App* command, WorkerArguments& arguments, const char* threads_are);

}  // namespace faultsim
