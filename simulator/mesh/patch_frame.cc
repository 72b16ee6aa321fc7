#include "simulator/mesh/patch_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

using Eigen::Vector3d;

/// (sin, cos) with rounding of multiples of 90 degrees taken off.
std::array<double, 2> clean_sin_cos(double angle) {
  std::array<double, 2> result = {std::sin(angle), std::cos(angle)};
  for (double& value : result)
    if (std::abs(value) < kAngleTolerance) value = 0;
  return result;
}

PatchFrame patch_frame(const PatchGeometry& patch) {
  PatchFrame frame;
  const auto [sin_strike, cos_strike] = clean_sin_cos(patch.strike);
  const auto [sin_dip, cos_dip] = clean_sin_cos(patch.dip_from_vertical);
  frame.center = Vector3d(patch.center[0], patch.center[1], patch.center[2]);
  frame.along = Vector3d(sin_strike, cos_strike, 0).normalized();
  frame.down = Vector3d(sin_dip * cos_strike, -sin_dip * sin_strike, -cos_dip).normalized();
  frame.normal = frame.down.cross(frame.along);  // its sign is set with the grid axis
  frame.half_length = 0.5 * patch.length;
  frame.half_width = 0.5 * patch.width;
  frame.ellipse = patch.shape == PatchShape::ellipse;
  frame.horizontal = cos_dip == 0;
  return frame;
}

}  // namespace

std::string patch_pointer(size_t patch) { return concat("/faults/", patch); }

void orient(PatchFrame& frame, size_t axis) {
  if (component(frame.normal, axis) < 0) frame.normal = -frame.normal;
  frame.dip = frame.down;
  frame.strike = frame.dip.cross(frame.normal);
  if (!frame.horizontal) return;
  frame.strike = frame.along;
  frame.dip = frame.normal.cross(frame.along);
}

std::vector<PatchFrame> patch_frames(const BoxMeshSpec& spec, std::vector<Problem>& problems) {
  std::vector<PatchFrame> frames;
  for (size_t i = 0; i < spec.patches.size(); ++i) {
    const PatchFrame& frame = frames.emplace_back(patch_frame(spec.patches[i]));
    if (spec.plane_strain && (std::abs(frame.normal.y()) > kAngleTolerance ||
                              std::abs(frame.along.x()) > kAngleTolerance))
      problems.push_back({patch_pointer(i) + "/strike", 0, "is not along y, as plane strain needs",
                          "use a strike of 0 or 180 deg"});
  }
  return frames;
}

size_t common_axis(const std::vector<PatchFrame>& frames) {
  for (size_t axis = 0; axis < 3; ++axis)
    if (std::ranges::all_of(frames, [&](const PatchFrame& frame) {
          return std::abs(component(frame.normal, axis)) >=
                 frame.normal.cwiseAbs().maxCoeff() * (1 - kAngleTolerance);
        }))
      return axis;
  return 3;
}

Vector3d PatchFrame::half_extent() const {
  const Vector3d u = half_length * along.cwiseAbs(), v = half_width * down.cwiseAbs();
  if (!ellipse) return u + v;
  return (u.array().square() + v.array().square()).sqrt().matrix();
}

bool PatchFrame::inside(const Vector3d& position, double tolerance, bool along_limit) const {
  const double u = along_limit ? std::abs((position - center).dot(along)) : 0;
  const double v = std::abs((position - center).dot(down));
  if (!ellipse) return u < half_length - tolerance && v < half_width - tolerance;
  const double p = u / (half_length - tolerance), q = v / (half_width - tolerance);
  return p * p + q * q < 1;
}

double ColumnShear::shift(double ref, double c) const {
  const size_t k = static_cast<size_t>(
      std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(knot, ref) - knot.begin(), 1,
                                 static_cast<std::ptrdiff_t>(knot.size()) - 1));
  const double width = knot[k] - knot[k - 1];
  const double t = width > 0 ? (ref - knot[k - 1]) / width : 0;
  return (weight[k - 1] * (1 - t) + weight[k] * t) * slope * (std::clamp(c, low, high) - pivot);
}

}  // namespace faultsim
