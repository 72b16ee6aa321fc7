#include <CLI/CLI.hpp>

#include "simulator/app/commands.h"
#include "simulator/app/together.h"
#include "simulator/case_figures/case_figures.h"
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
    "                                             a scene of your own flow grid\n"
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

/// What changes a scene: --set, --tier.
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
  command->add_flag("--json", arguments.json, "machine-readable output on stdout");
  return scene;
}

/// A mistyped command is named before CLI11 asks for one.
void require_known_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::vector<std::string> names =
      mapped(app.get_subcommands(nullptr), [](const CLI::App* one) { return one->get_name(); });
  if (contains(names, argv[1])) return;
  throw InputError("faultsim", concat("\"", argv[1], "\" is not a command"),
                   "choose one of " + joined(names, ", "));
}

/// All arguments of all commands; CLI11 fills them.
struct Arguments {
  std::string init_kind = "field", init_file, mesh_output;
  FromGridArguments from_grid;
  SceneArguments scene;
  RunArguments run;
  DiagnoseArguments diagnosed;
  ExportArguments exported;
  InfluenceArguments influence;
  PlotArguments plot;
  ReportArguments report;
  WorkerArguments worker;
  SolverStudyArguments study;
  bool environment_json = false;
};

constexpr const char* kBuilding = "for building an operator";
constexpr const char* kBuildingAndCase = "for operators, up to 4 for a case";

void add_threads(CLI::App* command, int& threads, const std::string& what,
                 const std::string& unless_given) {
  command
      ->add_option("--threads", threads,
                   what + " (default: " + unless_given + "); same bits with any")
      ->check(CLI::Range(1, 1024));
}

void add_operator(CLI::App* command, OperatorArguments& arguments,
                  const char* threads_are = kBuilding) {
  command->add_option("--cache", arguments.cache,
                      "operator cache (default: the user's cache folder)");
  command->add_flag("--no-cache", arguments.no_cache, "neither read nor write cached operators");
  add_threads(command, arguments.threads, threads_are, "all cores");
}

void add_recognition(CLI::App* command, FromGridArguments& a) {
  command->add_option("--least-offset", a.least_offset,
                      "smaller steps between columns are no fault (default \"20 ft\")");
  command->add_option("--fewest-edges", a.fewest_edges, "of the grid, of a fault (default 3)")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--straightening", a.straightening,
                   "cells that traces may leave the grid's edges (default 0.5)")
      ->check(CLI::Range(0.01, 10.0));
  command->add_option("--reference-depth", a.reference_depth,
                      "where traces are drawn (default: the reservoir's top beside faults)");
  command->add_flag("--faults-by-connections", a.faults_by_connections,
                    "non-neighbour connections make a fault at smaller steps");
  command->add_flag("--no-bridges", a.no_bridges, "smaller steps between two tips join nothing");
  command->add_flag("--extend-faults", a.extend_faults,
                    "compartments are parted beyond tips, on to the next fault or edge");
  command
      ->add_option("--compartments", a.compartments,
                   "what bounds them: faults (default), EQLNUM, FIPNUM")
      ->check(CLI::IsMember({"faults", "EQLNUM", "FIPNUM"}));
}

void add_from_grid(CLI::App* init, FromGridArguments& a, ExitCode& code) {
  CLI::App* command = init->add_subcommand(
      "from-grid", "a scene of a flow grid: horizons, faults, compartments, pressures");
  command->add_option("grid", a.grid, "CASE.EGRID")->required();
  command->add_option("--init", a.init, "CASE.INIT (default: the one beside the grid)");
  command->add_option("--restart", a.restart,
                      "CASE.UNRST or CASE.X0001 (default: those beside the grid)");
  command->add_option("-o,--output", a.output, "the scene; its tables are written beside it")
      ->required();
  command->add_flag("--force", a.force, "replace files that are there");
  command->add_option("--layers", a.layers,
                      "CSV of rock: name, top [m], density [kg/m3], youngs_modulus [GPa],\n"
                      "poisson_ratio, from the surface down; one is called reservoir");
  command
      ->add_option("--every-layer", a.every_layer,
                   "also the top of every so many layers of the grid (default: none)")
      ->check(CLI::Range(0, 10000));
  command->add_option("--least-layer", a.least_layer,
                      "thickness of the model's layers (default: a fifth of a cell at faults)");
  command->add_option("--overshoot", a.overshoot,
                      "of faults above and below the reservoir (default \"150 m\")");
  command->add_option("--margin", a.margin,
                      "beside the active map (default: twice the depth, 5 km at least)");
  command->add_option("--base", a.base, "depth of the model (default: twice the reservoir's)");
  command->add_option("--strike", a.strike,
                      "size of cells at faults (default: half the grid's, or by --tetrahedra)");
  command->add_option("--tetrahedra", a.tetrahedra, "about how many (default 100000)")
      ->check(CLI::Range(1e3, 1e8));
  add_recognition(command, a);
  command->footer(
      "Examples:\n"
      "  faultsim init from-grid FIELD.EGRID -o field.json\n"
      "  faultsim init from-grid FIELD.EGRID --layers rock.csv --least-offset \"10 m\" -o "
      "field.json\n"
      "Everything that was recognised, left out and chosen is printed, each with the option or "
      "the\n"
      "key of the scene that changes it; docs/your-field.md goes on from there.");
  command->callback([&] { code = init_from_grid_command(a); });
}

void add_init(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* init = app.add_subcommand("init", "write a starter scene, or one of a flow grid");
  init->add_option("kind", a.init_kind, "field or box")->check(CLI::IsMember({"field", "box"}));
  init->add_option("file", a.init_file, "where to write it (default KIND.json)");
  init->footer(
      "Examples:\n"
      "  faultsim init field my-field.json    two blocks and three faults between layers\n"
      "  faultsim init box slider.json        a box with patches of fault, for tests of the model\n"
      "  faultsim init from-grid FIELD.EGRID -o field.json");
  add_from_grid(init, a.from_grid, code);
  init->callback([&, init] {
    if (!init->get_subcommands().empty()) return;
    code = init_command(a.init_kind, a.init_file.empty() ? a.init_kind + ".json" : a.init_file);
  });
}

void add_looking(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* validate = app.add_subcommand("validate", "check a scene and list all its problems");
  add_scene(validate, a.scene);
  validate->footer(
      "Examples:\n"
      "  faultsim validate my-field.json\n"
      "  faultsim validate my-field.json --set friction_angle=\"20 deg\" --json");
  validate->callback([&] { code = validate_command(a.scene); });

  CLI::App* plan = app.add_subcommand("plan", "what will be modelled and why, sizes and cost");
  add_scene(plan, a.scene);
  plan->footer(
      "Examples:\n"
      "  faultsim plan my-field.json --tier standard\n"
      "  faultsim plan my-field.json --set /numerics/half_domain=off --json");
  plan->callback([&] { code = plan_command(a.scene); });

  CLI::App* parameters =
      app.add_subcommand("parameters", "what can be varied, with aliases and ranges");
  add_scene(parameters, a.scene);
  parameters->footer(
      "Examples:\n"
      "  faultsim parameters my-field.json | grep east     what the block \"east\" has\n"
      "  faultsim parameters my-field.json --json          with units and descriptions");
  parameters->callback([&] { code = parameters_command(a.scene); });

  CLI::App* mesh =
      app.add_subcommand("mesh", "make the mesh, report its quality, write it for ParaView");
  add_scene(mesh, a.scene);
  mesh->add_option("-o,--output", a.mesh_output, "folder for volume.h5 and volume.xmf");
  mesh->footer(
      "Examples:\n"
      "  faultsim mesh my-field.json --tier screening\n"
      "  faultsim mesh my-field.json -o mesh               then open mesh/volume.xmf");
  mesh->callback([&] { code = mesh_command(a.scene, a.mesh_output); });
}

void add_run(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand("run", "run a scene");
  CLI::Option* scene = add_scene(command, a.run.scene);
  command
      ->add_option_function<std::string>(
          "--from-report",
          [&a, scene](const std::string& page) {
            a.run.scene.file = page;
            scene->required(false);
          },
          "the scene of a page that report wrote, in place of a scene file")
      ->type_name("PAGE")
      ->excludes(scene)
      ->trigger_on_parse();
  command->add_option("-o,--output", a.run.output, "result folder (default SCENE-result)");
  add_operator(command, a.run.op, kBuildingAndCase);
  command->add_flag("--wide", a.run.wide, "the table with all its columns, however wide");
  command->add_flag("--trace", a.run.trace,
                    "how each load step was solved, iteration by iteration; also in trace.jsonl");
  command->add_flag("--exact", a.run.exact,
                    "the exact operator where the scene asks for a surface (/numerics/surface)");
  command
      ->add_option("--path", a.run.path,
                   "condensed (default); coupled: no operator, both sides of the faults and\n"
                   "multipliers; automatic: condensed where it fits into memory")
      ->check(CLI::IsMember({"condensed", "coupled", "automatic"}));
  command->add_option("--leading", a.run.leading,
                      "coupled path, for K + E: exact,fsai,ic,ilu,amg,amg-u (default amg-u)");
  command->add_option("--schur", a.run.schur,
                      "coupled path: exact,fsai+dir,fsai+fsai,bds,lsc,rac (default rac)");
  command->footer(
      "Examples:\n"
      "  faultsim run my-field.json -o out\n"
      "  faultsim run my-field.json --tier screening --set offset_east=\"150 m\" -o offset-150\n"
      "  mpirun -n 4 faultsim run my-field.json --path coupled -o out\n"
      "The folder holds one run: an earlier one is replaced when the new one is complete. Open\n"
      "out/faults.xmf in ParaView; see docs/commands.md.");
  command->callback([&] { code = run_command(a.run); });
}

void add_diagnose(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "diagnose", "run a scene, check it from outside the solver, and again with noise");
  add_scene(command, a.diagnosed.scene);
  add_operator(command, a.diagnosed.op);
  command->footer(
      "Examples:\n"
      "  faultsim diagnose my-field.json --set offset_east=\"200 m\"\n"
      "  faultsim diagnose my-field.json --tier screening --json\n"
      "Recomputes equilibrium, contact and energies of every load step in extended precision,\n"
      "tests the operator, and runs the case again with noise of 1e-12 in its loads. Exit code 5\n"
      "when a limit is not met; see docs/model.md, section 10.");
  command->callback([&] { code = diagnose_command(a.diagnosed); });
}

void add_export_contact(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "export-contact", "write the contact problem of a load step as an FCLib HDF5 file");
  add_scene(command, a.exported.scene);
  command->add_option("--step", a.exported.step, "load step; 0 = the initial equilibrium")
      ->required();
  command->add_option("-o,--output", a.exported.output, "file to write")->required();
  command->add_flag("--freeze-strength", a.exported.freeze_strength,
                    "friction that weakens keeps its value at the start of the step");
  add_operator(command, a.exported.op);
  command->footer(
      "Examples:\n"
      "  faultsim export-contact my-field.json --step 10 -o step10.hdf5\n"
      "  faultsim export-contact my-field.json --step 10 --freeze-strength -o step10.hdf5\n"
      "Runs the scene up to the step before, and writes u = W r + q, friction coefficients and\n"
      "our solution. The step must have no cohesion; see docs/contact-export.md.");
  command->callback([&] { code = export_contact_command(a.exported); });
}

void add_influence(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "influence", "what a pressure change in each reservoir cell does to the faults");
  add_scene(command, a.influence.scene);
  command->add_option("-o,--output", a.influence.output, "HDF5 file to write")->required();
  command
      ->add_option("--region", a.influence.regions,
                   "a compartment whose cells are wanted; may be repeated (default: all)")
      ->allow_extra_args(false);
  add_operator(command, a.influence.op);
  command->footer(
      "Examples:\n"
      "  faultsim influence my-field.json -o influence.h5\n"
      "  faultsim influence my-field.json --region west --region east -o both.h5 --json\n"
      "With Biot coefficient b and a pressure change per cell, traction^T (b dp) is the change of "
      "the\n"
      "locked effective traction on every fault node: see docs/commands.md, influence.");
  command->callback([&] { code = influence_command(a.influence); });
}

void add_plot(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand("plot", "draw a chart of a result as SVG or PNG");
  std::string charts = "one of:";
  for (const CaseChartInfo& info : case_charts()) {
    charts += concat("\n", info.name, ": ", info.meaning);
  }
  command->add_option("chart", a.plot.chart, charts)->required();
  command->add_option("result", a.plot.result, "folder that run wrote")->required();
  command
      ->add_option("-o,--output", a.plot.output, "file to write: *.svg, or *.png by rsvg-convert")
      ->required();
  command->add_option("--fault", a.plot.fault, "default: the one with the largest χ̄");
  command->add_option("--step", a.plot.step, "load step; default: that of its largest χ̄");
  command->add_option("--show", a.plot.show,
                      "of a fault-map: chi (default), slip, state, pressure");
  command->add_option("--before", a.plot.before,
                      "another folder that run wrote: its curves as thin lines");
  command->footer(
      "Examples:\n"
      "  faultsim plot history out -o history.svg\n"
      "  faultsim plot history out --before earlier -o both.svg\n"
      "  faultsim plot section out --step 10 -o section.svg\n"
      "  faultsim plot profiles out --fault F2 -o profiles.png");
  command->callback([&] { code = plot_command(a.plot); });
}

void add_report(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("report", "a result as one HTML page that needs no network");
  command->add_option("result", a.report.result, "folder that run wrote")->required();
  command->add_option("-o,--output", a.report.output, "file to write: *.html")->required();
  command->footer(
      "Examples:\n"
      "  faultsim report out -o out.html\n"
      "  faultsim run --from-report out.html -o again    the same scene, with the same bits");
  a.report.program = version_text("faultsim");
  command->callback([&] { code = report_command(a.report); });
}

/// What those have that other programs talk to.
void add_descriptors(CLI::App* command, WorkerArguments& arguments, const char* threads_are) {
  command->add_option("--requests", arguments.requests, "descriptor to read from")->required();
  command->add_option("--replies", arguments.replies, "descriptor to write to")->required();
  command->add_option("--cache", arguments.cache, "operator cache");
  command->add_option("--node-cache", arguments.node_cache,
                      "copies of cached operators on this host's own disk");
  command->add_option("--cache-size", arguments.cache_size, "bytes");
  add_threads(command, arguments.threads, threads_are, "1");
}

void add_what_if(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "what-if", "answer the newest question about a scene (schemas/what_if_protocol.md)");
  add_descriptors(command, a.worker, kBuildingAndCase);
  command->footer("Example: faultsim what-if --requests 0 --replies 1 <questions >answers");
  command->callback([&] { code = what_if_command(a.worker); });
}

void add_worker(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("worker", "serve cases to faultsweep (schemas/worker_protocol.md)");
  add_descriptors(command, a.worker, kBuilding);
  command->add_option("--memory-limit", a.worker.memory_limit, "bytes of private memory");
  command->footer("Example: faultsim worker --requests 0 --replies 1 <requests >replies");
  command->callback([&] { code = worker_command(a.worker); });
}

void add_solver_study(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "solver-study", "preconditioners of the coupled path on a published cracked box");
  CLI::Option* scene = command->add_option(
      "--scene", a.study.scene.file, "a scene's own body instead: its mesh, materials and holds");
  add_changes(command, a.study.scene);
  command->get_option("--set")->needs(scene);
  command->get_option("--tier")->needs(scene);
  command
      ->add_option("--case", a.study.cases,
                   "box (default), or stand-ins: 15-cuts,field-a,field-b,field-c; or all")
      ->delimiter(',')
      ->excludes(scene);
  command
      ->add_option("--stage", a.study.stages,
                   "how nodes stand, of stick,slip,open or all: a history (default stick)")
      ->delimiter(',');
  command
      ->add_option("--h", a.study.cell_sizes,
                   "cell sizes of the box: 1/2,1/4,1/8,1/16 … (default 1/2,1/4)")
      ->delimiter(',')
      ->excludes(scene);
  command
      ->add_option("--leading", a.study.leading,
                   "for K + E: exact,fsai,ic,ilu,amg,amg-u or all (default exact)")
      ->delimiter(',');
  command
      ->add_option("--schur", a.study.schur,
                   "for S: exact,fsai+dir,fsai+fsai,bds,lsc,rac or all (default: three)")
      ->delimiter(',');
  command
      ->add_option("--form", a.study.form,
                   "upper (default) or full: two leading solves an iteration")
      ->check(CLI::IsMember({"full", "upper"}));
  command->add_option("--fsai-steps", a.study.fsai_steps, "growth steps of FSAI (default 5)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--fsai-step-size", a.study.fsai_step_size, "entries per step (default 1)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--fsai-tolerance", a.study.fsai_tolerance, "of a step (default 0.01)")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-iterations", a.study.max_iterations, "of GMRES (default 500)")
      ->check(CLI::Range(1, 100000));
  command->add_option("--export", a.study.export_to,
                      "write the systems as PETSc's files into a folder, solve nothing");
  command->add_flag("--json", a.study.json, "machine-readable output on stdout");
  command->footer(
      "Examples:\n"
      "  faultsim solver-study --h 1/2 --leading all --schur all\n"
      "  faultsim solver-study --h 1/8 --leading exact,amg --json\n"
      "  faultsim solver-study --case field-b --stage all --leading amg-u --schur rac\n"
      "  faultsim solver-study --scene my-field.json --tier standard --leading amg-u --schur rac\n"
      "Right-preconditioned GMRES without restart on J = [[K + E, C - F], [C^T, 0]];\n"
      "iterations to 1e-6 and 1e-8 of a random and a physical right-hand side. See\n"
      "docs/model.md, section 11.");
  command->callback([&] { code = solver_study_command(a.study); });
}

void add_environment(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "environment",
      "what the last digits depend on: processor, BLAS, libraries; what is built in");
  command->add_flag("--json", a.environment_json, "machine-readable output on stdout");
  command->footer("Example: faultsim environment --json");
  command->callback([&] { code = environment_command(a.environment_json); });
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsim_main(int argc, char** argv) {
  start_blas(argv);
  CLI::App app{"faultsim: 3D fault reactivation in compartmentalised gas reservoirs", "faultsim"};
  app.require_subcommand(1);
  app.get_formatter()->column_width(24);  // texts of up to 76 columns stand beside it
  app.footer(kFooter);
  app.set_version_flag("--version", version_text("faultsim"));
  Arguments arguments;
  ExitCode code = ExitCode::done;
  for (auto* add :
       {add_init, add_looking, add_run, add_diagnose, add_export_contact, add_influence, add_plot,
        add_report, add_worker, add_what_if, add_solver_study, add_environment}) {
    add(app, arguments, code);
  }
  try {
    require_known_command(app, argc, argv);
    if (argc > 1 && argv[1][0] != '-' && std::string_view(argv[1]) != "run")
      require_started_alone(argv[1]);
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
