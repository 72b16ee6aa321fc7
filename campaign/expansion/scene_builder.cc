#include "campaign/expansion/scene_builder.h"

#include <cmath>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

std::vector<Change> changes_of_row(const CampaignSpec& spec, const Group& group, const Row& row,
                                   const std::vector<double>& derived) {
  std::vector<Change> result;
  for (std::size_t p = 0; p < row.size(); ++p) {
    group.parameters[p].append_changes(row[p], result);
  }
  for (std::size_t d = 0; d < derived.size(); ++d) {
    const Derived& one = spec.derived[d];
    if (std::isnan(derived[d])) continue;
    result.push_back({one.scene_pointer, spelled(derived[d], faultsim::si_unit(one.dimension))});
  }
  return result;
}

SceneBuilder::SceneBuilder(const CampaignSpec& spec, const Group& group)
    : spec_(spec), group_(group), base_{spec.scene_source, group.scene, spec.base.lines} {
  changed_.document = base_;
}

const faultsim::ChangedScene* SceneBuilder::scene(const Row& row,
                                                  const std::vector<double>& derived,
                                                  faultsim::Relations relations,
                                                  std::vector<Problem>& problems) {
  const std::size_t n_before = problems.size();
  for (std::size_t d = 0; d < derived.size(); ++d) {
    if (!std::isnan(derived[d])) continue;
    const Derived& one = spec_.derived[d];
    problems.push_back({one.pointer, spec_.document.line_of(one.pointer),
                        "\"" + one.text + "\" has no value where " + describe(row),
                        "use names that have a value in the scene, and do not divide by zero"});
  }
  std::vector<Problem> found;
  const std::vector<std::string> placeless = faultsim::change_scene(
      base_, changes_of_row(spec_, group_, row, derived), relations, changed_, found);
  for (const std::string& pointer : placeless) {
    problems.push_back(in_spec({pointer, 0, "the base scene has no place " + pointer,
                                "faultsim parameters lists what can be varied"},
                               row));
  }
  if (problems.size() > n_before) return nullptr;
  for (const Problem& one : found) problems.push_back(in_spec(one, row));
  return found.empty() ? &changed_ : nullptr;
}

Problem SceneBuilder::in_spec(const Problem& problem, const Row& row) const {
  const auto at = [&](const std::string& pointer) {
    return Problem{pointer, spec_.document.line_of(pointer), problem.what, problem.cure};
  };
  for (const Derived& one : spec_.derived) {
    if (overlap(one.scene_pointer, problem.pointer)) return at(one.pointer);
  }
  // The change that lies nearest: a problem of all of /friction is not that of one angle in it.
  for (const bool only_at_or_below : {true, false}) {
    for (std::size_t p = 0; p < row.size(); ++p) {
      std::vector<Change> changes;
      group_.parameters[p].append_changes(row[p], changes);
      for (const Change& change : changes) {
        const bool below = problem.pointer.size() >= change.pointer.size();
        if (problem.pointer.empty() || (only_at_or_below && !below)) continue;
        if (overlap(change.pointer, problem.pointer)) return at(group_.parameters[p].place(row[p]));
      }
    }
    for (auto origin = group_.origins.rbegin(); origin != group_.origins.rend(); ++origin) {
      const bool below = problem.pointer.size() >= origin->scene_pointer.size();
      if (problem.pointer.empty() || (only_at_or_below && !below)) continue;
      if (overlap(origin->scene_pointer, problem.pointer)) return at(origin->spec_pointer);
    }
  }
  if (spec_.base_is_inline) return at("/base" + problem.pointer);
  Problem result = at("/base");
  const int line = spec_.base.line_of(problem.pointer);
  result.what =
      faultsim::format_problems(spec_.scene_source, {{problem.pointer, line, problem.what, ""}});
  return result;
}

std::string SceneBuilder::describe(const Row& row) const {
  std::string text;
  for (std::size_t p = 0; p < row.size(); ++p) {
    const Parameter& parameter = group_.parameters[p];
    text += (text.empty() ? "" : ", ") + parameter.name + " = " + parameter.text(row[p]);
  }
  return text.empty() ? "nothing varies" : text;
}

}  // namespace faultsweep
