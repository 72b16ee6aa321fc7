#include "simulator/case_figures/stored_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"

namespace faultsim::case_figures {

namespace {

std::optional<std::size_t> fault_named(const FieldSource& fields, const std::string& name) {
  return place_of(mapped(fields.faults(), &StoredFault::name), name);
}

}  // namespace

std::size_t stored_fault(const Chosen& chosen) {
  if (const auto f = fault_named(*chosen.picture.fields, chosen.fault_name())) return *f;
  refuse("--fault", "no fields of fault " + chosen.fault_name() + " were kept", "name another");
}

std::optional<OriginalFault> original_fault(const Chosen& chosen) {
  const CasePicture* original = chosen.picture.original;
  if (original == nullptr || original->fields == nullptr) return std::nullopt;
  const auto stored = fault_named(*original->fields, chosen.fault_name()),
             own = place_of(original->result.fault_names, chosen.fault_name());
  if (!stored || !own) return std::nullopt;
  return OriginalFault{*stored, original->scene.faults[*own].friction};
}

std::optional<std::size_t> original_entry(const Chosen& chosen, std::size_t entry) {
  const FieldSource &now = *chosen.picture.fields, &before = *chosen.picture.original->fields;
  const auto same = std::ranges::find(before.steps(), now.steps()[entry]);
  if (same == before.steps().end()) return std::nullopt;
  const auto k = static_cast<std::size_t>(same - before.steps().begin());
  const double time = now.times()[entry];
  constexpr double kSameTime = 1e-9;  // relative
  if (std::abs(before.times()[k] - time) > kSameTime * std::abs(time)) return std::nullopt;
  return k;
}

std::optional<Eigen::Index> nearest_split(const StoredFault& fault, const Eigen::Vector3d& place) {
  std::optional<Eigen::Index> nearest;
  for (Eigen::Index k = 0; k < fault.points.cols(); ++k) {
    if (fault.split[static_cast<std::size_t>(k)] == 0) continue;
    const auto distance = [&](Eigen::Index i) { return (fault.points.col(i) - place).norm(); };
    if (!nearest || distance(k) < distance(*nearest)) nearest = k;
  }
  return nearest;
}

std::size_t stored_entry(Chosen& chosen) {
  const std::vector<int>& steps = chosen.picture.fields->steps();
  if (steps.empty()) refuse("--step", "the fields contain no load step", "run the case again");
  const int wanted = chosen.result().steps[chosen.step].step;
  const auto after = std::ranges::upper_bound(steps, wanted);
  const std::size_t entry =
      after == steps.begin() ? 0 : static_cast<std::size_t>(after - steps.begin()) - 1;
  if (steps[entry] != wanted && chosen.request.step) {
    refuse("--step", concat("the fields of load step ", wanted, " were not kept"),
           "choose one of " + joined(steps, ", "));
  }
  for (std::size_t k = 0; k < chosen.result().steps.size(); ++k) {
    if (chosen.result().steps[k].step == steps[entry]) chosen.step = k;
  }
  return entry;
}

DipLines dip_lines(const StoredFault& fault) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : fault.points.colwise()) points.emplace_back(point);
  std::vector<std::array<int, 4>> faces;
  for (const std::vector<int>& face : fault.faces) {
    // In plane strain two points: the ends of an edge down dip.
    faces.push_back({face.front(), face[1], face[face.size() / 2], face.back()});
  }
  return {std::move(points), faces};
}

std::vector<DipCrossing> split_line(const StoredFault& fault, const DipLines& lines,
                                    Eigen::Index point) {
  const int k = static_cast<int>(point);
  std::vector<DipCrossing> line = lines.line(lines.along(k), lines.part(k));
  std::erase_if(line, [&](const DipCrossing& at) {
    return fault.split[static_cast<std::size_t>(at.from)] == 0 ||
           fault.split[static_cast<std::size_t>(at.to)] == 0;
  });
  return line;
}

std::string along_strike_words(const DipLines& lines) {
  const Eigen::Vector3d& strike = lines.strike();
  const double angle = std::atan2(strike.x(), strike.y()) * 180 / std::numbers::pi;
  const auto degrees = std::lround(std::abs(angle));
  if (degrees == 0) return "along strike";
  if (degrees == 90) return "along strike, towards x";
  return concat("along strike, ", degrees, "° from y towards ", angle > 0 ? "x" : "−x");
}

std::vector<std::size_t> column_through(const StoredFault& fault, double y) {
  std::vector<std::size_t> column;
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] != 0 &&
        std::abs(fault.points(1, static_cast<Eigen::Index>(i)) - y) < kSamePlace) {
      column.push_back(i);
    }
  }
  std::ranges::sort(column, [&](std::size_t a, std::size_t b) {
    return fault.points(2, static_cast<Eigen::Index>(a)) >
           fault.points(2, static_cast<Eigen::Index>(b));
  });
  return column;
}

std::size_t most_critical(const StoredFault& fault, const Eigen::VectorXd& chi) {
  std::size_t most = fault.split.size();
  const auto chi_at = [&](std::size_t i) { return chi[static_cast<Eigen::Index>(i)]; };
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] == 0) continue;
    if (most == fault.split.size() || chi_at(i) > chi_at(most)) most = i;
  }
  if (most == fault.split.size()) refuse("--fault", "no point of it can move", "name another");
  return most;
}

double shear_at(const StoredFields& fields, Eigen::Index k) {
  return std::hypot(fields.traction(1, k), fields.traction(2, k));
}

}  // namespace faultsim::case_figures
