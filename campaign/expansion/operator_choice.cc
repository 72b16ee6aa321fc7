#include "campaign/expansion/operator_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/case_values.h"
#include "campaign/expansion/rows.h"
#include "campaign/expansion/scene_builder.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/surface_probes.h"
#include "simulator/scene/offset_intervals.h"

namespace faultsweep {
namespace {

using Kind = faultsim::SurfaceParameter::Kind;

constexpr long kProbingCases = 32;
constexpr int kMostOperators = 400;
constexpr std::int64_t kOtherSeed = 0x50726f6265;  // so that probing cases are none of the sample

/// A parameter of the surface, and that of the group that it follows.
struct Axis {
  faultsim::SurfaceParameter of;
  std::string pointer;
  const Parameter* parameter;
};

bool has_ends(const SampledRange& range) {
  const Marginal& m = range.marginal;
  const bool is_cut =
      std::isfinite(static_cast<double>(m.from)) && std::isfinite(static_cast<double>(m.to));
  return is_cut && (m.distribution != Distribution::log_normal || m.from > 0);
}

std::vector<Axis> axes_of(const Group& group, const faultsim::Scene& scene) {
  std::vector<Axis> axes;
  for (const Parameter& parameter : group.parameters) {
    if (!parameter.range || parameter.has_own_values || !has_ends(*parameter.range)) continue;
    for (const std::string& target : parameter.targets) {
      auto of = faultsim::surface_parameter(target, scene);
      if (!of) continue;
      const double first = *parameter.si(0), last = *parameter.si(1);
      of->from = std::min(first, last);
      of->to = std::max(first, last);
      axes.push_back({*of, target, &parameter});
    }
  }
  return axes;
}

/// What the rows of the group give a parameter, SI.
std::vector<double> values_of_rows(const Group& group, const Parameter& parameter) {
  const auto p = static_cast<std::size_t>(&parameter - group.parameters.data());
  std::vector<double> values;
  Row row;
  for (long i = 0; i < count_rows(group); ++i) {
    row_at(group, i, row);
    values.push_back(*parameter.si(row[p]));
  }
  return values;
}

/// The design drawn again, by another seed; of a file every so many rows.
Group probing_group(const Group& group) {
  Group other = group;
  other.picked.clear();
  for (Parameter& parameter : other.parameters) {
    if (parameter.range && !parameter.range->is_given) parameter.drawn.clear();
  }
  for (Design& design : other.designs) {
    if (!is_sampled(design.kind)) continue;
    design.kind = DesignKind::monte_carlo;
    design.rows.clear();
    design.n = kProbingCases;
    design.seed += kOtherSeed;
  }
  draw_sampled_rows(other);
  return other;
}

/// What the rows change in the scene but for the surface's own parameters.
json probing_cases(const CampaignSpec& spec, const Group& group, const std::vector<Axis>& axes) {
  const Group other = probing_group(group);
  const CaseValues values(spec, other);
  const long n_rows = count_rows(other), stride = std::max(1L, n_rows / kProbingCases);
  json cases = json::array();
  Row row;
  std::vector<double> derived;
  for (long i = 0; i < n_rows && std::ssize(cases) < kProbingCases; i += stride) {
    row_at(other, i, row);
    values.derive(row, derived);
    if (values.excluded_by(row, derived) >= 0) continue;
    json one = json::object();
    for (const Change& change : changes_of_row(spec, other, row, derived)) {
      if (!contains(axes, change.pointer, &Axis::pointer)) one[change.pointer] = change.value;
    }
    cases.push_back(std::move(one));
  }
  return cases;
}

std::string metres(double value) { return concat(shortest_text(value), " m"); }

/// How one group's operators are made.
class OperatorChoice {
 public:
  OperatorChoice(const CampaignSpec& spec, Group& group, const faultsim::Scene& scene)
      : spec_(spec), group_(group), scene_(scene), axes_(axes_of(group, scene)) {}

  bool has_axes() const { return !axes_.empty(); }

  /// The section of the scene, and what it makes of the rows.
  void put(std::vector<std::string>& notes) {
    faultsim::SurfaceRequest request;
    for (const Axis& axis : axes_) request.over.push_back(axis.of);
    request.most_operators = kMostOperators;
    request.probes.emplace().tolerance = spec_.operators.tolerance;
    n_operators_ = faultsim::predicted_operators(request);
    const long n_rows = count_rows(group_);
    if (is_automatic() && n_rows < n_operators_) {
      notes.push_back(concat("operators of ", where(), " are exact: a surface over ", names(),
                             " would take about ", n_operators_, ", for only ", n_rows, " rows"));
      return;
    }
    json over = json::array();
    for (const Axis& axis : axes_) over.push_back(section_of(axis));
    json& numerics = group_.scene["numerics"];
    if (!numerics.is_object()) numerics = json::object();
    numerics["surface"] = {{"over", over},
                           {"most_operators", kMostOperators},
                           {"probes",
                            {{"tolerance", spec_.operators.tolerance},
                             {"cases", probing_cases(spec_, group_, axes_)}}}};
    group_.origins.push_back({"/numerics/surface", "/operators"});
    notes.push_back(concat("operators of ", where(), " are interpolated over ", names(), ": about ",
                           n_operators_, " exact ones for each of ", n_surfaces_,
                           n_surfaces_ == 1 ? " surface" : " surfaces",
                           ", until χ̄ of probing cases is within ",
                           formatted("%.2g", spec_.operators.tolerance), of_exact_rows()));
  }

 private:
  bool is_automatic() const { return spec_.operators.kind == OperatorPolicy::Kind::automatic; }
  std::string where() const { return group_.name.empty() ? "cases" : group_.pointer; }

  std::string names() const {
    std::string list;
    for (const Axis& axis : axes_) {
      if (list.find(axis.parameter->name) != std::string::npos) continue;
      list += (list.empty() ? "" : ", ") + axis.parameter->name;
    }
    return list;
  }

  std::string of_exact_rows() const {
    if (n_exact_ == 0) return "";
    return concat("; ", n_exact_, n_exact_ == 1 ? " row has" : " rows have",
                  " exact ones, where mesh lines meet or a surface would serve too few rows");
  }

  json section_of(const Axis& axis) {
    json section = {{"parameter", axis.pointer},
                    {"from", axis.parameter->text(0)},
                    {"to", axis.parameter->text(1)}};
    if (*axis.parameter->si(0) > *axis.parameter->si(1)) std::swap(section["from"], section["to"]);
    const bool is_joined =
        axis.of.kind == Kind::offset &&
        !scene_.field.blocks[static_cast<std::size_t>(axis.of.index)].mesh_offset;
    if (is_joined) look_at_intervals(axis, section);
    return section;
  }

  void look_at_intervals(const Axis& axis, json& section) {
    const auto intervals = faultsim::offset_intervals(
        scene_.field, static_cast<std::size_t>(axis.of.index), axis.of.from, axis.of.to);
    const std::vector<double> offsets = values_of_rows(group_, *axis.parameter);
    n_surfaces_ = 0;
    n_exact_ = std::ssize(offsets);
    json exact = json::array();
    for (const faultsim::OffsetInterval& one : intervals) {
      const long n_rows =
          std::ranges::count_if(offsets, [&](double offset) { return one.holds(offset); });
      if (is_automatic() && n_rows < n_operators_) {
        exact.push_back({metres(one.from), metres(one.to)});
        continue;
      }
      ++n_surfaces_;
      n_exact_ -= n_rows;
    }
    if (!exact.empty()) section["exact"] = exact;
  }

  const CampaignSpec& spec_;
  Group& group_;
  const faultsim::Scene& scene_;
  std::vector<Axis> axes_;
  int n_operators_ = 0;  ///< of a surface, check points included.
  long n_surfaces_ = 1, n_exact_ = 0;
};

void choose(const CampaignSpec& spec, Group& group, std::vector<std::string>& notes,
            std::vector<Problem>& problems) {
  std::vector<Problem> found;
  const faultsim::Scene scene =
      faultsim::read_scene({spec.scene_source, group.scene, spec.base.lines}, found);
  if (!found.empty()) return;  // said when its cases are read
  OperatorChoice choice(spec, group, scene);
  if (choice.has_axes()) return choice.put(notes);
  if (spec.operators.kind == OperatorPolicy::Kind::automatic) return;
  problems.push_back(
      {"/operators/policy", spec.document.line_of("/operators/policy"),
       concat("nothing in ", group.pointer,
              " that changes the operator is drawn from a bounded range"),
       "draw moduli, dips or an offset from ranges and give distributions \"from\" and "
       "\"to\", or write \"automatic\""});
}

}  // namespace

void choose_operators(const CampaignSpec& spec, Group& group, std::vector<std::string>& notes,
                      std::vector<Problem>& problems) {
  std::vector<long> picked = std::exchange(group.picked, {});  // chosen is for the whole design
  if (spec.operators.kind != OperatorPolicy::Kind::exact) choose(spec, group, notes, problems);
  group.picked = std::move(picked);
  const bool has_surface = faultsim::value_at(group.scene, "/numerics/surface") != nullptr;
  if (spec.operators.for_comparison && has_surface)
    group.scene["numerics"]["surface"]["exact"] = true;
}

}  // namespace faultsweep
