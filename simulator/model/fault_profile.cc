#include "simulator/model/fault_profile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "simulator/model/dip_lines.h"
#include "simulator/model/fault_operator.h"
#include "simulator/model/strike_coordinate.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

/// That of all nodes of a plane fault; of one whose trace is straight and whose dip varies, by the
/// mean of its normals over its area. None where the trace bends.
std::optional<StrikeAndDip> straight_frame(const OperatorFault& fault,
                                           const std::vector<OperatorNode>& nodes) {
  constexpr double kSame = 1e-9, kHorizontal = 1e-9;
  const OperatorNode& first = nodes[fault.first_node];
  Vector3d sum = Vector3d::Zero();
  bool is_plane = true, bends = false;
  for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
    sum += nodes[k].area * nodes[k].normal;
    is_plane = is_plane && (nodes[k].normal - first.normal).norm() < kSame;
    bends = bends || (nodes[k].strike - first.strike).norm() > kSame;
  }
  const Vector3d across = sum.normalized().cross(Vector3d::UnitZ());
  if (is_plane || across.norm() < kHorizontal) return StrikeAndDip{first.strike, first.dip};
  if (bends) return std::nullopt;
  const Vector3d strike = across.normalized();
  return StrikeAndDip{strike, sum.normalized().cross(strike)};
}

class ProfileBuilder {
 public:
  ProfileBuilder(const OperatorFault& fault, const std::vector<OperatorNode>& nodes)
      : fault_(fault), lines_(fault.points, fault.faces, straight_frame(fault, nodes)) {}

  /// From south to north, or west to east, whatever part they are of.
  std::vector<Profile> build() const {
    std::vector<std::pair<double, Profile>> found;
    for (int part = 0; part < n_parts(); ++part) {
      const std::vector<double> at = stations(part);
      std::vector<Profile> profiles = of_part(part, at);
      for (std::size_t j = 0; j < at.size(); ++j) found.emplace_back(at[j], std::move(profiles[j]));
    }
    const double sign = is_northward(lines_.strike()) ? 1 : -1;
    std::ranges::stable_sort(found, {}, [&](const auto& one) { return sign * one.first; });
    std::vector<Profile> profiles;
    for (auto& [at, profile] : found) profiles.push_back(std::move(profile));
    return profiles;
  }

 private:
  int n_parts() const {
    int most = -1;
    for (int i = 0; i < lines_.n_points(); ++i) most = std::max(most, lines_.part(i));
    return most + 1;
  }

  std::vector<Profile> of_part(int part, const std::vector<double>& stations) const {
    std::vector<Profile> profiles;
    std::vector<DipCrossing> middle;  // of each profile, where distances along strike are measured
    for (const double at : stations) {
      const std::vector<DipCrossing> line = lines_.line(at, part);
      profiles.push_back(profile(line));
      middle.push_back(line[line.size() / 2]);
    }
    if (!profiles.empty() && std::isfinite(lines_.narrowest())) set_widths(part, middle, profiles);
    return profiles;
  }

  /// Strike coordinates of the profiles.
  std::vector<double> stations(int part) const {
    std::vector<double> split;
    for (int i = 0; i < lines_.n_points(); ++i) {
      if (fault_.node_of_point[i] >= 0 && lines_.part(i) == part) split.push_back(lines_.along(i));
    }
    std::ranges::sort(split);
    std::vector<double> stations;
    for (const double at : split) {
      if (stations.empty() || at > stations.back() + 0.5 * lines_.narrowest())
        stations.push_back(at);
    }
    return stations;
  }

  /// @pre the crossing is split.
  ProfileSample sample(const DipCrossing& at, double position) const {
    int first = fault_.node_of_point[at.from], second = fault_.node_of_point[at.to];
    double weight = 1 - at.share;
    if (first < 0 || (second >= 0 && weight < 0.5)) {
      std::swap(first, second);
      weight = at.share;
    }
    if (second < 0) return {position, {first, first}, {1, 0}, weight};
    return {position, {first, second}, {weight, 1 - weight}, 1};
  }

  Profile profile(const std::vector<DipCrossing>& line) const {
    Profile profile;
    double s = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (i > 0) s += (line[i].place - line[i - 1].place).norm();
      if (fault_.node_of_point[line[i].from] >= 0 || fault_.node_of_point[line[i].to] >= 0) {
        profile.samples.push_back(sample(line[i], s));
      } else if (profile.samples.empty()) {
        profile.tip_before = s;
      } else if (std::isnan(profile.tip_after)) {
        profile.tip_after = s;
      }
    }
    const auto end = [](double tip, double sample) {
      return std::isnan(tip) ? sample : 0.5 * (tip + sample);
    };
    const std::vector<ProfileSample>& x = profile.samples;
    profile.edge.push_back(end(profile.tip_before, x.front().position));
    for (std::size_t i = 1; i < x.size(); ++i) {
      profile.edge.push_back(0.5 * (x[i - 1].position + x[i].position));
    }
    profile.edge.push_back(end(profile.tip_after, x.back().position));
    return profile;
  }

  /// Distance along strike from a profile to the end of its part on one side; 0 where the body cuts
  /// it there. @param side  −1 or 1.
  double to_the_end(int part, const DipCrossing& middle, double side) const {
    double most = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < lines_.n_points(); ++i) {
      if (lines_.part(i) == part) most = std::max(most, side * lines_.along(i));
    }
    std::optional<DipCrossing> nearest;
    for (int i = 0; i < lines_.n_points(); ++i) {
      const bool is_end = lines_.part(i) == part && (side * lines_.along(i) >= most ||
                                                     lines_.is_same(side * lines_.along(i), most));
      if (!is_end) continue;
      const Vector3d& point = lines_.point(i);
      if (!nearest || (point - middle.place).norm() < (nearest->place - middle.place).norm())
        nearest = DipCrossing{point, i, i, 0};
    }
    return nearest ? side * lines_.between(middle, *nearest) : 0;
  }

  /// A profile stands for half of the way to its neighbours.
  void set_widths(int part, const std::vector<DipCrossing>& middle,
                  std::vector<Profile>& profiles) const {
    double before = to_the_end(part, middle.front(), -1);
    profiles.front().strike_edge = !lines_.is_same(before, 0);
    for (std::size_t j = 0; j < profiles.size(); ++j) {
      const bool last = j + 1 == profiles.size();
      const double after = last ? to_the_end(part, middle[j], 1)
                                : std::abs(lines_.between(middle[j], middle[j + 1]));
      if (last && !lines_.is_same(after, 0)) profiles[j].strike_edge = true;
      profiles[j].width = 0.5 * before + 0.5 * after;
      before = after;
    }
  }

  const OperatorFault& fault_;
  const DipLines lines_;
};

}  // namespace

double Profile::length() const {
  return (std::isnan(tip_after) ? samples.back().position : tip_after) -
         (std::isnan(tip_before) ? samples.front().position : tip_before);
}

std::vector<Profile> fault_profiles(const OperatorFault& fault,
                                    const std::vector<OperatorNode>& nodes) {
  if (fault.n_nodes == 0) return {};
  return ProfileBuilder(fault, nodes).build();
}

}  // namespace faultsim
