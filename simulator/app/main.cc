#include <CLI/CLI.hpp>

#include "simulator/app/commands.h"
#include "simulator/app/verify/verify.h"
#include "simulator/common/errors.h"
#include "simulator/linalg/blas_start.h"

namespace faultsim {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsim init field my-field.json          write a starter scene\n"
    "  faultsim plan my-field.json                what will be modelled, unknowns, memory, time\n"
    "  faultsim run my-field.json -o out          run it: table, result.json, faults.xmf\n"
    "  faultsim run my-field.json --tier screening --set friction_angle=\"20 deg\"\n"
    "  faultsim diagnose my-field.json            check a run from outside the solver, and with "
    "noise\n"
    "  faultsim export-contact my-field.json --step 10 -o step10.hdf5\n"
    "                                             a step's contact problem for other solvers\n"
    "  faultsim verify V1 V2                      meet the closed forms\n"
    "  faultsim environment                       processor, BLAS, compiler: for bug reports\n"
    "Exit codes: 0 done, 2 input, 3 no convergence, 4 disk or memory, 5 a comparison failed,\n"
    "            70 bug, 75 interrupted.";

void add_scene(CLI::App* command, SceneArguments& arguments) {
  command->add_option("scene", arguments.file, "scene file (JSON)")->required();
  command->add_option("--set", arguments.set, "change a value: /json/pointer=value or alias=value")
      ->type_name("POINTER=VALUE")
      ->allow_extra_args(false);
  command->add_option("--tier", arguments.tier,
                      "screening, demonstration, standard, reference or custom");
  command->add_flag("--json", arguments.json, "machine-readable output on stdout");
}

/// A mistyped command is named before CLI11 asks for one.
void demand_known_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == argv[1]) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw InputError("faultsim", {{"", 0, concat("\"", argv[1], "\" is not a command"),
                                 "choose one of " + names}});
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsim_main(int argc, char** argv) {
  start_blas(argv);
  CLI::App app{"faultsim: 3D fault reactivation in compartmentalised gas reservoirs", "faultsim"};
  app.require_subcommand(1);
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("faultsim ") + FAULTSIM_VERSION);
  ExitCode code = ExitCode::done;

  std::string kind = "field", init_file;
  CLI::App* init = app.add_subcommand("init", "write a starter scene");
  init->add_option("kind", kind, "field or box")->check(CLI::IsMember({"field", "box"}));
  init->add_option("file", init_file, "where to write it (default KIND.json)");
  init->callback(
      [&] { code = init_command(kind, init_file.empty() ? kind + ".json" : init_file); });

  SceneArguments scene;
  CLI::App* validate = app.add_subcommand("validate", "check a scene and list all its problems");
  add_scene(validate, scene);
  validate->callback([&] { code = validate_command(scene); });
  CLI::App* plan = app.add_subcommand("plan", "what will be modelled and why, sizes and cost");
  add_scene(plan, scene);
  plan->callback([&] { code = plan_command(scene); });
  CLI::App* parameters =
      app.add_subcommand("parameters", "what can be varied, with aliases and ranges");
  add_scene(parameters, scene);
  parameters->callback([&] { code = parameters_command(scene); });
  std::string mesh_output;
  CLI::App* mesh =
      app.add_subcommand("mesh", "make the mesh, report its quality, write it for ParaView");
  add_scene(mesh, scene);
  mesh->add_option("-o,--output", mesh_output, "folder for volume.h5 and volume.xmf");
  mesh->callback([&] { code = mesh_command(scene, mesh_output); });

  RunArguments run;
  std::string path = "condensed";
  CLI::App* run_app = app.add_subcommand("run", "run a scene");
  add_scene(run_app, run.scene);
  run_app->add_option("-o,--output", run.output, "result folder (default SCENE-result)");
  run_app->add_option("--cache", run.cache, "operator cache (default: the user's cache folder)");
  run_app->add_flag("--no-cache", run.no_cache, "neither read nor write cached operators");
  run_app->add_option("--path", path, "how to solve")->check(CLI::IsMember({"condensed"}));
  run_app->callback([&] { code = run_command(run); });

  DiagnoseArguments diagnosed;
  CLI::App* diagnose_app = app.add_subcommand(
      "diagnose", "run a scene, check it from outside the solver, and again with noise");
  add_scene(diagnose_app, diagnosed.scene);
  diagnose_app->add_option("--cache", diagnosed.cache,
                           "operator cache (default: the user's cache folder)");
  diagnose_app->add_flag("--no-cache", diagnosed.no_cache,
                         "neither read nor write cached operators");
  diagnose_app->footer(
      "Recomputes equilibrium, contact and energies of every load step in extended precision,\n"
      "tests the operator, and runs the case again with noise of 1e-12 in its loads. Exit code 5\n"
      "when a limit is not met; see docs/model.md, section 10.\n"
      "Example: faultsim diagnose my-field.json --set offset_east=\"200 m\"");
  diagnose_app->callback([&] { code = diagnose_command(diagnosed); });

  ExportArguments exported;
  CLI::App* export_app = app.add_subcommand(
      "export-contact", "write the contact problem of a load step as an FCLib HDF5 file");
  add_scene(export_app, exported.scene);
  export_app->add_option("--step", exported.step, "load step; 0 = the initial equilibrium")
      ->required();
  export_app->add_option("-o,--output", exported.output, "file to write")->required();
  export_app->add_flag("--freeze-strength", exported.freeze_strength,
                       "friction that weakens keeps its value at the start of the step");
  export_app->add_option("--cache", exported.cache,
                         "operator cache (default: the user's cache folder)");
  export_app->add_flag("--no-cache", exported.no_cache, "neither read nor write cached operators");
  export_app->footer(
      "Runs the scene up to the step before, and writes u = W r + q, friction coefficients and "
      "our\n"
      "solution. The step must have no cohesion; see docs/contact-export.md.\n"
      "Example: faultsim export-contact my-field.json --step 10 -o step10.hdf5");
  export_app->callback([&] { code = export_contact_command(exported); });

  WorkerArguments worker;
  CLI::App* worker_app =
      app.add_subcommand("worker", "serve cases to faultsweep (schemas/worker_protocol.md)");
  worker_app->add_option("--requests", worker.requests, "descriptor to read from")->required();
  worker_app->add_option("--replies", worker.replies, "descriptor to write to")->required();
  worker_app->add_option("--cache", worker.cache, "operator cache");
  worker_app->add_option("--node-cache", worker.node_cache,
                         "copies of cached operators on this host's own disk");
  worker_app->add_option("--cache-size", worker.cache_size, "bytes");
  worker_app->add_option("--memory-limit", worker.memory_limit, "bytes of private memory");
  worker_app->callback([&] { code = worker_command(worker); });

  bool environment_json = false;
  CLI::App* environment = app.add_subcommand(
      "environment", "what the last digits depend on: processor, BLAS, compiler, libraries");
  environment->add_flag("--json", environment_json, "machine-readable output on stdout");
  environment->callback([&] { code = environment_command(environment_json); });

  std::vector<std::string> names;
  bool list = false, json = false, slow = false, markdown = false;
  CLI::App* verify =
      app.add_subcommand("verify", "run the verification problems against closed forms");
  verify->add_option("names", names, "V1 V2 … (default: all)");
  verify->add_flag("--list", list, "list the problems");
  verify->add_flag("--json", json, "machine-readable output");
  verify->add_flag("--slow", slow, "also the members that take minutes");
  verify->add_flag("--markdown", markdown, "tables as in docs/verification.md");
  verify->callback([&] { code = verify_command(names, list, json, slow, markdown); });

  try {
    demand_known_command(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? ExitCode::done : ExitCode::input;
  }
  return code;
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  return static_cast<int>(faultsim::run_program("faultsim", faultsim::faultsim_main, argc, argv));
}
