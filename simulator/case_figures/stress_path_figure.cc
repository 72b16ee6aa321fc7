#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/stress_path.h"
#include "simulator/initial_state/initial_state.h"

namespace faultsim::case_figures {
namespace {

/// Principal stresses σ + α_f p0 across the fault at the start, effective as the fault's traction
/// is, MPa, compression positive. With σ_xz = 0 in every initial state but a tensor's, these are
/// those of x and z.
std::optional<figure::StressPath::Circle> initial_circle(const Scene& scene, double fault_biot,
                                                         double z) {
  if (scene.initial.tensor || scene.geometry_kind != GeometryKind::field) return std::nullopt;
  const StressAtDepth start = initial_state(scene, z);
  const double fluid = fault_biot * start.pressure;
  const double across = -(start.sigma[0] + fluid), down = -(start.sigma[8] + fluid);
  return figure::StressPath::Circle{std::max(across, down) / kMegapascal,
                                    std::min(across, down) / kMegapascal};
}

std::string words_of_circle(double fault_biot) {
  return concat("; grey circle: rock at the start, fault_biot ", figure::plain_number(fault_biot),
                "; ");
}

/// Traction at a point, step after step.
template <typename Path>
void add_tractions(const FieldSource& file, std::size_t fault, Eigen::Index point, Path& path) {
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const StoredFields now = file.fields(fault, entry);
    path.normal.push_back(-now.traction(0, point) / kMegapascal);
    path.shear.push_back(shear_at(now, point) / kMegapascal);
  }
}

/// Before the change, at the point that is nearest to a place. @return what the remark says of it.
std::string add_original(const Chosen& chosen, const Eigen::Vector3d& place,
                         figure::StressPath& path) {
  const auto known = original_fault(chosen);
  if (!known) return words_of_original(chosen.picture, false);
  const FieldSource& file = *chosen.picture.original->fields;
  const StoredFault& fault = file.faults()[known->fault];
  const auto nearest = nearest_split(fault, place);
  if (!nearest) return words_of_original(chosen.picture, false);
  path.before = figure::StressPath::Before{};
  figure::StressPath::Before& before = *path.before;
  add_tractions(file, known->fault, *nearest, before);
  before.cohesion = known->friction.cohesion / kMegapascal;
  before.friction = std::tan(known->friction.static_friction_angle);
  const bool is_same = (fault.points.col(*nearest) - place).norm() < kSamePlace;
  return words_of_original(
      chosen.picture, true,
      is_same ? ""
              : concat("at ", figure::plain_number(-fault.points(2, *nearest), 4), " m depth"));
}

}  // namespace

using figure::plain_number;

std::string draw_stress_path(Chosen chosen) {
  const std::size_t f = stored_fault(chosen), critical = stored_entry(chosen);
  const FieldSource& file = *chosen.picture.fields;
  const StoredFault& fault = file.faults()[f];
  const auto k = static_cast<Eigen::Index>(most_critical(fault, file.critical_index(f, critical)));
  const Fault& of_scene = chosen.scene().faults[chosen.fault];
  const CoulombLaw& friction = of_scene.friction;
  figure::StressPath path;
  std::map<int, std::string> stages;
  for (const StepResult& step : chosen.result().steps) stages[step.step] = step.stage;
  add_tractions(file, f, k, path);
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const std::string stage = with_blanks(stages[file.steps()[entry]]);
    const bool is_last = entry + 1 == file.steps().size();
    const bool ends_stage = is_last || with_blanks(stages[file.steps()[entry + 1]]) != stage;
    if (entry == 0)
      path.marks.push_back({entry, "start"});
    else if (ends_stage)
      path.marks.push_back({entry, "end of " + stage});
  }
  path.title = concat("Stress path of fault ", chosen.fault_name(), " at ",
                      plain_number(-fault.points(2, k), 4), " m depth");
  path.circle = initial_circle(chosen.scene(), of_scene.fault_biot, fault.points(2, k));
  path.remark =
      concat(add_original(chosen, fault.points.col(k), path), "where χ is largest at ",
             moment_text(chosen), path.circle ? words_of_circle(of_scene.fault_biot) : "; ",
             subject_of(chosen.picture));
  path.cohesion = friction.cohesion / kMegapascal;
  path.friction = std::tan(friction.static_friction_angle);
  if (friction.dynamic_friction_angle != friction.static_friction_angle) {
    path.weakened = std::tan(friction.dynamic_friction_angle);
  }
  return figure::draw(path);
}

}  // namespace faultsim::case_figures
