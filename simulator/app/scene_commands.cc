#include <cstdio>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/app/screen.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/files/result_folder.h"
#include "simulator/loading/run_case.h"
#include "simulator/result_files/volume_writer.h"
#include "simulator/scene/tiers.h"

namespace faultsim {
namespace {

struct InitArguments {
  std::string kind = "field";  ///< or box.
  std::string file;            ///< "" = KIND.json.
};

struct MeshArguments {
  SceneArguments scene;
  std::string output;  ///< folder; "" = the mesh is not written.
};

/// Which part of the scene a pointer leads into: 'block "east"'; "" where it is none with a name.
std::string owner_of(const nlohmann::json& document, const std::string& pointer) {
  const std::map<std::string, std::string> kinds = {
      {"blocks", "block"}, {"regions", "region"}, {"layers", "layer"},
      {"faults", "fault"}, {"stages", "stage"},   {"observation_points", "point"}};
  nlohmann::json::json_pointer place(pointer);
  for (; !place.empty(); place.pop_back()) {
    const nlohmann::json::json_pointer above = place.parent_pointer();
    if (above.empty()) break;
    if (above.back() == "materials" || above.back() == "compartments") {
      return concat(above.back() == "materials" ? "material" : "compartment", " \"", place.back(),
                    "\"");
    }
    const auto kind = kinds.find(above.back());
    if (kind == kinds.end() || !document.contains(place)) continue;
    const nlohmann::json& part = document.at(place);
    const std::string name = part.is_object() ? part.value("name", "") : "";
    if (!name.empty()) return concat(kind->second, " \"", name, "\"");
  }
  return "";
}

/// What was found of fields is said with the rest.
void add_remarks(const FieldCheck& fields, LoadedScene& loaded) {
  loaded.scene.remarks.insert(loaded.scene.remarks.end(), fields.remarks.begin(),
                              fields.remarks.end());
}

ExitCode init_command(const InitArguments& arguments) {
  const std::filesystem::path file =
      arguments.file.empty() ? arguments.kind + ".json" : arguments.file;
  if (std::filesystem::exists(file)) {
    throw InputError(file.string(), "the file exists already", "choose another name");
  }
  require_writable_file("file", file, FileKind::json, {});
  write_text(file, starter_scene(arguments.kind));
  std::cerr << "wrote " << file.string() << "\nnext: faultsim plan " << file.string()
            << "   or   faultsim run " << file.string() << "\n";
  return ExitCode::done;
}

ExitCode validate_command(const SceneArguments& arguments) {
  try {
    LoadedScene loaded = load_scene(arguments);
    const FieldCheck fields = check_geometry(loaded);
    add_remarks(fields, loaded);
    if (arguments.json) {
      std::cout << json_text(nlohmann::json{{"valid", true},
                                            {"identity", case_identity(loaded.scene)},
                                            {"warnings", remarks_to_json(loaded)}});
    } else {
      std::cout << arguments.file << ": valid, case " << case_identity(loaded.scene).substr(0, 12)
                << "\n"
                << sides_to_text(loaded.plan) << remarks_to_text(loaded);
      for (const std::string& text : loaded.plan.warnings) std::cout << "warning: " << text << "\n";
    }
    return ExitCode::done;
  } catch (const InputError& error) {
    if (!arguments.json) throw;
    nlohmann::json problems = nlohmann::json::array();
    for (const Problem& p : error.problems()) {
      problems.push_back(
          {{"pointer", p.pointer}, {"line", p.line}, {"what", p.what}, {"cure", p.cure}});
    }
    std::cout << json_text(nlohmann::json{{"valid", false}, {"problems", problems}});
    return ExitCode::input;
  }
}

ExitCode plan_command(const SceneArguments& arguments) {
  LoadedScene loaded = load_scene(arguments);
  const FieldCheck fields = check_geometry(loaded);
  add_remarks(fields, loaded);
  add_savings(loaded.scene, loaded.plan);
  const bool is_field = loaded.scene.geometry_kind == GeometryKind::field;
  if (arguments.json) {
    nlohmann::json plan = plan_to_json(loaded.plan);
    plan["warnings"] = remarks_to_json(loaded);
    if (is_field) plan["cells"] = mesh_text(loaded.scene);
    if (!fields.notes.empty()) plan["field_coverage"] = fields.notes;
    std::cout << json_text(std::move(plan));
  } else {
    if (is_field) std::cout << mesh_text(loaded.scene) << "\n";
    std::cout << plan_to_text(loaded.plan);
    for (const std::string& note : fields.notes) std::cout << note << "\n";
    std::cout << remarks_to_text(loaded);
  }
  return ExitCode::done;
}

ExitCode parameters_command(const SceneArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments);
  const std::vector<ParameterInfo> rows = parameters(loaded.document);
  if (arguments.json) {
    nlohmann::json out = nlohmann::json::array();
    for (const ParameterInfo& p : rows) {
      out.push_back({{"pointer", p.pointer},
                     {"alias", p.alias},
                     {"of", owner_of(loaded.document.value, p.pointer)},
                     {"unit", si_unit(p.dimension)},
                     {"value", p.value},
                     {"default", p.default_value},
                     {"range", p.range},
                     {"new_family", p.new_family},
                     {"description", p.description}});
    }
    std::cout << json_text(nlohmann::json{{"parameters", std::move(out)}});
    return ExitCode::done;
  }
  std::printf("%-50s %-20s %s\n", "pointer", "value", "default");
  for (const ParameterInfo& p : rows) {
    std::printf("%-50s %-20s %s\n", p.pointer.c_str(), p.value.c_str(), p.default_value.c_str());
    const std::string owner = owner_of(loaded.document.value, p.pointer);
    std::string more;
    for (const std::string& part :
         {p.alias, owner.empty() ? "" : "of the " + owner, p.range.empty() ? "" : "in " + p.range,
          std::string(p.new_family ? "new operator" : "")}) {
      if (!part.empty()) more += (more.empty() ? "" : "; ") + part;
    }
    if (!more.empty()) std::printf("    %s\n", more.c_str());
  }
  return ExitCode::done;
}

ExitCode mesh_command(const MeshArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene);
  const std::filesystem::path output = arguments.output;
  std::optional<ResultFolder> folder;
  if (!output.empty()) {
    folder.emplace(ResultFolder::Request{.option = "-o",
                                         .folder = output,
                                         .made_by = "faultsim mesh",
                                         .names = {"volume.h5", "volume.xmf"},
                                         .inputs = input_files(loaded)});
  }
  const BulkProblem problem = bulk_problem(loaded.scene, loaded.plan);
  const MeshQuality quality = check_quality(problem.mesh);
  std::size_t n_pairs = 0;
  for (const FaultSurface& fault : problem.mesh.faults) n_pairs += fault.nodes.size();
  if (arguments.scene.json) {
    std::cout << json_text(nlohmann::json{{"n_nodes", problem.mesh.nodes.size()},
                                          {"n_cells", problem.mesh.cells.size()},
                                          {"n_fault_node_pairs", n_pairs},
                                          {"min_scaled_jacobian", quality.min_scaled_jacobian},
                                          {"max_aspect", quality.max_aspect}});
  } else {
    std::printf(
        "nodes %zu, cells %zu, fault node pairs %zu\nsmallest scaled Jacobian %.3f, largest aspect "
        "ratio %.1f, worst cell at (%.0f, %.0f, %.0f) m\n",
        problem.mesh.nodes.size(), problem.mesh.cells.size(), n_pairs, quality.min_scaled_jacobian,
        quality.max_aspect, quality.worst_position.x(), quality.worst_position.y(),
        quality.worst_position.z());
  }
  if (folder) {
    write_volume(folder->path(), problem.mesh.nodes,
                 {problem.mesh.cells.nodes(), problem.mesh.cells.n_nodes()}, problem.mesh.material,
                 {});
    folder->commit();
    std::cerr << "wrote " << (output / "volume.xmf").string() << " (open it in ParaView)\n";
  }
  return ExitCode::done;
}

}  // namespace

void add_init(Program& program) {
  auto [command, a] =
      program.add("init", "write a starter scene, or one from a flow grid", init_command);
  command->add_option("kind", a.kind, "field or box")->check(CLI::IsMember({"field", "box"}));
  command->add_option("file", a.file, "where to write it (default KIND.json)");
  command->footer(
      "Examples:\n"
      "  faultsim init field my-field.json    two blocks and three faults between layers\n"
      "  faultsim init box slider.json        a box with patches of fault, for tests of the model\n"
      "  faultsim init from-grid FIELD.EGRID -o field.json");
  add_from_grid(program, command);
}

void add_looking(Program& program) {
  auto [validate, validated] =
      program.add("validate", "check a scene and list all its problems", validate_command);
  add_scene(validate, validated);
  validate->footer(
      "Examples:\n"
      "  faultsim validate my-field.json\n"
      "  faultsim validate my-field.json --set friction_angle=\"20 deg\" --json");

  auto [plan, planned] =
      program.add("plan", "what will be modelled and why, sizes and cost", plan_command);
  add_scene(plan, planned);
  plan->footer(
      "Examples:\n"
      "  faultsim plan my-field.json --tier standard\n"
      "  faultsim plan my-field.json --set /numerics/half_domain=off --json");

  auto [parameters, varied] =
      program.add("parameters", "what can be varied, with aliases and ranges", parameters_command);
  add_scene(parameters, varied);
  parameters->footer(
      "Examples:\n"
      "  faultsim parameters my-field.json | grep east     what the block \"east\" has\n"
      "  faultsim parameters my-field.json --json          with units and descriptions");

  auto [mesh, a] =
      program.add("mesh", "make the mesh, report its quality, write it for ParaView", mesh_command);
  add_scene(mesh, a.scene);
  mesh->add_option("-o,--output", a.output, "folder for volume.h5 and volume.xmf");
  mesh->footer(
      "Examples:\n"
      "  faultsim mesh my-field.json --tier screening\n"
      "  faultsim mesh my-field.json -o mesh               then open mesh/volume.xmf");
}

}  // namespace faultsim
