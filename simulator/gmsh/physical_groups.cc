#include "simulator/gmsh/physical_groups.h"

#include <map>
#include <utility>

#include "simulator/common/table_reader.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

constexpr const char* kVolumeCure = "give every volume one Physical Volume with a name";

std::size_t at(int dimension) { return static_cast<std::size_t>(dimension); }

const char* name_of_entities(int dimension) { return dimension == 2 ? "surface" : "volume"; }

}  // namespace

PhysicalGroups::PhysicalGroups(const GmshContent& content, FileProblems& problems)
    : content_(content), problems_(problems) {
  for (const int dimension : {2, 3}) check_names(dimension);
  if (content_.has_all_entities) check_entities();
}

const std::vector<std::int64_t>& PhysicalGroups::of(int dimension, std::int64_t entity) const {
  static const std::vector<std::int64_t> none;
  const auto& entities = content_.entities[at(dimension)];
  const auto found = entities.find(entity);
  return found == entities.end() ? none : found->second.physical;
}

std::string PhysicalGroups::name(int dimension, std::int64_t group) const {
  const auto& names = content_.names[at(dimension)];
  const auto found = names.find(group);
  return found != names.end() ? found->second.name
                              : concat("physical ", name_of_entities(dimension), ' ', group);
}

void PhysicalGroups::check_names(int dimension) {
  std::map<std::int64_t, int> groups;  // and the place of what tells of them
  for (const auto& [number, entity] : content_.entities[at(dimension)]) {
    for (const std::int64_t group : entity.physical) groups.emplace(group, entity.place);
  }
  for (const auto& [group, named] : content_.names[at(dimension)]) groups[group] = named.place;
  std::map<std::string, std::int64_t> group_of;
  for (const auto& entry : groups) {
    const std::int64_t group = entry.first;
    const std::string own = name(dimension, group);
    const auto known = group_of.emplace(own, group);
    if (known.second) continue;
    problems_.add(entry.second, "give each physical group a name of its own", [&] {
      return concat("the physical ", name_of_entities(dimension), "s ", known.first->second,
                    " and ", group, " are both called ", table_quote(own));
    });
  }
}

void PhysicalGroups::check_entities() {
  std::map<std::pair<int, std::int64_t>, std::pair<const ElementBlock*, std::int64_t>> counts;
  for (const ElementBlock& block : content_.blocks) {
    auto& entry = counts[{block.kind->dimension, block.entity}];
    if (entry.first == nullptr) entry.first = &block;
    entry.second += std::ssize(block.tags);
  }
  for (const auto& [entity, entry] : counts) {
    const ElementBlock& first = *entry.first;
    const int dimension = entity.first;
    const std::int64_t n = entry.second;
    if (!content_.entities[at(dimension)].contains(entity.second)) {
      problems_.add(first.place, kSaveAnew, [&] {
        return concat(name_of_entities(dimension), ' ', first.entity, ", which has ",
                      counted(n, "element", "elements"), ", is not in $Entities");
      });
    } else if (dimension == 3 && n > 0) {
      check_volume(first, n);
    }
  }
}

void PhysicalGroups::check_volume(const ElementBlock& first, std::int64_t n_cells) {
  const std::vector<std::int64_t>& groups = of(3, first.entity);
  if (groups.size() == 1) return;
  problems_.add(first.place, kVolumeCure, [&] {
    const std::string volume =
        concat("volume ", first.entity, ", which has ", counted(n_cells, "cell", "cells"));
    if (groups.empty()) return volume + ", belongs to no physical volume";
    return volume + ", belongs to several physical volumes: " +
           joined(groups, ", ", [&](std::int64_t group) { return table_quote(name(3, group)); });
  });
}

}  // namespace faultsim
