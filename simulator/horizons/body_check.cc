#include "simulator/horizons/body_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/text.h"

namespace faultsim::horizons {
namespace {

class NumberCheck {
 public:
  explicit NumberCheck(std::vector<Problem>& problems) : problems_(problems) {}

  void demand(bool holds, const std::string& pointer, const std::string& what,
              const std::string& cure) {
    if (!holds) problems_.push_back({pointer, 0, what, cure});
  }

 private:
  std::vector<Problem>& problems_;
};

void check_box(const LayeredBody& body, NumberCheck& check) {
  const bool is_box = (body.high - body.low).minCoeff() > 0 && body.top > body.base &&
                      body.low.allFinite() && body.high.allFinite() &&
                      std::isfinite(body.top - body.base);
  check.demand(is_box, "/box", "the box has no volume",
               "give low x, y and base below high and top");
  check.demand(body.layers.size() == body.horizons.size() + 1, "/layers",
               concat(counted(body.horizons.size(), "horizon bounds ", "horizons bound "),
                      body.horizons.size() + 1, " layers, not ", body.layers.size()),
               "give one layer more than horizons");
  const BodyCells& cells = body.cells;
  check.demand(cells.at_faults > 0 && cells.far >= cells.at_faults && cells.growth > 0 &&
                   std::isfinite(cells.far) && !(cells.at_dividers <= 0),
               "/cells", "the sizes of cells make no sense",
               "give 0 < at_faults <= far, and a growth above 0");
}

/// rad from the horizontal, of the flattest piece of a sorted profile.
double least_dip(const DipProfile& profile) {
  double least = std::numbers::pi / 2;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    least = std::min(least, std::atan2(profile[k + 1].z - profile[k].z,
                                       std::abs(profile[k + 1].shift - profile[k].shift)));
  return least;
}

void check_profile(DipProfile profile, const std::string& name, const std::string& pointer,
                   NumberCheck& check) {
  constexpr double kLeast = 5 * std::numbers::pi / 180, kSlack = 1e-9;
  std::ranges::sort(profile, {}, &DipPoint::z);
  bool is_line = profile.size() >= 2;
  for (const DipPoint& point : profile)
    is_line = is_line && std::isfinite(point.z) && std::isfinite(point.shift);
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    is_line = is_line && profile[k].z < profile[k + 1].z;
  check.demand(is_line, pointer, concat("a profile of ", name, " does not go down"),
               "give two or more points, each at a different depth");
  if (!is_line) return;
  const double dip = least_dip(profile);
  check.demand(dip >= kLeast - kSlack, pointer,
               concat(name, " dips by ", decimal(dip * 180 / std::numbers::pi, 3), " degrees"),
               "let it dip by 5 to 90 degrees");
}

void check_profiles(const LayeredFault& fault, const std::string& pointer, NumberCheck& check) {
  const std::string name = "\"" + fault.name + "\"";
  const std::size_t n = fault.profiles.size();
  check.demand(n <= 1 || n == fault.trace.size(), pointer,
               concat(name, " has ", n, " profiles for ",
                      counted(fault.trace.size(), "point", "points"), " of its trace"),
               "give one for all of it, or one for each point");
  for (std::size_t k = 0; k < n; ++k)
    check_profile(fault.profiles[k], name, concat(pointer, "/", k), check);
}

void check_fault(const LayeredBody& body, const LayeredFault& fault, const std::string& pointer,
                 NumberCheck& check) {
  const std::string name = "\"" + fault.name + "\"";
  check_profiles(fault, pointer + "/profiles", check);
  const double top = fault.top.value_or(body.top), bottom = fault.bottom.value_or(body.base);
  check.demand(
      top <= body.top && bottom >= body.base && top - bottom > body.cells.at_faults, pointer,
      concat(name, " reaches from z ", decimal(bottom, 1), " to z ", decimal(top, 1), " m"),
      "give a top above its bottom by more than a cell, within the box");
  if (!fault.moved) return;
  const FaultThrow& moved = *fault.moved;
  check.demand(
      std::isfinite(moved.down) && moved.left_share >= 0 && moved.left_share <= 1 &&
          moved.reach > 0 && !(moved.taper < 0),
      pointer + "/throw", concat("the throw of ", name, " makes no sense"),
      "give metres, a share of the left side in [0, 1], a reach above 0 and a taper of 0 or more");
}

/// m, of a trace; pieces that leave the box count as its diagonal at most.
double clipped_length(const std::vector<Eigen::Vector2d>& trace, double diagonal) {
  double length = 0;
  for (std::size_t k = 0; k + 1 < trace.size(); ++k)
    length += std::min((trace[k + 1] - trace[k]).norm(), diagonal);
  return length;
}

/// About how many tetrahedra a body takes, often some 30 % too few: regular ones of the size that
/// cells have at a distance from each line of the map, on both sides and along all of its depths,
/// but nowhere finer than at faults; and of the largest size in all of the box.
double cells_needed(const LayeredBody& body) {
  constexpr double kPerCube = 6.93;  // three of a prism, on 4/√3 triangles in a square
  const BodyCells& cells = body.cells;
  const Eigen::Vector2d extent = body.high - body.low;
  const double area = extent.prod(), depth = body.top - body.base, diagonal = extent.norm();
  // ∫ 2 dy / (h + g y)³ from the line to where cells are largest, for each area of it.
  const auto beside = [&](double size) {
    return std::max(0.0, 1 / std::pow(size, 2) - 1 / std::pow(cells.far, 2)) / cells.growth;
  };
  double fine = 0;
  for (const LayeredFault& fault : body.faults) {
    const double height = fault.top.value_or(body.top) - fault.bottom.value_or(body.base);
    fine += clipped_length(fault.trace, diagonal) * height * beside(cells.at_faults);
  }
  for (const Divider& divider : body.dividers)
    fine += clipped_length(divider.line, diagonal) * depth * beside(cells.beside_dividers());
  fine = std::min(fine, area * depth / std::pow(cells.at_faults, 3));
  return kPerCube * (fine + area * depth / std::pow(cells.far, 3));
}

/// Before they are made: "5 mm" for "5 m" would take all memory, after minutes.
void check_cells(const LayeredBody& body, std::vector<Problem>& problems) {
  constexpr double kMost = 1e7;  // 40 million unknowns, which no path solves in 100 GB
  const double needed = cells_needed(body);
  if (needed <= kMost) return;
  problems.push_back({"/cells", 0,
                      concat("cells of ", decimal(body.cells.at_faults, 3), " m at the faults and ",
                             decimal(body.cells.far, 3), " m at most would make a body of about ",
                             formatted("%.0f", needed / 1e6), " million cells"),
                      "take larger cells: at most 10 million are built"});
}

}  // namespace

void check_numbers(const LayeredBody& body, std::vector<Problem>& problems) {
  NumberCheck check(problems);
  check_box(body, check);
  for (std::size_t f = 0; f < body.faults.size(); ++f)
    check_fault(body, body.faults[f], concat("/faults/", f), check);
  for (std::size_t c = 0; c < body.compartments.size(); ++c) {
    const Compartment& one = body.compartments[c];
    const bool are_places =
        one.inside.allFinite() &&
        std::ranges::all_of(one.also_inside, [](const auto& at) { return at.allFinite(); });
    check.demand(are_places, concat("/compartments/", c, "/inside"),
                 "a point of a compartment is not finite", "give finite numbers");
    check.demand(one.region.size() == body.layers.size(), concat("/compartments/", c, "/region"),
                 concat("\"", one.name, "\" has ", counted(one.region.size(), "region", "regions"),
                        " for ", counted(body.layers.size(), "layer", "layers")),
                 "give one per layer, -1 for none");
  }
  if (problems.empty()) check_cells(body, problems);
}

}  // namespace faultsim::horizons
