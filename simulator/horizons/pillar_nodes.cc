#include "simulator/horizons/pillar_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/common/ranges.h"

namespace faultsim::horizons {
namespace {

constexpr double kEndApart = 0.3;  // of a cell

/// Where along a pillar cells are smallest, m; empty if low > high.
struct FineReach {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double away(double z) const { return low > high ? 0 : std::max({low - z, z - high, 0.0}); }
};

std::vector<bool> fine_layers(const LayeredBody& body) {
  std::vector<bool> fine;
  for (const BodyLayer& layer : body.layers) fine.push_back(layer.is_fine);
  for (const Compartment& one : body.compartments)
    for (std::size_t k = 0; k < one.region.size(); ++k)
      if (one.region[k] >= 0) fine[k] = true;
  return fine;
}

class NodePlacer {
 public:
  NodePlacer(const LayeredBody& body, const MapMesh& map, const CutMap& cut, const Levels& levels)
      : body_(body), map_(map), cut_(cut), levels_(levels), fine_(fine_layers(body)) {}
  PillarNodes run();

 private:
  FineReach reach_at(int vertex) const;
  void fill(std::vector<double>& z, double to, double size, const FineReach& reach) const;
  std::vector<std::vector<double>> kept_depths() const;
  void add_ends(std::size_t vertex, std::vector<double>& depths) const;

  const LayeredBody& body_;
  const MapMesh& map_;
  const CutMap& cut_;
  const Levels& levels_;
  std::vector<bool> fine_;
};

FineReach NodePlacer::reach_at(int vertex) const {
  FineReach reach;
  for (const int place : cut_.at[vertex]) {
    const std::vector<double>& horizons = levels_.horizons[place];
    for (std::size_t k = 0; k < fine_.size(); ++k) {
      if (!fine_[k]) continue;
      reach.high = std::max(reach.high, k == 0 ? body_.top : horizons[k - 1]);
      reach.low = std::min(reach.low, k == horizons.size() ? body_.base : horizons[k]);
    }
  }
  return reach;
}

/// Appends points up to `to`, at distances in proportion to sizes and at most 1.2 of them.
void NodePlacer::fill(std::vector<double>& z, double to, double size,
                      const FineReach& reach) const {
  constexpr std::size_t kSteps = 64;
  constexpr double kSlenderest = 8;  // cells as tall as this many times their width are flat
  const double tallest = std::min(body_.cells.far, kSlenderest * size);
  const double from = z.back(), step = (to - from) / kSteps;
  std::array<double, kSteps + 1> cells = {0};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double away = reach.away(from + step * (static_cast<double>(i) + 0.5));
    cells[i + 1] = cells[i] + step / std::min(tallest, size + body_.cells.growth * away);
  }
  constexpr double kTallest = 1.2;  // of a size: tall steps beside leaning pillars are steep
  const int n = std::max(1, static_cast<int>(std::ceil(cells.back() / kTallest)));
  std::size_t i = 0;
  for (int k = 1; k < n; ++k) {
    const double want = cells.back() * k / n;
    while (cells[i + 1] < want) ++i;
    const double part = (want - cells[i]) / (cells[i + 1] - cells[i]);
    z.push_back(from + step * (static_cast<double>(i) + part));
  }
  z.push_back(to);
}

std::vector<std::vector<double>> NodePlacer::kept_depths() const {
  std::vector<std::vector<double>> kept(map_.vertices.size(), {body_.base, body_.top});
  for (std::size_t place = 0; place < cut_.n_places(); ++place)
    for (const double z : levels_.horizons[place]) kept[cut_.vertex[place]].push_back(z);
  for (int f = 0; f < map_.n_faults; ++f)
    for (std::size_t k = 0; k < map_.lines[f].size(); ++k)
      for (const double z : {levels_.bottom[f][k], levels_.top[f][k]})
        kept[map_.lines[f][k]].push_back(z);
  for (std::size_t v = 0; v < kept.size(); ++v) {
    std::ranges::sort(kept[v]);
    drop_repeated(kept[v]);
    add_ends(v, kept[v]);
  }
  return kept;
}

/// All pillars have a node where a fault ends in depth: where some had one and their neighbours
/// none, cells between them would be steep, and leaning pillars would turn them inside out. Away
/// from the fault it keeps a distance from horizons; layers too thin for it go without.
void NodePlacer::add_ends(std::size_t vertex, std::vector<double>& depths) const {
  const double apart = kEndApart * map_.size[vertex];
  std::vector<double> ends;
  for (int f = 0; f < map_.n_faults; ++f)
    for (std::size_t k = 0; k < map_.lines[f].size(); ++k)
      if (map_.lines[f][k] == static_cast<int>(vertex))
        ends.insert(ends.end(), {levels_.bottom[f][k], levels_.top[f][k]});
  for (const LayeredFault& fault : body_.faults)
    for (const std::optional<double>& end : {fault.bottom, fault.top}) {
      const auto is_near = [&](double other) { return std::abs(other - *end) < apart; };
      if (!end || std::ranges::any_of(ends, is_near)) continue;
      const auto above = std::ranges::lower_bound(depths, *end);
      if (above == depths.begin() || above == depths.end()) continue;
      const double low = *(above - 1) + apart, high = *above - apart;
      if (low > high) continue;
      ends.push_back(*end);
      depths.insert(above, std::clamp(*end, low, high));
    }
}

PillarNodes NodePlacer::run() {
  PillarNodes nodes;
  const std::vector<std::vector<double>> kept = kept_depths();
  for (std::size_t v = 0; v < kept.size(); ++v) {
    const FineReach reach = reach_at(static_cast<int>(v));
    std::vector<double> z = {kept[v].front()};
    for (std::size_t k = 1; k < kept[v].size(); ++k) fill(z, kept[v][k], map_.size[v], reach);
    nodes.first.push_back(nodes.n_nodes);
    nodes.n_nodes += static_cast<int>(z.size());
    nodes.z.push_back(std::move(z));
  }
  const auto rank = [&](int vertex, double z) {
    const std::vector<double>& all = nodes.z[vertex];
    return static_cast<int>(std::ranges::lower_bound(all, z) - all.begin());
  };
  nodes.horizon_rank.resize(cut_.n_places());
  for (std::size_t p = 0; p < cut_.n_places(); ++p)
    for (const double z : levels_.horizons[p])
      nodes.horizon_rank[p].push_back(rank(cut_.vertex[p], z));
  for (int f = 0; f < map_.n_faults; ++f) {
    nodes.bottom_rank.emplace_back();
    nodes.top_rank.emplace_back();
    for (std::size_t k = 0; k < map_.lines[f].size(); ++k) {
      nodes.bottom_rank[f].push_back(rank(map_.lines[f][k], levels_.bottom[f][k]));
      nodes.top_rank[f].push_back(rank(map_.lines[f][k], levels_.top[f][k]));
    }
  }
  return nodes;
}

}  // namespace

PillarNodes nodes_on_pillars(const LayeredBody& body, const MapMesh& map, const CutMap& cut,
                             const Levels& levels) {
  return NodePlacer(body, map, cut, levels).run();
}

int layer_above(const std::vector<int>& horizon_rank, int rank) {
  return static_cast<int>(
      std::ranges::count_if(horizon_rank, [&](int horizon) { return horizon > rank; }));
}

}  // namespace faultsim::horizons
