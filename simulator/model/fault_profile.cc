#include "simulator/model/fault_profile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "simulator/model/fault_operator.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

constexpr double kOnLine = 1e-6;  // of the narrowest face: rounding of positions
constexpr double kFlat = 1e-9;    // of a face: rounding of an edge down dip

/// Where a dip line meets the surface: on the edge from point `from` to point `to`, by its share.
struct Crossing {
  Vector3d place;
  int from, to;  // the same at a point
  double share;  // 0 at `from`, 1 at `to`
};

bool is_northward(const Vector3d& strike) {
  return strike[std::abs(strike.x()) > std::abs(strike.y()) ? 0 : 1] >= 0;
}

struct Frame {
  Vector3d strike, dip;
};

/// That of all nodes of a plane fault; of a curved one by the mean of its normals over its area.
Frame frame_of(const OperatorFault& fault, const std::vector<OperatorNode>& nodes) {
  constexpr double kPlane = 1e-9, kHorizontal = 1e-9;
  const OperatorNode& first = nodes[fault.first_node];
  Vector3d sum = Vector3d::Zero();
  bool is_plane = true;
  for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
    sum += nodes[k].area * nodes[k].normal;
    is_plane = is_plane && (nodes[k].normal - first.normal).norm() < kPlane;
  }
  const Vector3d across = sum.normalized().cross(Vector3d::UnitZ());
  if (is_plane || across.norm() < kHorizontal) return {first.strike, first.dip};
  const Vector3d strike = across.normalized();
  return {strike, sum.normalized().cross(strike)};
}

class ProfileBuilder {
 public:
  ProfileBuilder(const OperatorFault& fault, const Frame& frame)
      : fault_(fault), strike_(frame.strike), dip_(frame.dip) {
    for (const Vector3d& point : fault.points) along_.push_back(point.dot(strike_));
    narrowest_ = std::numeric_limits<double>::infinity();  // a line has no width
    for (const std::array<int, 4>& face : fault.faces) add_face(face);
  }

  std::vector<Profile> build() const {
    std::vector<Profile> profiles;
    std::vector<Vector3d> middle;  // of each profile, where distances along strike are measured
    for (const double at : stations()) {
      const std::vector<Crossing> line = crossings(at);
      profiles.push_back(profile(line));
      middle.push_back(line[line.size() / 2].place);
    }
    if (!profiles.empty() && std::isfinite(narrowest_)) set_widths(middle, profiles);
    if (!is_northward(strike_)) std::ranges::reverse(profiles);
    return profiles;
  }

 private:
  void add_face(const std::array<int, 4>& face) {
    double low = along_[face[0]], high = low;
    for (std::size_t i = 0; i < 4; ++i) {
      low = std::min(low, along_[face[i]]);
      high = std::max(high, along_[face[i]]);
      const auto [from, to] = std::minmax(face[i], face[(i + 1) % 4]);
      if (from != to) edges_.emplace(from, to);
    }
    const double size = (fault_.points[face[2]] - fault_.points[face[0]]).norm();
    if (high - low > kFlat * size) narrowest_ = std::min(narrowest_, high - low);
  }

  /// Strike coordinates of the profiles.
  std::vector<double> stations() const {
    std::vector<double> split;
    for (std::size_t i = 0; i < along_.size(); ++i) {
      if (fault_.node_of_point[i] >= 0) split.push_back(along_[i]);
    }
    std::ranges::sort(split);
    std::vector<double> stations;
    for (const double at : split) {
      if (stations.empty() || at > stations.back() + 0.5 * narrowest_) stations.push_back(at);
    }
    return stations;
  }

  bool on_line(int point, double at) const {
    return std::abs(along_[point] - at) <= kOnLine * narrowest_;
  }

  /// All points and edges that the line meets, down dip.
  std::vector<Crossing> crossings(double at) const {
    std::vector<Crossing> found;
    for (int i = 0; i < static_cast<int>(along_.size()); ++i) {
      if (on_line(i, at)) found.push_back({fault_.points[i], i, i, 0});
    }
    for (const auto& [from, to] : edges_) {
      if ((along_[from] < at) == (along_[to] < at) || on_line(from, at) || on_line(to, at))
        continue;
      const double share = (at - along_[from]) / (along_[to] - along_[from]);
      found.push_back({fault_.points[from] + share * (fault_.points[to] - fault_.points[from]),
                       from, to, share});
    }
    std::ranges::stable_sort(found, [&](const Crossing& a, const Crossing& b) {
      return a.place.dot(dip_) < b.place.dot(dip_);
    });
    return found;
  }

  /// @pre the crossing is split.
  ProfileSample sample(const Crossing& at, double position) const {
    int first = fault_.node_of_point[at.from], second = fault_.node_of_point[at.to];
    double weight = 1 - at.share;
    if (first < 0 || (second >= 0 && weight < 0.5)) {
      std::swap(first, second);
      weight = at.share;
    }
    if (second < 0) return {position, {first, first}, {1, 0}, weight};
    return {position, {first, second}, {weight, 1 - weight}, 1};
  }

  Profile profile(const std::vector<Crossing>& line) const {
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

  /// Distance along strike from a profile to the end of the fault on one side; 0 where the body
  /// cuts it there. @param side  −1 or 1.
  double to_the_end(const Vector3d& middle, double side) const {
    double most = side * middle.dot(strike_);
    for (const double at : along_) most = std::max(most, side * at);
    const Vector3d* nearest = &middle;
    for (std::size_t i = 0; i < along_.size(); ++i) {
      if (side * along_[i] < most - kOnLine * narrowest_) continue;
      const Vector3d& point = fault_.points[i];
      if (nearest == &middle || (point - middle).norm() < (*nearest - middle).norm())
        nearest = &point;
    }
    return side * (*nearest - middle).dot(strike_);
  }

  /// A profile stands for half of the way to its neighbours.
  void set_widths(const std::vector<Vector3d>& middle, std::vector<Profile>& profiles) const {
    double before = to_the_end(middle.front(), -1);
    profiles.front().strike_edge = before > kOnLine * narrowest_;
    for (std::size_t j = 0; j < profiles.size(); ++j) {
      const bool last = j + 1 == profiles.size();
      const double after =
          last ? to_the_end(middle[j], 1) : std::abs((middle[j + 1] - middle[j]).dot(strike_));
      if (last && after > kOnLine * narrowest_) profiles[j].strike_edge = true;
      profiles[j].width = 0.5 * before + 0.5 * after;
      before = after;
    }
  }

  const OperatorFault& fault_;
  const Vector3d strike_, dip_;
  std::vector<double> along_;            // strike coordinate of each point, m
  double narrowest_;                     // least extent of a face along strike, m
  std::set<std::pair<int, int>> edges_;  // lower point first
};

}  // namespace

double Profile::length() const {
  return (std::isnan(tip_after) ? samples.back().position : tip_after) -
         (std::isnan(tip_before) ? samples.front().position : tip_before);
}

std::vector<Profile> fault_profiles(const OperatorFault& fault,
                                    const std::vector<OperatorNode>& nodes) {
  if (fault.n_nodes == 0) return {};
  return ProfileBuilder(fault, frame_of(fault, nodes)).build();
}

}  // namespace faultsim
