#include "simulator/grid_scene/grid_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/grid_scene/line_maker.h"
#include "simulator/grid_scene/mesh_size.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::RemarkKind;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

/// "1234.5 m": to a centimetre.
std::string length(double value) { return decimal(value, 2) + " m"; }

std::string depth(double z) { return length(-z); }

Json place(const Vector2d& at) { return Json::array({length(at.x()), length(at.y())}); }

Json places(const Polyline& line) {
  Json all = Json::array();
  for (const Vector2d& at : line) all.push_back(place(at));
  return all;
}

/// From the vertical: one, or one per point of the trace.
Json dips_json(const ModelFault& fault) {
  const auto dip = [](double lean) {
    return formatted("%.4g deg", std::atan(lean) * 180 / std::numbers::pi);
  };
  if (fault.leans.size() == 1) return dip(fault.leans[0]);
  return mapped(fault.leans, dip);
}

/// The day, and the time of day where it has one.
std::string moment(double seconds) {
  const double day = 86400, of_day = seconds - day * std::floor(seconds / day);
  const int s = static_cast<int>(of_day);
  if (s == 0) return date_text(seconds);
  return date_text(seconds) + formatted("T%02d:%02d:%02d", s / 3600, s / 60 % 60, s % 60);
}

/// @param first  the surface whose points have the thickness of this one's layer above.
std::string csv_of(const ModelSurface& surface, const ModelSurface& first) {
  const bool is_hung = !surface.thickness.empty();
  std::string text = is_hung ? "x [m],y [m],thickness [m]\n" : "x [m],y [m],depth [m]\n";
  for (std::size_t p = 0; p < first.points.size(); ++p) {
    const Vector3d& at = first.points[p];
    text += formatted("%.3f,%.3f,%.4f\n", at.x(), at.y(), is_hung ? surface.thickness[p] : -at.z());
  }
  return text;
}

class SceneMaker {
 public:
  SceneMaker(const corner_point::CornerPointGrid& grid,
             const corner_point::GridStructure& structure, const GridSceneOptions& options,
             const FlowField* pressures)
      : grid_(grid), structure_(structure), options_(options), pressures_(pressures) {}

  GridScene make() {
    made_.lines = model_lines(grid_, structure_, options_.lines, made_.remarks);
    made_.surfaces =
        model_surfaces(grid_, structure_, made_.lines, options_.surfaces, made_.remarks);
    made_.compartments = model_compartments(grid_, structure_, made_.lines, made_.remarks);
    take_layers();
    Json& scene = made_.scene;
    scene["comment"] = "Made from " + options_.source +
                       " by faultsim init from-grid. x, y as on its map, depth downwards. Every "
                       "value may be changed here; " +
                       options_.stem + "-report.txt says what was chosen and why.";
    scene["format"] = 1;
    scene["title"] = options_.stem;
    add_materials();
    add_geometry();
    add_mesh();
    add_initial_state();
    add_faults();
    add_loading();
    return std::move(made_);
  }

 private:
  void say(RemarkKind kind, const std::string& text, const std::string& option) {
    made_.remarks.push_back({kind, text, option});
  }
  void take_layers();
  void add_materials();
  void add_geometry();
  Json layers_json();
  void add_mesh();
  void add_initial_state();
  void add_faults();
  void add_loading();
  void add_stage_without_reports();

  const corner_point::CornerPointGrid& grid_;
  const corner_point::GridStructure& structure_;
  const GridSceneOptions& options_;
  const FlowField* pressures_;
  RockLayers rocks_;
  double shallowest_ = 0, deepest_ = 0, middle_ = 0;  ///< depth of the reservoir, m.
  GridScene made_;
};

void SceneMaker::take_layers() {
  shallowest_ = 1e300;
  deepest_ = -1e300;
  double sum = 0, n = 0;
  for (const ModelSurface* surface : {&made_.surfaces.front(), &made_.surfaces.back()}) {
    for (const Vector3d& at : surface->points) {
      shallowest_ = std::min(shallowest_, -at.z());
      deepest_ = std::max(deepest_, -at.z());
      sum -= at.z();
      n += 1;
    }
  }
  middle_ = sum / n;
  if (shallowest_ <= made_.lines.strike)
    throw InputError(options_.source,
                     formatted("the reservoir reaches up to a depth of %.0f m", shallowest_),
                     "the model begins at depth 0 and needs rock above: is depth downwards there?");
  if (deepest_ + made_.lines.strike >= -made_.lines.base)
    throw InputError(
        options_.source,
        formatted("the reservoir reaches down to a depth of %.0f m, the model to %.0f m", deepest_,
                  -made_.lines.base),
        "let the model reach deeper: --base");
  if (options_.layers_text.empty()) {
    rocks_ = assumed_layers();
    say(RemarkKind::choice,
        "rock above, in and below the reservoir is assumed: 10, 11 and 30 GPa, 2200, 2400 and 2600 "
        "kg/m3",
        "--layers, /materials");
  } else {
    rocks_ = read_layers(options_.layers_text, options_.layers_name, shallowest_, deepest_,
                         -made_.lines.base);
  }
}

void SceneMaker::add_materials() {
  Json& materials = made_.scene["materials"];
  for (const RockLayer& rock : rocks_.all) {
    Json one = {{"density", formatted("%.6g kg/m3", rock.density)},
                {"youngs_modulus", formatted("%.6g GPa", rock.youngs_modulus / 1e9)},
                {"poisson_ratio", rock.poisson_ratio}};
    if (&rock == &rocks_.all[rocks_.reservoir]) one["biot"] = 1.0;
    materials[rock.name] = one;
  }
}

Json SceneMaker::layers_json() {
  Json layers = Json::array();
  const auto add = [&](const std::string& name, const std::string& material, const Json& top) {
    layers.push_back({{"name", name}, {"material", material}, {"top", top}});
  };
  for (std::size_t k = 0; k < rocks_.reservoir; ++k)
    add(rocks_.all[k].name, rocks_.all[k].name, length(rocks_.all[k].top));
  const RockLayer& below = rocks_.all[rocks_.reservoir + 1];
  for (std::size_t s = 0; s < made_.surfaces.size(); ++s) {
    ModelSurface& surface = made_.surfaces[s];
    const bool is_base = s + 1 == made_.surfaces.size();
    // By the surfaces' own names: those of the user's layers may be no names of files.
    const std::string file = options_.stem + "-" + surface.name + ".csv";
    if (is_base) surface.name = below.name;
    made_.tables.push_back({file, csv_of(surface, made_.surfaces.front())});
    add(surface.name, is_base ? below.name : rocks_.all[rocks_.reservoir].name, {{"csv", file}});
  }
  for (std::size_t k = rocks_.reservoir + 2; k < rocks_.all.size(); ++k)
    add(rocks_.all[k].name, rocks_.all[k].name, length(rocks_.all[k].top));
  return layers;
}

void SceneMaker::add_geometry() {
  const ModelLines& lines = made_.lines;
  Json& geometry = made_.scene["geometry"];
  geometry["kind"] = "horizons";
  geometry["from"] = place(lines.low);
  geometry["to"] = place(lines.high);
  geometry["depth"] = depth(lines.base);
  geometry["trace_depth"] = depth(lines.reference_z);
  geometry["layers"] = layers_json();
  Json reservoir = Json::array();
  for (std::size_t s = 0; s + 1 < made_.surfaces.size(); ++s)
    reservoir.push_back(made_.surfaces[s].name);
  for (const ModelCompartment& one : made_.compartments) {
    Json compartment = {{"name", one.name}, {"inside", place(one.inside)}};
    if (!one.also.empty()) compartment["also_inside"] = places(one.also);
    compartment["layers"] = reservoir;
    geometry["compartments"].push_back(std::move(compartment));
  }
  for (const ModelDivider& one : lines.dividers)
    geometry["dividers"].push_back({{"name", one.name}, {"line", places(one.line)}});
  say(RemarkKind::choice,
      "beside the active map the reservoir's rock continues at the depth of its edge, without "
      "pressure changes",
      "/geometry/layers, \"outside\"");
}

void SceneMaker::add_mesh() {
  const MeshGrading grading = grading_of(structure_, made_.lines);
  made_.scene["mesh"] = {{"strike", length(made_.lines.strike)},
                         {"growth", 1 + grading.growth},
                         {"largest", length(grading.largest)}};
}

/// Gradients that give the weight of the layers and the reservoir's pressure in its middle.
void SceneMaker::add_initial_state() {
  constexpr double kGravity = 9.81, kWater = 1e4;  // m/s2; Pa/m
  double weight = 0;
  for (std::size_t k = 0; k <= rocks_.reservoir; ++k) {
    const double top = k == rocks_.reservoir ? shallowest_ : rocks_.all[k].top;
    const double base = k + 1 < rocks_.reservoir    ? rocks_.all[k + 1].top
                        : k + 1 == rocks_.reservoir ? shallowest_
                                                    : middle_;
    weight += kGravity * rocks_.all[k].density * (base - top);
  }
  double surface_pressure = 0;
  if (pressures_ != nullptr) {
    double sum = 0, volume = 0, moment_of_depth = 0;
    for (std::size_t c = 0; c < pressures_->cells.size(); ++c) {
      const FlowCell& cell = pressures_->cells[c];
      const double v = flow_cell_volume(cell);
      volume += v;
      sum += v * pressures_->value(static_cast<Eigen::Index>(c), 0);
      moment_of_depth -= v * (cell.low.z() + cell.high.z()) / 2;
    }
    surface_pressure = (sum - kWater * moment_of_depth) / volume;
  }
  made_.scene["initial_state"] = {
      {"kind", "profile"},
      {"vertical_stress_gradient", formatted("%.6g kPa/m", -weight / middle_ / 1e3)},
      {"pressure", formatted("%.6g bar", surface_pressure / 1e5)},
      {"pressure_gradient", formatted("%.6g kPa/m", kWater / 1e3)},
      {"ratio_across", 0.74},
      {"ratio_along", 0.83}};
  say(RemarkKind::choice,
      std::string("initial pressures grow by 0.1 bar/m of depth") +
          (pressures_ != nullptr ? ", and have the mean of the first report in the reservoir"
                                 : " from 0 at the surface"),
      "/initial_state");
  say(RemarkKind::choice,
      "effective horizontal stresses are 0.74 (along x) and 0.83 (along y) of the vertical one: "
      "assumed",
      "/initial_state");
}

void SceneMaker::add_faults() {
  if (made_.lines.faults.empty()) return;
  made_.scene["friction"] = {{"cohesion", "0 MPa"}, {"friction_angle", "30 deg"}};
  say(RemarkKind::choice, "all faults have a friction angle of 30 deg and no cohesion: assumed",
      "/friction");
  made_.scene["fault_pressure"] = {{"rule", "mean"}};
  say(RemarkKind::choice, "pressures in faults are the mean of both sides: assumed",
      "/fault_pressure");
  Json faults = Json::array();
  for (const ModelFault& fault : made_.lines.faults) {
    Json one = {{"name", fault.name}, {"trace", places(fault.trace)}};
    const auto say_end = [&](const char* key, LineEnd end) {
      if (end == LineEnd::fault) one[key] = "fault";
    };
    say_end("first_end", fault.first_end);
    say_end("last_end", fault.last_end);
    one["dip_from_vertical"] = dips_json(fault);
    one["top"] = depth(fault.top);
    one["bottom"] = depth(fault.bottom);
    faults.push_back(one);
  }
  made_.scene["faults"] = faults;
  say(RemarkKind::choice,
      formatted("each fault reaches %.0f m above and below the reservoir beside it",
                options_.lines.overshoot),
      "--overshoot, /faults");
}

void SceneMaker::add_stage_without_reports() {
  made_.scene["stages"] = Json::array({{{"name", "production"},
                                        {"duration", "10 year"},
                                        {"steps", 10},
                                        {"pressure_change", "-100 bar"}}});
  say(RemarkKind::choice,
      std::string(pressures_ == nullptr ? "no reports" : "one report only") +
          ": -100 bar over 10 years is assumed in all compartments",
      "--restart, /stages");
}

void SceneMaker::add_loading() {
  if (pressures_ == nullptr || pressures_->date.size() < 2) return add_stage_without_reports();
  made_.scene["pressure_field"] = {
      {"file", options_.field_file}, {"outside", "nearest"}, {"integral", "flow_grid"}};
  say(RemarkKind::choice,
      "changes of pressure are scaled, by some percent, so that their integral over each "
      "compartment is that of the grid's cells, though straight lines do not follow them",
      "/pressure_field/integral");
  made_.scene["stages"] =
      Json::array({{{"name", "history"}, {"until", moment(pressures_->date.back())}}});
  say(RemarkKind::recognised,
      concat(pressures_->date.size(), " reports from ", date_text(pressures_->date.front()), " to ",
             date_text(pressures_->date.back()),
             ": one stage; what changed since the first acts on the initial state"),
      "/stages, /pressure_field/reference");
}

}  // namespace

GridScene grid_scene(const corner_point::CornerPointGrid& grid,
                     const corner_point::GridStructure& structure, const GridSceneOptions& options,
                     const FlowField* pressures) {
  return SceneMaker(grid, structure, options, pressures).make();
}

}  // namespace faultsim::grid_scene
