#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/common/text.h"
#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/figure/panel.h"
#include "simulator/grid_scene/grid_pictures.h"
#include "simulator/horizons/traces.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::cross_product;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSectionWidth = 860, kLeftOfSection = 80;  // px

/// m across from the middle, and z.
using PlaceInSection = Vector2d;

class SectionPicture {
 public:
  SectionPicture(const corner_point::CornerPointGrid& grid,
                 const corner_point::GridStructure& structure, const GridScene& made)
      : grid_(grid), structure_(structure), made_(made), map_(grid) {
    choose_place();
    gather_columns();
    choose_depths();
  }

  std::string draw() const {
    const double width = kSectionWidth - kLeftOfSection - 20,
                 height = width * (high_ - low_) / (2 * half_);
    figure::Svg svg(kSectionWidth, height + 120,
                    "Section through what was recognised in the flow grid");
    const double top =
        figure::draw_heading(svg, "A section " + title_,
                             "to scale; filled, grey: the grid's columns, their tops and bases; "
                             "dots: points of the model's surfaces; lines: "
                             "faults of the model",
                             kLeftOfSection);
    figure::Panel panel(svg, {kLeftOfSection, top, width, height},
                        figure::axis_between("across, m", -half_, half_),
                        figure::axis_between("depth, m", -low_, -high_));
    for (const std::vector<PlaceInSection>& column : columns_) {
      std::vector<figure::Point> corners;
      for (const PlaceInSection& at : column) corners.push_back(panel.at(at.x(), -at.y()));
      svg.polygon(corners, figure::kReservoir);
    }
    for (const std::vector<PlaceInSection>& edge : edges_)
      panel.curve({edge[0].x(), edge[1].x()}, {-edge[0].y(), -edge[1].y()}, {figure::kFrame, 2});
    draw_points(svg, panel);
    for (std::size_t f = 0; f < made_.lines.faults.size(); ++f) draw_fault(panel, f);
    panel.frame();
    return svg.finish();
  }

 private:
  void choose_place();
  void gather_columns();
  void choose_depths();
  std::vector<PlaceInSection> crossed(int column, bool bottom) const;
  void draw_points(figure::Svg& svg, const figure::Panel& panel) const;
  void draw_fault(figure::Panel& panel, std::size_t f) const;

  const corner_point::CornerPointGrid& grid_;
  const corner_point::GridStructure& structure_;
  const GridScene& made_;
  corner_point::ColumnMap map_;
  std::string title_ = "from west to east";
  Vector2d middle_ = {0, 0}, across_ = {1, 0};
  double half_ = 1500, cell_ = 100;                   ///< m
  double low_ = 0, high_ = 0;                         ///< z
  std::vector<std::vector<PlaceInSection>> columns_;  ///< where top and base are crossed.
  std::vector<std::vector<PlaceInSection>> edges_;    ///< tops and bases.
};

void SectionPicture::choose_place() {
  if (made_.lines.faults.empty()) {
    middle_ = made_.compartments.empty() ? Vector2d((made_.lines.low + made_.lines.high) / 2)
                                         : made_.compartments.front().inside;
    return;
  }
  const auto longest = std::ranges::max_element(made_.lines.faults, {}, [](const ModelFault& one) {
    return corner_point::line_length(one.trace);
  });
  const corner_point::Fault& source = structure_.faults[longest->source];
  std::size_t most = 0;
  for (std::size_t p = 1; p < source.offset.size(); ++p) {
    if (std::abs(source.offset[p]) > std::abs(source.offset[most])) most = p;
  }
  const auto on = corner_point::nearest_on_line(longest->trace, source.pillars[most]);
  const Vector2d along = (longest->trace[on.piece + 1] - longest->trace[on.piece]).normalized();
  middle_ = on.point;
  across_ = {along.y(), -along.x()};
  cell_ = source.cell;
  title_ = "across " + longest->name +
           formatted(" where its throw is largest, at x %.0f, y %.0f m", middle_.x(), middle_.y());
  constexpr double kCells = 10;
  half_ = std::max(500.0, kCells * cell_);
}

/// Where the section crosses the top or the base of a column.
std::vector<PlaceInSection> SectionPicture::crossed(int column, bool bottom) const {
  const int k = bottom ? map_.base_layer(column) : map_.top_layer(column);
  const std::array<Vector3d, 4> corners = {grid_.corner(column, k, {false, false, bottom}),
                                           grid_.corner(column, k, {true, false, bottom}),
                                           grid_.corner(column, k, {true, true, bottom}),
                                           grid_.corner(column, k, {false, true, bottom})};
  std::vector<PlaceInSection> places;
  for (std::size_t c = 0; c < 4; ++c) {
    const Vector3d &a = corners[c], &b = corners[(c + 1) % 4];
    const double from = cross_product(across_, a.head<2>() - middle_),
                 to = cross_product(across_, b.head<2>() - middle_);
    if ((from > 0) == (to > 0)) continue;
    const Vector3d at = a + from / (from - to) * (b - a);
    places.emplace_back((at.head<2>() - middle_).dot(across_), at.z());
  }
  std::ranges::sort(places, {}, [](const PlaceInSection& at) { return at.x(); });
  return places;
}

void SectionPicture::gather_columns() {
  for (int column = 0; column < grid_.n_columns(); ++column) {
    if (!map_.is_inside(column)) continue;
    const std::vector<PlaceInSection> top = crossed(column, false), base = crossed(column, true);
    const auto is_shown = [&](const std::vector<PlaceInSection>& places) {
      return std::ranges::all_of(
          places, [&](const PlaceInSection& at) { return std::abs(at.x()) < half_; });
    };
    for (const std::vector<PlaceInSection>& edge : {top, base}) {
      if (edge.size() == 2 && is_shown(edge)) edges_.push_back(edge);
    }
    if (top.size() != 2 || base.size() != 2 || !is_shown(top) || !is_shown(base)) continue;
    columns_.push_back({top[0], top[1], base[1], base[0]});
  }
}

void SectionPicture::choose_depths() {
  low_ = 1e300;
  high_ = -1e300;
  for (const auto& edge : edges_) {
    for (const PlaceInSection& at : edge) {
      low_ = std::min(low_, at.y());
      high_ = std::max(high_, at.y());
    }
  }
  if (edges_.empty()) low_ = high_ = made_.lines.reference_z;
  constexpr double kRoom = 180;  // m above and below
  low_ -= kRoom;
  high_ += kRoom;
}

void SectionPicture::draw_points(figure::Svg& svg, const figure::Panel& panel) const {
  for (const ModelSurface& surface : made_.surfaces) {
    for (const Vector3d& at : surface.points) {
      const Vector2d away = at.head<2>() - middle_;
      const double s = away.dot(across_);
      if (std::abs(cross_product(across_, away)) > 0.6 * cell_ || !panel.holds(s, -at.z()))
        continue;
      svg.circle(panel.at(s, -at.z()), 2.5, figure::kInk);
    }
  }
}

void SectionPicture::draw_fault(figure::Panel& panel, std::size_t f) const {
  const ModelFault& fault = made_.lines.faults[f];
  std::vector<double> x, depth;
  constexpr int kSteps = 20;
  for (int step = 0; step <= kSteps; ++step) {
    const double z = fault.bottom + (fault.top - fault.bottom) * step / kSteps;
    const Polyline line = fault.at(z, made_.lines.reference_z);
    double nearest = 1e300, s = 0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Vector2d at = horizons::crossing_of(middle_ - half_ * across_,
                                                middle_ + half_ * across_, line[k], line[k + 1]);
      if (!at.allFinite()) continue;
      const double here = (at - middle_).dot(across_);
      if (std::abs(here) >= nearest) continue;
      nearest = std::abs(here);
      s = here;
    }
    if (nearest > half_) continue;
    x.push_back(s);
    depth.push_back(-z);
  }
  panel.curve(x, depth, figure::fault_stroke(f, 2.5));
}

}  // namespace

std::string section_picture(const corner_point::CornerPointGrid& grid,
                            const corner_point::GridStructure& structure, const GridScene& made) {
  return SectionPicture(grid, structure, made).draw();
}

}  // namespace faultsim::grid_scene
