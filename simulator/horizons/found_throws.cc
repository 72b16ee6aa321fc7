#include "simulator/horizons/found_throws.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim::horizons {
namespace {

/// The places on the left and on the right of a trace at one of its vertices.
struct BothPlaces {
  std::size_t left, right;
  double along;  ///< the trace, m.
};

std::vector<BothPlaces> both_places(const MapMesh& map, const std::vector<MapSide>& sides,
                                    const CutMap& cut, int fault) {
  const std::vector<int>& line = map.lines[fault];
  std::vector<BothPlaces> both;
  double along = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const std::size_t piece = std::min(k, line.size() - 2);
    const MapSide* side = find_side(sides, line[piece], line[piece + 1]);
    const bool is_forward = line[piece] == side->a;
    const int left = is_forward ? side->left : side->right;
    const int right = is_forward ? side->right : side->left;
    if (k > 0) along += (map.vertices[line[k]] - map.vertices[line[k - 1]]).norm();
    both.push_back({static_cast<std::size_t>(place_at(map, cut, left, line[k])),
                    static_cast<std::size_t>(place_at(map, cut, right, line[k])), along});
  }
  return both;
}

}  // namespace

std::vector<FoundThrow> found_throws(const LayeredBody& body, const MapMesh& map,
                                     const std::vector<MapSide>& sides, const CutMap& cut,
                                     const Levels& levels) {
  std::vector<FoundThrow> all;
  for (int f = 0; f < map.n_faults; ++f) {
    const std::vector<BothPlaces> both = both_places(map, sides, cut, f);
    const double half = both.back().along / 2;
    for (std::size_t h = 0; h < body.horizons.size(); ++h) {
      FoundThrow found{f, static_cast<int>(h), 0, std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity()};
      double nearest = std::numeric_limits<double>::infinity();
      for (const BothPlaces& one : both) {
        if (one.left == one.right) continue;
        const double down = levels.horizons[one.left][h] - levels.horizons[one.right][h];
        found.least = std::min(found.least, down);
        found.largest = std::max(found.largest, down);
        if (std::abs(one.along - half) >= nearest) continue;
        nearest = std::abs(one.along - half);
        found.middle = down;
      }
      // A trace of two tips only has no sides.
      if (found.least > found.largest) found.least = found.largest = 0;
      all.push_back(found);
    }
  }
  return all;
}

}  // namespace faultsim::horizons
