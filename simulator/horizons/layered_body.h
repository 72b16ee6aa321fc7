#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// A body of rock as geologists have it: horizons over the map, faults as traces with a dip, and
/// the throw of each. Lengths in m, angles in rad, z up (negative below the surface), x and y in
/// the map.
namespace faultsim::horizons {

/// The same depth everywhere.
struct ConstantDepth {
  double z;
};

/// z + slope · ((x, y) − at).
struct PlaneDepth {
  double z;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dz/dx, dz/dy.
};

/// Depths at the points of a grid; bilinear between, those of the edge outside.
struct GridDepth {
  Eigen::Vector2d origin;   ///< of the first value.
  Eigen::Vector2d spacing;  ///< > 0.
  int nx, ny;               ///< points, >= 1.
  std::vector<double> z;    ///< nx * ny, those of the first y first.
};

/// Depths at scattered points: linear on their Delaunay triangulation, and outside of it as at the
/// nearest place of its edge. Points at one place must agree. One point is a constant; points on
/// one line are linear along it and constant across.
///
/// Where a fault has no throw of its own the points have it: they are interpolated on either side
/// by themselves (SidedHorizon). Each closed part of the map needs a point then.
struct PointDepth {
  std::vector<Eigen::Vector3d> points;
};

/// A horizon that hangs from scattered points: how much deeper than the horizon above it, m, > 0,
/// on the pillar through each point of the PointDepth that is the next above. Interpolated from the
/// same points with the same sight as their depths, and never below half of the least of those: it
/// cannot cross the horizon above, whatever the points say. It keeps that thickness where a fault
/// has a throw of its own.
struct HungDepth {
  std::vector<double> thickness;
};

using DepthOverMap = std::variant<ConstantDepth, PlaneDepth, GridDepth, PointDepth, HungDepth>;

/// A surface between two layers.
struct Horizon {
  std::string name;
  DepthOverMap depth;
};

/// The rock between two horizons.
struct BodyLayer {
  int material = 0;
  /// Depths of the layer count as those of a reservoir: beside faults cells are small there, though
  /// no compartment has a region in it.
  bool is_fine = false;
};

/// Parts of the map, each bounded by faults and dividers (and the box), with a region in some
/// layers.
struct Compartment {
  std::string name;
  Eigen::Vector2d inside;   ///< a point of it, at the depth of traces.
  std::vector<int> region;  ///< per layer, pressure region or −1.
  /// Points of its other parts of the map: one pressure, whatever faults lie between.
  std::vector<Eigen::Vector2d> also_inside = {};
};

/// A line in the map that separates compartments and is no fault: a fault's continuation, say. The
/// rock goes through it.
struct Divider {
  std::string name;
  std::vector<Eigen::Vector2d> line;
};

/// Where an end of a trace lies.
enum class TraceEnd {
  in_rock,   ///< the fault ends there, with a tip.
  at_edge,   ///< on a side of the box.
  at_fault,  ///< on the trace of another one, which goes on (T).
};

/// How far a fault lies to the right of its trace (seen along it) at a depth, m; negative: left.
struct DipPoint {
  double z;
  double shift;
};

/// A line down a fault, by points from top to bottom or back: straight between them, and beyond
/// them as its first and last pieces. What counts is how far it goes from the depth of traces on.
using DipProfile = std::vector<DipPoint>;

/// A straight one. @param lean  m to the right for each m downwards: tan of the dip from the
/// vertical.
inline DipProfile straight_profile(double lean) { return {{0, 0}, {-1, lean}}; }

/// How much deeper the rock lies to the right of a fault's trace (negative: higher).
///
/// The shift of a horizon is −down · (1 − left_share) on the right and down · left_share on the
/// left, all along the trace, but over `taper` from an end in the rock, where both fall linearly to
/// zero. Away from the fault the shift fades as u − reach² ∇²u = 0 does, without crossing other
/// faults; with an infinite reach a part of the map that faults cut off moves as a whole. Where a
/// fault ends in depth the shift of a horizon falls linearly to zero over the last 2 |down| of it.
struct FaultThrow {
  double down = 0;
  double left_share = 0.5;                                  ///< [0, 1].
  double reach = std::numeric_limits<double>::infinity();   ///< m, > 0.
  double taper = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN: a quarter of the trace.
};

/// A fault, by its trace at the depth of traces.
struct LayeredFault {
  std::string name;
  std::vector<Eigen::Vector2d> trace;  ///< >= 2 points.
  TraceEnd first_end = TraceEnd::in_rock;
  TraceEnd last_end = TraceEnd::in_rock;
  /// Lines down the fault, the same all along it or one per point of the trace; between two points
  /// shifts at a depth are linear along the trace. Empty: it is vertical.
  std::vector<DipProfile> profiles;
  std::optional<double> top;     ///< where it ends upwards; empty: at the top of the box.
  std::optional<double> bottom;  ///< where it ends downwards; empty: at the base.
  /// Empty: what the points of horizons say; horizons given otherwise go on across the fault.
  std::optional<FaultThrow> moved;
};

/// Sizes of cells, m: at the faults `at_faults` and beside them `growth` per metre more, up to
/// `far`; beside faults the same above and below the reservoir layers, to 8
/// times their width. Along dividers cells are `at_dividers` at most: no rock slides there, but
/// pressures end.
struct BodyCells {
  double at_faults = 50;
  double far = 1000;
  double growth = 0.2;
  double at_dividers = std::numeric_limits<double>::quiet_NaN();  ///< NaN: 8 at_faults.

  double beside_dividers() const { return at_dividers > 0 ? at_dividers : 8 * at_faults; }
};

/// What a body is built of. Horizons go from top to bottom; layer k is above horizon k, the last
/// one below the last horizon. Faults stand in order of priority: where two cross, the first goes
/// on.
struct LayeredBody {
  Eigen::Vector2d low, high;  ///< of the box in the map.
  double top = 0;             ///< z of its plane top.
  double base = 0;            ///< z of its plane base, below all horizons.
  double trace_depth = 0;     ///< z at which traces, compartments and dividers are drawn.
  std::vector<Horizon> horizons;
  std::vector<BodyLayer> layers;  ///< horizons + 1.
  std::vector<Compartment> compartments;
  std::vector<Divider> dividers;
  std::vector<LayeredFault> faults;
  BodyCells cells;
};

}  // namespace faultsim::horizons
