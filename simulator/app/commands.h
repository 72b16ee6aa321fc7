#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/exit_code.h"
#include "simulator/result/result.h"

/// The commands of `faultsim`, one function each; main.cc reads the command line.
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

struct DiagnoseArguments {
  SceneArguments scene;
  OperatorArguments op;
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

struct PlotArguments {
  std::string chart;             ///< a name of case_charts().
  std::string result;            ///< folder that `run` wrote.
  std::filesystem::path output;  ///< .svg or .png.
  std::string fault;             ///< "" = the most critical one.
  std::optional<int> step;       ///< load step; none = the most critical one.
  std::string show = "chi";      ///< of a fault map: a word of MapField.
  std::string before;            ///< folder of another run, drawn as thin lines; "" = none.
};

struct ReportArguments {
  std::string result;            ///< folder that `run` wrote.
  std::filesystem::path output;  ///< .html.
  std::string program;           ///< with version and commit, for the provenance.
};

struct WorkerArguments {
  int requests = 0;  ///< descriptor to read from.
  int replies = 1;   ///< descriptor to write to.
  std::filesystem::path cache;
  std::filesystem::path node_cache;  ///< CachePolicy::node_folder.
  double cache_size = 20e9;          ///< bytes.
  double memory_limit = 0;           ///< bytes of private memory; 0 = not limited.
  int threads = 1;                   ///< of a factorisation.
};

struct SolverStudyArguments {
  SceneArguments scene;  ///< studied instead of the cases where it has a file.
  std::vector<std::string> cases = {"box"}, stages = {"stick"};  ///< StudyCase, FaultStage, "all".
  std::vector<std::string> cell_sizes = {"1/2", "1/4"};          ///< h of the box, "1/8".
  std::vector<std::string> leading = {"exact"}, schur = {"fsai+dir", "bds", "lsc"};  ///< or "all".
  std::string form = "upper";
  int fsai_steps = 0, fsai_step_size = 0;  ///< 0 = as FsaiOptions.
  double fsai_tolerance = 0;
  int max_iterations = 500;
  std::filesystem::path export_to;  ///< folder for the systems; empty = they are solved.
  bool json = false;
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

ExitCode init_command(const std::string& kind, const std::filesystem::path& file);
/// Writes a scene of a flow grid, its tables, a report and two pictures (grid_scene/grid_scene.h).
ExitCode init_from_grid_command(const FromGridArguments& arguments);
ExitCode validate_command(const SceneArguments& arguments);
ExitCode plan_command(const SceneArguments& arguments);
ExitCode parameters_command(const SceneArguments& arguments);
ExitCode mesh_command(const SceneArguments& arguments, const std::filesystem::path& output);
ExitCode run_command(const RunArguments& arguments);
/// Runs a scene, checks every step from outside the solver and runs it again with noise in its
/// loads (loading/diagnosis.h). Ends with regress when a limit is not met.
ExitCode diagnose_command(const DiagnoseArguments& arguments);
/// Writes the contact problem of one load step, and our solution, as an FCLib file. Ends with
/// no_convergence when the case does not reach the step, or the step has no solution to add.
ExitCode export_contact_command(const ExportArguments& arguments);
/// Writes what a pressure change in each reservoir cell does to the faults (model/influence.h).
ExitCode influence_command(const InfluenceArguments& arguments);
/// Draws a chart of a result folder (case_figures/case_figures.h).
ExitCode plot_command(const PlotArguments& arguments);
/// Writes a result folder as one page (page/run_page.h).
ExitCode report_command(const ReportArguments& arguments);
/// Prints what the bits of results depend on besides the scene: processor, BLAS, compiler, flags,
/// libraries; and their fingerprint. No names of machines, no paths.
ExitCode environment_command(bool json);
/// Iterations, time and memory of the coupled path's preconditioners on a published cracked box
/// (coupled/box_study.h). Throws InputError with all names that are none.
ExitCode solver_study_command(const SolverStudyArguments& arguments);
/// Serves cases to a campaign; see schemas/worker_protocol.md.
ExitCode worker_command(const WorkerArguments& arguments);
/// Serves questions to a page; see schemas/what_if_protocol.md.
ExitCode what_if_command(const WorkerArguments& arguments);

}  // namespace faultsim
