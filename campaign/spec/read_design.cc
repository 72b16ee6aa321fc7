#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"

namespace faultsweep {
namespace {

/// The target itself, or the part of it that the other parameter changes.
std::string deeper_target(const Parameter& other, const std::string& target) {
  for (const std::string& one : other.targets) {
    if (overlap(one, target)) return one.size() > target.size() ? one : target;
  }
  return target;
}

}  // namespace

void SpecReader::read_designs(const std::string& pointer, const std::string& prefix,
                              const json& scene, const std::vector<Origin>& origins) {
  const auto kind = at(pointer + "/kind").get<std::string>();
  if (kind == "groups") {
    read_groups(pointer, prefix, scene, origins);
    return;
  }
  Group group;
  group.name = prefix;
  group.pointer = pointer;
  group.scene = scene;
  group.origins = origins;
  const SceneNames& names = names_of(scene);
  if (kind == "nested") {
    for (const Member& one : members(pointer + "/designs")) read_design(one.pointer, names, group);
  } else {
    read_design(pointer, names, group);
  }
  if (is_usable("/limits")) read_limits(names, group);
  check_targets(group);
  spec_.groups.push_back(std::move(group));
}

void SpecReader::read_design(const std::string& pointer, const SceneNames& names, Group& group) {
  Design design;
  design.pointer = pointer;
  design.kind = named<DesignKind>(at(pointer + "/kind").get<std::string>()).value();
  std::vector<Parameter> parameters;
  if (design.kind == DesignKind::list) {
    read_list(pointer + "/cases", names, design, parameters);
  } else if (is_of_file(design.kind)) {
    read_samples(pointer, names, design, parameters);
  } else {
    for (const auto& [name, place] : members(pointer + "/parameters")) {
      if (auto parameter = read_parameter(place, name, names, design.kind)) {
        parameters.push_back(std::move(*parameter));
      }
    }
  }
  if (is_sampled(design.kind)) read_sampling(pointer, design);
  if (has(pointer + "/correlations")) read_correlations(pointer, parameters, design);
  if (design.kind == DesignKind::zip) check_zip(parameters);
  if (design.kind == DesignKind::morris) check_morris(design, parameters);
  design.n_parameters = parameters.size();
  constexpr std::size_t kMostSobolParameters = 1000;  // two dimensions each of a sequence with 3667
  if (design.kind == DesignKind::sobol && design.n_parameters > kMostSobolParameters) {
    problem(pointer + "/parameters", std::to_string(design.n_parameters) + " parameters",
            "give a sobol design at most " + std::to_string(kMostSobolParameters));
  }
  group.designs.push_back(std::move(design));
  for (Parameter& one : parameters) group.parameters.push_back(std::move(one));
}

void SpecReader::read_sampling(const std::string& pointer, Design& design) {
  const bool is_morris = design.kind == DesignKind::morris;
  design.n = at(pointer + (is_morris ? "/trajectories" : "/samples")).get<long>();
  if (is_morris) design.levels = 4;
  read(pointer + "/levels", design.levels);
  if (design.levels % 2 != 0) {
    problem(pointer + "/levels", std::to_string(design.levels) + " is an odd number of levels",
            "write an even one: parameters move by half the levels");
  }
  read(pointer + "/first", design.first);
  read(pointer + "/seed", design.seed);
  read(pointer + "/second_order", design.second_order);
}

/// "correlations": [{"of": ["friction_angle", "cohesion"], "rank": -0.5}, ...]
void SpecReader::read_correlations(const std::string& pointer,
                                   const std::vector<Parameter>& parameters, Design& design) {
  std::vector<std::size_t> places;  // of the correlated parameters, in the design
  std::map<std::pair<std::size_t, std::size_t>, double> ranks;
  const std::string list = pointer + "/correlations";
  const auto place_of = [&](const std::string& where) -> std::optional<std::size_t> {
    const std::string name = at(where);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (parameters[p].name != name) continue;
      if (parameters[p].range) return p;
      problem(where, "\"" + name + "\" has listed values", "give it a range");
      return std::nullopt;
    }
    if (has(pointer + "/parameters/" + faultsim::pointer_token(name))) return std::nullopt;
    problem(where, "the design has no parameter \"" + name + "\"", "name one of its parameters");
    return std::nullopt;
  };
  const std::size_t before = problems_.size();
  for (const auto& [key, one] : members(list)) {
    const auto a = place_of(one + "/of/0"), b = place_of(one + "/of/1");
    if (!a || !b) continue;
    if (!ranks.emplace(std::minmax(*a, *b), at(one + "/rank").get<double>()).second)
      problem(one + "/of", "these two are correlated twice", "remove one");
    for (const std::size_t p : {*a, *b}) {
      if (!contains(places, p)) places.push_back(p);
    }
  }
  if (problems_.size() > before || places.empty()) return;
  std::ranges::sort(places);
  std::vector<std::vector<double>> matrix(places.size(), std::vector<double>(places.size(), 0));
  for (std::size_t i = 0; i < places.size(); ++i) {
    matrix[i][i] = 1;
    for (std::size_t j = 0; j < i; ++j) {
      const auto rank = ranks.find({places[j], places[i]});
      if (rank != ranks.end()) matrix[i][j] = matrix[j][i] = rank->second;
    }
  }
  auto copula = GaussianCopula::make(matrix);
  if (!copula) {
    problem(list, "these correlations contradict each other",
            "bring them closer to zero; pairs not given have 0");
    return;
  }
  design.correlated = {places, std::move(matrix), std::move(*copula)};
}

void SpecReader::read_groups(const std::string& pointer, const std::string& prefix,
                             const json& scene, const std::vector<Origin>& origins) {
  std::map<std::string, std::string> seen;
  for (const auto& [key, place] : members(pointer + "/groups")) {
    const auto name = at(place + "/name").get<std::string>();
    const auto [other, is_new] = seen.emplace(name, place);
    if (!is_new) {
      problem(place + "/name", "the name \"" + name + "\" is used by " + other->second,
              "give each group a name of its own");
    }
    json own_scene = scene;
    std::vector<Origin> own_origins = origins;
    if (has(place + "/set")) apply_set(place + "/set", own_scene, own_origins);
    read_designs(place + "/design", prefix.empty() ? name : prefix + "/" + name, own_scene,
                 own_origins);
  }
}

void SpecReader::read_list(const std::string& pointer, const SceneNames& names, Design& design,
                           std::vector<Parameter>& parameters) {
  std::map<std::string, int> columns;             // parameter -> column; -1 = unknown, reported
  std::vector<std::map<std::string, int>> known;  // per column: JSON text of a value -> choice
  for (const Member& one : members(pointer)) {
    std::vector<int> row(parameters.size(), -1);
    for (const auto& [name, place] : members(one.pointer)) {
      auto column = columns.find(name);
      if (column == columns.end()) {
        const auto target = resolve(names, name, place);
        column = columns.emplace(name, target ? static_cast<int>(parameters.size()) : -1).first;
        if (!target) continue;
        Parameter parameter;
        parameter.name = name;
        parameter.pointer = place;
        parameter.targets = {*target};
        set_base_choice(names, parameter);
        parameters.push_back(std::move(parameter));
        known.emplace_back();
        row.push_back(-1);
      }
      if (column->second < 0) continue;
      const auto index = static_cast<std::size_t>(column->second);
      Parameter& parameter = parameters[index];
      const json& value = at(place);
      auto choice = known[index].find(value.dump());
      if (choice == known[index].end()) {
        auto made = make_choice(value, place, names, parameter);
        if (!made) continue;
        if (!made->si) parameter.is_text = true;
        choice =
            known[index].emplace(value.dump(), static_cast<int>(parameter.choices.size())).first;
        parameter.choices.push_back(std::move(*made));
      }
      row[index] = choice->second;
    }
    design.rows.push_back(std::move(row));
  }
  for (auto& row : design.rows) row.resize(parameters.size(), -1);
  for (Parameter& parameter : parameters) unify_kind(parameter);
}

/// No two parameters may change the same place, or one a part of what another changes.
void SpecReader::check_targets(const Group& group) {
  std::unordered_map<std::string, std::size_t> owner;  // of targets, and of all places above them
  const auto above = [](const std::string& pointer) {
    std::vector<std::string> places;
    for (std::size_t slash = pointer.rfind('/'); slash != std::string::npos && slash > 0;
         slash = pointer.rfind('/', slash - 1)) {
      places.push_back(pointer.substr(0, slash));
    }
    return places;
  };
  std::unordered_set<std::string> changed;  // the targets alone
  for (std::size_t i = 0; i < group.parameters.size(); ++i) {
    const Parameter& mine = group.parameters[i];
    for (const std::string& target : mine.targets) {
      const std::vector<std::string> places = above(target);
      std::optional<std::size_t> other;
      if (const auto found = owner.find(target); found != owner.end()) other = found->second;
      for (const std::string& place : places) {
        if (!other && changed.count(place) != 0) other = owner.at(place);
      }
      if (other && *other != i) {
        problem(mine.pointer,
                "\"" + mine.name + "\" and \"" + group.parameters[*other].name + "\" both change " +
                    deeper_target(group.parameters[*other], target),
                "vary it with one of them");
      }
      changed.insert(target);
      owner.emplace(target, i);
      for (const std::string& place : places) owner.emplace(place, i);
    }
  }
}

void SpecReader::check_zip(const std::vector<Parameter>& parameters) {
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const Parameter& first = parameters.front();
    const Parameter& other = parameters[i];
    if (other.choices.size() == first.choices.size()) continue;
    problem(other.pointer,
            "\"" + other.name + "\" has " + std::to_string(other.choices.size()) + " values, \"" +
                first.name + "\" has " + std::to_string(first.choices.size()),
            "give each parameter of a zip the same number of values");
  }
}

/// Values that are listed must be equally likely and change with every move.
void SpecReader::check_morris(const Design& design, const std::vector<Parameter>& parameters) {
  for (const Parameter& one : parameters) {
    const auto n = static_cast<int>(one.choices.size());
    if (one.range || (n > 1 && design.levels % n == 0)) continue;
    problem(one.pointer,
            "\"" + one.name + "\" has " + std::to_string(n) + (n == 1 ? " value" : " values") +
                " on the " + std::to_string(design.levels) + " levels of morris",
            n == 1 ? "give at least two values, or put the one into set"
                   : "give a number of values that divides the levels, or set levels to " +
                         std::to_string(n % 2 == 0 ? n : 2 * n));
  }
}

}  // namespace faultsweep
