#include "simulator/plan/field_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "simulator/common/dates.h"
#include "simulator/common/text.h"
#include "simulator/flow/whole_cells.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/plan/field_bodies.h"

namespace faultsim {
namespace {

constexpr double kWhole = 1 - 1e-6;
constexpr double kReferenceAgrees = 5e5;  // Pa
constexpr double kRounding = 1;           // Pa, as loading/pressure_warnings

std::string bar(double pascal) { return formatted("%.1f bar", pascal / 1e5); }

std::string percent(const RegionCoverage& part) {
  return formatted("%.4g %%", 100 * part.covered / part.volume);
}

using Extent = Eigen::AlignedBox3d;

void hold(Extent& extent, const FlowCell& cell) { extent.extend(cell.low).extend(cell.high); }

std::string text_of(const Extent& extent) {
  const auto range = [](double from, double to) {
    return concat(std::llround(from), " to ", std::llround(to), " m");
  };
  const Eigen::Vector3d &low = extent.min(), &high = extent.max();
  return concat("x ", range(low.x(), high.x()), ", y ", range(low.y(), high.y()), ", depth ",
                range(-high.z(), -low.z()));
}

Extent extent_of(const FlowField& field) {
  Extent extent;
  for (const FlowCell& cell : field.cells) hold(extent, cell);
  return extent;
}

/// The most of something over flow cells and reports, Pa.
struct Peak {
  double value = kRounding;
  double change = 0;  ///< there, Pa.
  double limit = 0;   ///< that it exceeds, Pa.
  int cell = -1, report = -1;

  void see(double other, double change_there, double limit_there, int flow_cell, int when) {
    if (!(other > value)) return;
    *this = {other, change_there, limit_there, flow_cell, when};
  }
};

/// Looks at one field.
class FieldChecker {
 public:
  FieldChecker(const Scene& scene, const Plan& plan, const FlowLoad& load, std::string key,
               FieldCheck& found)
      : scene_(scene),
        plan_(plan),
        load_(load),
        at_("/" + std::move(key)),
        found_(found),
        there_(field_in_scene(load)),
        names_(region_names(scene)) {
    bodies_ = field_bodies(scene, plan, load.y);
    if (plan.plane_strain) y_range_ = {load.y - kHalfSection, load.y + kHalfSection};
    for (const Fault& fault : scene.faults) names_.push_back(fault.name);
  }

  void check(bool is_pressure) {
    FlowOverlaps overlaps;
    try {
      overlaps = flow_overlaps(*there_, bodies_);
      mapping_ =
          map_overlaps(*there_, bodies_, overlaps, names_, {.outside = OutsideRule::unchanged});
      if (!coverage()) return;
      if (load_.integral == IntegralRule::flow_grid) integrals(std::move(overlaps));
    } catch (const InputError& error) {
      for (const Problem& one : error.problems()) problem(one.what, one.cure);
      return;
    }
    faults();
    if (!is_pressure) return;
    for (int region = 0; region < n_regions(); ++region) pressures(region);
  }

 private:
  int n_regions() const { return static_cast<int>(scene_.pressure.size()); }
  const std::string& name(int part) const { return names_[static_cast<std::size_t>(part)]; }
  const RegionCoverage& part(int number) const {
    return mapping_.coverage[static_cast<std::size_t>(number)];
  }
  void problem(const std::string& what, const std::string& cure) {
    found_.problems.push_back({at_, 0, what, cure});
  }
  void remark(const std::string& what) { found_.remarks.push_back({at_, what}); }

  Extent extent_of_region(int region) const {
    Extent extent;
    for (const MappedCell& body : bodies_) {
      if (body.region == region) hold(extent, flow_cell_around(body.corners));
    }
    return extent;
  }

  /// Whether enough is covered to go on.
  bool coverage() {
    bool is_any = false;
    for (int r = 0; r < n_regions(); ++r) is_any = is_any || part(r).covered > 0;
    if (!is_any) {
      nothing_covered();
      return false;
    }
    if (load_.integral == IntegralRule::flow_grid) say_beside();
    bool is_enough = true;
    for (int r = 0; r < n_regions(); ++r) {
      const RegionCoverage& region = part(r);
      if (region.n_cells == 0) continue;
      found_.notes.push_back(
          concat(at_.substr(1), " covers ", percent(region), " of the volume of ", name(r)));
      if (region.covered >= kWhole * region.volume) continue;
      const std::string what = concat("covers ", percent(region), " of the volume of ", name(r));
      if (load_.outside_given || region.covered >= kLeastCovered * region.volume) {
        remark(concat(what, "; the rest ",
                      load_.outside == OutsideRule::nearest ? "takes what the nearest flow cell has"
                                                            : "does not change",
                      load_.integral == IntegralRule::flow_grid
                          ? ", and the integral stays that of the flow cells"
                          : ""));
        continue;
      }
      is_enough = false;
      problem(
          concat(what, ", which lies at ", text_of(extent_of_region(r)), "; its cells at ",
                 text_of(extent_of(*there_))),
          "check the units, \"origin\" and \"azimuth\" of the field and the place of the "
          "compartment; if so little is intended, write \"outside\": \"nearest\" or \"unchanged\"");
    }
    return is_enough;
  }

  /// What a run would refuse: integrals that cannot be kept, in the cells of its mesh. Those of a
  /// field are none of its bodies; elsewhere the first bodies are.
  void integrals(FlowOverlaps overlaps) const {
    std::vector<MappedCell> cells = bodies_;
    if (scene_.geometry_kind == GeometryKind::field) {
      cells = cells_of_compartments(scene_mesh(scene_, plan_), load_.y);
      overlaps = flow_overlaps(*there_, cells);
    }
    std::erase_if(cells, [&](const MappedCell& cell) { return cell.region >= n_regions(); });
    overlaps.resize(cells.size());
    MappingRules rules{.outside = load_.outside, .integral = load_.integral, .y_range = y_range_};
    if (plan_.half_domain) rules.y_range[0] = 0;
    const std::vector<std::string> regions = region_names(scene_);
    const FlowMapping mapping = map_overlaps(*there_, cells, std::move(overlaps), regions, rules);
    Eigen::MatrixXd change = mapped_change(mapping, *there_, load_.reference, load_.reports);
    keep_integrals(mapping, *there_, load_.reference, load_.reports, regions, change);
  }

  /// How much of the flow grid counts with compartments that it does not lie in.
  void say_beside() {
    double flow = 0, within = 0;
    for (const FlowCell& cell : there_->cells) flow += volume_between(cell, y_range_);
    for (int r = 0; r < n_regions(); ++r) within += part(r).covered;
    found_.notes.push_back(concat(
        at_.substr(1), formatted(": %.4g %% of the volume of its cells", 100 * within / flow),
        " lies in compartments, the others count with the nearest one (\"integral\")"));
  }

  void nothing_covered() {
    const Extent own = extent_of(*load_.field);
    const Eigen::Vector3d middle = own.center();
    problem(
        concat("no flow cell lies in a compartment: its cells lie at ", text_of(extent_of(*there_)),
               " of the scene, ", name(0), " at ", text_of(extent_of_region(0))),
        concat("say where the scene's x = y = 0 lies in the coordinates of the field, \"origin\": "
               "[\"x m\", \"y m\"], and \"azimuth\" (the middle of the field is ",
               std::llround(middle.x()), " m, ", std::llround(middle.y()),
               " m), and check its units"));
  }

  void faults() {
    for (int f = 0; f < static_cast<int>(scene_.faults.size()); ++f) {
      const RegionCoverage& beside = part(n_regions() + f);
      if (beside.n_cells == 0 || beside.covered >= kLeastCovered * beside.volume) continue;
      const bool is_box = scene_.geometry_kind == GeometryKind::box;
      const std::string there =
          is_box ? "in the cells beside it" : concat("within ", kBesideFault, " m of it");
      remark(concat("hardly reaches fault ", name(n_regions() + f), ": ", percent(beside),
                    " of the reservoir ", there, " is covered"));
    }
  }

  /// Middle of the part of a flow cell that lies at a region's depths, m.
  double depth_in(int flow_cell, const Extent& region) const {
    const FlowCell& cell = there_->cells[static_cast<std::size_t>(flow_cell)];
    return -0.5 *
           (std::max(cell.low.z(), region.min().z()) + std::min(cell.high.z(), region.max().z()));
  }

  std::string place_of(const Peak& peak, const Extent& region) const {
    const FlowCell& cell = there_->cells[static_cast<std::size_t>(peak.cell)];
    const Eigen::Vector3d middle = 0.5 * (cell.low + cell.high);
    return concat("at x ", std::llround(middle.x()), " m, y ", std::llround(middle.y()),
                  " m, depth ", std::llround(depth_in(peak.cell, region)), " m on ",
                  date_text(load_.field->date[static_cast<std::size_t>(peak.report)]));
  }

  /// The initial pressure plus the change since the reference, in the flow cells of a region.
  void pressures(int region) {
    const Extent extent = extent_of_region(region);
    const Eigen::MatrixXd& value = load_.field->value;
    Peak rise, fracture, below_zero;
    double excess = 0, weight = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].region != region || mapping_.weights[b].empty()) continue;
      const double share =
          bodies_[b].fraction * mapping_.covered[b] * cell_volume(bodies_[b].corners);
      weight += share;
      for (const FlowMapping::Weight& one : mapping_.weights[b]) {
        const int f = one.flow_cell;
        const double depth = depth_in(f, extent), reference = value(f, load_.reference);
        const double initial =
            initial_region_pressure(scene_, static_cast<std::size_t>(region), depth);
        excess += share * one.value * (reference - initial);
        const double largest = largest_change(f);
        const double least = largest > kRounding ? least_stress(scene_, depth) : HUGE_VAL;
        for (const int t : load_.reports) {
          const double change = value(f, t) - reference;
          rise.see(change, change, initial, f, t);
          fracture.see(initial + change - least, change, least, f, t);
          below_zero.see(-(initial + change), change, initial, f, t);
        }
      }
    }
    say_pressures(name(region), extent, rise, fracture, below_zero);
    if (weight > 0) say_reference(name(region), excess / weight);
  }

  double largest_change(int flow_cell) const {
    double largest = 0;
    for (const int t : load_.reports)
      largest = std::max(largest, load_.field->value(flow_cell, t) -
                                      load_.field->value(flow_cell, load_.reference));
    return largest;
  }

  void say_pressures(const std::string& region, const Extent& extent, const Peak& rise,
                     const Peak& fracture, const Peak& below_zero) {
    if (rise.cell >= 0) {
      remark(concat("rises to ", bar(rise.change), " above the initial pressure of ", region, " ",
                    place_of(rise, extent)));
    }
    if (fracture.cell >= 0) {
      remark(concat("reaches ", bar(fracture.limit + fracture.value), " in ", region, " ",
                    place_of(fracture, extent), ", above the least total principal stress of ",
                    bar(fracture.limit),
                    " there before production: rock would fracture, which is not modelled"));
    }
    if (below_zero.cell >= 0) {
      remark(concat("falls by ", bar(-below_zero.change), " in ", region, " ",
                    place_of(below_zero, extent), ", more than the initial pressure of ",
                    bar(below_zero.limit), " there: a pressure below zero"));
    }
  }

  /// Where the pressures of the reference report are not those that the initial state has.
  void say_reference(const std::string& region, double excess) {
    if (std::abs(excess) <= kReferenceAgrees) return;
    remark(concat("begins ", std::lround(std::abs(excess) / 1e5), " bar ",
                  excess > 0 ? "above" : "below", " the initial pressure of ", region,
                  " (mean over its volume): the change since its reference acts on the scene's "
                  "initial state; give the initial state the same pressure, as overpressure of the "
                  "block"));
  }

  const Scene& scene_;
  const Plan& plan_;
  const FlowLoad& load_;
  std::string at_;
  FieldCheck& found_;
  std::shared_ptr<const FlowField> there_;
  std::vector<MappedCell> bodies_;
  std::array<double, 2> y_range_ = MappingRules{}.y_range;  ///< what of the flow cells is there, m.
  std::vector<std::string> names_;                          ///< of their regions.
  FlowMapping mapping_;
};

}  // namespace

FieldCheck check_fields(const Scene& scene, const Plan& plan) {
  FieldCheck found;
  if (scene.pressure_field.is_given())
    FieldChecker(scene, plan, scene.pressure_field, "pressure_field", found).check(true);
  if (scene.temperature_field.is_given())
    FieldChecker(scene, plan, scene.temperature_field, "temperature_field", found).check(false);
  return found;
}

}  // namespace faultsim
