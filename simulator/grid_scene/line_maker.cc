#include "simulator/grid_scene/line_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/fault_dips.h"
#include "simulator/grid_scene/line_check.h"
#include "simulator/grid_scene/mesh_size.h"
#include "simulator/grid_scene/outline.h"
#include "simulator/grid_scene/trace_ends.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::ColumnMap;
using corner_point::CornerPointGrid;
using corner_point::EndKind;
using corner_point::Fault;
using corner_point::FaultEnd;
using corner_point::GridStructure;
using corner_point::line_length;
using corner_point::nearest_on_line;
using corner_point::RemarkKind;
using Eigen::Vector2d;

std::string metres(double value) { return formatted("%.0f m", value); }

/// How far dips of a fault reach along it: over so many cells of the grid; 0: it has one.
constexpr std::array<double, 4> kDipReaches = {2, 4, 8, 0};

/// A place of a closed line, on one of its pieces.
struct RingPlace {
  std::size_t piece;
  Vector2d at;
};

/// A closed line from one of its places on to another, which may lie on the same piece.
Polyline stretch_of(const Polyline& ring, const RingPlace& from, const RingPlace& to) {
  const std::size_t n = ring.size() - 1;
  const Vector2d& corner = ring[from.piece];
  const bool is_ahead =
      from.piece == to.piece && (to.at - corner).norm() > (from.at - corner).norm();
  Polyline line = {from.at};
  if (!is_ahead) {
    std::size_t p = from.piece;
    do {
      line.push_back(ring[p + 1]);
      p = (p + 1) % n;
    } while (p != to.piece);
  }
  line.push_back(to.at);
  return line;
}

class LineMaker {
 public:
  LineMaker(const CornerPointGrid& grid, const GridStructure& structure, const LineOptions& options,
            Remarks& remarks)
      : grid_(grid),
        structure_(structure),
        options_(options),
        remarks_(remarks),
        map_(grid),
        cell_(median_cell(map_)),
        reach_(structure.faults.size(), 0) {
    for (const Fault& fault : structure.faults)
      pillars_.push_back(fault_pillars(map_, fault, structure.reference_z));
  }

  ModelLines make() {
    lines_.reference_z = structure_.reference_z;
    lines_.outlines = active_outlines(map_, outline_cell(map_), lines_.reference_z, remarks_);
    if (lines_.outlines.empty())
      throw InputError("the flow grid", "its active map is nowhere two columns wide",
                       "give the grid of the field, not that of a section");
    take_box();
    lines_.strike = chosen_strike(structure_, lines_, cell_, options_, remarks_);
    std::string trouble = fit(Blame::of_all);
    if (!trouble.empty()) {
      for (Polyline& outline : lines_.outlines) outline = hull_of(outline);
      remarks_.push_back({RemarkKind::choice,
                          "the outline of the active map is its convex hull: the nearer one did "
                          "not fit with the faults (" +
                              trouble + ")",
                          ""});
      trouble = fit(Blame::of_the_first);
    }
    if (!trouble.empty())
      remarks_.push_back({RemarkKind::warning, "lines do not fit together yet: " + trouble, ""});
    say_dips();
    say_left_out();
    return std::move(lines_);
  }

 private:
  void take_box();
  std::string fit(Blame blame);
  bool smooth_dips(int source);
  double dip_reach(int source) const {
    return kDipReaches[reach_[source]] * structure_.faults[source].cell;
  }
  void say_dips();
  void draw_faults();
  ModelFault drawn(int source) const;
  void draw_depths(const Fault& fault, ModelFault& drawn) const;
  void open_v_ends();
  void draw_ends(std::size_t f);
  void draw_end(std::size_t f, bool is_last);
  std::optional<Polyline> beyond_edge(const Polyline& trace, const FaultEnd& end) const;
  Polyline at_tip(const Polyline& trace, std::size_t f, LineEnd& kind) const;
  bool is_clear(const Vector2d& from, const Vector2d& to, std::size_t except) const;
  void draw_dividers();
  std::array<RingPlace, 2> places_to_part(const Polyline& ring) const;
  double distance_to_drawn(const Vector2d& at) const;
  void draw_extension(const ModelFault& fault, bool is_last);
  int model_of(int source) const;
  void leave_out(int source, const std::string& why) { left_out_.emplace_back(source, why); }
  void say_left_out();
  bool is_left_out(int source) const {
    return contains(left_out_, source, &std::pair<int, std::string>::first);
  }

  const CornerPointGrid& grid_;
  const GridStructure& structure_;
  const LineOptions& options_;
  Remarks& remarks_;
  ColumnMap map_;
  double cell_;
  ModelLines lines_;
  std::vector<std::vector<FaultPillar>> pillars_;  ///< per fault of the structure.
  std::vector<std::size_t> reach_;                 ///< per fault of the structure: of kDipReaches.
  std::vector<std::pair<int, std::string>> left_out_;  ///< faults of the structure, and why.
};

void LineMaker::take_box() {
  double lowest = 0;
  Vector2d low = Vector2d::Constant(1e300), high = -low;
  for (int column = 0; column < grid_.n_columns(); ++column) {
    if (!map_.is_inside(column)) continue;
    for (const bool right : {false, true}) {
      for (const bool back : {false, true}) {
        const Eigen::Vector3d at =
            grid_.corner(column, map_.base_layer(column), {right, back, true});
        lowest = std::min(lowest, at.z());
        low = low.cwiseMin(at.head<2>());
        high = high.cwiseMax(at.head<2>());
      }
    }
  }
  constexpr double kLeastMargin = 5000, kRound = 500;
  const double margin = options_.margin > 0 ? options_.margin : std::max(kLeastMargin, -2 * lowest);
  for (int axis = 0; axis < 2; ++axis) {
    lines_.low[axis] = kRound * std::floor((low[axis] - margin) / kRound);
    lines_.high[axis] = kRound * std::ceil((high[axis] + margin) / kRound);
  }
  lines_.base =
      options_.base_depth > 0 ? -options_.base_depth : kRound * std::floor(2 * lowest / kRound);
  remarks_.push_back({RemarkKind::choice,
                      "the model ends " + metres(margin) + " or more beside the active map and " +
                          metres(-lines_.base) + " deep, with rollers",
                      "--margin, --base"});
}

/// Draws all lines; what does not fit with others is left out, one fault after the other.
/// @returns "" or what is still wrong.
std::string LineMaker::fit(Blame blame) {
  const std::size_t n_rounds = structure_.faults.size() * (kDipReaches.size() + 1);
  for (std::size_t round = 0; round <= n_rounds; ++round) {
    draw_faults();
    draw_dividers();
    const std::optional<Misfit> misfit = first_misfit(lines_, blame);
    if (!misfit) return "";
    if (misfit->fault < 0) return misfit->what;
    if (misfit->is_in_depth && smooth_dips(lines_.faults[misfit->fault].source)) continue;
    leave_out(lines_.faults[misfit->fault].source, misfit->what);
  }
  return "faults do not fit together";
}

/// Lets a fault that does not fit in depth dip more evenly, and all faults have one dip before it
/// is left out. @returns false where they have.
bool LineMaker::smooth_dips(int source) {
  constexpr std::size_t kLast = kDipReaches.size() - 1;
  if (reach_[source] < kLast) {
    ++reach_[source];
    return true;
  }
  const bool can = std::ranges::any_of(
      lines_.faults, [&](const ModelFault& fault) { return reach_[fault.source] < kLast; });
  std::ranges::fill(reach_, kLast);
  return can;
}

void LineMaker::draw_faults() {
  lines_.faults.clear();
  for (int f = 0; f < static_cast<int>(structure_.faults.size()); ++f) {
    if (is_left_out(f)) continue;
    if (structure_.faults[f].begin.kind == EndKind::closed) {
      leave_out(f, "it runs back into itself");
      continue;
    }
    lines_.faults.push_back(drawn(f));
  }
  open_v_ends();
  for (std::size_t f = 0; f < lines_.faults.size(); ++f) draw_ends(f);
  for (ModelFault& fault : lines_.faults)
    take_dips(pillars_[fault.source], dip_reach(fault.source), lines_.reference_z, fault);
}

ModelFault LineMaker::drawn(int source) const {
  const Fault& fault = structure_.faults[source];
  ModelFault drawn{.name = concat("F", source + 1), .source = source, .trace = fault.trace};
  draw_depths(fault, drawn);
  return drawn;
}

void LineMaker::draw_depths(const Fault& fault, ModelFault& drawn) const {
  drawn.top = -1e300;
  drawn.bottom = 1e300;
  for (const corner_point::FaultEdge& edge : fault.edges) {
    for (const int column : {edge.left, edge.right}) {
      for (const int pillar : {edge.from, edge.to}) {
        corner_point::CornerPlace corner = map_.corner_at(column, pillar);
        drawn.top = std::max(drawn.top, grid_.z(column, map_.top_layer(column), corner));
        corner.bottom = true;
        drawn.bottom = std::min(drawn.bottom, grid_.z(column, map_.base_layer(column), corner));
      }
    }
  }
  drawn.top = std::min(drawn.top + options_.overshoot, -lines_.strike);
  drawn.bottom = std::max(drawn.bottom - options_.overshoot, lines_.base + lines_.strike);
}

int LineMaker::model_of(int source) const {
  for (std::size_t f = 0; f < lines_.faults.size(); ++f) {
    if (lines_.faults[f].source == source) return static_cast<int>(f);
  }
  return -1;
}

/// Two faults that end at each other: the first goes on, the other ends at it.
void LineMaker::open_v_ends() {
  for (ModelFault& fault : lines_.faults) {
    const Fault& source = structure_.faults[fault.source];
    for (const bool is_last : {false, true}) {
      const FaultEnd& end = is_last ? source.end : source.begin;
      const int other = end.kind == EndKind::junction ? model_of(end.other) : -1;
      if (other < 0 || lines_.faults[other].source > fault.source) continue;
      const Vector2d at = is_last ? fault.trace.back() : fault.trace.front();
      Polyline& through = lines_.faults[other].trace;
      for (const bool at_last : {false, true}) {
        const Vector2d& tip = at_last ? through.back() : through.front();
        if ((tip - at).norm() > 2 * lines_.strike) continue;
        if (!at_last) std::ranges::reverse(through);
        through = prolonged(through, 3 * lines_.strike);
        if (!at_last) std::ranges::reverse(through);
      }
    }
  }
}

void LineMaker::draw_ends(std::size_t f) {
  for (const bool is_last : {false, true}) draw_end(f, is_last);
}

void LineMaker::draw_end(std::size_t f, bool is_last) {
  ModelFault& fault = lines_.faults[f];
  const Fault& source = structure_.faults[fault.source];
  const FaultEnd& end = is_last ? source.end : source.begin;
  LineEnd& kind = is_last ? fault.last_end : fault.first_end;
  if (!is_last) std::ranges::reverse(fault.trace);
  const int other = end.kind == EndKind::junction ? model_of(end.other) : -1;
  kind = LineEnd::rock;
  const bool is_led =
      other >= 0 &&
      (lines_.faults[other].source < fault.source ||
       nearest_on_line(lines_.faults[other].trace, fault.trace.back()).distance < lines_.strike);
  if (is_led) {
    const Polyline& at = lines_.faults[other].trace;
    fault.trace = led_to(fault.trace, at, cell_);
    // What is still apart would be refused.
    const bool is_there = nearest_on_line(at, fault.trace.back()).distance <= lines_.strike;
    kind = is_there ? LineEnd::fault : LineEnd::rock;
    if (!is_there) fault.trace = at_tip(fault.trace, f, kind);
  } else if (end.kind == EndKind::grid_edge) {
    const std::optional<Polyline> beyond = beyond_edge(fault.trace, end);
    fault.trace = beyond ? *beyond : at_tip(fault.trace, f, kind);
  } else {
    fault.trace = at_tip(fault.trace, f, kind);
  }
  if (!is_last) std::ranges::reverse(fault.trace);
}

/// A trace that ends outside of an outline that is near. None is where the outline takes in a small
/// hole: the fault has a tip there, however near the edge of the map.
std::optional<Polyline> LineMaker::beyond_edge(const Polyline& trace, const FaultEnd& end) const {
  constexpr double kNear = 2;  // cells
  constexpr double kFlat = 4;  // m beyond the edge for each m of throw: the horizons close there
  const double beyond = std::max(options_.least_edge_run * cell_, kFlat * std::abs(end.offset));
  const bool is_outside = !is_within(lines_.outlines, trace.back());
  std::optional<Polyline> best;
  for (const Polyline& outline : lines_.outlines) {
    const Polyline ring = closed(outline);
    if (!is_outside && nearest_on_line(ring, trace.back()).distance > kNear * cell_) continue;
    const auto led = led_across(trace, ring, cell_, beyond);
    if (led && (!best || line_length(*led) < line_length(*best))) best = led;
  }
  return best;
}

/// Whether a stretch keeps a cell of the mesh and a half from all other lines.
bool LineMaker::is_clear(const Vector2d& from, const Vector2d& to, std::size_t except) const {
  const double least = 1.5 * lines_.strike;
  const auto keeps_away = [&](const Polyline& line) {
    if (crossing_beyond({from, to}, line, 0)) return false;
    for (const Vector2d& end : {from, to, Vector2d((from + to) / 2)}) {
      if (nearest_on_line(line, end).distance < least) return false;
    }
    return true;
  };
  for (std::size_t f = 0; f < lines_.faults.size(); ++f) {
    if (f != except && !keeps_away(lines_.faults[f].trace)) return false;
  }
  return std::ranges::all_of(lines_.outlines,
                             [&](const Polyline& line) { return keeps_away(closed(line)); });
}

/// A trace that goes on at its tip, as far as there is room; where there is none it is cut back.
Polyline LineMaker::at_tip(const Polyline& trace, std::size_t f, LineEnd& kind) const {
  const double length = line_length(trace);
  for (const double share : {1.0, 0.5, 0.25, 0.0}) {
    const Polyline longer = prolonged(trace, share * options_.tip_reach * cell_);
    if (is_clear(trace.back(), longer.back(), f)) return longer;
  }
  for (const double back : {0.5, 1.0, 2.0, 3.0}) {
    if (back * cell_ > 0.5 * length) break;
    const Polyline shorter = cut_at(trace, length - back * cell_);
    if (is_clear(shorter.back(), shorter.back(), f)) return shorter;
  }
  for (std::size_t g = 0; g < f; ++g) {
    const auto nearest = nearest_on_line(lines_.faults[g].trace, trace.back());
    if (nearest.distance > cell_) continue;
    kind = LineEnd::fault;
    Polyline on = cut_at(trace, std::max(0.5 * length, length - cell_));
    on.push_back(nearest_on_line(lines_.faults[g].trace, on.back()).point);
    return on;
  }
  return trace;
}

/// Two lines around each part of the active map, parted far from faults and other lines, and those
/// that go on from tips.
void LineMaker::draw_dividers() {
  lines_.dividers.clear();
  for (const ModelFault& fault : lines_.faults) {
    for (const bool is_last : {false, true}) draw_extension(fault, is_last);
  }
  for (std::size_t k = 0; k < lines_.outlines.size(); ++k) {
    const Polyline ring = closed(lines_.outlines[k]);
    const auto [one, two] = places_to_part(ring);
    lines_.dividers.push_back({concat("outline", 2 * k + 1), stretch_of(ring, one, two)});
    lines_.dividers.push_back({concat("outline", 2 * k + 2), stretch_of(ring, two, one)});
  }
}

/// Two places of a ring, far from all lines so far, from its corners and from each other. Straight
/// sides have several to choose from, a cell apart: faults often meet them at their middles.
std::array<RingPlace, 2> LineMaker::places_to_part(const Polyline& ring) const {
  std::vector<RingPlace> places;
  std::vector<double> room;  // m
  for (std::size_t p = 0; p + 1 < ring.size(); ++p) {
    const double length = (ring[p + 1] - ring[p]).norm();
    const auto n = static_cast<std::size_t>(std::max(1.0, std::floor(length / cell_)));
    for (std::size_t k = 0; k < n; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
      const Vector2d at = ring[p] + share * (ring[p + 1] - ring[p]);
      places.push_back({p, at});
      room.push_back(std::min(distance_to_drawn(at), 2 * std::min(share, 1 - share) * length));
    }
  }
  const auto roomiest = [&](const RingPlace* from) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double here =
          from == nullptr ? room[k] : std::min(room[k], (places[k].at - from->at).norm());
      if (here <= most) continue;
      most = here;
      best = k;
    }
    return places[best];
  };
  const RingPlace one = roomiest(nullptr);
  return {one, roomiest(&one)};
}

/// m, to faults and to dividers drawn so far.
double LineMaker::distance_to_drawn(const Vector2d& at) const {
  double least = 1e300;
  for (const ModelFault& fault : lines_.faults)
    least = std::min(least, nearest_on_line(fault.trace, at).distance);
  for (const ModelDivider& divider : lines_.dividers)
    least = std::min(least, nearest_on_line(divider.line, at).distance);
  return least;
}

/// The straight line on from a tip that was prolonged (StructureOptions::extend_faults).
void LineMaker::draw_extension(const ModelFault& fault, bool is_last) {
  const Fault& source = structure_.faults[fault.source];
  const FaultEnd& end = is_last ? source.end : source.begin;
  if (end.n_extension == 0 || (is_last ? fault.last_end : fault.first_end) != LineEnd::rock) return;
  const std::size_t n_first = is_last ? static_cast<std::size_t>(source.begin.n_extension) : 0;
  const auto n = static_cast<std::size_t>(end.n_extension);
  const corner_point::FaultEdge& last = source.extension[n_first + n - 1];
  const Vector2d to = grid_.pillars[last.to].at(lines_.reference_z);
  const Vector2d tip = is_last ? fault.trace.back() : fault.trace.front();
  if ((to - tip).norm() < 2 * lines_.strike) return;
  Polyline line = {tip, to};
  std::optional<Polyline> best;
  const auto try_line = [&](const Polyline& other) {
    const auto led = led_across(line, other, cell_, 0);
    if (led && led->size() >= 2 && (!best || line_length(*led) < line_length(*best))) best = led;
  };
  for (const Polyline& outline : lines_.outlines) try_line(closed(outline));
  for (const ModelFault& other : lines_.faults) {
    if (other.source != fault.source && nearest_on_line(other.trace, to).distance < cell_)
      try_line(other.trace);
  }
  if (best) lines_.dividers.push_back({"on_from_" + fault.name, *best});
}

void LineMaker::say_dips() {
  for (const ModelFault& fault : lines_.faults) {
    remarks_.push_back(
        {RemarkKind::choice,
         dips_text(pillars_[fault.source], fault, dip_reach(fault.source), lines_.reference_z),
         "/faults, \"dip_from_vertical\""});
  }
}

void LineMaker::say_left_out() {
  for (const auto& [source, why] : left_out_) {
    remarks_.push_back({RemarkKind::left_out,
                        concat("fault ", source + 1, " is not in the model: ", why),
                        "--least-offset, --strike"});
  }
}

}  // namespace

ModelLines model_lines(const CornerPointGrid& grid, const GridStructure& structure,
                       const LineOptions& options, Remarks& remarks) {
  return LineMaker(grid, structure, options, remarks).make();
}

}  // namespace faultsim::grid_scene
