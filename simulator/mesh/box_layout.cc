#include "simulator/mesh/box_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/mesh/grading.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 3> kAxisName = {"x", "y", "z"};

void check_sizes(const BoxMeshSpec& spec, std::vector<Problem>& problems) {
  const double least = std::min(
      {spec.sizes.dip, spec.sizes.normal, spec.plane_strain ? spec.sizes.dip : spec.sizes.strike});
  const double most = 1e6;  // lines per axis
  for (size_t d = 0; d < 3; ++d)
    if ((spec.to[d] - spec.from[d]) / least > most && !(spec.plane_strain && d == 1))
      problems.push_back({"/mesh", 0, "cells are a millionth of the box", "use larger cells"});
}

void check_regions(const BoxMeshSpec& spec, std::vector<Problem>& problems) {
  const double tolerance = edge_tolerance(spec);
  const auto overlaps = [&](const Bounds& a, const Bounds& b) {
    for (size_t d = 0; d < 3; ++d)
      if (std::min(a.high[d], b.high[d]) - std::max(a.low[d], b.low[d]) <= tolerance) return false;
    return true;
  };
  for (size_t i = 0; i < spec.regions.size(); ++i) {
    const Bounds bounds = bounds_of(spec.regions[i]);
    if (!overlaps(bounds, {spec.from, spec.to}))
      problems.push_back({concat("/geometry/regions/", i), 0, "is empty or lies outside the box",
                          "give it a part of the box"});
    for (size_t j = 0; j < i; ++j)
      if (overlaps(bounds, bounds_of(spec.regions[j])))
        problems.push_back({concat("/geometry/regions/", i), 0,
                            concat("overlaps region ", j, " (discs by their bounding boxes)"),
                            "a cell has one pressure: make regions disjoint"});
  }
}

/// Works out one layout step by step; each step needs those before it.
class LayoutBuilder {
 public:
  LayoutBuilder(const BoxMeshSpec& spec, std::vector<Problem>& problems)
      : spec_(spec), problems_(problems), tolerance_(edge_tolerance(spec)) {}

  BoxLayout build() {
    layout_.frames = patch_frames(spec_, problems_);
    if (problems_.empty() && !layout_.frames.empty()) choose_axes();
    if (problems_.empty()) set_sizes();
    if (problems_.empty() && !layout_.frames.empty()) {
      check_rotation();
      add_column_shear();
      find_extents();
      if (problems_.empty()) bend_planes();
    }
    if (problems_.empty()) make_lines();
    return std::move(layout_);
  }

 private:
  struct Extent {
    std::array<double, 2> column, row;  ///< reference coordinates of the patch's edges.
  };

  void choose_axes() {
    const size_t axis = common_axis(layout_.frames);
    if (axis == 3) {
      problems_.push_back(
          {"/faults", 0, "no grid axis is within 45 deg of the normals of all patches",
           "make the patches more parallel; for a single fault turn the far-field stress"});
      return;
    }
    layout_.axis = axis;
    const PatchFrame& first = layout_.frames[0];
    const bool strike_is_x =
        std::abs(first.along.x()) > std::abs(first.along.y()) + kAngleTolerance;
    layout_.column_axis = axis == 0 ? 1 : axis == 1 ? 0 : strike_is_x ? 0 : 1;
    layout_.row_axis = 3 - axis - layout_.column_axis;
    for (PatchFrame& frame : layout_.frames) {
      orient(frame, axis);
      const bool bent =
          std::abs(component(frame.normal, axis)) < 1 - kAngleTolerance * kAngleTolerance;
      if (axis == 2 && bent && spec_.layers.size() > 1)
        problems_.push_back(
            {patch_pointer(static_cast<size_t>(&frame - layout_.frames.data())), 0,
             "is flatter than 45 deg but not horizontal, which would bend the layers",
             "use one material, a steeper or a horizontal patch"});
    }
  }

  void set_sizes() {
    size_[layout_.axis] = spec_.sizes.normal;
    size_[layout_.column_axis] = spec_.sizes.strike;
    size_[layout_.row_axis] = spec_.sizes.dip;
  }

  /// Bounds of the patch beyond the body in the direction of the columns: no end to be met.
  std::array<bool, 2> ends_inside(const PatchFrame& frame) const {
    const size_t b = layout_.column_axis;
    const double half = frame.half_length * std::abs(component(frame.along, b)) -
                        frame.half_width * std::abs(component(frame.down, b));
    const double middle = component(frame.center, b);
    return {middle - half > spec_.from[b] + tolerance_, middle + half < spec_.to[b] - tolerance_};
  }

  bool has_ends(const PatchFrame& frame) const {
    const std::array<bool, 2> inside = ends_inside(frame);
    return !frame.ellipse && !spec_.plane_strain && (inside[0] || inside[1]);
  }

  /// A rectangle on a flat grid plane must lie along the grid.
  void check_rotation() {
    if (layout_.axis != 2) return;
    for (size_t i = 0; i < layout_.frames.size(); ++i) {
      const PatchFrame& frame = layout_.frames[i];
      const double skew = std::min(std::abs(frame.along.x()), std::abs(frame.along.y()));
      const Vector3d half = frame.half_extent();
      const bool covers = frame.center.x() - 0.5 * half.x() < spec_.from[0] &&
                          frame.center.x() + 0.5 * half.x() > spec_.to[0] &&
                          frame.center.y() - 0.5 * half.y() < spec_.from[1] &&
                          frame.center.y() + 0.5 * half.y() > spec_.to[1];
      if (skew > kAngleTolerance && !frame.ellipse && !covers)
        problems_.push_back(
            {patch_pointer(i) + "/strike", 0,
             "a flat rectangle that is not along x or y does not fit the grid",
             "use a multiple of 90 deg and turn the far-field stress, or an ellipse"});
    }
  }

  double column_slope(const PatchFrame& frame) const {
    const double slope =
        component(frame.down, layout_.column_axis) / component(frame.down, layout_.row_axis);
    return std::abs(slope) > kAngleTolerance ? slope : 0;
  }

  void add_column_shear() {
    if (layout_.axis == 2 || !problems_.empty()) return;
    const PatchFrame* first = nullptr;
    for (size_t i = 0; i < layout_.frames.size(); ++i) {
      const PatchFrame& frame = layout_.frames[i];
      if (!has_ends(frame)) continue;
      if (first == nullptr) first = &frame;
      if (std::abs(column_slope(frame) - column_slope(*first)) > kAngleTolerance)
        problems_.push_back(
            {patch_pointer(i), 0,
             "its ends and those of another rectangle are not parallel on the grid",
             "give rectangles the same strike and dip, let them pass beyond the box, or "
             "use ellipses"});
    }
    if (first == nullptr || column_slope(*first) == 0 || !problems_.empty()) return;
    make_column_shear(*first);
  }

  void make_column_shear(const PatchFrame& first) {
    const size_t b = layout_.column_axis, c = layout_.row_axis;
    ColumnShear shear;
    shear.slope = column_slope(first);
    shear.pivot = component(first.center, c);
    shear.low = spec_.to[c];
    shear.high = spec_.from[c];
    const double margin = kShearMargin * size_[c];
    double first_end = spec_.to[b], last_end = spec_.from[b];
    for (const PatchFrame& frame : layout_.frames) {
      if (!has_ends(frame)) continue;
      const double half = component(frame.half_extent(), c), middle = component(frame.center, c);
      shear.low = std::max(spec_.from[c], std::min(shear.low, middle - half - margin));
      shear.high = std::min(spec_.to[c], std::max(shear.high, middle + half + margin));
      const double reference = shear.reference(component(frame.center, b), middle);
      const double length = frame.half_length * std::abs(component(frame.along, b));
      const std::array<bool, 2> inside = ends_inside(frame);
      if (inside[0]) first_end = std::min(first_end, reference - length);
      if (inside[1]) last_end = std::max(last_end, reference + length);
    }
    if (first_end > last_end) std::swap(first_end, last_end);
    first_end = std::max(first_end, spec_.from[b]);
    last_end = std::min(last_end, spec_.to[b]);
    const double most = std::abs(shear.slope) * std::max(std::abs(shear.high - shear.pivot),
                                                         std::abs(shear.low - shear.pivot));
    if (most > (1 - Shear::kLeastGap) * std::min(first_end - spec_.from[b], spec_.to[b] - last_end))
      problems_.push_back({"/faults", 0,
                           concat("the ends of the patches come too close to the ", kAxisName[b],
                                  " sides of the box"),
                           "enlarge the box or let the patches pass beyond it"});
    shear.knot = {spec_.from[b], first_end, last_end, spec_.to[b]};
    shear.weight = {0, 1, 1, 0};
    layout_.column_shear = shear;
  }

  void find_extents() {
    const size_t b = layout_.column_axis, c = layout_.row_axis;
    for (size_t i = 0; i < layout_.frames.size(); ++i) {
      const PatchFrame& frame = layout_.frames[i];
      double middle_b = component(frame.center, b), half_b = component(frame.half_extent(), b);
      const double middle_c = component(frame.center, c),
                   half_c = component(frame.half_extent(), c);
      if (layout_.column_shear && !frame.ellipse) {
        middle_b = layout_.column_shear->reference(middle_b, middle_c);
        half_b = frame.half_length * std::abs(component(frame.along, b));
      }
      if (spec_.plane_strain) {
        middle_b = 0.5 * (spec_.from[b] + spec_.to[b]);
        half_b = spec_.to[b] - spec_.from[b];
      }
      extent_.push_back(
          {{middle_b - half_b, middle_b + half_b}, {middle_c - half_c, middle_c + half_c}});
      const Extent& e = extent_.back();
      if (e.column[0] >= spec_.to[b] || e.column[1] <= spec_.from[b] || e.row[0] >= spec_.to[c] ||
          e.row[1] <= spec_.from[c])
        problems_.push_back({patch_pointer(i), 0, "lies outside the box", "move it into the box"});
    }
  }

  BentPlane bent_plane(const PatchFrame& frame) const {
    BentPlane plane;
    const double across = component(frame.normal, layout_.axis);
    plane.ref = component(frame.center, layout_.axis);
    for (size_t d = 0; d < 2; ++d) {
      const size_t other = other_axis(d);
      const double middle = component(frame.center, other);
      const double half = component(frame.half_extent(), other) + kShearMargin * size_[other];
      plane.slope[d] = -component(frame.normal, other) / across;
      plane.pivot[d] = std::clamp(middle, spec_.from[other], spec_.to[other]);
      plane.ref += plane.slope[d] * (plane.pivot[d] - middle);
      plane.low[d] = middle - half;
      plane.high[d] = middle + half;
    }
    return plane;
  }

  /// The d-th of the two axes in the plane, in ascending order (as BentPlane counts them).
  size_t other_axis(size_t d) const {
    return std::array<std::array<size_t, 2>, 3>{{{1, 2}, {0, 2}, {0, 1}}}[layout_.axis][d];
  }

  bool same_plane(const PatchFrame& a, const PatchFrame& b) const {
    return (a.normal - b.normal).norm() < kAngleTolerance &&
           std::abs(a.normal.dot(a.center - b.center)) < tolerance_;
  }

  void bend_planes() {
    std::vector<BentPlane> planes;
    std::vector<size_t> owner;  // first patch of each plane
    layout_.plane_of.assign(layout_.frames.size(), 0);
    for (size_t i = 0; i < layout_.frames.size(); ++i) {
      const BentPlane plane = bent_plane(layout_.frames[i]);
      size_t k = 0;
      while (k < planes.size() && !same_plane(layout_.frames[owner[k]], layout_.frames[i])) ++k;
      layout_.plane_of[i] = k;
      if (k == planes.size()) {
        planes.push_back(plane);
        owner.push_back(i);
      } else {
        for (size_t d = 0; d < 2; ++d) {
          planes[k].low[d] = std::min(planes[k].low[d], plane.low[d]);
          planes[k].high[d] = std::max(planes[k].high[d], plane.high[d]);
        }
      }
      check_overlap(i);
    }
    align_parallel(planes, owner);
    check_inside(planes, owner);
    if (problems_.empty()) sort_planes(planes, owner);
  }

  /// Parallel planes are bent over the same range and about the same place, the centre of the first
  /// patch, so that they are as far apart everywhere as they are on the reference grid.
  void align_parallel(std::vector<BentPlane>& planes, const std::vector<size_t>& owner) const {
    const std::vector<BentPlane> own = planes;
    for (size_t k = 0; k < planes.size(); ++k) {
      bool first = true;
      for (size_t m = 0; m < planes.size(); ++m) {
        const Vector3d turn = layout_.frames[owner[k]].normal - layout_.frames[owner[m]].normal;
        if (turn.norm() > kAngleTolerance) continue;
        for (size_t d = 0; d < 2; ++d) {
          planes[k].low[d] = std::min(planes[k].low[d], own[m].low[d]);
          planes[k].high[d] = std::max(planes[k].high[d], own[m].high[d]);
          if (!first) continue;
          planes[k].ref += planes[k].slope[d] * (own[m].pivot[d] - planes[k].pivot[d]);
          planes[k].pivot[d] = own[m].pivot[d];
        }
        first = false;
      }
    }
  }

  void check_inside(const std::vector<BentPlane>& planes, const std::vector<size_t>& owner) {
    const size_t a = layout_.axis;
    for (size_t k = 0; k < planes.size(); ++k)
      if (!(planes[k].ref > spec_.from[a] + tolerance_) ||
          !(planes[k].ref < spec_.to[a] - tolerance_))
        problems_.push_back({patch_pointer(owner[k]), 0,
                             concat("its plane meets the ", kAxisName[a], " side of the box"),
                             "move it inwards or enlarge the box"});
  }

  void check_overlap(size_t i) {
    const auto overlap = [&](const std::array<double, 2>& p, const std::array<double, 2>& q) {
      return std::min(p[1], q[1]) - std::max(p[0], q[0]) > tolerance_;
    };
    for (size_t j = 0; j < i; ++j)
      if (layout_.plane_of[j] == layout_.plane_of[i] &&
          overlap(extent_[i].column, extent_[j].column) && overlap(extent_[i].row, extent_[j].row))
        problems_.push_back({patch_pointer(i), 0,
                             concat("overlaps patch ", j, " on the same plane"),
                             "make them one patch or move them apart"});
  }

  void sort_planes(const std::vector<BentPlane>& planes, const std::vector<size_t>& owner) {
    std::vector<size_t> order(planes.size());
    for (size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::ranges::sort(order, [&](size_t p, size_t q) { return planes[p].ref < planes[q].ref; });
    std::vector<BentPlane> sorted;
    std::vector<size_t> rank(planes.size());
    for (size_t k = 0; k < order.size(); ++k) {
      if (k > 0 && planes[order[k]].ref - sorted.back().ref < tolerance_)
        problems_.push_back({patch_pointer(owner[order[k]]), 0,
                             concat("crosses patch ", owner[order[k - 1]]),
                             "move them apart: patches may not cross"});
      sorted.push_back(planes[order[k]]);
      rank[order[k]] = k;
    }
    if (!problems_.empty()) return;
    for (size_t& k : layout_.plane_of) k = rank[k];
    layout_.shear.emplace(spec_.from[layout_.axis], spec_.to[layout_.axis], sorted);
    const size_t b = other_axis(0), c = other_axis(1);
    const int gap = layout_.shear->first_squeezed_gap({spec_.from[b], spec_.to[b]},
                                                      {spec_.from[c], spec_.to[c]});
    if (gap < 0) return;
    const bool side = gap == 0 || static_cast<size_t>(gap) == sorted.size();
    const size_t right =
        owner[order[side && gap > 0 ? sorted.size() - 1 : static_cast<size_t>(gap)]];
    const std::string other = side ? concat("the ", kAxisName[layout_.axis], " side of the box")
                                   : concat("patch ", owner[order[static_cast<size_t>(gap) - 1]]);
    problems_.push_back({patch_pointer(right), 0, concat("crosses or comes too close to ", other),
                         "move them apart, make them parallel, or enlarge the box"});
  }

  void make_lines() {
    for (size_t d = 0; d < 3; ++d) {
      if (spec_.plane_strain && d == 1) {
        layout_.lines[d] = {spec_.from[1], spec_.to[1]};
        continue;
      }
      LineBuilder builder(spec_.from[d], spec_.to[d], spec_.sizes.growth, spec_.sizes.largest);
      add_patch_lines(d, builder);
      for (const PressureRegion& region : spec_.regions) {
        const Bounds bounds = bounds_of(region);
        builder.add_line(bounds.low[d]);
        builder.add_line(bounds.high[d]);
      }
      if (d == 2)
        for (const Layer& layer : spec_.layers) builder.add_line(-layer.top_depth);
      if (layout_.frames.empty()) add_windows_without_patch(d, builder);
      layout_.lines[d] = builder.build();
    }
  }

  void add_patch_lines(size_t d, LineBuilder& builder) const {
    if (layout_.frames.empty()) return;
    if (d == layout_.axis) {
      for (const BentPlane& plane : layout_.shear->planes()) builder.add_line(plane.ref, size_[d]);
      return;
    }
    for (const Extent& extent : extent_) {
      const std::array<double, 2>& range = d == layout_.column_axis ? extent.column : extent.row;
      builder.add_line(range[0]);
      builder.add_line(range[1]);
      builder.add_window(range[0] - spec_.sizes.fine_margin, range[1] + spec_.sizes.fine_margin,
                         size_[d]);
    }
  }

  /// Without patches the regions are what needs small cells; without those, all is even.
  void add_windows_without_patch(size_t d, LineBuilder& builder) const {
    for (const PressureRegion& region : spec_.regions) {
      const Bounds bounds = bounds_of(region);
      builder.add_window(bounds.low[d] - spec_.sizes.fine_margin,
                         bounds.high[d] + spec_.sizes.fine_margin, size_[d]);
    }
    if (spec_.regions.empty()) builder.add_window(spec_.from[d], spec_.to[d], size_[d]);
  }

  const BoxMeshSpec& spec_;
  std::vector<Problem>& problems_;
  double tolerance_;
  BoxLayout layout_;
  std::array<double, 3> size_ = {0, 0, 0};
  std::vector<Extent> extent_;
};

}  // namespace

double edge_tolerance(const BoxMeshSpec& spec) {
  double tolerance = 0;
  for (size_t d = 0; d < 3; ++d)
    tolerance = std::max(tolerance, 10 * std::min(1e-6, 1e-9 * (spec.to[d] - spec.from[d])));
  return tolerance;
}

BoxLayout box_layout(const BoxMeshSpec& spec, std::vector<Problem>& problems) {
  std::vector<Problem> found;
  check_sizes(spec, found);
  BoxLayout layout;
  if (found.empty()) check_regions(spec, found);
  if (found.empty()) {
    try {
      layout = LayoutBuilder(spec, found).build();
    } catch (const InputError& error) {  // too many lines on an axis
      found = error.problems();
    }
  }
  problems.insert(problems.end(), found.begin(), found.end());
  return layout;
}

}  // namespace faultsim
