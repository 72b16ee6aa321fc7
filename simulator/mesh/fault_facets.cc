#include "simulator/mesh/fault_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

/// What was wrong with some facets of a group: how many, and the first.
struct Faulty {
  std::size_t count = 0;
  std::array<int, 4> first = {-1, -1, -1, -1};
  void add(const std::array<int, 4>& facet) {
    if (count++ == 0) first = facet;
  }
};

std::size_t n_corners(const std::array<int, 4>& facet) { return facet[3] < 0 ? 3 : 4; }

/// A fault's facets and the edges at which they join.
class Orienter {
 public:
  Orienter(const UncutMesh& body, const CellFaces& faces, std::vector<FaultFacet>& facets)
      : body_(body), faces_(faces), facets_(facets) {
    for (std::size_t k = 0; k < facets.size(); ++k) {
      const std::array<int, 4>& at = facets[k].corners;
      for (std::size_t v = 0; v < n_corners(at); ++v) {
        const int from = at[v], to = at[(v + 1) % n_corners(at)];
        edges_.push_back({std::minmax(from, to), static_cast<int>(k)});
      }
    }
    std::ranges::sort(edges_);
  }

  /// Turns facets so that all of a connected part look the same way; where that cannot be, says so.
  void run(const std::string& name, std::vector<Problem>& problems) {
    for (std::size_t first = 0; first < edges_.size();) {
      std::size_t last = first;
      while (last < edges_.size() && edges_[last].first == edges_[first].first) ++last;
      if (last - first > 2) {
        branching_.add({edges_[first].first.first, edges_[first].first.second, -1, -1});
      }
      first = last;
    }
    done_.assign(facets_.size(), false);
    for (std::size_t k = 0; k < facets_.size(); ++k)
      if (!done_[k]) orient_part(static_cast<int>(k));
    report(name, problems);
  }

 private:
  using Edge = std::pair<std::pair<int, int>, int>;  ///< its ends, and a facet at it.

  void turn(FaultFacet& facet) {
    const CellFace& face = faces_.faces[facet.face];
    const bool was_first = facet.minus_cell == face.cells[0];
    const std::size_t n = corners_of_cell(body_.shape);
    std::swap(facet.minus_cell, facet.plus_cell);
    facet.corners = corners_of_face(
        body_.shape,
        std::span(body_.corners).subspan(n * static_cast<std::size_t>(facet.minus_cell), n),
        face.place[was_first ? 1 : 0]);
  }

  /// True where a facet runs along an edge from its lower to its higher end.
  bool ascends(int facet, const std::pair<int, int>& ends) const {
    const std::array<int, 4>& at = facets_[facet].corners;
    const std::size_t n = n_corners(at);
    for (std::size_t v = 0; v < n; ++v)
      if (at[v] == ends.first && at[(v + 1) % n] == ends.second) return true;
    return false;
  }

  void orient_part(int first) {
    std::vector<int> part = {first};
    done_[first] = true;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const int facet = part[next];
      const std::array<int, 4> at = facets_[facet].corners;
      for (std::size_t v = 0; v < n_corners(at); ++v) {
        const std::pair<int, int> ends = std::minmax(at[v], at[(v + 1) % n_corners(at)]);
        visit(facet, ends, part);
      }
    }
    Vector3d sum = Vector3d::Zero();
    for (const int facet : part) sum += area_vector(body_.nodes, facets_[facet].corners);
    if (is_turned(sum))
      for (const int facet : part) turn(facets_[facet]);
  }

  void visit(int facet, const std::pair<int, int>& ends, std::vector<int>& part) {
    auto edge = std::ranges::lower_bound(edges_, Edge{ends, -1});
    for (; edge != edges_.end() && edge->first == ends; ++edge) {
      if (edge->second == facet) continue;
      const bool alike = ascends(facet, ends) != ascends(edge->second, ends);
      if (done_[edge->second]) {
        if (!alike) turning_.add(facets_[facet].corners);
        continue;
      }
      if (!alike) turn(facets_[edge->second]);
      done_[edge->second] = true;
      part.push_back(edge->second);
    }
  }

  /// Whether a mean normal points to smaller x, or y where it is across x, or down.
  static bool is_turned(const Vector3d& normal) {
    constexpr double kAcross = 1e-3;
    for (int c = 0; c < 3; ++c)
      if (std::abs(normal[c]) > kAcross * normal.norm()) return normal[c] < 0;
    return false;
  }

  void report(const std::string& name, std::vector<Problem>& problems) const {
    if (branching_.count > 0) {
      const Vector3d middle =
          (body_.nodes[branching_.first[0]] + body_.nodes[branching_.first[1]]) / 2;
      problems.push_back({"", 0,
                          concat("fault \"", name, "\" branches along ",
                                 counted(branching_.count, "edge", "edges"), ", the first at ",
                                 place_text(middle)),
                          "give each branch a name of its own"});
    } else if (turning_.count > 0) {
      problems.push_back({"", 0,
                          concat("fault \"", name, "\" has one side only: it turns them at ",
                                 place_of(body_.nodes, turning_.first)),
                          "divide it into faults with two sides each"});
    }
  }

  const UncutMesh& body_;
  const CellFaces& faces_;
  std::vector<FaultFacet>& facets_;
  std::vector<Edge> edges_;
  std::vector<bool> done_;
  Faulty branching_, turning_;
};

/// The facets of a fault that are faces of two cells.
std::vector<FaultFacet> facets_inside(const UncutMesh& body, const CellFaces& faces,
                                      const FacetGroup& fault, std::vector<int>& fault_of,
                                      int number, std::vector<Problem>& problems) {
  std::vector<FaultFacet> found;
  Faulty lost, outside, shared;
  int other = -1;
  const std::size_t n = corners_of_cell(body.shape);
  for (const std::array<int, 4>& facet : fault.facets) {
    const int at = faces.find(facet);
    if (at < 0) {
      lost.add(facet);
    } else if (faces.faces[at].cells[1] < 0) {
      outside.add(facet);
    } else if (fault_of[at] == number) {
      continue;  // said twice
    } else if (fault_of[at] >= 0) {
      shared.add(facet);
      other = fault_of[at];
    } else {
      fault_of[at] = number;
      const CellFace& face = faces.faces[at];
      const auto cell = static_cast<std::size_t>(face.cells[0]);
      found.push_back(
          {at,
           corners_of_face(body.shape, std::span(body.corners).subspan(n * cell, n), face.place[0]),
           face.cells[0], face.cells[1]});
    }
  }
  const auto say = [&](const Faulty& some, const std::string& what, const std::string& cure) {
    if (some.count == 0) return;
    problems.push_back({"", 0,
                        concat("fault \"", fault.name, "\": ", some.count, " of ",
                               counted(fault.facets.size(), "facet", "facets"), " ", what,
                               ", the first at ", place_of(body.nodes, some.first)),
                        cure});
  };
  say(lost, "are not faces of cells", "embed the fault in the volumes before they are meshed");
  say(outside, "are on the outside of the body",
      "let the fault end at the outside or leave it out");
  if (other >= 0)
    say(shared, concat("belong to \"", body.faults[other].name, "\" too"),
        "let each facet belong to one fault");
  return found;
}

}  // namespace

Vector3d area_vector(const std::vector<Vector3d>& nodes, const std::array<int, 4>& corners) {
  const Vector3d &a = nodes[corners[0]], &b = nodes[corners[1]], &c = nodes[corners[2]];
  if (corners[3] < 0) return (b - a).cross(c - a) / 2;
  return (c - a).cross(nodes[corners[3]] - b) / 2;
}

std::string place_text(const Vector3d& at) {
  return formatted("x %.7g, y %.7g, z %.7g m", at.x() + 0.0, at.y() + 0.0, at.z() + 0.0);
}

std::string place_of(const std::vector<Vector3d>& nodes, const std::array<int, 4>& corners) {
  Vector3d sum = Vector3d::Zero();
  const std::size_t n = n_corners(corners);
  for (std::size_t v = 0; v < n; ++v) sum += nodes[corners[v]] / static_cast<double>(n);
  return place_text(sum);
}

std::vector<std::vector<FaultFacet>> fault_facets(const UncutMesh& body, const CellFaces& faces,
                                                  std::vector<Problem>& problems) {
  std::vector<int> fault_of(faces.faces.size(), -1);
  std::vector<std::vector<FaultFacet>> all;
  for (std::size_t f = 0; f < body.faults.size(); ++f) {
    all.push_back(
        facets_inside(body, faces, body.faults[f], fault_of, static_cast<int>(f), problems));
    Orienter(body, faces, all.back()).run(body.faults[f].name, problems);
    if (all.back().empty())
      problems.push_back({"", 0, concat("fault \"", body.faults[f].name, "\" has no facet inside"),
                          "leave it out"});
  }
  return all;
}

std::vector<std::vector<CellFace>> boundary_facets(const UncutMesh& body, const CellFaces& faces,
                                                   std::vector<Problem>& problems) {
  std::vector<std::vector<CellFace>> all;
  for (const FacetGroup& group : body.boundary) {
    std::vector<CellFace>& own = all.emplace_back();
    std::size_t n_bad = 0;
    std::array<int, 4> first = {};
    for (const std::array<int, 4>& facet : group.facets) {
      const int at = faces.find(facet);
      if (at >= 0 && faces.faces[at].cells[1] < 0) {
        own.push_back(faces.faces[at]);
      } else if (n_bad++ == 0) {
        first = facet;
      }
    }
    if (n_bad == 0) continue;
    problems.push_back(
        {"", 0,
         concat("boundary \"", group.name, "\": ", n_bad, " of ",
                counted(group.facets.size(), "facet", "facets"),
                " are not on the outside of the body, the first at ", place_of(body.nodes, first)),
         "let its surfaces bound the volumes, on one side only"});
  }
  return all;
}

}  // namespace faultsim
