#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "simulator/corner_point/corner_point_grid.h"

/// What a corner-point grid says of the rock: horizons, faults, compartments. All lengths in m, on
/// the map of the grid, z up (negative below the datum), angles in rad.
///
/// The grid is seen as a map of columns. A column is active if one of its cells is; a pillar edge
/// is the piece between two pillars that two columns share. Where both are active and their
/// corners do not meet on the shared pillars, there is a fault: pillar edges of enough offset are
/// joined to chains, and each chain that is long enough is a fault. Left and right are those of
/// someone who looks along the fault from its first pillar to its last.
namespace faultsim::corner_point {

enum class CompartmentRule {
  faults,               ///< the parts of the active map that faults separate.
  equilibrium_regions,  ///< cells of one EQLNUM.
  fluid_regions,        ///< cells of one FIPNUM.
};

struct StructureOptions {
  double least_offset = 6.096;  ///< m (20 ft): a pillar edge of less is no fault. Too small: noise
                                ///< of the geological model becomes faults; too large: tips are
                                ///< cut off, small faults missed.
  double negligible_offset = 0.1;      ///< m: less is not even reported as left out.
  bool faults_by_connections = false;  ///< an edge that connections between cells which are no
                                       ///< neighbours cross is one of a fault at any offset above
                                       ///< the negligible one.
  bool bridge_gaps = true;     ///< edges of less than least_offset that lead from the tip of one
                               ///< chain to that of another join them: a fault whose offset
                               ///< changes its direction along it (a hinge).
  int fewest_edges = 3;        ///< a chain of fewer pillar edges is left out.
  double straightening = 0.5;  ///< in cells (Fault::cell): how far the middles
                               ///< of pillar edges may lie from the straightened trace.
  std::optional<double> reference_z = {};  ///< m, of all traces; none: the mean height of the
                                           ///< reservoir's top beside the faults.
  bool extend_faults = false;  ///< a fault that ends in the grid is prolonged, in its direction, to
                               ///< the grid's edge or another fault, and then separates.
  CompartmentRule compartments = CompartmentRule::faults;
  double no_thickness = 0.01;  ///< m: a cell that is thinner at all its corners has collapsed.
};

/// A piece of a fault between two pillars.
struct FaultEdge {
  int from = -1, to = -1;     ///< pillars, in the fault's direction.
  int left = -1, right = -1;  ///< columns.
  /// z of left − right, m, > 0: right is lower; mean over tops and bottoms of the layers that are
  /// active on both sides (of all layers where there is none), at either pillar.
  double offset_from = 0, offset_to = 0;
  double least = 0, most = 0;  ///< of all these, m: layers whose offsets differ.

  /// The largest amount, m ≥ 0: what is compared with StructureOptions::least_offset.
  double largest() const { return std::max(std::abs(least), std::abs(most)); }
};

/// Of values along a fault: the middle one, least and most.
struct Spread {
  double median = 0, least = 0, most = 0;
};

enum class EndKind {
  tip,        ///< in the grid.
  grid_edge,  ///< at the edge of the active map.
  junction,   ///< at another fault.
  closed,     ///< the fault runs back to where it begins.
};

struct FaultEnd {
  EndKind kind = EndKind::tip;
  int pillar = -1;
  int other = -1;       ///< of a junction: the fault that it ends at.
  double offset = 0;    ///< m, signed, at the last pillar edge: its largest amount.
  bool tapers = false;  ///< the amount there is below half of the fault's largest.
  int n_extension = 0;  ///< pillar edges by which it was prolonged (extend_faults).
};

enum class Side { neither, left, right, both };

/// A fault: a chain of pillar edges, and what it says.
struct Fault {
  std::vector<FaultEdge> edges;      ///< in order. Where faults cross at an acute angle, edges
                                     ///< may belong to both, with the sum of their offsets.
  std::vector<FaultEdge> extension;  ///< of the first end and of the last, if they were prolonged;
                                     ///< no part of what follows.
  std::vector<Eigen::Vector2d>
      pillars;  ///< m, at the reference height: edges + 1 (closed: last = first).
  std::vector<Eigen::Vector2d> trace;  ///< m, straightened, at least two points. Ends at a
                                       ///< junction lie on the other fault's trace.
  double length = 0;                   ///< m, of the trace.
  double largest_distance = 0;         ///< m, of the middles of pillar edges from the trace.
  double cell = 0;                     ///< m: the longer side of its cells: the median of its
  ///< pillar edges along i, or of those along j.
  std::vector<double> along;    ///< m, per pillar: its place on the trace.
  std::vector<double> offset;   ///< m, per pillar, signed as FaultEdge's: the mean of
                                ///< the edges beside it.
  double largest_offset = 0;    ///< m ≥ 0, over edges and layers.
  Side down = Side::neither;    ///< the lower side; both: it changes along the fault.
  std::vector<double> lean;     ///< per pillar: m to the right of the trace for each m downwards,
                                ///< across it.
  Spread dip;                   ///< rad from the horizontal, (0, π/2], per pillar: of
                                ///< the plane of pillar and trace.
  Spread pillar_angle;          ///< rad, of the pillars from the vertical.
  double dip_direction = 0;     ///< rad, clockwise from y on the map (azimuth), in
                                ///< [0, 2π), median over pillars; 0 if vertical.
  double direction_spread = 0;  ///< rad ≥ 0: how far a pillar's direction is from that, at most.
  Side dips_towards = Side::neither;  ///< neither: vertical to a tenth of a degree.
  FaultEnd begin, end;

  bool is_normal() const {
    return down == dips_towards && (down == Side::left || down == Side::right);
  }
};

/// Where faults meet.
struct Junction {
  bool crosses = false;  ///< X: both go on; else T: `fault` ends at `other`.
  int fault = -1, other = -1;
  int pillar = -1;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m, at the reference height.
};

struct Compartment {
  int region = 0;          ///< the number of EQLNUM or FIPNUM; from 1 on where faults bound it.
  std::vector<int> cells;  ///< active ones, ascending.
  int n_columns = 0;       ///< that have one of them.
  double area = 0;         ///< m2, on the map: of the tops of these columns' uppermost cells.
  double volume = 0;       ///< m3, of the cells.
  double mean_top = 0;     ///< m, z, over the area: of the uppermost cells' tops.
  double mean_base = 0;    ///< m, z, over the area: of the lowest cells' bottoms.
};

/// A place where a horizon is known: on a pillar, once for each side of the faults there.
struct HorizonPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m.
  int pillar = -1;
  int compartment = -1;  ///< of the side, into GridStructure::compartments; −1: of none.
};

/// The top or the bottom of a layer over the active map.
struct Horizon {
  int layer = 0;         ///< k from 0.
  bool is_base = false;  ///< its bottom; of layers but the last only where a gap is below it.
  std::vector<HorizonPoint> points = {};  ///< by pillar. Where the layer's cells are inactive, what
                                          ///< the grid has there counts.
  double largest_step =
      0;  ///< m, between corners that became one point: offsets below least_offset.
};

struct Layer {
  int n_active = 0;           ///< cells.
  int n_inactive = 0;         ///< in active columns.
  int n_collapsed = 0;        ///< of all cells of the layer: of no thickness, active or not.
  double thickness = 0;       ///< m, mean of the active cells; 0 if there is none.
  bool is_collapsed = false;  ///< no cell of an active column has a thickness.
};

enum class LeftOutReason {
  short_chain,   ///< fewer edges than fewest_edges, on its own or beside a junction.
  small_offset,  ///< below least_offset everywhere.
  in_junction,   ///< between faults that meet within a few edges.
};

/// Pillar edges that hang together and became no fault.
struct LeftOut {
  LeftOutReason reason = LeftOutReason::short_chain;
  int n_edges = 0;
  double largest_offset = 0;  ///< m ≥ 0.
  Eigen::Vector2d low = Eigen::Vector2d::Zero(),
                  high = Eigen::Vector2d::Zero();  ///< box on the map.
  int continues = -1;  ///< a fault at whose tip it begins: the fault's fading end.
};

enum class RemarkKind { recognised, left_out, choice, warning };

/// A sentence on what was recognised, left out or chosen.
struct StructureRemark {
  RemarkKind kind = RemarkKind::recognised;
  std::string text;
  std::string option;  ///< the member of StructureOptions that changes it, "" where none does.
};

struct GridStructure {
  double reference_z = 0;         ///< m, of the traces.
  std::vector<Horizon> horizons;  ///< from the top down.
  std::vector<Layer> layers;
  std::vector<Fault> faults;  ///< by falling number of edges.
  std::vector<Junction> junctions;
  std::vector<Compartment> compartments;  ///< by falling volume, or by number of region.
  std::vector<int> compartment_of_cell;   ///< per cell; −1: inactive.
  std::vector<LeftOut> left_out;          ///< by falling offset.
  int n_active_cells = 0, n_active_columns = 0, n_collapsed_cells = 0;
  int n_hole_columns = 0;  ///< inactive ones that the reservoir encloses (ColumnMap).
  int n_bridged = 0;       ///< pillar edges of faults below least_offset (bridge_gaps).
  int n_connections = 0, n_connections_on_faults = 0;  ///< between cells that are no neighbours.
  double largest_gap = 0;  ///< m, between a layer's bottom and the next one's top.
  std::vector<StructureRemark> report;
};

}  // namespace faultsim::corner_point
