// Ways to take χ̄, thickness and extents from the nodal fields of a fault, side by side on one
// solution, for results/measures. Usage: measures_study SCENE STUDY.json >figures.csv
//
// STUDY.json: {"meshes": {NAME: {POINTER: VALUE}}, "families": [{...}], "cases": [{...}]}; every
// mesh × family (changes that need an operator) × case (changes that do not) is run, and a line
// written per load step and fault; with "flags": true one per case, of its flag of activation; with
// "rules": false without the rules, which are for plane strain, cohesion 0 and constant friction.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/model/fault_profile.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using Eigen::VectorXd;
using nlohmann::json;
using Line = std::function<double(double)>;  // of s, Pa

constexpr double kWindow = 40;      // m
constexpr double kThreshold = 0.8;  // of χ

/// Shear and strength down one profile as functions of s with kinks at `knots` only.
struct Reading {
  Line shear, strength;
  std::vector<double> knots;
};

/// Maximum over windows of ∫shear/∫strength with an end at a knot, integrals by midpoints of many
/// parts: slow and plain, so that it shares no code with what it judges.
double window_index(const Profile& profile, const Reading& reading) {
  constexpr double kPart = 0.02;  // m
  const double from = profile.edge.front(), to = profile.edge.back();
  const auto n = static_cast<std::size_t>(std::ceil((to - from) / kPart));
  const double part = (to - from) / static_cast<double>(n);
  std::vector<double> load(n + 1, 0), bearing(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double s = from + part * (static_cast<double>(i) + 0.5);
    load[i + 1] = load[i] + part * reading.shear(s);
    bearing[i + 1] = bearing[i] + part * reading.strength(s);
  }
  const auto width = static_cast<std::size_t>(std::lround(std::min(kWindow, to - from) / part));
  double best = 0;
  for (std::size_t i = 0; i + width <= n; ++i)
    best = std::max(best, (load[i + width] - load[i]) / (bearing[i + width] - bearing[i]));
  return best;
}

double thickness(const Profile& profile, const Reading& reading) {
  constexpr double kPart = 0.05;  // m
  double length = 0;
  for (double s = profile.edge.front() + kPart / 2; s < profile.edge.back(); s += kPart)
    if (reading.shear(s) > kThreshold * reading.strength(s)) length += kPart;
  return length;
}

std::vector<double> positions(const Profile& profile) {
  std::vector<double> s;
  for (const ProfileSample& sample : profile.samples) s.push_back(sample.position);
  return s;
}

/// Linear between nodes, constant beyond the first and last.
Line linear(const Profile& profile, std::vector<double> value) {
  return [x = positions(profile), value = std::move(value)](double s) {
    const auto next = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), s) - x.begin());
    if (next == 0) return value.front();
    if (next == x.size()) return value.back();
    const double share = (s - x[next - 1]) / (x[next] - x[next - 1]);
    return value[next - 1] + share * (value[next] - value[next - 1]);
  };
}

std::size_t dual_cell(const Profile& profile, double s) {
  const auto after = std::upper_bound(profile.edge.begin() + 1, profile.edge.end() - 1, s);
  return static_cast<std::size_t>(after - profile.edge.begin()) - 1;
}

/// Constant over dual cells.
Line dual(const Profile& profile, std::vector<double> value) {
  return [&profile, value = std::move(value)](double s) { return value[dual_cell(profile, s)]; };
}

/// With the sum of each dual cell kept, sloped in it by the lesser of the slopes to its neighbours
/// (0 where they differ in sign).
Line sloped(const Profile& profile, std::vector<double> value) {
  const std::size_t n = value.size();
  std::vector<double> slope(n, 0), middle(n);
  for (std::size_t i = 0; i < n; ++i) middle[i] = 0.5 * (profile.edge[i] + profile.edge[i + 1]);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = (value[i] - value[i - 1]) / (middle[i] - middle[i - 1]);
    const double after = (value[i + 1] - value[i]) / (middle[i + 1] - middle[i]);
    if (before * after > 0) slope[i] = std::abs(before) < std::abs(after) ? before : after;
  }
  return [&profile, value = std::move(value), slope, middle](double s) {
    const std::size_t i = dual_cell(profile, s);
    return value[i] + slope[i] * (s - middle[i]);
  };
}

/// The piecewise linear traction whose consistent nodal forces are those of the profile: M q = F,
/// F_i = value_i share_i, q constant beyond the first and last node.
std::vector<double> recovered(const Profile& profile, const std::vector<double>& value) {
  const std::size_t n = value.size();
  if (n == 1) return value;
  const std::vector<double> x = positions(profile);
  std::vector<double> diagonal(n), off(n, 0), force(n);
  for (std::size_t i = 0; i < n; ++i) {
    force[i] = value[i] * profile.share(i);
    if (i > 0) diagonal[i] += (x[i] - x[i - 1]) / 3;
    if (i + 1 < n) {
      diagonal[i] += (x[i + 1] - x[i]) / 3;
      off[i] = (x[i + 1] - x[i]) / 6;
    }
  }
  diagonal[0] += x.front() - profile.edge.front();
  diagonal[n - 1] += profile.edge.back() - x.back();
  for (std::size_t i = 1; i < n; ++i) {  // Thomas
    const double factor = off[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * off[i - 1];
    force[i] -= factor * force[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) force[i] -= off[i] * force[i + 1];
    force[i] /= diagonal[i];
  }
  return force;
}

struct Rule {
  const char* name;
  std::function<Reading(const Profile&, const std::vector<double>& shear,
                        const std::vector<double>& strength)>
      read;
};

std::vector<double> floored(std::vector<double> strength) {
  for (double& value : strength) value = std::max(value, 1e3);
  return strength;
}

std::vector<double> absolute(std::vector<double> shear) {
  for (double& value : shear) value = std::abs(value);
  return shear;
}

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = {
      {"linear",
       [](const Profile& c, const auto& t, const auto& l) {
         return Reading{linear(c, absolute(t)), linear(c, floored(l)), {}};
       }},
      {"dual",
       [](const Profile& c, const auto& t, const auto& l) {
         return Reading{dual(c, absolute(t)), dual(c, floored(l)), {}};
       }},
      {"sloped",
       [](const Profile& c, const auto& t, const auto& l) {
         return Reading{sloped(c, absolute(t)), sloped(c, floored(l)), {}};
       }},
      {"recovered",
       [](const Profile& c, const auto& t, const auto& l) {
         return Reading{
             linear(c, absolute(recovered(c, t))), linear(c, floored(recovered(c, l))), {}};
       }},
      {"limited",  // recovered, but nowhere beyond strength
       [](const Profile& c, const auto& t, const auto& l) {
         const Line strength = linear(c, floored(recovered(c, l)));
         const Line shear = linear(c, absolute(recovered(c, t)));
         return Reading{[=](double s) { return std::min(shear(s), strength(s)); }, strength, {}};
       }},
  };
  return all;
}

/// Writes the lines of one step.
class StepWriter {
 public:
  StepWriter(const FaultOperator& op, const Scene& scene, std::string prefix, bool with_rules)
      : faults_(op.geometry.faults),
        scene_(scene),
        prefix_(std::move(prefix)),
        with_rules_(with_rules) {}

  void write(const StepResult& step, const FaultFields& fields) const {
    for (std::size_t f = 0; f < step.faults.size(); ++f) {
      const FaultMetrics& m = step.faults[f];
      std::printf("%s,%d,%s,%.3f,%d,%d,%.9g,%.6g,%.6g", prefix_.c_str(), step.step,
                  scene_.faults[f].name.c_str(), m.activated_length, m.activated ? 1 : 0,
                  m.activation_resolved ? 1 : 0, m.chi_bar, m.max_slip, m.thickness_chi_080_max);
      if (with_rules_)
        for (const Rule& rule : rules()) write_rule(rule, static_cast<int>(f), fields);
      std::printf("\n");
    }
  }

 private:
  void write_rule(const Rule& rule, int fault, const FaultFields& fields) const {
    const double tangent = std::tan(scene_.faults[fault].friction.static_friction_angle);
    double chi = 0, thick = 0;
    for (const Profile& profile : faults_[fault].profiles) {
      std::vector<double> shear, strength;
      for (const ProfileSample& sample : profile.samples) {
        shear.push_back(fields.traction(2, sample.node[0]));  // plane strain: down dip only
        strength.push_back(-fields.traction(0, sample.node[0]) * tangent);
      }
      const Reading reading = rule.read(profile, shear, strength);
      chi = std::max(chi, window_index(profile, reading));
      thick = std::max(thick, thickness(profile, reading));
    }
    std::printf(",%.7g,%.5g", chi, thick);
  }

  const std::vector<OperatorFault>& faults_;
  const Scene& scene_;
  std::string prefix_;
  bool with_rules_;
};

JsonDocument with(JsonDocument document, const json& changes) {
  for (const auto& [name, value] : changes.items()) {
    const std::string pointer = name.starts_with("/") ? name : resolve_parameter(document, name);
    set_value(document, pointer, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return document;
}

std::string label(const json& changes) {
  std::string text;
  for (const auto& [name, value] : changes.items())
    text += (text.empty() ? "" : "; ") + name + " " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

void write_flag(const std::string& prefix, const CaseResult& result) {
  double length = 0;
  for (const StepResult& step : result.steps)
    for (const FaultMetrics& fault : step.faults) length = std::max(length, fault.activated_length);
  const StageMetrics& whole = result.whole;
  std::printf("%s,%s,%d,%d,%.3f,%.7g,%.6g\n", prefix.c_str(), to_string(result.outcome),
              whole.activated ? 1 : 0, whole.activation_resolved ? 1 : 0, length, whole.chi_bar,
              whole.max_slip);
}

void run_family(const JsonDocument& document, const std::string& prefix, const json& cases,
                bool flags, bool with_rules) {
  std::optional<PreparedOperator> prepared;
  SilentMonitor monitor;
  for (const json& changes : cases) {
    const Scene scene = read_scene(with(document, changes));
    if (!prepared) {
      std::vector<Problem> problems;
      const Plan plan = make_plan(scene, problems);
      if (!problems.empty()) throw InputError(document.source, problems);
      prepared = prepare_operator(scene, plan, {}, false, monitor);
    }
    const std::string start = concat(prefix, ",", prepared->op->n_unknowns, ",",
                                     prepared->op->geometry.n_dofs, ",", label(changes));
    if (flags) {
      write_flag(start, run_case(scene, *prepared, monitor));
    } else {
      const StepWriter writer(*prepared->op, scene, start, with_rules);
      run_case(scene, *prepared, monitor, {{[&](const StepResult& step, const FaultFields& fields) {
                 writer.write(step, fields);
               }}});
    }
    std::fflush(stdout);
  }
}

void run(const std::string& scene_file, const std::string& study_file) {
  const JsonDocument scene = read_json_file(scene_file);
  const json study = read_json_file(study_file).value;
  const bool flags = study.value("flags", false), with_rules = study.value("rules", true);
  std::printf("mesh,family,unknowns,jumps,case,");
  if (flags) {
    std::printf("outcome,activated,resolved,length_m,chi,slip_m\n");
  } else {
    std::printf("step,fault,length_m,activated,resolved,chi,slip_m,thickness_m");
    for (const Rule& rule : with_rules ? rules() : std::vector<Rule>())
      std::printf(",chi_%s,thickness_%s_m", rule.name, rule.name);
    std::printf("\n");
  }
  for (const auto& [name, mesh] : study.at("meshes").items()) {
    for (const json& family : study.at("families")) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), label(family).c_str());
      run_family(with(with(scene, mesh), family), name + "," + label(family), study.at("cases"),
                 flags, with_rules);
    }
  }
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: measures_study SCENE STUDY.json >figures.csv\n");
    return 2;
  }
  try {
    faultsim::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
