#include "simulator/reading/read_layered_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/horizons/depth_surface.h"
#include "simulator/horizons/drawn_surface.h"
#include "simulator/horizons/traces.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/fault_places.h"
#include "simulator/reading/fault_surface.h"
#include "simulator/reading/horizon_csv.h"
#include "simulator/reading/read_body.h"

namespace faultsim {
namespace {

using Eigen::Vector2d;
using horizons::LayeredFault;
using horizons::TraceEnd;

class BodyReader {
 public:
  BodyReader(SceneReader& reader, const Scene& scene) : reader_(reader), scene_(scene) {}

  BodyOfKeys read() {
    read_box();
    read_layers();
    read_compartments();
    read_dividers();
    read_cells();
    for (std::size_t i = 0; i < reader_.size("/faults"); ++i) read_fault(element("/faults", i));
    check_reach();
    return std::move(result_);
  }

 private:
  Vector2d pair(const std::string& at) const {
    return {reader_.real(at + "/0"), reader_.real(at + "/1")};
  }
  std::vector<Vector2d> line(const std::string& at) const {
    std::vector<Vector2d> points;
    for (std::size_t k = 0; k < reader_.size(at); ++k) points.push_back(pair(element(at, k)));
    return points;
  }
  std::optional<double> height(const std::string& at) const {
    if (!reader_.has(at)) return std::nullopt;
    return -reader_.real(at);
  }

  void read_box();
  void read_layers();
  void read_top(const std::string& at, std::size_t layer);
  horizons::DepthOverMap read_surface(const std::string& at);
  horizons::DepthOverMap hung(const std::string& at, const std::string& name,
                              const HorizonTable& table);
  void read_compartments();
  void read_dividers();
  void read_fault(const std::string& at);
  void read_profiles(const std::string& at, LayeredFault& fault);
  void read_listric(const std::string& at, LayeredFault& fault);
  void read_fault_surface(const std::string& at, LayeredFault& fault);
  bool refuse_longer(const std::string& pointer, const std::string& fault,
                     const std::vector<Vector2d>& trace);
  void read_dips(const std::string& at, LayeredFault& fault);
  void read_throw(const std::string& at, LayeredFault& fault);
  void read_cells();
  std::vector<std::size_t> reservoir_horizons() const;
  void check_reach();
  bool refuse_within(std::size_t fault, const Vector2d& place, const std::array<double, 2>& reached,
                     const std::array<double, 2>& reservoir);

  SceneReader& reader_;
  const Scene& scene_;
  BodyOfKeys result_;
  std::vector<Eigen::Vector3d> above_;  ///< points that a thickness below them may be given for.
  /// Of faults with a surface, by number: SurfaceLines::reached.
  std::map<std::size_t, std::vector<std::array<double, 2>>> reached_;
  horizons::LayeredBody& body_ = result_.body;
};

void BodyReader::read_box() {
  body_.low = pair("/geometry/from");
  body_.high = pair("/geometry/to");
  body_.base = -reader_.real("/geometry/depth");
  body_.trace_depth = -reader_.real("/geometry/trace_depth");
}

void BodyReader::read_layers() {
  const std::vector<std::string> materials = material_names(scene_);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < reader_.size("/geometry/layers"); ++k) {
    const std::string at = element("/geometry/layers", k);
    LayerRock rock{reader_.text(at + "/name"), reader_.text(at + "/material"), ""};
    rock.outside = reader_.text(at + "/outside", rock.material);
    reader_.require_known(at + "/material", rock.material, "material", materials);
    if (reader_.has(at + "/outside"))
      reader_.require_known(at + "/outside", rock.outside, "material", materials);
    names.push_back(rock.name);
    result_.rocks.push_back(std::move(rock));
    body_.layers.push_back({});
    read_top(at + "/top", k);
  }
  reader_.require_unique("/geometry/layers", "/name", names);
}

void BodyReader::read_top(const std::string& at, std::size_t layer) {
  const nlohmann::json* top = reader_.find(at);
  if (layer == 0) {
    if (top != nullptr && top->is_object()) {
      reader_.problem(at, "the first layer begins at the top of the model, which is level",
                      "write its depth, \"0 m\" for the surface");
    }
    body_.top = -reader_.real(at);
    return;
  }
  body_.horizons.push_back({"top of " + result_.rocks[layer].name, read_surface(at)});
}

horizons::DepthOverMap BodyReader::read_surface(const std::string& at) {
  const nlohmann::json* top = reader_.find(at);
  const bool is_level = top == nullptr || !top->is_object();
  const std::string name = is_level ? "" : reader_.text(at + "/csv");
  if (name.empty()) above_.clear();
  if (is_level) return horizons::ConstantDepth{-reader_.real(at)};
  if (name.empty()) {
    horizons::PlaneDepth plane{-reader_.real(at + "/depth")};
    if (reader_.has(at + "/at")) plane.at = pair(at + "/at");
    if (reader_.has(at + "/slope")) plane.slope = -pair(at + "/slope");
    return plane;
  }
  const JsonDocument& document = reader_.document();
  try {
    const std::string text = table_text(document.value, document.source, name);
    result_.tables += text;
    const HorizonTable table = parse_horizon_csv(text, name);
    if (table.is_thickness) return hung(at + "/csv", name, table);
    above_ = table.points;
    return horizons::PointDepth{table.points};
  } catch (const InputError& error) {
    above_.clear();
    reader_.table_problems(at + "/csv", name, error);
    return horizons::ConstantDepth{kNaN};
  }
}

/// A table of thicknesses: it has the places of the table above, line by line.
horizons::DepthOverMap BodyReader::hung(const std::string& at, const std::string& name,
                                        const HorizonTable& table) {
  const horizons::ConstantDepth unknown{kNaN};
  const auto refuse = [&](const std::string& what) {
    reader_.problem(
        at, name + what,
        "give a thickness for each line of the table of the layer above, with the same x "
        "and y in the same order, or write depth [m] for a surface of its own");
    return unknown;
  };
  if (above_.empty())
    return refuse(" has thicknesses, but the top of the layer above is not a table of points");
  if (table.points.size() != above_.size())
    return refuse(concat(" has ", counted(table.points.size(), "thickness", "thicknesses"),
                         ", but the table of the layer above has ",
                         counted(above_.size(), "point", "points")));
  horizons::HungDepth below;
  for (std::size_t k = 0; k < above_.size(); ++k) {
    const Eigen::Vector3d& point = table.points[k];
    if (point.head<2>() != above_[k].head<2>())
      return refuse(concat(" line ", table.line[k], ": x ", point.x(), ", y ", point.y(),
                           " m is not the place of the point in the table of the layer above, x ",
                           above_[k].x(), ", y ", above_[k].y(), " m"));
    below.thickness.push_back(point.z());
  }
  return below;
}

void BodyReader::read_compartments() {
  const std::vector<std::string> layers = mapped(result_.rocks, &LayerRock::name);
  std::vector<std::string> names;
  for (std::size_t c = 0; c < reader_.size("/geometry/compartments"); ++c) {
    const std::string at = element("/geometry/compartments", c);
    horizons::Compartment one{reader_.text(at + "/name"), pair(at + "/inside"),
                              std::vector<int>(layers.size(), -1)};
    if (reader_.has(at + "/also_inside")) one.also_inside = line(at + "/also_inside");
    for (std::size_t k = 0; k < reader_.size(at + "/layers"); ++k) {
      const std::string place = element(at + "/layers", k), name = reader_.text(place);
      reader_.require_known(place, name, "layer", layers);
      const auto found = std::ranges::find(layers, name);
      if (found == layers.end()) continue;
      one.region[static_cast<std::size_t>(found - layers.begin())] = static_cast<int>(c);
    }
    names.push_back(one.name);
    body_.compartments.push_back(std::move(one));
  }
  reader_.require_unique("/geometry/compartments", "/name", names);
}

void BodyReader::read_dividers() {
  for (std::size_t d = 0; d < reader_.size("/geometry/dividers"); ++d) {
    const std::string at = element("/geometry/dividers", d);
    body_.dividers.push_back({reader_.text(at + "/name"), line(at + "/line")});
  }
}

void BodyReader::read_fault(const std::string& at) {
  const auto end = [&](const char* key) {
    const std::string word = reader_.text(at + key, "rock");
    if (word == "edge") return TraceEnd::at_edge;
    return word == "fault" ? TraceEnd::at_fault : TraceEnd::in_rock;
  };
  LayeredFault fault;
  fault.name = reader_.text(at + "/name");
  fault.trace = line(at + "/trace");
  if (!reader_.has(at + "/trace") && !reader_.has(at + "/surface")) {
    reader_.problem(
        at, "the fault \"" + fault.name + "\" has no trace",
        R"(add "trace": [["0 m", "-1 km"], ["0 m", "1 km"]], its line in the map, or a "surface")");
  }
  fault.first_end = end("/first_end");
  fault.last_end = end("/last_end");
  fault.top = height(at + "/top");
  fault.bottom = height(at + "/bottom");
  read_profiles(at, fault);
  read_throw(at, fault);
  body_.faults.push_back(std::move(fault));
}

/// How it goes down: a surface, a curved profile, or dips.
void BodyReader::read_profiles(const std::string& at, LayeredFault& fault) {
  std::string said;
  for (const char* key : {"/surface", "/listric", "/dip_from_vertical"}) {
    if (!reader_.has(at + key)) continue;
    if (said.empty()) {
      said = key;
      continue;
    }
    const std::string other = said == "/surface" ? "surface" : "listric profile";
    reader_.problem(at + key, "the fault has a " + other + " that says how it dips",
                    "remove one of the two");
  }
  if (said == "/surface") return read_fault_surface(at, fault);
  if (said == "/listric") return read_listric(at, fault);
  read_dips(at + "/dip_from_vertical", fault);
}

void BodyReader::read_listric(const std::string& at, LayeredFault& fault) {
  horizons::DipProfile profile;
  for (std::size_t k = 0; k < reader_.size(at + "/listric"); ++k) {
    const std::string place = element(at + "/listric", k);
    profile.push_back({-reader_.real(place + "/depth"), reader_.real(place + "/shift")});
  }
  fault.profiles = {std::move(profile)};
}

/// The trace, unless one is given, the lines down it and its ends, as far as they are in the body.
void BodyReader::read_fault_surface(const std::string& at, LayeredFault& fault) {
  const std::string pointer = at + "/surface", name = reader_.text(pointer);
  const JsonDocument& document = reader_.document();
  horizons::DrawnSurface surface;
  try {
    const std::string text = table_text(document.value, document.source, name);
    result_.tables += text;
    surface = parse_fault_surface(text, name, fault.name);
  } catch (const InputError& error) {
    return reader_.table_problems(pointer, name, error);
  }
  // Strengths do not matter here: a body is built where places are sound.
  const auto is_sound = [&](std::string_view key) {
    return reader_.sound(at + "/" + std::string(key));
  };
  if (!(body_.cells.at_faults > 0) || !reader_.sound("/geometry") || !is_sound("name") ||
      !std::ranges::all_of(place_keys("horizons"), is_sound))
    return;
  std::vector<Problem> problems;
  const horizons::SurfaceLines lines =
      horizons::lines_of(surface, fault.trace, body_.trace_depth, body_.cells.at_faults, pointer,
                         fault.name, problems);
  for (const Problem& one : problems) reader_.problem(one.pointer, one.what, one.cure);
  if (!problems.empty() || (fault.trace.empty() && refuse_longer(pointer, fault.name, lines.trace)))
    return;
  fault.trace = lines.trace;
  fault.profiles = lines.profiles;
  reached_[body_.faults.size()] = lines.reached;
  if (!fault.top && lines.top < body_.top) fault.top = lines.top;
  if (!fault.bottom && lines.bottom > body_.base) fault.bottom = lines.bottom;
}

/// A surface whose line leaves the box, as the builder would say of a trace.
bool BodyReader::refuse_longer(const std::string& pointer, const std::string& fault,
                               const std::vector<Vector2d>& trace) {
  const auto is_outside = [&](const Vector2d& at) {
    return (body_.low - at).cwiseMax(at - body_.high).maxCoeff() > body_.cells.at_faults;
  };
  const auto outside = std::ranges::find_if(trace, is_outside);
  if (outside == trace.end()) return false;
  reader_.problem(
      pointer,
      concat("the surface of \"", fault, "\" is longer than the box, which it leaves at ",
             horizons::map_place(*outside)),
      "write a \"trace\", its line as far as it is to lie in the box (it then goes down as the "
      "surface does), or enlarge the box");
  return true;
}

/// One dip, or one for each point of the trace.
void BodyReader::read_dips(const std::string& at, LayeredFault& fault) {
  const auto add = [&](double dip) {
    fault.profiles.push_back(horizons::straight_profile(std::tan(dip)));
  };
  const nlohmann::json* dips = reader_.find(at);
  if (dips == nullptr || !dips->is_array()) return add(reader_.real(at, 0));
  for (std::size_t k = 0; k < reader_.size(at); ++k) add(reader_.real(element(at, k)));
  const std::size_t n = fault.profiles.size(), n_points = fault.trace.size();
  if (n == n_points || n_points == 0 || !reader_.sound(at)) return;
  reader_.problem(
      at, concat("has ", counted(n, "dip", "dips"), " for ", n_points, " points of the trace"),
      "write one for each point, or one for all");
}

void BodyReader::read_throw(const std::string& at, LayeredFault& fault) {
  if (!reader_.has(at + "/throw")) {
    for (const char* key : {"/throw_share", "/throw_reach", "/throw_taper"}) {
      if (!reader_.has(at + key)) continue;
      reader_.problem(at + key, "says how a throw fades, but none is given",
                      "add \"throw\", or remove it");
    }
    return;
  }
  horizons::FaultThrow moved;
  moved.down = reader_.real(at + "/throw");
  moved.left_share = reader_.real(at + "/throw_share", moved.left_share);
  if (reader_.has(at + "/throw_reach")) moved.reach = reader_.real(at + "/throw_reach");
  if (reader_.has(at + "/throw_taper")) moved.taper = reader_.real(at + "/throw_taper");
  fault.moved = moved;
}

/// Those above and below layers whose pressure changes.
std::vector<std::size_t> BodyReader::reservoir_horizons() const {
  std::vector<std::size_t> found;
  for (std::size_t h = 0; h < body_.horizons.size(); ++h)
    for (const horizons::Compartment& one : body_.compartments)
      if (one.region[h] >= 0 || one.region[h + 1] >= 0) found.push_back(h);
  drop_repeated(found);
  return found;
}

/// Surfaces of faults that end within the reservoir: more likely cut off than meant.
void BodyReader::check_reach() {
  if (reached_.empty() || !reader_.sound("/geometry") || !reader_.sound("/faults")) return;
  std::vector<Problem> problems;  // said by the builder
  const std::vector<horizons::DepthSurface> all = horizons::depth_surfaces(body_, problems);
  const auto tops = mapped(reservoir_horizons(), [&](std::size_t h) { return all[h]; });
  if (tops.empty() || !problems.empty()) return;
  for (const auto& [f, reached] : reached_) {
    const LayeredFault& fault = body_.faults[f];
    for (std::size_t k = 0; k < fault.trace.size(); ++k) {
      const auto depths = mapped(tops, [&](const auto& top) { return top.at(fault.trace[k]); });
      const auto [low, high] = std::ranges::minmax(depths);
      if (refuse_within(f, fault.trace[k], reached[k], {low, high})) break;
    }
  }
}

/// Where a surface ends between the reservoir's base and its top, z; none of the two is said.
bool BodyReader::refuse_within(std::size_t fault, const Vector2d& place,
                               const std::array<double, 2>& reached,
                               const std::array<double, 2>& reservoir) {
  const std::string at = element("/faults", fault);
  const auto is_within = [&](double z) { return z > reservoir[0] && z < reservoir[1]; };
  const bool is_top = !reader_.has(at + "/top") && is_within(reached[1]),
             is_base = !reader_.has(at + "/bottom") && is_within(reached[0]);
  if (!is_top && !is_base) return false;
  reader_.problem(
      at + "/surface",
      concat("the surface of \"", body_.faults[fault].name, "\" ends within the reservoir: at ",
             horizons::map_place(place), " its ", is_top ? "top" : "base", " lies at ",
             metres(-reached[is_top ? 1 : 0]), " depth, the reservoir from ", metres(-reservoir[1]),
             " to ", metres(-reservoir[0])),
      concat("give a surface that goes further, or write \"", is_top ? "top" : "bottom",
             "\": it then goes straight on to there"));
  return true;
}

void BodyReader::read_cells() {
  constexpr double kGrowth = 1.3, kFar = 1000;
  body_.cells.at_faults = reader_.real("/mesh/strike");
  body_.cells.growth = reader_.real("/mesh/growth", kGrowth) - 1;
  body_.cells.far = reader_.real("/mesh/largest", std::max(kFar, body_.cells.at_faults));
}

/// "/faults/0/profiles/1" is about the key that gave them.
std::string fault_pointer(const SceneReader& reader, const std::string& of_body) {
  const std::size_t slash = of_body.find('/', std::string_view("/faults/").size());
  if (slash == std::string::npos) return of_body;
  const std::string fault = of_body.substr(0, slash), key = of_body.substr(slash);
  const bool is_profile = key.starts_with("/profiles");
  if (reader.has(fault + "/surface") && (is_profile || !reader.has(fault + key)))
    return fault + "/surface";
  if (!is_profile) return of_body;
  if (reader.has(fault + "/listric")) return fault + "/listric";
  const std::string dip = fault + "/dip_from_vertical";
  const nlohmann::json* given = reader.find(dip);
  const bool is_list = given != nullptr && given->is_array();
  return is_list ? dip + key.substr(std::string_view("/profiles").size()) : dip;
}

}  // namespace

BodyOfKeys read_layered_body(SceneReader& reader, const Scene& scene) {
  return BodyReader(reader, scene).read();
}

std::string scene_pointer(const SceneReader& reader, const std::string& of_body) {
  const std::string_view at = of_body;
  const auto begins = [&](std::string_view word) { return at.starts_with(word); };
  if (begins("/faults/")) return fault_pointer(reader, of_body);
  if (begins("/faults")) return of_body;
  if (begins("/cells")) return "/mesh";
  if (begins("/box")) return "/geometry";
  if (!begins("/horizons/")) return "/geometry" + of_body;
  const std::size_t number = std::string_view("/horizons/").size();
  const int horizon = std::stoi(of_body.substr(number));
  return concat("/geometry/layers/", horizon + 1, "/top");
}

}  // namespace faultsim
