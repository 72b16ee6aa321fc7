#include "campaign/expansion/expansion.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/case_values.h"
#include "campaign/expansion/extreme_rows.h"
#include "campaign/expansion/families.h"
#include "campaign/expansion/operator_choice.h"
#include "campaign/expansion/row_reader.h"
#include "campaign/expansion/scene_builder.h"
#include "campaign/spec/pointers.h"
#include "simulator/scene/identity.h"

namespace faultsweep {
namespace {

constexpr long kRowsCheckedOneByOne = 2000;  ///< beyond, some are (extreme_rows.h).
constexpr std::size_t kChoicesTried = 64;    ///< per parameter; the extremes are among them.
constexpr int kMaximumWrongCases = 20;       ///< of cases wrong only as a combination.
constexpr std::size_t kMaximumProblems = 100;

class Expander {
 public:
  Expander(CampaignSpec spec, std::size_t most_planned) {
    families_.most_planned = most_planned;
    result_.spec = std::move(spec);
  }

  Expansion run() {
    for (Group& group : result_.spec.groups) {
      draw_sampled_rows(group);
      choose_operators(result_.spec, group, result_.notes, problems_);
    }
    throw_problems();
    for (const Group& group : result_.spec.groups) result_.n_designed += count_rows(group);
    for (const Exclusion& one : result_.spec.exclude) result_.excluded.push_back({one.text, 0});
    result_.case_of_row.resize(result_.spec.groups.size());
    for (std::size_t g = 0; g < result_.spec.groups.size(); ++g) expand_group(static_cast<int>(g));
    throw_problems();
    result_.families = std::move(families_.families);
    result_.n_planned = families_.n_planned;
    for (const Case& one : result_.cases) {
      result_.families[one.family].cases.push_back(one.index);
    }
    if (result_.cases.empty()) {
      problems_.push_back(
          {"/design", result_.spec.document.line_of("/design"),
           "every one of " + std::to_string(result_.n_designed) + " cases is excluded",
           "relax a condition of exclude"});
      throw_problems();
    }
    write_notes();
    return std::move(result_);
  }

 private:
  void throw_problems() {
    if (problems_.empty()) return;
    throw InputError(result_.spec.source, problems_);
  }

  /// Adds problems that were not said before.
  void add(const std::vector<Problem>& found) {
    for (const Problem& one : found) {
      if (problems_.size() >= kMaximumProblems) return;
      if (said_.insert(one.pointer + "\n" + one.what).second) problems_.push_back(one);
    }
  }

  /// The design of a group whose estimators need every row, or null.
  static const Design* whole_design(const Group& group) {
    const auto found = std::ranges::find_if(group.designs, [](const Design& one) {
      return one.kind == DesignKind::sobol || one.kind == DesignKind::morris;
    });
    return found == group.designs.end() ? nullptr : &*found;
  }

  void refuse_exclusion(const Design& design, std::size_t exclusion, const std::string& row) {
    const std::string& place = result_.spec.exclude[exclusion].pointer;
    add({{place, result_.spec.document.line_of(place),
          std::string("leaves out a row of the ") + to_string(design.kind) + " design " +
              design.pointer + ", which needs all of them (where " + row + ")",
          "narrow the ranges, or use latin-hypercube, which leaves out and counts excluded "
          "samples"}});
  }

  void note_drawn(const std::vector<std::string>& names, const Group& group) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    const bool are_places = contains(group.designs, DesignKind::places, &Design::kind);
    if (names.empty() || are_places) return;  // each place is its own
    result_.notes.push_back(
        list + " of " + group.pointer +
        (names.size() == 1 ? " is drawn from a range and changes the operator: each of its values "
                             "is a family of its own; values of a short list would share operators"
                           : " are drawn from ranges and change the operator: each row is a family "
                             "of its own; values of short lists would share operators"));
  }

  void expand_group(int index) {
    const Group& group = result_.spec.groups[index];
    SceneBuilder builder(result_.spec, group);
    const CaseValues values(result_.spec, group);
    if (!check_choices(group, builder, values)) return;
    FamilyFinder families(result_.spec, group, builder, values, families_);
    const long n_rows = count_rows(group);
    // Each line of a file is somebody's own: nothing but checking it tells whether it is sound.
    const bool has_file =
        std::ranges::any_of(group.designs, [](const Design& one) { return is_of_file(one.kind); });
    const bool is_large = n_rows > kRowsCheckedOneByOne && !has_file;
    if (is_large && !check_extremes(group, builder, values)) return;
    const auto relations = is_large ? faultsim::Relations::trusted : faultsim::Relations::checked;
    std::vector<int>& case_of_row = result_.case_of_row[index];
    case_of_row.assign(static_cast<std::size_t>(n_rows), -1);
    note_drawn(families.drawn(), group);
    RowReader rows(result_.spec, group, values, relations);
    int n_wrong = 0;
    for (long i = 0; i < n_rows; ++i) {
      ReadRow& read = rows.next(families.are_many());
      if (read.excluded >= 0) {
        ++result_.excluded[read.excluded].n_cases;
        if (const Design* whole = whole_design(group)) {
          refuse_exclusion(*whole, static_cast<std::size_t>(read.excluded),
                           builder.describe(read.row));
          return;
        }
        continue;
      }
      std::vector<Problem>& found = read.problems;
      int& place = case_of_row[i];
      place = read.identity.empty() ? -1 : add_case(index, read, builder, families);
      if (place < 0) {
        if (found.empty()) continue;  // said of an earlier row
        for (Problem& one : found) one.what += " (where " + builder.describe(read.row) + ")";
        add(found);
        if (++n_wrong < kMaximumWrongCases) continue;
        add({{group.pointer, result_.spec.document.line_of(group.pointer),
              "checking stopped after " + std::to_string(n_wrong) +
                  " wrong combinations: there may be more",
              "exclude them or change the values"}});
        return;
      }
    }
  }

  /// False where extreme rows of a large design have problems.
  bool check_extremes(const Group& group, SceneBuilder& builder, const CaseValues& values) {
    const std::vector<bool> all(group.parameters.size(), true);
    std::vector<double> derived;
    std::vector<Problem> found;
    for (const Row& row : extreme_rows(group, values, all)) {
      values.derive(row, derived);
      const std::size_t n_before = found.size();
      builder.scene(row, derived, faultsim::Relations::checked, found);
      for (std::size_t i = n_before; i < found.size(); ++i)
        found[i].what += " (where " + builder.describe(row) + ")";
    }
    add(found);
    return found.empty();
  }

  /// Tries every choice once, in the first row of the design with that choice put in, so that a
  /// wrong value is reported once and not in each of 10^5 cases.
  bool check_choices(const Group& group, SceneBuilder& builder, const CaseValues& values) {
    std::vector<double> derived;
    std::vector<Problem> found;
    for (const Row& row : rows_to_try(group)) {
      values.derive(row, derived);
      if (values.excluded_by(row, derived) >= 0) continue;
      builder.scene(row, derived, faultsim::Relations::checked, found);
    }
    std::set<std::string> places;
    for (const Problem& one : found) places.insert(one.pointer);
    const bool ok = found.empty();
    std::erase_if(found, [&](const Problem& one) {  // a drawn value, where an end is wrong already
      return places.count(one.pointer + "/from") + places.count(one.pointer + "/to") > 0;
    });
    add(found);
    return ok;
  }

  /// Any choice of a grid or a sampled design (of a range: its ends) goes with any other. The
  /// values in a row of other designs may make sense only together; where such a design is all
  /// there is, its rows use each choice about once.
  static std::vector<Row> rows_to_try(const Group& group) {
    std::vector<Row> rows;
    Row first;
    row_at(group, 0, first);
    std::size_t begin = 0;
    for (const Design& design : group.designs) {
      const std::size_t end = begin + design.n_parameters;
      const bool free = design.kind == DesignKind::grid || is_sampled(design.kind);
      for (std::size_t p = begin; free && p < end; ++p) {
        const Parameter& parameter = group.parameters[p];
        const auto tried =
            parameter.range ? std::vector<int>{0, 1} : sample_choices(parameter, kChoicesTried);
        for (const int choice : tried) {
          if (!rows.empty() && choice == first[p]) continue;  // the first row itself
          rows.push_back(first);
          rows.back()[p] = choice;
        }
      }
      begin = end;
    }
    return rows;
  }

  /// The index of the row's case, or -1 where problems were found.
  int add_case(int group, ReadRow& read, const SceneBuilder& builder, FamilyFinder& families) {
    Case one;
    one.index = static_cast<int>(result_.cases.size());
    one.group = group;
    one.identity = read.identity;
    const auto [known, is_new] = by_identity_.emplace(one.identity, one.index);
    if (!is_new) {
      ++result_.n_merged;
      join_names(result_.cases[static_cast<std::size_t>(known->second)], group, read.row);
      if (first_merged_.empty()) {
        first_merged_ = builder.describe(read.row) + " is the same as case " +
                        std::to_string(known->second + 1);
      }
      return known->second;
    }
    one.family = families.family_of(read);
    if (one.family < 0) return -1;
    one.choices = std::move(read.row);
    one.derived = std::move(read.derived);
    result_.cases.push_back(std::move(one));
    return result_.cases.back().index;
  }

  /// Places that are the same case have their names together, up to a line of them.
  void join_names(const Case& one, int group, const Row& row) {
    if (one.group != group) return;
    Group& places = result_.spec.groups[static_cast<std::size_t>(group)];
    for (const Design& design : places.designs) {
      if (design.kind != DesignKind::places) continue;
      const auto of = std::ranges::find(places.parameters, design.names, &Parameter::name) -
                      places.parameters.begin();
      const auto p = static_cast<std::size_t>(of);
      std::vector<Choice>& names = places.parameters[p].choices;
      std::string& all = names[static_cast<std::size_t>(one.choices[p])].text;
      const std::string& own = names[static_cast<std::size_t>(row[p])].text;
      constexpr std::size_t kMost = 80;
      constexpr std::string_view kMore = ", …";
      if (all.ends_with(kMore)) continue;
      all += all.size() + own.size() < kMost ? ", " + own : std::string(kMore);
    }
  }

  void write_notes() {
    note_fields();
    if (families_.n_estimated > 0) {
      const std::size_t n_families = result_.families.size();
      result_.notes.push_back(std::to_string(n_families - families_.n_estimated) + " of " +
                              std::to_string(n_families) +
                              " families were planned, spread over the design; each other one is "
                              "assumed to have the size of the planned one before it");
    }
    for (const Group& group : result_.spec.groups) {
      for (const Design& design : group.designs) {
        if (design.kind != DesignKind::sobol || (design.n & (design.n - 1)) == 0) continue;
        result_.notes.push_back(
            std::to_string(design.n) + " samples of " + design.pointer +
            " are not a power of two: the sequence is balanced only at powers of two");
      }
    }
    if (result_.n_merged > 0) {
      result_.notes.push_back(
          std::to_string(result_.n_merged) + (result_.n_merged == 1 ? " case is" : " cases are") +
          " identical to an earlier one and run once (the first: " + first_merged_ + ")");
    }
    for (const ExcludedCases& one : result_.excluded) {
      if (one.n_cases == 0) {
        result_.notes.push_back("\"" + one.reason + "\" excludes nothing");
      }
    }
    note_distributions();
  }

  /// What flow results do not cover, once for all cases.
  void note_fields() {
    constexpr std::size_t kShown = 10;
    const std::vector<FieldRemark>& remarks = families_.field_remarks;
    for (std::size_t i = 0; i < std::min(kShown, remarks.size()); ++i)
      result_.notes.push_back(remarks[i].text + " (first where " + remarks[i].where + ")");
    if (remarks.size() > kShown)
      result_.notes.push_back(std::to_string(remarks.size() - kShown) + " more of this kind");
  }

  /// Leaving cases out changes how the parameters of the others are distributed.
  void note_distributions() {
    long n_excluded = 0;
    for (const ExcludedCases& one : result_.excluded) n_excluded += one.n_cases;
    const auto is_stated = [](const Group& group) {
      return std::ranges::any_of(group.designs,
                                 [](const Design& one) {
                                   return one.correlated || one.kind == DesignKind::samples;
                                 }) ||
             std::ranges::any_of(group.parameters, [](const auto& one) {
               return one.range && one.range->marginal.spread > 0;
             });
    };
    const auto& groups = result_.spec.groups;
    if (n_excluded == 0 || std::ranges::none_of(groups, is_stated)) return;
    result_.notes.push_back(std::to_string(n_excluded) +
                            " samples are excluded: distributions and correlations of the rest "
                            "differ from those given, "
                            "and probabilities are those of the rest");
  }

  Expansion result_;
  std::vector<Problem> problems_;
  std::set<std::string> said_;
  FamiliesSoFar families_;
  std::unordered_map<std::string, int> by_identity_;
  std::string first_merged_;
};

const Group& group_of(const Expansion& expansion, const Case& one) {
  return expansion.spec.groups.at(one.group);
}

}  // namespace

Expansion expand(CampaignSpec spec, std::size_t most_planned) {
  return Expander(std::move(spec), most_planned).run();
}

std::vector<ParameterValue> parameters_of(const Expansion& expansion, const Case& one) {
  const Group& group = group_of(expansion, one);
  std::vector<ParameterValue> values;
  for (std::size_t p = 0; p < group.parameters.size(); ++p) {
    const Parameter& parameter = group.parameters[p];
    const int c = one.choices[p];
    values.push_back({parameter.name, parameter.text(c), parameter.si(c), parameter.dimension});
  }
  for (std::size_t d = 0; d < one.derived.size(); ++d) {
    const Derived& derived = expansion.spec.derived[d];
    const json text = spelled(one.derived[d], faultsim::si_unit(derived.dimension));
    values.push_back({derived.name, scalar_text(text), one.derived[d], derived.dimension});
  }
  return values;
}

nlohmann::json changes_of(const Expansion& expansion, const Case& one) {
  json result = json::object();
  for (const Change& change :
       changes_of_row(expansion.spec, group_of(expansion, one), one.choices, one.derived)) {
    result[change.pointer] = change.value;
  }
  return result;
}

nlohmann::json scene_of(const Expansion& expansion, const Case& one) {
  const Group& group = group_of(expansion, one);
  json scene = group.scene;
  for (Change& change : changes_of_row(expansion.spec, group, one.choices, one.derived)) {
    faultsim::put_value(scene, change.pointer, std::move(change.value));
  }
  return scene;
}

nlohmann::json scene_from_changes(const std::string& base, const std::string& changes) {
  json scene = json::parse(base);
  const json changed = json::parse(changes);
  for (const auto& [pointer, value] : changed.items()) {
    FAULTSIM_DEMAND(faultsim::put_value(scene, pointer, value), pointer);
  }
  return scene;
}

}  // namespace faultsweep
