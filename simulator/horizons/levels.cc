#include "simulator/horizons/levels.h"

#include <algorithm>
#include <cmath>

#include "simulator/horizons/snapping.h"
#include "simulator/horizons/throws.h"

namespace faultsim::horizons {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Where z = horizon(x(v, z)) + shift(z), by bisection; horizons are less steep than pillars.
template <typename Above>
double meet_pillar(double low, double high, const Above& above) {
  constexpr int kHalvings = 200;
  double at_low = above(low), at_high = above(high);
  if (at_low >= 0) return low;
  if (at_high <= 0) return high;
  for (int k = 0; k < kHalvings; ++k) {
    // Secant steps first, which are exact on planes; then halves.
    const double secant = low - at_low * (high - low) / (at_high - at_low);
    const double z = k % 3 < 2 && secant > low && secant < high ? secant : (low + high) / 2;
    const double there = above(z);
    if (there == 0 || z == low || z == high) return z;
    (there < 0 ? low : high) = z;
    (there < 0 ? at_low : at_high) = there;
    if (high - low < 1e-9) break;
  }
  return low - at_low * (high - low) / (at_high - at_low);
}

class LevelFinder {
 public:
  LevelFinder(const LayeredBody& body, const MapMesh& map, const CutMap& cut,
              const Pillars& pillars, const std::vector<DepthSurface>& horizons,
              std::vector<Problem>& problems)
      : body_(body),
        map_(map),
        cut_(cut),
        pillars_(pillars),
        horizons_(horizons),
        problems_(problems) {}

  Levels run();

 private:
  double depth_of(std::size_t horizon, std::size_t place, const MatrixXd& throws) const;
  void check_order();
  void check_beyond_ends();
  void complain(const std::string& pointer, const std::string& what, int vertex, double z,
                const std::string& cure) {
    const Vector3d at = pillars_.at(vertex, z);
    problems_.push_back(
        {pointer, 0, concat(what, " at x ", at.x(), ", y ", at.y(), ", z ", at.z(), " m"), cure});
  }

  const LayeredBody& body_;
  const MapMesh& map_;
  const CutMap& cut_;
  const Pillars& pillars_;
  const std::vector<DepthSurface>& horizons_;
  std::vector<Problem>& problems_;
  Levels levels_;
};

double LevelFinder::depth_of(std::size_t horizon, std::size_t place, const MatrixXd& throws) const {
  const int vertex = cut_.vertex[place];
  const double reach = body_.top - body_.base;
  // The depth that it had, of which the throw in depth is a function, and then where it lies now.
  return meet_pillar(body_.base - reach, body_.top + reach, [&](double z) {
    const double before = horizons_[horizon].at(pillars_.in_map(vertex, z));
    double moved = before;
    for (int f = 0; f < map_.n_faults; ++f)
      if (throws(static_cast<Eigen::Index>(place), f) != 0)
        moved +=
            throws(static_cast<Eigen::Index>(place), f) * throw_in_depth(body_.faults[f], before);
    return z - moved;
  });
}

void LevelFinder::check_order() {
  for (std::size_t k = 0; k <= body_.horizons.size(); ++k) {
    double worst = 0.02 * body_.cells.at_faults;
    std::size_t count = 0, where = 0;
    for (std::size_t p = 0; p < cut_.n_places(); ++p) {
      const std::vector<double>& z = levels_.horizons[p];
      const double above = k == 0 ? body_.top : z[k - 1];
      const double below = k == z.size() ? body_.base : z[k];
      count += above - below < 0.02 * body_.cells.at_faults;
      if (above - below >= worst) continue;
      worst = above - below;
      where = p;
    }
    if (count == 0) continue;
    const auto name = [&](std::size_t h) { return "\"" + body_.horizons[h].name + "\""; };
    const std::string above = k == 0 ? "the top of the box" : name(k - 1);
    const std::string below = k == body_.horizons.size() ? "the base of the box" : name(k);
    complain(concat("/horizons/", std::min(k, body_.horizons.size() - 1)),
             concat(above, " and ", below, " touch or cross, worst by ", -worst, " m"),
             cut_.vertex[where], k == 0 ? body_.top : levels_.horizons[where][k - 1],
             "keep a layer between them, less throw, or a box that holds them");
  }
}

/// Above and below a fault's ends both sides must have the same horizons.
void LevelFinder::check_beyond_ends() {
  const std::vector<MapSide> sides = sides_of(map_.triangles);
  for (const TracePiece& piece : trace_pieces(map_, sides)) {
    const int f = piece.fault;
    const int vertex = map_.lines[f][piece.k];
    const auto z_at = [&](int triangle, std::size_t horizon) {
      const auto corner = std::ranges::find(map_.triangles[triangle], vertex);
      const auto v = static_cast<std::size_t>(corner - map_.triangles[triangle].begin());
      return levels_.horizons[cut_.places[triangle][v]][horizon];
    };
    for (std::size_t k = 0; k < body_.horizons.size(); ++k) {
      const double left = z_at(piece.side->left, k), right = z_at(piece.side->right, k);
      const bool is_beyond = std::max(left, right) > levels_.top[f][piece.k] ||
                             std::min(left, right) < levels_.bottom[f][piece.k];
      if (!is_beyond || std::abs(left - right) < 1e-6 * body_.cells.at_faults) continue;
      complain(concat("/faults/", f),
               concat("\"", body_.horizons[k].name, "\" steps by ", std::abs(left - right),
                      " m beyond the end of \"", body_.faults[f].name, "\" in depth"),
               vertex, left, "let the fault end further up or down, or reduce the throw there");
      return;
    }
  }
}

Levels LevelFinder::run() {
  const MatrixXd throws = throw_fields(body_, map_, cut_);
  levels_.horizons.resize(cut_.n_places());
  for (std::size_t p = 0; p < cut_.n_places(); ++p)
    for (std::size_t k = 0; k < body_.horizons.size(); ++k)
      levels_.horizons[p].push_back(depth_of(k, p, throws));
  for (int f = 0; f < map_.n_faults; ++f) {
    const LayeredFault& fault = body_.faults[f];
    levels_.bottom.emplace_back(map_.lines[f].size(), fault.bottom.value_or(body_.base));
    levels_.top.emplace_back(map_.lines[f].size(), fault.top.value_or(body_.top));
  }
  check_order();
  if (problems_.empty()) snap_levels(body_, map_, cut_, levels_, problems_);
  if (problems_.empty()) check_beyond_ends();
  return std::move(levels_);
}

}  // namespace

Levels find_levels(const LayeredBody& body, const MapMesh& map, const CutMap& cut,
                   const Pillars& pillars, const std::vector<DepthSurface>& horizons,
                   std::vector<Problem>& problems) {
  return LevelFinder(body, map, cut, pillars, horizons, problems).run();
}

}  // namespace faultsim::horizons
