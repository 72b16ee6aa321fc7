#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulator/common/exit_code.h"
#include "simulator/result/result.h"

/// What the commands of `faultsim` share, and those that tests call as functions: without the
/// command line, which is program.h's.
namespace faultsim {

/// What most commands take: a scene file and changes to it.
struct SceneArguments {
  std::string file;
  std::vector<std::string> set;  ///< "/json/pointer=value" or "alias=value".
  std::string tier;              ///< replaces the scene's tier; empty = as given.
  bool json = false;
};

/// Where a command's operator is kept, and what may be spent on building it.
struct OperatorArguments {
  std::filesystem::path cache;  ///< empty = the user's cache folder.
  bool no_cache = false;
  int threads = 0;  ///< of the factorisation; 0 = every core that this process may use.
};

struct RunArguments {
  SceneArguments scene;
  OperatorArguments op;
  std::filesystem::path output;    ///< empty = <scene name>-result beside the current folder.
  bool wide = false;               ///< the step table with all its columns.
  bool trace = false;              ///< how each load step was solved (docs/trace.md).
  bool exact = false;              ///< the exact operator, whatever the scene says of a surface.
  std::string path = "condensed";  ///< or coupled, automatic.
  std::string leading = "amg-u", schur = "rac";  ///< of the coupled path.
};

struct ExportArguments {
  SceneArguments scene;
  OperatorArguments op;
  int step = 0;                  ///< load step whose contact problem is wanted.
  std::filesystem::path output;  ///< the HDF5 file.
  bool freeze_strength = false;  ///< weakening friction keeps its value at the start of the step.
};

struct InfluenceArguments {
  SceneArguments scene;
  std::vector<std::string> regions;  ///< names of compartments; empty = all.
  OperatorArguments op;
  std::filesystem::path output;  ///< the HDF5 file.
};

/// From a flow grid to a scene; lengths as text with their unit, "" = the default.
struct FromGridArguments {
  std::filesystem::path grid;           ///< CASE.EGRID.
  std::filesystem::path init, restart;  ///< beside it; empty = what is there.
  std::filesystem::path layers;         ///< table of rock; empty = assumed.
  std::filesystem::path output;         ///< the scene.
  bool force = false;
  std::string least_offset, reference_depth, margin, base, overshoot, strike, least_layer;
  int fewest_edges = 3, every_layer = 0;
  double straightening = 0.5, tetrahedra = 100'000;
  bool faults_by_connections = false, no_bridges = false, extend_faults = false;
  std::string compartments = "faults";  ///< or EQLNUM, FIPNUM.
};

/// What the outcome of a case is to a shell.
ExitCode exit_code_of(Outcome outcome);

/// Writes a scene of a flow grid, its tables, a report and two pictures (grid_scene/grid_scene.h).
ExitCode init_from_grid_command(const FromGridArguments& arguments);
ExitCode run_command(const RunArguments& arguments);
/// Writes the contact problem of one load step, and our solution, as an FCLib file. Ends with
/// no_convergence when the case does not reach the step, or the step has no solution to add.
ExitCode export_contact_command(const ExportArguments& arguments);
/// Writes what a pressure change in each reservoir cell does to the faults (model/influence.h).
ExitCode influence_command(const InfluenceArguments& arguments);

}  // namespace faultsim
