#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

namespace faultsim {

struct OperatorFault;
struct OperatorNode;

/// Where a profile meets the fault: at a node, or on the edge between two points.
struct ProfileSample {
  double position = 0;                 ///< s, m down the profile from its first point.
  std::array<int, 2> node = {-1, -1};  ///< into FaultGeometry::nodes, the heavier first; the same
                                       ///< one twice where there is but one.
  std::array<double, 2> weight = {1, 0};  ///< of their values; sum to 1.
  double moving = 1;  ///< < 1 on an edge with an unsplit end: slip is this times the weighted sum.

  /// A nodal field there, such as traction or strength. @param values  per fault node.
  double of(const Eigen::VectorXd& values) const {
    return weight[0] * values[node[0]] + weight[1] * values[node[1]];
  }
  /// Slip there. @param slip  per fault node, m.
  double slip(const Eigen::VectorXd& values) const { return moving * of(values); }
};

/// A line down the dip of a fault, and how much of the fault's length along strike it stands for.
/// What is measured down dip (docs/model.md, section 7) is measured on profiles.
///
/// Nodal tractions are forces over lumped areas, that is, means over the nodes' dual cells, which
/// end half way to the neighbours; a sample's dual cell is the part of the line between the middles
/// to its neighbours. Slip is a displacement and linear between samples; it falls to 0 at unsplit
/// ends.
struct Profile {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double width = 1;                    ///< m along strike; plane strain: 1.
  std::vector<ProfileSample> samples;  ///< down dip, at least one.
  std::vector<double> edge;            ///< s of the ends of the dual cells, m; samples + 1.
  double tip_before = kNone,
         tip_after = kNone;  ///< s of the unsplit ends (slip 0), m; NaN where
                             ///< the line is cut by the body's boundary instead.
  bool strike_edge = false;  ///< the fault ends next to it along strike, inside the rock.

  double share(std::size_t i) const { return edge[i + 1] - edge[i]; }  ///< of sample i, m.
  /// The longest extent that slip could reach, m.
  double length() const;
};

/// The profiles of a fault: its lines down dip (dip_lines.h), each within one part of it. There is
/// one through every split point, but points closer along strike than half the narrowest face share
/// the first one's: of a grid whose lines go down dip, a profile is such a line, and its samples
/// are its nodes.
///
/// Strike and dip are those of a plane fault; of a fault with a straight trace, those of its mean
/// normal over its area. Along a trace that bends, position along strike is the
/// strike_coordinate(), and depth orders a profile.
///
/// @return from south to north, or west to east if strike is nearer to that; none without nodes.
std::vector<Profile> fault_profiles(const OperatorFault& fault,
                                    const std::vector<OperatorNode>& nodes);

}  // namespace faultsim
