#include "simulator/reading/read_layered_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/reading/csv_tables.h"
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
    for (std::size_t i = 0; i < reader_.size("/faults"); ++i) read_fault(element("/faults", i));
    read_cells();
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
  void read_compartments();
  void read_dividers();
  void read_fault(const std::string& at);
  void read_profile(const std::string& at, LayeredFault& fault);
  void read_throw(const std::string& at, LayeredFault& fault);
  void read_cells();

  SceneReader& reader_;
  const Scene& scene_;
  BodyOfKeys result_;
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
      reader_.problem(at, "the first layer ends at the top of the model, which is level",
                      "write its depth, \"0 m\" for the surface");
    }
    body_.top = -reader_.real(at);
    return;
  }
  body_.horizons.push_back({"top of " + result_.rocks[layer].name, read_surface(at)});
}

horizons::DepthOverMap BodyReader::read_surface(const std::string& at) {
  const nlohmann::json* top = reader_.find(at);
  if (top == nullptr || !top->is_object()) return horizons::ConstantDepth{-reader_.real(at)};
  const std::string name = reader_.text(at + "/csv");
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
    return horizons::PointDepth{parse_horizon_csv(text, name)};
  } catch (const InputError& error) {
    reader_.table_problems(at + "/csv", name, error);
    return horizons::ConstantDepth{kNaN};
  }
}

void BodyReader::read_compartments() {
  const std::vector<std::string> layers = mapped(result_.rocks, &LayerRock::name);
  std::vector<std::string> names;
  for (std::size_t c = 0; c < reader_.size("/geometry/compartments"); ++c) {
    const std::string at = element("/geometry/compartments", c);
    horizons::Compartment one{reader_.text(at + "/name"), pair(at + "/inside"),
                              std::vector<int>(layers.size(), -1)};
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
  if (!reader_.has(at + "/trace")) {
    reader_.problem(at, "the fault \"" + fault.name + "\" has no trace",
                    R"(add "trace": [["0 m", "-1 km"], ["0 m", "1 km"]], its line in the map)");
  }
  fault.first_end = end("/first_end");
  fault.last_end = end("/last_end");
  fault.top = height(at + "/top");
  fault.bottom = height(at + "/bottom");
  read_profile(at, fault);
  read_throw(at, fault);
  body_.faults.push_back(std::move(fault));
}

/// Shifts in a scene are to the right of the trace, for the builder towards the hanging wall.
void BodyReader::read_profile(const std::string& at, LayeredFault& fault) {
  const std::size_t n = reader_.size(at + "/listric");
  if (n == 0) {
    const double lean = reader_.real(at + "/dip_from_vertical", 0);
    fault.dips_to = lean < 0 ? horizons::DipSide::left : horizons::DipSide::right;
    fault.dip = std::numbers::pi / 2 - std::abs(lean);
    return;
  }
  if (reader_.has(at + "/dip_from_vertical")) {
    reader_.problem(at + "/dip_from_vertical", "the fault has a profile that says how it dips",
                    "remove one of the two");
  }
  std::vector<horizons::DipPoint> points;
  for (std::size_t k = 0; k < n; ++k) {
    const std::string place = element(at + "/listric", k);
    points.push_back({-reader_.real(place + "/depth"), reader_.real(place + "/shift")});
  }
  const auto [low, high] = std::ranges::minmax_element(points, {}, &horizons::DipPoint::z);
  const bool is_right = low->shift >= high->shift;
  fault.dips_to = is_right ? horizons::DipSide::right : horizons::DipSide::left;
  for (horizons::DipPoint& point : points) point.shift = is_right ? point.shift : -point.shift;
  fault.listric = std::move(points);
}

/// A throw in a scene lowers what is right of the trace, for the builder the hanging wall.
void BodyReader::read_throw(const std::string& at, LayeredFault& fault) {
  if (!reader_.has(at + "/throw")) {
    for (const char* key : {"/throw_share", "/throw_reach", "/throw_taper"}) {
      if (!reader_.has(at + key)) continue;
      reader_.problem(at + key, "says how a throw fades, and none is given",
                      "add \"throw\", or remove it");
    }
    return;
  }
  const bool is_right = fault.dips_to == horizons::DipSide::right;
  const double down = reader_.real(at + "/throw"), left = reader_.real(at + "/throw_share", 0.5);
  horizons::FaultThrow moved;
  moved.down = is_right ? down : -down;
  moved.footwall_share = is_right ? left : 1 - left;
  if (reader_.has(at + "/throw_reach")) moved.reach = reader_.real(at + "/throw_reach");
  if (reader_.has(at + "/throw_taper")) moved.taper = reader_.real(at + "/throw_taper");
  fault.moved = moved;
}

void BodyReader::read_cells() {
  constexpr double kGrowth = 1.3, kFar = 1000;
  body_.cells.at_faults = reader_.real("/mesh/strike");
  body_.cells.growth = reader_.real("/mesh/growth", kGrowth) - 1;
  body_.cells.far = reader_.real("/mesh/largest", std::max(kFar, body_.cells.at_faults));
}

}  // namespace

BodyOfKeys read_layered_body(SceneReader& reader, const Scene& scene) {
  return BodyReader(reader, scene).read();
}

std::string scene_pointer(const std::string& of_body) {
  const std::string_view at = of_body;
  const auto begins = [&](std::string_view word) { return at.starts_with(word); };
  if (begins("/faults")) {
    const std::size_t key = of_body.find('/', std::string_view("/faults/").size());
    if (key == std::string::npos || of_body.substr(key) != "/dip") return of_body;
    return of_body.substr(0, key) + "/dip_from_vertical";
  }
  if (begins("/cells")) return "/mesh";
  if (begins("/box")) return "/geometry";
  if (!begins("/horizons/")) return "/geometry" + of_body;
  const std::size_t number = std::string_view("/horizons/").size();
  const int horizon = std::stoi(of_body.substr(number));
  return concat("/geometry/layers/", horizon + 1, "/top");
}

}  // namespace faultsim
