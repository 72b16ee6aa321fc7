#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/figure/panel.h"
#include "simulator/grid_scene/grid_pictures.h"
#include "simulator/grid_scene/outline.h"

namespace faultsim::grid_scene {
namespace {

using Eigen::Vector2d;

constexpr double kMapWidth = 860, kLeftOfMap = 80, kBelowMap = 50;  // px

class MapPicture {
 public:
  MapPicture(const corner_point::GridStructure& structure, const GridScene& made)
      : structure_(structure), made_(made) {
    low_ = Vector2d::Constant(1e300);
    high_ = -low_;
    for (const Polyline& outline : made.lines.outlines) hold(outline);
    for (const ModelFault& fault : made.lines.faults) hold(fault.trace);
    const Vector2d room = 0.05 * (high_ - low_);
    low_ -= room;
    high_ += room;
  }

  std::string draw() const {
    const double width = kMapWidth - kLeftOfMap - 20;
    const double height = width * (high_.y() - low_.y()) / (high_.x() - low_.x());
    figure::Svg svg(kMapWidth, height + kBelowMap + 70,
                    "Map of what was recognised in the flow grid");
    const double top =
        figure::draw_heading(svg, "What was recognised in the flow grid",
                             "lines: faults of the model with their largest throw; thin: pillars "
                             "of the grid; dashed: where compartments end",
                             kLeftOfMap);
    figure::Panel panel(svg, {kLeftOfMap, top, width, height},
                        figure::axis_between("x, km", low_.x() / 1e3, high_.x() / 1e3),
                        figure::axis_between("y, km", low_.y() / 1e3, high_.y() / 1e3));
    for (const Polyline& outline : made_.lines.outlines) {
      std::vector<figure::Point> corners;
      for (const Vector2d& at : outline) corners.push_back(panel.at(at.x() / 1e3, at.y() / 1e3));
      const bool is_hole = &outline != &made_.lines.outlines.front() && is_clockwise(outline);
      svg.polygon(corners, is_hole ? "#ffffff" : figure::kReservoir);
    }
    for (const ModelDivider& divider : made_.lines.dividers)
      curve(panel, divider.line, {figure::kFaint, 1, "5 3"});
    for (std::size_t f = 0; f < made_.lines.faults.size(); ++f) draw_fault(svg, panel, f);
    for (const ModelCompartment& one : made_.compartments) {
      std::vector<Vector2d> parts = one.also;
      parts.push_back(one.inside);
      for (const Vector2d& inside : parts) {
        const figure::Point at = panel.at(inside.x() / 1e3, inside.y() / 1e3);
        svg.text({at.x, at.y + 4}, one.name,
                 {.size = figure::kTitleSize, .anchor = figure::Anchor::middle, .bold = true});
      }
    }
    panel.frame();
    return svg.finish();
  }

 private:
  void hold(const Polyline& line) {
    for (const Vector2d& at : line) {
      low_ = low_.cwiseMin(at);
      high_ = high_.cwiseMax(at);
    }
  }

  static bool is_clockwise(const Polyline& line) {
    double doubled = 0;
    for (std::size_t k = 0; k < line.size(); ++k)
      doubled += corner_point::cross_product(line[k], line[(k + 1) % line.size()]);
    return doubled < 0;
  }

  static void curve(figure::Panel& panel, const Polyline& line, const figure::Stroke& stroke) {
    std::vector<double> x, y;
    for (const Vector2d& at : line) {
      x.push_back(at.x() / 1e3);
      y.push_back(at.y() / 1e3);
    }
    panel.curve(x, y, stroke);
  }

  void draw_fault(figure::Svg& svg, figure::Panel& panel, std::size_t f) const {
    const ModelFault& fault = made_.lines.faults[f];
    const corner_point::Fault& source = structure_.faults[fault.source];
    curve(panel, source.pillars, {figure::kFaint, 1});
    curve(panel, fault.trace, figure::fault_stroke(f, 2.5));
    std::size_t most = 0;
    for (std::size_t p = 1; p < source.offset.size(); ++p) {
      if (std::abs(source.offset[p]) > std::abs(source.offset[most])) most = p;
    }
    const Vector2d on = corner_point::nearest_on_line(fault.trace, source.pillars[most]).point;
    const figure::Point at = panel.at(on.x() / 1e3, on.y() / 1e3);
    svg.text({at.x, at.y - 8}, fault.name + formatted(", %.0f m", source.largest_offset),
             {.size = figure::kLabelSize,
              .colour = figure::fault_ink(f),
              .anchor = figure::Anchor::middle,
              .bold = true});
  }

  const corner_point::GridStructure& structure_;
  const GridScene& made_;
  Vector2d low_, high_;
};

}  // namespace

std::string map_picture(const corner_point::GridStructure& structure, const GridScene& made) {
  return MapPicture(structure, made).draw();
}

}  // namespace faultsim::grid_scene
