#include <algorithm>
#include <iostream>
#include <map>
#include <optional>
#include <tuple>

#include "simulator/app/program.h"
#include "simulator/common/input_file.h"
#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/corner_point/structure_finder.h"
#include "simulator/corner_point/structure_text.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"
#include "simulator/flow/eclipse_files.h"
#include "simulator/flow/field_file.h"
#include "simulator/grid_scene/grid_pictures.h"
#include "simulator/grid_scene/grid_scene.h"
#include "simulator/simulation/loaded_scene.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;
using corner_point::StructureOptions;
using grid_scene::GridScene;
using grid_scene::GridSceneOptions;

constexpr std::size_t kMostTableBytes = 10'000'000;

/// What of the structure's options the command calls otherwise than "--" and their name; "": it has
/// no such option.
const std::map<std::string, std::string> kOptionNames = {{"reference_z", "--reference-depth"},
                                                         {"bridge_gaps", "--no-bridges"},
                                                         {"negligible_offset", ""},
                                                         {"no_thickness", ""}};

std::string option_name(const std::string& member) {
  const auto known = kOptionNames.find(member);
  if (known != kOptionNames.end()) return known->second;
  std::string name = "--" + member;
  std::ranges::replace(name, '_', '-');
  return name;
}

class FromGrid {
 public:
  explicit FromGrid(const FromGridArguments& arguments)
      : arguments_(arguments), files_(eclipse_files(arguments.grid)) {}

  ExitCode run() {
    take_options();
    check_files();
    if (!problems_.empty()) throw InputError("faultsim init from-grid", problems_);
    corner_point::CornerPointGrid grid = corner_point::read_corner_point_grid(arguments_.grid);
    corner_point::GridStructure structure = recognise_structure(grid, structure_options_);
    FieldFile pressures;
    if (!files_.restarts.empty()) pressures = read_field_file(field_file(), FlowQuantity::pressure);
    if (!arguments_.layers.empty())
      options_.layers_text = read_input_or_throw(arguments_.layers.string(), kMostTableBytes);
    const GridScene made = grid_scene::grid_scene(grid, structure, options_, pressures.field.get());
    check_targets(made);
    write(grid, structure, made);
    say_refusal();
    return ExitCode::done;
  }

 private:
  /// A length of an option, where it was given.
  std::optional<double> length(const char* option, const std::string& text) {
    if (text.empty()) return std::nullopt;
    const ParsedQuantity parsed = parse_quantity(text, Dimension::length);
    if (!parsed.ok) problems_.push_back({option, 0, parsed.what, parsed.cure});
    if (parsed.ok && parsed.value <= 0)
      problems_.push_back(
          {option, 0, "\"" + text + "\" is not above 0", "write a length such as \"20 m\""});
    return parsed.ok ? std::optional(parsed.value) : std::nullopt;
  }

  void take_options() {
    const FromGridArguments& a = arguments_;
    const auto take = [&](const char* option, const std::string& text, double& into) {
      if (const std::optional<double> value = length(option, text)) into = *value;
    };
    take("--least-offset", a.least_offset, structure_options_.least_offset);
    structure_options_.negligible_offset =
        std::min(structure_options_.negligible_offset, structure_options_.least_offset);
    if (const auto depth = length("--reference-depth", a.reference_depth))
      structure_options_.reference_z = -*depth;
    structure_options_.fewest_edges = a.fewest_edges;
    structure_options_.straightening = a.straightening;
    structure_options_.faults_by_connections = a.faults_by_connections;
    structure_options_.bridge_gaps = !a.no_bridges;
    structure_options_.extend_faults = a.extend_faults;
    using corner_point::CompartmentRule;
    structure_options_.compartments = a.compartments == "EQLNUM"
                                          ? CompartmentRule::equilibrium_regions
                                      : a.compartments == "FIPNUM" ? CompartmentRule::fluid_regions
                                                                   : CompartmentRule::faults;
    take("--margin", a.margin, options_.lines.margin);
    take("--base", a.base, options_.lines.base_depth);
    take("--overshoot", a.overshoot, options_.lines.overshoot);
    take("--strike", a.strike, options_.lines.strike);
    take("--least-layer", a.least_layer, options_.surfaces.least_layer);
    options_.lines.n_cells = a.tetrahedra;
    options_.surfaces.every = a.every_layer;
    options_.stem = a.output.stem().string();
    options_.source = files_.grid.filename().string();
    options_.layers_name = a.layers.string();
    if (!files_.restarts.empty())
      options_.field_file = fs::absolute(field_file())
                                .lexically_proximate(fs::absolute(a.output).parent_path())
                                .generic_string();
  }

  /// What names the pressures in the scene: a restart file that was given alone, else the grid.
  fs::path field_file() const {
    return arguments_.restart.empty() ? files_.grid : arguments_.restart;
  }

  void check_files() {
    fs::path restart = files_.grid;
    restart.replace_extension(arguments_.restart.extension());
    for (const auto& [option, given, beside] : {std::tuple{"--init", arguments_.init, files_.init},
                                                {"--restart", arguments_.restart, restart}}) {
      if (given.empty()) continue;
      std::error_code error;
      if (!fs::is_regular_file(given, error))
        problems_.push_back(
            {option, 0, given.string() + ": there is no such file", "name an existing file"});
      if (fs::weakly_canonical(given, error) != fs::weakly_canonical(beside, error))
        problems_.push_back(
            {option, 0, given.string() + " is not beside the grid under the grid's name",
             "put it there as " + beside.string() + ": scenes find files of a case by their name"});
    }
    if (!arguments_.restart.empty()) files_.restarts = eclipse_files(arguments_.restart).restarts;
    if (arguments_.output.extension() != ".json")
      problems_.push_back({"-o", 0,
                           "\"" + arguments_.output.string() + "\" is not the name of a scene",
                           "let it end in .json"});
    for (const std::string& name : {options_.stem, options_.source, options_.field_file}) {
      const std::string odd = first_unprintable(name);
      if (odd.empty()) continue;
      problems_.push_back({"", 0, "the name \"" + printable(name) + "\" contains \"" + odd + "\"",
                           "rename the file"});
    }
  }

  fs::path beside(const std::string& ending) const {
    return arguments_.output.parent_path() / (options_.stem + ending);
  }

  void check_targets(const GridScene& made) {
    std::vector<fs::path> targets = {arguments_.output, beside("-report.txt"), beside("-map.svg"),
                                     beside("-section.svg")};
    for (const grid_scene::SceneTable& table : made.tables)
      targets.push_back(arguments_.output.parent_path() / table.name);
    for (const fs::path& target : targets) {
      std::error_code error;
      if (!arguments_.force && fs::exists(target, error))
        problems_.push_back({"-o", 0, target.string() + " exists already",
                             "choose another name, or give --force to replace what is there"});
    }
    if (!problems_.empty()) throw InputError("faultsim init from-grid", problems_);
    std::vector<fs::path> inputs = files_.restarts;
    inputs.push_back(files_.grid);
    if (!arguments_.layers.empty()) inputs.push_back(arguments_.layers);
    for (const fs::path& target : targets)
      require_writable_file("-o", target,
                            target == targets.front() ? FileKind::json : FileKind::text, inputs);
  }

  void write(const corner_point::CornerPointGrid& grid, corner_point::GridStructure& structure,
             const GridScene& made) const {
    for (corner_point::StructureRemark& remark : structure.report) {
      if (!remark.option.empty()) remark.option = option_name(remark.option);
    }
    const std::string report = "In the grid\n\n" + structure_text(structure) +
                               "\nIn the scene\n\n" + corner_point::remarks_text(made.remarks);
    for (const grid_scene::SceneTable& table : made.tables)
      write_text(arguments_.output.parent_path() / table.name, table.text);
    write_text(beside("-report.txt"), report);
    write_text(beside("-map.svg"), grid_scene::map_picture(structure, made));
    write_text(beside("-section.svg"), grid_scene::section_picture(grid, structure, made));
    write_text(arguments_.output, grid_scene::scene_text(made.scene));
    std::cout << report;
    std::cerr << "wrote " << arguments_.output.string() << ", " << made.tables.size()
              << " tables, a report and two pictures beside it\nnext: look at "
              << beside("-map.svg").string() << ", then faultsim validate "
              << arguments_.output.string() << "\n";
  }

  /// Horizons of a grid may leave no body between them, which only the builder finds out, or cells
  /// of the grid lie over each other. The scene is written all the same: its pictures say more than
  /// a refusal.
  void say_refusal() const {
    try {
      LoadedScene loaded = load_scene(read_scene_file(arguments_.output.string(), {}));
      check_geometry(loaded);
    } catch (const InputError& error) {
      std::cerr << "warning: validate refuses the scene as it stands; change the keys named below, "
                   "or the options of init from-grid\n"
                << error.what() << "\n";
    }
  }

  const FromGridArguments& arguments_;
  EclipseFiles files_;
  StructureOptions structure_options_;
  GridSceneOptions options_;
  std::vector<Problem> problems_;
};

/// What is read and written.
void add_grid_files(CLI::App* command, FromGridArguments& a) {
  command->add_option("grid", a.grid, "CASE.EGRID")->required();
  command->add_option("--init", a.init, "CASE.INIT (default: the one beside the grid)");
  command->add_option("--restart", a.restart,
                      "CASE.UNRST or CASE.X0001 (default: those beside the grid)");
  command->add_option("-o,--output", a.output, "the scene; its tables are written beside it")
      ->required();
  command->add_flag("--force", a.force, "replace existing files");
  command->add_option("--layers", a.layers,
                      "CSV of rock: name, top [m], density [kg/m3], youngs_modulus [GPa],\n"
                      "poisson_ratio, from the surface down; one is called reservoir");
}

/// How large the model is, and how fine.
void add_sizes(CLI::App* command, FromGridArguments& a) {
  command
      ->add_option("--every-layer", a.every_layer,
                   "also take the top of every N-th layer of the grid (default: none)")
      ->check(CLI::Range(0, 10000));
  command->add_option("--least-layer", a.least_layer,
                      "thickness of the model's layers (default: a fifth of a cell at faults,\n"
                      "or half the reservoir's where that is less)");
  command->add_option("--overshoot", a.overshoot,
                      "of faults above and below the reservoir (default \"150 m\")");
  command->add_option("--margin", a.margin,
                      "beside the active map (default: twice the depth, at least 5 km)");
  command->add_option("--base", a.base, "depth of the model (default: twice the reservoir's)");
  command->add_option("--strike", a.strike,
                      "size of cells at faults (default: half the grid's, or by --tetrahedra)");
  command->add_option("--tetrahedra", a.tetrahedra, "about how many (default 100000)")
      ->check(CLI::Range(1e3, 1e8));
}

/// What of the grid is a fault, and what a compartment.
void add_recognition(CLI::App* command, FromGridArguments& a) {
  command->add_option("--least-offset", a.least_offset,
                      "smaller steps between columns are not a fault (default \"20 ft\")");
  command
      ->add_option("--fewest-edges", a.fewest_edges,
                   "least number of the grid's edges in a fault (default 3)")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--straightening", a.straightening,
                   "how far traces may leave the grid's edges, in cells (default 0.5)")
      ->check(CLI::Range(0.01, 10.0));
  command->add_option("--reference-depth", a.reference_depth,
                      "where traces are drawn (default: the reservoir's top beside faults)");
  command->add_flag("--faults-by-connections", a.faults_by_connections,
                    "non-neighbour connections make a fault at smaller steps");
  command->add_flag("--no-bridges", a.no_bridges,
                    "do not join two tips by smaller steps between them");
  command->add_flag("--extend-faults", a.extend_faults,
                    "separate compartments beyond tips, as far as the next fault or edge");
  command
      ->add_option("--compartments", a.compartments,
                   "what bounds them: faults (default), EQLNUM, FIPNUM")
      ->check(CLI::IsMember({"faults", "EQLNUM", "FIPNUM"}));
}

}  // namespace

ExitCode init_from_grid_command(const FromGridArguments& arguments) {
  return FromGrid(arguments).run();
}

void add_from_grid(Program& program, CLI::App* init) {
  auto [command, a] = program.add(
      "from-grid", "a scene from a flow grid: horizons, faults, compartments, pressures",
      init_from_grid_command, init);
  add_grid_files(command, a);
  add_sizes(command, a);
  add_recognition(command, a);
  command->footer(
      "Examples:\n"
      "  faultsim init from-grid FIELD.EGRID -o field.json\n"
      "  faultsim init from-grid FIELD.EGRID --layers rock.csv --least-offset \"10 m\" -o "
      "field.json\n"
      "Everything that was recognised, left out and chosen is printed, each with the option or "
      "the\n"
      "key of the scene that changes it; docs/your-field.md goes on from there.");
}

}  // namespace faultsim
