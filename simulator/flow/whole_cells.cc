#include "simulator/flow/whole_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/flow/flow_cell_search.h"

namespace faultsim {
namespace {

/// Integrals over a compartment at one report.
struct Sums {
  double flow_grid = 0, mapped = 0, size = 0;

  static constexpr double kMost = 0.5;  ///< of |κ|.

  /// κ.
  double scaling() const {
    return size > 0 ? std::clamp((flow_grid - mapped) / size, -kMost, kMost) : 0;
  }
  /// What scaling leaves: changes where our cells have next to none.
  double left() const {
    const double rest = flow_grid - mapped - scaling() * size;
    return std::abs(rest) > kRounding * (std::abs(flow_grid) + size) ? rest : 0;
  }

 private:
  static constexpr double kRounding = 1e-14;
};

std::vector<Sums> sums_at(const FlowMapping& mapping, const FlowField& field, int reference,
                          int report, const Eigen::VectorXd& change) {
  std::vector<Sums> sums(mapping.flow_cells.size());
  for (std::size_t r = 0; r < sums.size(); ++r) {
    for (const FlowMapping::Weight& own : mapping.flow_cells[r])
      sums[r].flow_grid +=
          own.value * (field.value(own.flow_cell, report) - field.value(own.flow_cell, reference));
  }
  for (std::size_t c = 0; c < mapping.part.size(); ++c) {
    Sums& region = sums[static_cast<std::size_t>(mapping.region[c])];
    const double integral = mapping.part[c] * change[static_cast<Eigen::Index>(c)];
    region.mapped += integral;
    region.size += std::abs(integral);
  }
  return sums;
}

/// Rock of each compartment, m3.
std::vector<double> volumes_of_ours(const FlowMapping& mapping) {
  std::vector<double> volume(mapping.flow_cells.size());
  for (std::size_t c = 0; c < mapping.part.size(); ++c)
    volume[static_cast<std::size_t>(mapping.region[c])] += mapping.part[c];
  return volume;
}

/// That of the flow cells that count with one.
double volume_of_theirs(const FlowMapping& mapping, std::size_t region) {
  double volume = 0;
  for (const FlowMapping::Weight& cell : mapping.flow_cells[region]) volume += cell.value;
  return volume;
}

/// The largest change of any flow cell, Pa (or K).
double largest_change(const FlowField& field, int reference, const std::vector<int>& reports) {
  double largest = 0;
  for (const int report : reports) {
    for (int f = 0; f < std::ssize(field.cells); ++f)
      largest = std::max(largest, std::abs(field.value(f, report) - field.value(f, reference)));
  }
  return largest;
}

/// Of what differs by `off` where our cells have `size`; more than kMany times it is no number.
std::string times_text(double off, double size) {
  constexpr double kMany = 1000;
  return off > kMany * size ? formatted("more than %.0f", kMany)
                            : formatted("up to %.3g", off / size);
}

/// What is said of a compartment whose integrals are not those of one field.
Problem integral_misfit(const FlowMapping& mapping, std::size_t region, const std::string& name,
                        double off, double size) {
  if (mapping.flow_cells[region].empty()) {
    return {"", 0,
            "no flow cell counts with " + name +
                ", which takes changes from beside it: no integral can be kept",
            "leave \"integral\" out, or write \"outside\": \"unchanged\""};
  }
  return {
      "", 0,
      formatted("the integrals of its change over %s and over the flow cells that count with it "
                "differ by %s times the former; it has %.3g m3, they %.3g m3",
                name.c_str(), times_text(off, size).c_str(), volumes_of_ours(mapping)[region],
                volume_of_theirs(mapping, region)),
      "check where the compartment lies and how thick its layers are; with \"integral\": "
      "\"flow_grid\", flow cells far from it count with it too: leave that out where the model "
      "is only part of the field"};
}

/// @param negligible  Pa (or K): what may be spread over a compartment whose cells hardly change.
/// @throws InputError for all compartments whose integrals are not those of one field.
std::vector<IntegralBalance> balances(const FlowMapping& mapping,
                                      const std::vector<std::vector<Sums>>& of_report,
                                      const std::vector<std::string>& region_names,
                                      double negligible) {
  const std::vector<double> volume = volumes_of_ours(mapping);
  std::vector<IntegralBalance> balance;
  std::vector<Problem> problems;
  for (std::size_t r = 0; !of_report.empty() && r < of_report.back().size(); ++r) {
    double size = 0, off = 0;
    for (const std::vector<Sums>& regions : of_report) {
      size = std::max(size, regions[r].size);
      off = std::max(off, std::abs(regions[r].flow_grid - regions[r].mapped));
    }
    const Sums& last = of_report.back()[r];
    balance.push_back({.flow_grid = last.flow_grid,
                       .mapped = last.mapped,
                       .largest_scaling = size > 0 ? std::min(Sums::kMost, off / size) : 0});
    if (off > Sums::kMost * size && off > negligible * volume[r])
      problems.push_back(integral_misfit(mapping, r, region_names[r], off, size));
  }
  if (!problems.empty()) throw InputError("flow field", problems);
  return balance;
}

CellCorners corners_of_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  CellCorners corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {i % 4 == 1 || i % 4 == 2 ? high.x() : low.x(), i % 4 >= 2 ? high.y() : low.y(),
                  i >= 4 ? high.z() : low.z()};
  }
  return corners;
}

/// What a compartment holds of a flow cell, m3.
struct Held {
  int flow_cell = -1, region = -1;
  double volume = 0;

  std::pair<int, int> key() const { return {flow_cell, region}; }
};

/// By flow cell, then compartment, each pair once: memory goes with the overlaps there are, not
/// with compartments times flow cells.
std::vector<Held> held_volumes(const std::vector<MappedCell>& cells,
                               const std::vector<std::vector<FlowMapping::Weight>>& overlaps) {
  std::vector<Held> held;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const FlowMapping::Weight& overlap : overlaps[c])
      held.push_back({overlap.flow_cell, cells[c].region, cells[c].fraction * overlap.value});
  }
  std::ranges::stable_sort(held, {}, &Held::key);  // stable: sums in the order of our cells
  std::size_t n = 0;
  for (const Held& one : held) {
    if (n > 0 && held[n - 1].key() == one.key())
      held[n - 1].volume += one.volume;
    else
      held[n++] = one;
  }
  held.resize(n);
  return held;
}

}  // namespace

std::vector<int> compartments_of_flow_cells(
    const FlowField& field, const std::vector<MappedCell>& cells,
    const std::vector<std::vector<FlowMapping::Weight>>& overlaps) {
  std::vector<FlowCell> ours;
  for (const MappedCell& cell : cells) ours.push_back(flow_cell_around(cell.corners));
  const FlowCellSearch search(ours);
  const std::vector<Held> held = held_volumes(cells, overlaps);
  auto next = held.begin();
  std::vector<int> compartments;
  for (int f = 0; f < std::ssize(field.cells); ++f) {
    Held most;
    for (; next != held.end() && next->flow_cell == f; ++next) {
      if (next->volume > most.volume) most = *next;
    }
    if (most.volume <= 0) {
      const FlowCell& cell = field.cells[static_cast<std::size_t>(f)];
      most.region =
          cells[static_cast<std::size_t>(search.nearest((cell.low + cell.high) / 2))].region;
    }
    compartments.push_back(most.region);
  }
  return compartments;
}

double volume_between(const FlowCell& cell, const std::array<double, 2>& y_range) {
  FlowCell part{.low = cell.low, .high = cell.high};
  if (part.low.y() >= y_range[0] && part.high.y() <= y_range[1]) return flow_cell_volume(cell);
  part.low.y() = std::max(part.low.y(), y_range[0]);
  part.high.y() = std::min(part.high.y(), y_range[1]);
  if (part.low.y() >= part.high.y()) return 0;
  return overlap_volume(corners_of_box(part.low, part.high), cell);
}

std::vector<IntegralBalance> keep_integrals(const FlowMapping& mapping, const FlowField& field,
                                            int reference, const std::vector<int>& reports,
                                            const std::vector<std::string>& region_names,
                                            Eigen::MatrixXd& change) {
  std::vector<std::vector<Sums>> of_report;
  for (std::size_t t = 0; t < reports.size(); ++t)
    of_report.push_back(
        sums_at(mapping, field, reference, reports[t], change.col(static_cast<Eigen::Index>(t))));
  constexpr double kNegligible = 1e-3;
  const std::vector<IntegralBalance> balance = balances(
      mapping, of_report, region_names, kNegligible * largest_change(field, reference, reports));
  const std::vector<double> volume = volumes_of_ours(mapping);
  for (std::size_t t = 0; t < reports.size(); ++t) {
    for (std::size_t c = 0; c < mapping.part.size(); ++c) {
      const auto region = static_cast<std::size_t>(mapping.region[c]);
      const Sums& sums = of_report[t][region];
      double& value = change(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(t));
      value += sums.scaling() * std::abs(value) + sums.left() / volume[region];
    }
  }
  return balance;
}

}  // namespace faultsim
