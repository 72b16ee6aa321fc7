#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulator/common/exit_code.h"

/// The commands of `faultsim`, one function each; main.cc reads the command line.
namespace faultsim {

/// What most commands take: a scene file and changes to it.
struct SceneArguments {
  std::string file;
  std::vector<std::string> set;  ///< "/json/pointer=value" or "alias=value".
  std::string tier;              ///< replaces the scene's tier; empty = as given.
  bool json = false;
};

struct RunArguments {
  SceneArguments scene;
  std::filesystem::path output;  ///< empty = <scene name>-result beside the current folder.
  std::filesystem::path cache;   ///< empty = the user's cache folder.
  bool no_cache = false;
};

struct WorkerArguments {
  int requests = 0;  ///< descriptor to read from.
  int replies = 1;   ///< descriptor to write to.
  std::filesystem::path cache;
  double cache_size = 20e9;  ///< bytes.
};

ExitCode init_command(const std::string& kind, const std::filesystem::path& file);
ExitCode validate_command(const SceneArguments& arguments);
ExitCode plan_command(const SceneArguments& arguments);
ExitCode parameters_command(const SceneArguments& arguments);
ExitCode mesh_command(const SceneArguments& arguments, const std::filesystem::path& output);
ExitCode run_command(const RunArguments& arguments);
/// Serves cases to a campaign; see schemas/worker_protocol.md.
ExitCode worker_command(const WorkerArguments& arguments);

}  // namespace faultsim
