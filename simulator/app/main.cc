#include <string>
#include <string_view>
#include <vector>

#include "simulator/app/program.h"
#include "simulator/app/together.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/common/version.h"
#include "simulator/linalg/blas_start.h"

namespace faultsim {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsim init field my-field.json          write a starter scene\n"
    "  faultsim init from-grid FIELD.EGRID -o field.json\n"
    "                                             a scene from your own flow grid\n"
    "  faultsim plan my-field.json                what will be modelled, unknowns, memory, time\n"
    "  faultsim run my-field.json -o out          run it: table, result.json, faults.xmf\n"
    "  faultsim run my-field.json --tier screening --set friction_angle=\"20 deg\"\n"
    "  faultsim diagnose my-field.json            check a run from outside the solver, and with "
    "noise\n"
    "  faultsim export-contact my-field.json --step 10 -o step10.hdf5\n"
    "                                             a step's contact problem for other solvers\n"
    "  faultsim influence my-field.json -o influence.h5\n"
    "                                             what pressure in each reservoir cell does\n"
    "  faultsim plot history out -o history.svg   a chart of a result\n"
    "  faultsim solver-study --h 1/8              preconditioners of the coupled path\n"
    "  faultsim environment                       processor, BLAS, compiler: for bug reports\n"
    "Exit codes: 0 done, 2 input, 3 no convergence, 4 disk or memory, 5 a comparison failed,\n"
    "            70 bug, 75 interrupted.";

/// A mistyped command is named before CLI11 asks for one.
void require_known_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::vector<std::string> names =
      mapped(app.get_subcommands(nullptr), [](const CLI::App* one) { return one->get_name(); });
  if (contains(names, argv[1])) return;
  throw InputError("faultsim", concat("\"", argv[1], "\" is not a command"),
                   "choose one of " + joined(names, ", "));
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsim_main(int argc, char** argv) {
  start_blas(argv);
  Program program;
  CLI::App& app = program.app;
  app.require_subcommand(1);
  app.get_formatter()->column_width(24);  // texts of up to 76 columns stand beside it
  app.footer(kFooter);
  app.set_version_flag("--version", version_text("faultsim"));
  for (const auto add :
       {add_init, add_looking, add_run, add_diagnose, add_export_contact, add_influence, add_plot,
        add_report, add_worker, add_what_if, add_solver_study, add_environment})
    add(program);
  try {
    require_known_command(app, argc, argv);
    if (argc > 1 && argv[1][0] != '-' && std::string_view(argv[1]) != "run")
      require_started_alone(argv[1]);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? ExitCode::done : ExitCode::input;
  }
  return program.code;
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  return static_cast<int>(faultsim::run_program("faultsim", faultsim::faultsim_main, argc, argv));
}
