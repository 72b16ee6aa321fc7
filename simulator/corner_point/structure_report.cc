#include "simulator/corner_point/structure_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsim::corner_point {
namespace {

std::string metres(double value) { return formatted("%.6g m", value); }
std::string degrees(double angle) { return formatted("%.0f", angle * 180 / std::numbers::pi); }

/// From 0 in the code, from 1 for people.
std::string name_of(int fault) { return concat("fault ", fault + 1); }

class ReportWriter {
 public:
  ReportWriter(const CornerPointGrid& grid, const GridStructure& found,
               const StructureOptions& options)
      : grid_(grid), found_(found), options_(options) {}

  std::vector<StructureRemark> write() {
    for (const std::string& remark : grid_.remarks) add(RemarkKind::choice, remark);
    say_cells();
    say_faults();
    say_junctions();
    say_compartments();
    say_left_out();
    say_connections();
    say_choices();
    return std::move(remarks_);
  }

 private:
  void add(RemarkKind kind, const std::string& text, const std::string& option = "") {
    remarks_.push_back({kind, text, option});
  }

  void say_cells() {
    add(RemarkKind::recognised,
        concat(grid_.size[0], " x ", grid_.size[1], " x ", grid_.size[2], " cells, ",
               found_.n_active_cells, " active, in ", found_.n_active_columns, " columns; ",
               counted(found_.horizons.size(), "horizon", "horizons")));
    int n_inactive = 0;
    for (const Layer& layer : found_.layers) n_inactive += layer.n_inactive;
    if (n_inactive > 0)
      add(RemarkKind::left_out,
          counted(n_inactive, "inactive cell", "inactive cells") +
              " in active columns: in no compartment; horizons run through them");
    if (found_.n_hole_columns > 0)
      add(RemarkKind::choice,
          counted(found_.n_hole_columns, "inactive column", "inactive columns") +
              " enclosed by active ones: faults and horizons run through them");
    if (found_.n_collapsed_cells > 0) say_collapsed();
    if (found_.largest_gap > options_.no_thickness)
      add(RemarkKind::warning,
          "layers do not touch: gaps of up to " + metres(found_.largest_gap) +
              "; both surfaces of each gap are horizons",
          "no_thickness");
  }

  void say_collapsed() {
    std::vector<std::string> partly, wholly;
    for (std::size_t k = 0; k < found_.layers.size(); ++k) {
      if (found_.layers[k].is_collapsed) {
        wholly.push_back(concat(k + 1));
      } else if (found_.layers[k].n_collapsed > 0) {
        partly.push_back(concat(k + 1, " (", found_.layers[k].n_collapsed, ")"));
      }
    }
    std::string text =
        counted(found_.n_collapsed_cells, "cell has", "cells have") + " no thickness";
    if (!wholly.empty()) text += "; wholly collapsed layers: " + joined(wholly, ", ");
    if (!partly.empty()) text += "; layers with collapsed cells: " + joined(partly, ", ");
    add(RemarkKind::recognised, text, "no_thickness");
  }

  std::string end_text(const FaultEnd& end) const {
    switch (end.kind) {
      case EndKind::closed:
        return "it runs back into itself";
      case EndKind::grid_edge:
        return "at the edge of the grid with an offset of " + metres(std::abs(end.offset));
      case EndKind::junction:
        return "at " + name_of(end.other);
      case EndKind::tip:
        break;
    }
    return std::string("in the grid, ") + (end.tapers ? "tapered to " : "abruptly at ") +
           metres(std::abs(end.offset));
  }

  void say_faults() {
    if (found_.faults.empty())
      add(RemarkKind::recognised, "no fault of " + metres(options_.least_offset) + " or more",
          "least_offset");
    for (std::size_t f = 0; f < found_.faults.size(); ++f) {
      const Fault& fault = found_.faults[f];
      add(RemarkKind::recognised,
          concat(name_of(static_cast<int>(f)), ": ", fault.edges.size(), " pillar edges, ",
                 metres(std::round(fault.length)), " long, straight to ",
                 metres(std::round(fault.largest_distance)), " with ",
                 counted(fault.trace.size() - 1, "piece", "pieces"), ", largest offset ",
                 metres(fault.largest_offset), ", ", side_text(fault), "; dips ",
                 degrees(fault.dip.median), " degrees (", degrees(fault.dip.least), " to ",
                 degrees(fault.dip.most), ")", direction_text(fault), "; ends: ",
                 fault.begin.kind == EndKind::closed
                     ? end_text(fault.begin)
                     : end_text(fault.begin) + "; " + end_text(fault.end)),
          "least_offset");
    }
    say_tips();
    if (found_.n_bridged > 0) {
      add(RemarkKind::choice,
          counted(found_.n_bridged, "pillar edge", "pillar edges") +
              " of smaller offsets between the tips of chains join them",
          "bridge_gaps");
    }
  }

  static std::string side_text(const Fault& fault) {
    if (fault.down == Side::both) return "the lower side changes along it";
    return fault.down == Side::left ? "left is lower" : "right is lower";
  }

  static std::string direction_text(const Fault& fault) {
    if (fault.dips_towards == Side::neither) return "";
    const std::string kind = fault.down == Side::both ? ""
                             : fault.is_normal()      ? ", a normal fault"
                                                      : ", a reverse fault";
    return " towards " + degrees(fault.dip_direction) + kind;
  }

  void say_tips() {
    for (std::size_t f = 0; f < found_.faults.size(); ++f) {
      for (const FaultEnd* end : {&found_.faults[f].begin, &found_.faults[f].end}) {
        if (end->kind != EndKind::tip) continue;
        const std::string name = name_of(static_cast<int>(f));
        if (end->n_extension > 0) {
          add(RemarkKind::choice,
              concat(name, " ends in the grid and was extended by ", end->n_extension,
                     " pillar edges, so that it separates compartments"),
              "extend_faults");
        } else if (options_.extend_faults) {
          add(RemarkKind::warning, name + " ends in the grid and could not be extended");
        } else {
          add(RemarkKind::warning,
              name + " ends in the grid: it does not separate compartments there", "extend_faults");
        }
      }
    }
  }

  void say_junctions() {
    for (const Junction& junction : found_.junctions) {
      add(RemarkKind::recognised,
          concat(name_of(junction.fault), junction.crosses ? " crosses " : " ends at ",
                 name_of(junction.other), " at x = ", metres(std::round(junction.position.x())),
                 ", y = ", metres(std::round(junction.position.y()))),
          "fewest_edges");
    }
  }

  void say_compartments() {
    const std::string rule = options_.compartments == CompartmentRule::faults ? "bounded by faults"
                             : options_.compartments == CompartmentRule::equilibrium_regions
                                 ? "by EQLNUM"
                                 : "by FIPNUM";
    add(RemarkKind::recognised,
        counted(found_.compartments.size(), "compartment ", "compartments ") + rule,
        "compartments");
  }

  void say_left_out() {
    constexpr std::size_t kMost = 20;
    const std::size_t n = found_.left_out.size();
    for (std::size_t c = 0; c < std::min(n, kMost); ++c) {
      const LeftOut& left = found_.left_out[c];
      add(RemarkKind::left_out, left_out_text(left),
          left.reason == LeftOutReason::small_offset ? "least_offset" : "fewest_edges");
    }
    if (n > kMost)
      add(RemarkKind::left_out, concat(n - kMost, " more sets of pillar edges of smaller offsets"),
          "least_offset");
  }

  std::string left_out_text(const LeftOut& left) const {
    const std::string edges = counted(left.n_edges, "pillar edge", "pillar edges");
    const std::string place = concat(" between x = ", metres(std::round(left.low.x())),
                                     ", y = ", metres(std::round(left.low.y())),
                                     " and x = ", metres(std::round(left.high.x())),
                                     ", y = ", metres(std::round(left.high.y())));
    const std::string offset = ", largest offset " + metres(left.largest_offset);
    const std::string continues =
        left.continues < 0 ? "" : ": the fading end of " + name_of(left.continues);
    switch (left.reason) {
      case LeftOutReason::short_chain:
        return concat("a chain of ", edges, ", fewer than ", options_.fewest_edges, place, offset,
                      continues);
      case LeftOutReason::in_junction:
        return edges + " between faults that meet" + place + offset;
      case LeftOutReason::small_offset:
        break;
    }
    return edges + " of less than " + metres(options_.least_offset) + place + offset + continues;
  }

  void say_connections() {
    if (found_.n_connections == 0) return;
    add(RemarkKind::recognised,
        concat(counted(found_.n_connections, "connection", "connections"),
               " between cells that are not neighbours, ", found_.n_connections_on_faults,
               " of them across the faults"),
        "faults_by_connections");
  }

  void say_choices() {
    add(RemarkKind::choice,
        "offsets of " + metres(options_.least_offset) + " and more make a fault", "least_offset");
    add(RemarkKind::choice, "offsets below " + metres(options_.negligible_offset) + " are noise",
        "negligible_offset");
    add(RemarkKind::choice,
        concat("chains of ", options_.fewest_edges, " pillar edges and more make a fault"),
        "fewest_edges");
    add(RemarkKind::choice,
        concat("traces are straightened to within ", options_.straightening, " of a cell"),
        "straightening");
    add(RemarkKind::choice, "traces are those at z = " + metres(std::round(found_.reference_z)),
        "reference_z");
  }

  const CornerPointGrid& grid_;
  const GridStructure& found_;
  const StructureOptions& options_;
  std::vector<StructureRemark> remarks_;
};

}  // namespace

std::vector<StructureRemark> structure_report(const CornerPointGrid& grid,
                                              const GridStructure& structure,
                                              const StructureOptions& options) {
  return ReportWriter(grid, structure, options).write();
}

}  // namespace faultsim::corner_point
