#include "tests/stress/stress_operators.h"

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

StressOperator made(const std::string& name, const json& document) {
  const Scene scene = read_scene(parse_json(document.dump(), name));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  FAULTSIM_DEMAND(problems.empty(), "scene ", name);
  SilentMonitor monitor;
  return {name, prepare_operator(scene, plan, {}, false, monitor).op};
}

json box(const char* strike, const char* dip, const char* normal) {
  json scene = json::parse(starter_scene("box"));
  scene["mesh"] = {{"strike", strike},
                   {"dip", dip},
                   {"normal", normal},
                   {"growth", 2.0},
                   {"fine_margin", "0 m"}};
  return scene;
}

json field(const char* strike, const char* dip, const char* normal) {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", strike}, {"dip", dip}, {"normal", normal}, {"growth", 2.0}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["geometry"]["depth"] = "4 km";
  return scene;
}

json plane_field(const char* dip, const char* normal) {
  json scene = field("400 m", dip, normal);
  scene["numerics"] = {{"plane_strain", "on"}};
  return scene;
}

json patch(const char* name, const char* x, const char* dip, const char* length,
           const char* width) {
  return {{"name", name},      {"center", {x, "0 m", "-2000 m"}},
          {"strike", "0 deg"}, {"dip_from_vertical", dip},
          {"length", length},  {"width", width}};
}

/// Soft rock over and stiff rock under the middle of the patch.
void make_contrast(json& scene) {
  scene["materials"] = {{"soft", {{"youngs_modulus", "1 GPa"}, {"poisson_ratio", 0.4}}},
                        {"stiff", {{"youngs_modulus", "60 GPa"}, {"poisson_ratio", 0.1}}}};
  scene["geometry"].erase("material");
  scene["geometry"]["layers"] = {{{"name", "above"}, {"material", "soft"}, {"top", "1000 m"}},
                                 {{"name", "below"}, {"material", "stiff"}, {"top", "2000 m"}}};
}

std::vector<StressOperator> make_all() {
  std::vector<StressOperator> all;
  all.push_back(made("plane field, coarse", plane_field("150 m", "300 m")));

  json scene = plane_field("100 m", "200 m");
  scene["geometry"]["blocks"] = {{{"name", "west"}, {"from", "0 m"}, {"to", "2000 m"}}};
  scene["compartments"] = json::object();
  scene["faults"] = {{{"name", "F1"}, {"dip_from_vertical", "-30 deg"}},
                     {{"name", "F2"}, {"dip_from_vertical", "30 deg"}}};
  all.push_back(made("plane field, dips of 30 deg", scene));

  scene = plane_field("60 m", "100 m");
  scene["materials"]["reservoir"]["youngs_modulus"] = "2 GPa";
  scene["materials"]["salt"]["youngs_modulus"] = "70 GPa";
  scene["geometry"]["blocks"][1]["offset"] = "250 m";
  all.push_back(made("plane field, large offset, stiff salt", scene));

  all.push_back(made("plane field, fine", plane_field("25 m", "60 m")));

  scene = box("250 m", "150 m", "200 m");
  all.push_back(made("box, vertical", scene));

  scene = box("250 m", "150 m", "200 m");
  scene["faults"] = {patch("F1", "0 m", "40 deg", "800 m", "800 m")};
  all.push_back(made("box, dip of 40 deg", scene));

  scene = box("250 m", "150 m", "200 m");
  scene["faults"] = {patch("F1", "-150 m", "0 deg", "800 m", "600 m"),
                     patch("F2", "150 m", "0 deg", "800 m", "600 m")};
  scene["geometry"]["regions"][0]["to"] = {"150 m", "500 m", "-1900 m"};
  scene["geometry"]["regions"][0]["from"] = {"-150 m", "-500 m", "-2100 m"};
  all.push_back(made("box, two faults beside each other", scene));

  scene = box("250 m", "125 m", "150 m");
  make_contrast(scene);
  all.push_back(made("box, soft over stiff", scene));

  scene = box("250 m", "150 m", "200 m");
  scene["faults"] = {patch("F1", "0 m", "10 deg", "1400 m", "600 m")};
  all.push_back(made("box, patch cut by rollers", scene));

  scene = box("125 m", "100 m", "150 m");
  scene["faults"] = {patch("F1", "0 m", "0 deg", "800 m", "700 m")};
  scene["faults"][0]["shape"] = "ellipse";
  all.push_back(made("box, ellipse", scene));

  scene = field("600 m", "150 m", "300 m");
  scene["numerics"] = {{"half_domain", "on"}};
  all.push_back(made("half field", scene));

  scene = box("125 m", "75 m", "100 m");
  scene["faults"] = {patch("F1", "0 m", "20 deg", "1000 m", "800 m")};
  make_contrast(scene);
  all.push_back(made("box, dip of 20 deg, soft over stiff", scene));
  return all;
}

}  // namespace

const std::vector<StressOperator>& stress_operators() {
  static const std::vector<StressOperator> all = make_all();
  return all;
}

}  // namespace faultsim
