#include "simulator/horizons/levels.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/common/text.h"
#include "simulator/horizons/meet_pillar.h"
#include "simulator/horizons/sided_horizon.h"
#include "simulator/horizons/snapping.h"
#include "simulator/horizons/throws.h"

namespace faultsim::horizons {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

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
  double shift_of(std::size_t place, const MatrixXd& throws, double before) const;
  double meet(const SidedHorizon::Surface& surface, std::size_t place,
              const MatrixXd& throws) const;
  void find_depths(std::size_t horizon, const MatrixXd& throws);
  void find_sided_depths(const SidedHorizon& sided, const MatrixXd& throws);
  void hang(std::size_t horizon, const SidedHorizon* sided);
  std::vector<int> places_of(const SidedHorizon& sided) const;
  void find_all_depths();
  void check_order();
  void check_beyond_ends();
  void complain(const std::string& pointer, const std::string& what, int vertex, double z,
                const std::string& cure) {
    const Vector3d at = pillars_.at(vertex, z);
    problems_.push_back({pointer, 0,
                         concat(what, " at x ", decimal(at.x(), 1), ", y ", decimal(at.y(), 1),
                                ", z ", decimal(at.z(), 1), " m"),
                         cure});
  }

  const LayeredBody& body_;
  const MapMesh& map_;
  const CutMap& cut_;
  const Pillars& pillars_;
  const std::vector<DepthSurface>& horizons_;
  std::vector<Problem>& problems_;
  Levels levels_;
};

double LevelFinder::shift_of(std::size_t place, const MatrixXd& throws, double before) const {
  double shift = 0;
  for (int f = 0; f < map_.n_faults; ++f)
    if (throws(static_cast<Eigen::Index>(place), f) != 0)
      shift +=
          throws(static_cast<Eigen::Index>(place), f) * throw_in_depth(body_.faults[f], before);
  return shift;
}

/// Where a place's pillar meets a surface: the depth that it had, of which the throw in depth is a
/// function, and then where it lies now.
double LevelFinder::meet(const SidedHorizon::Surface& surface, std::size_t place,
                         const MatrixXd& throws) const {
  const double reach = body_.top - body_.base;
  return meet_pillar(body_.base - reach, body_.top + reach, [&](double z) {
    const double before = surface(pillars_.in_map(cut_.vertex[place], z));
    return z - (before + shift_of(place, throws, before));
  });
}

void LevelFinder::find_depths(std::size_t horizon, const MatrixXd& throws) {
  const SidedHorizon::Surface surface = [&](const Eigen::Vector2d& xy) {
    return horizons_[horizon].at(xy);
  };
  for (std::size_t p = 0; p < cut_.n_places(); ++p)
    levels_.horizons[p].push_back(meet(surface, p, throws));
}

/// A horizon's own places, per place of the map.
std::vector<int> LevelFinder::places_of(const SidedHorizon& sided) const {
  std::vector<int> own(cut_.n_places());
  for (std::size_t t = 0; t < map_.triangles.size(); ++t)
    for (std::size_t v = 0; v < 3; ++v) own[cut_.places[t][v]] = sided.cut().places[t][v];
  return own;
}

/// A horizon at its thickness below the one above. @param sided  of the points that both have.
void LevelFinder::hang(std::size_t horizon, const SidedHorizon* sided) {
  const DepthSurface& surface = horizons_[horizon];
  if (sided != nullptr) {
    const std::vector<int> own = places_of(*sided);
    const std::vector<double> thickness = sided->beside(surface.thickness());
    for (std::size_t p = 0; p < cut_.n_places(); ++p)
      levels_.horizons[p].push_back(levels_.horizons[p].back() - thickness[own[p]]);
    return;
  }
  std::size_t first = horizon;  // that has the points
  while (!horizons_[first].thickness().empty()) --first;
  for (std::size_t p = 0; p < cut_.n_places(); ++p) {
    std::vector<double>& z = levels_.horizons[p];
    const Eigen::Vector2d at = pillars_.in_map(cut_.vertex[p], z[first]);
    z.push_back(z.back() - surface.scattered()->support_at(at).of(surface.thickness()));
  }
}

void LevelFinder::find_sided_depths(const SidedHorizon& sided, const MatrixXd& throws) {
  const std::vector<int> own = places_of(sided);
  for (std::size_t p = 0; p < cut_.n_places(); ++p) {
    const bool is_moved = !throws.row(static_cast<Eigen::Index>(p)).isZero(0);
    const double z = is_moved ? sided.depth(own[p],
                                            [&](const SidedHorizon::Surface& surface) {
                                              return meet(surface, p, throws);
                                            })
                              : sided.depth(own[p]);
    levels_.horizons[p].push_back(z);
  }
}

/// Of all horizons; those of points on sides of their own where a fault has no throw.
void LevelFinder::find_all_depths() {
  const MatrixXd throws = throw_fields(body_, map_, cut_);
  levels_.horizons.resize(cut_.n_places());
  const std::vector<MapSide> sides = sides_of(map_.triangles);
  const MapLocator locator(body_, map_, sides, pillars_);
  const bool has_sides =
      std::ranges::any_of(body_.faults, [](const LayeredFault& fault) { return !fault.moved; });
  std::optional<SidedHorizon> sided;  // of the points last met
  for (std::size_t k = 0; k < horizons_.size(); ++k) {
    if (!horizons_[k].thickness().empty()) {
      if (problems_.empty()) hang(k, sided ? &*sided : nullptr);
      continue;
    }
    const PointSurface* points = horizons_[k].scattered();
    sided.reset();
    if (points == nullptr || !has_sides) {
      find_depths(k, throws);
      continue;
    }
    sided.emplace(SidedGround{body_, map_, sides, pillars_, locator}, static_cast<int>(k), *points,
                  problems_);
    if (problems_.empty()) find_sided_depths(*sided, throws);
  }
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
             concat(above, " and ", below,
                    worst > 0 ? concat(" touch: ", decimal(worst, 2), " m between them")
                              : concat(" cross, worst by ", decimal(-worst, 1), " m")),
             cut_.vertex[where], k == 0 ? body_.top : levels_.horizons[where][k - 1],
             "keep a layer between them, reduce the throw, or use a box that contains them");
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
  find_all_depths();
  if (!problems_.empty()) return std::move(levels_);
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
