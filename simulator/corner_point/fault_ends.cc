#include "simulator/corner_point/fault_ends.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "simulator/corner_point/fault_description.h"
#include "simulator/corner_point/straight_trace.h"

namespace faultsim::corner_point {
namespace {

/// A fault at a pillar, which is its nth.
struct Passage {
  int fault = -1, nth = 0;
};
using Passages = std::map<int, std::vector<Passage>>;

Passages passages_of(const std::vector<Fault>& faults) {
  Passages all;
  for (int f = 0; f < static_cast<int>(faults.size()); ++f) {
    const std::vector<int> pillars = pillars_of(faults[f]);
    for (int nth = 0; nth < static_cast<int>(pillars.size()); ++nth)
      all[pillars[nth]].push_back({f, nth});
  }
  return all;
}

bool is_closed(const Fault& fault) { return fault.edges.front().from == fault.edges.back().to; }
bool is_within(const Fault& fault, int nth) {
  return is_closed(fault) || (nth > 0 && nth < static_cast<int>(fault.edges.size()));
}

double largest_signed(const FaultEdge& edge) {
  return std::abs(edge.least) > std::abs(edge.most) ? edge.least : edge.most;
}

FaultEnd end_of(const ColumnMap& map, const std::vector<Fault>& faults, const Passages& passages,
                int f, bool is_last) {
  const Fault& fault = faults[f];
  const FaultEdge& edge = is_last ? fault.edges.back() : fault.edges.front();
  FaultEnd end;
  end.pillar = is_last ? edge.to : edge.from;
  end.offset = largest_signed(edge);
  end.tapers = std::abs(end.offset) < fault.largest_offset / 2;
  if (is_closed(fault)) {
    end.kind = EndKind::closed;
    return end;
  }
  for (const Passage& passage : passages.at(end.pillar)) {
    if (passage.fault == f) continue;
    const bool goes_through = is_within(faults[passage.fault], passage.nth);
    if (end.other < 0 || goes_through) end.other = passage.fault;
  }
  end.kind = end.other >= 0               ? EndKind::junction
             : map.is_at_edge(end.pillar) ? EndKind::grid_edge
                                          : EndKind::tip;
  return end;
}

/// Where a line, prolonged at its last piece, meets another within reach, m; and nothing where it
/// would turn back on itself.
std::optional<Eigen::Vector2d> meeting(const Eigen::Vector2d& before, const Eigen::Vector2d& end,
                                       const std::vector<Eigen::Vector2d>& other, double reach) {
  std::optional<Eigen::Vector2d> best;
  const Eigen::Vector2d along = end - before;
  for (std::size_t k = 0; k + 1 < other.size(); ++k) {
    const Eigen::Vector2d piece = other[k + 1] - other[k];
    const double sine = cross_product(along, piece);
    if (sine == 0) continue;
    const Eigen::Vector2d away = other[k] - before;
    const double s = cross_product(away, piece) / sine, t = cross_product(away, along) / sine;
    if (s <= 0 || t < 0 || t > 1) continue;
    const Eigen::Vector2d point = before + s * along;
    const double distance = (point - end).norm();
    if (distance <= reach && (!best || distance < (*best - end).norm())) best = point;
  }
  return best;
}

void move_ends_onto_others(std::vector<Fault>& faults) {
  constexpr double kReach = 2;  // cells: either trace is within half of one of its chain
  std::vector<std::vector<Eigen::Vector2d>> traces;
  for (const Fault& fault : faults) traces.push_back(fault.trace);
  for (Fault& fault : faults) {
    for (const bool is_last : {false, true}) {
      const FaultEnd& at = is_last ? fault.end : fault.begin;
      if (at.kind != EndKind::junction) continue;
      Eigen::Vector2d& end = is_last ? fault.trace.back() : fault.trace.front();
      const Eigen::Vector2d& before =
          is_last ? fault.trace[fault.trace.size() - 2] : fault.trace[1];
      const std::vector<Eigen::Vector2d>& other = traces[at.other];
      const std::optional<Eigen::Vector2d> point = meeting(before, end, other, kReach * fault.cell);
      end = point ? *point : nearest_on_line(other, end).point;
    }
  }
}

/// Faults that run through the same pillars: of those in a row the middle one.
void add_crossings(const std::vector<Fault>& faults, const Passages& passages,
                   std::vector<Junction>& junctions) {
  std::map<std::pair<int, int>, std::vector<int>> shared;  // of the first: which pillars
  for (const auto& [pillar, here] : passages) {
    for (std::size_t a = 0; a < here.size(); ++a) {
      for (std::size_t b = a + 1; b < here.size(); ++b) {
        const Passage &one = here[a], &other = here[b];
        const bool both_go_on =
            is_within(faults[one.fault], one.nth) && is_within(faults[other.fault], other.nth);
        if (one.fault != other.fault && both_go_on)
          shared[{one.fault, other.fault}].push_back(one.nth);
      }
    }
  }
  for (auto& [pair, nth] : shared) {
    std::ranges::sort(nth);
    for (std::size_t begin = 0; begin < nth.size();) {
      std::size_t end = begin + 1;
      while (end < nth.size() && nth[end] == nth[end - 1] + 1) ++end;
      const int middle = nth[(begin + end - 1) / 2];
      junctions.push_back({true, pair.first, pair.second, pillars_of(faults[pair.first])[middle],
                           faults[pair.first].pillars[middle]});
      begin = end;
    }
  }
}

class Extension {
 public:
  Extension(const ColumnMap& map, const std::set<int>& on_faults, double reference_z)
      : map_(map), on_faults_(on_faults), z_(reference_z) {}

  /// Edges from a pillar in a direction, next to the straight line; none where there is no way.
  std::vector<FaultEdge> from(int pillar, const Eigen::Vector2d& direction) const {
    std::vector<FaultEdge> edges;
    const Eigen::Vector2d begin = at(pillar);
    const int most = map_.grid().size[0] + map_.grid().size[1];
    while (static_cast<int>(edges.size()) < most) {
      const int next = next_pillar(pillar, begin, direction);
      if (next < 0) return {};
      edges.push_back(map_.measured(pillar, next));
      pillar = next;
      if (map_.is_at_edge(pillar) || on_faults_.contains(pillar)) return edges;
    }
    return {};
  }

 private:
  Eigen::Vector2d at(int pillar) const { return map_.grid().pillars[pillar].at(z_); }

  int next_pillar(int pillar, const Eigen::Vector2d& begin,
                  const Eigen::Vector2d& direction) const {
    int best = -1;
    double least = 0;
    for (const int next : map_.neighbours(pillar)) {
      const std::array<int, 2> columns = map_.sides(pillar, next);
      const bool goes_on = (at(next) - at(pillar)).dot(direction) > 0;
      if (!goes_on || !map_.is_inside(columns[0]) || !map_.is_inside(columns[1])) continue;
      // The middle of the edge, as of a trace.
      const Eigen::Vector2d middle = (at(next) + at(pillar)) / 2;
      const double distance = std::abs(cross_product(direction, middle - begin));
      if (best >= 0 && distance >= least) continue;
      best = next;
      least = distance;
    }
    return best;
  }

  const ColumnMap& map_;
  const std::set<int>& on_faults_;
  double z_;
};

}  // namespace

std::vector<Junction> meet_faults(const ColumnMap& map, std::vector<Fault>& faults) {
  const Passages passages = passages_of(faults);
  for (int f = 0; f < static_cast<int>(faults.size()); ++f) {
    faults[f].begin = end_of(map, faults, passages, f, false);
    faults[f].end = end_of(map, faults, passages, f, true);
  }
  move_ends_onto_others(faults);
  std::vector<Junction> junctions;
  for (int f = 0; f < static_cast<int>(faults.size()); ++f) {
    Fault& fault = faults[f];
    fault.length = line_length(fault.trace);
    for (const Eigen::Vector2d& pillar : fault.pillars)
      fault.along.push_back(nearest_on_line(fault.trace, pillar).along);
    for (const bool is_last : {false, true}) {
      const FaultEnd& end = is_last ? fault.end : fault.begin;
      if (end.kind != EndKind::junction) continue;
      junctions.push_back(
          {false, f, end.other, end.pillar, is_last ? fault.trace.back() : fault.trace.front()});
    }
  }
  add_crossings(faults, passages, junctions);
  return junctions;
}

void extend_tips(const ColumnMap& map, std::vector<Fault>& faults, double reference_z) {
  std::set<int> on_faults;
  for (const Fault& fault : faults) {
    for (const int pillar : pillars_of(fault)) on_faults.insert(pillar);
  }
  const Extension extension(map, on_faults, reference_z);
  for (Fault& fault : faults) {
    for (const bool is_last : {false, true}) {
      FaultEnd& end = is_last ? fault.end : fault.begin;
      if (end.kind != EndKind::tip) continue;
      const std::size_t n = fault.trace.size();
      const Eigen::Vector2d direction =
          is_last ? fault.trace[n - 1] - fault.trace[n - 2] : fault.trace[0] - fault.trace[1];
      const std::vector<FaultEdge> edges = extension.from(end.pillar, direction.normalized());
      end.n_extension = static_cast<int>(edges.size());
      fault.extension.insert(fault.extension.end(), edges.begin(), edges.end());
    }
  }
}

}  // namespace faultsim::corner_point
