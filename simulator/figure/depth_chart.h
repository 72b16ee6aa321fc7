#pragma once

#include <string>
#include <vector>

#include "simulator/figure/face_colours.h"
#include "simulator/figure/history_chart.h"

namespace faultsim::figure {

/// An interval of depth that matters: a compartment on one side of a fault.
struct DepthBand {
  std::string name;
  double top = 0, base = 0;   ///< m.
  bool on_plus_side = false;  ///< right of the fault; else left.
};
/// A quantity against depth.
struct DepthColumn {
  std::string label;          ///< quantity and unit.
  std::vector<Curve> curves;  ///< values at the depths of the chart.
  std::vector<Level> levels = {};
  std::vector<double> always = {};
};
/// Columns side by side with one axis of depth, growing downwards; reservoir intervals of both
/// sides stand at the left and their tops and bases run through.
struct DepthChart {
  std::string title, remark;
  std::vector<double> depth;  ///< m, ascending.
  std::vector<DepthBand> bands;
  std::vector<DepthColumn> columns;
  std::vector<double> depth_before = {};  ///< m, ascending: of Curve::before.
};
std::string draw(const DepthChart& chart);

/// A face of a fault in its plane.
struct FaultCell {
  std::vector<Point> corners;  ///< m along strike or step of time; m of depth.
  double value = 0;            ///< see FaceColours.
  bool is_marked = false;      ///< slips or is open: outlined.
};
/// A quantity on a fault's plane as colours.
struct FaultMap {
  std::string title, remark;
  std::string across;  ///< "along strike, m".
  std::string marked;  ///< what the outline means; "" = nothing is outlined.
  std::vector<FaultCell> cells;
  std::vector<DepthBand> bands;
  FaceColours colours = {};  ///< its scale is widened to hold the cells.
};
std::string draw(const FaultMap& map);

}  // namespace faultsim::figure
