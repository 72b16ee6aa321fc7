#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "campaign/spec/pointers.h"
#include "campaign/spec/sample_file.h"
#include "campaign/spec/spec.h"
#include "simulator/reading/read_scene.h"

/// Inside of the module: the steps from a spec's document to a CampaignSpec. Problems are
/// collected, each once; what depends on a wrong value is left out.
namespace faultsweep {

/// A group's scene while its design is read: what its parameters are called and worth.
struct SceneNames {
  faultsim::JsonDocument document;             ///< the group's scene.
  std::vector<faultsim::ParameterInfo> infos;  ///< of faultsim::parameters.
  std::map<std::string, std::string> aliases;  ///< of faultsim::parameter_aliases.

  explicit SceneNames(faultsim::JsonDocument scene);
  const faultsim::ParameterInfo* find(const std::string& scene_pointer) const;

 private:
  std::unordered_map<std::string, std::size_t> places_;  ///< of pointers in infos.
};

class SpecReader {
 public:
  SpecReader(const std::string& text, const std::string& source);
  /// Throws InputError with all problems.
  CampaignSpec read();

 private:
  using json = nlohmann::json;

  // spec_reader.cc: top level.
  void check_schema();
  /// No problem in this section so far.
  bool is_sound(const std::string& pointer) const;
  /// There, and no problem in it.
  bool is_usable(const std::string& pointer) const;
  void read_name();
  void read_base();
  void read_policy();
  void read_operators();
  std::optional<double> read_time_limit(const std::string& pointer);
  void problem(const std::string& pointer, const std::string& what, const std::string& cure);
  const json& at(const std::string& pointer) const;
  bool has(const std::string& pointer) const;
  /// Reads what is there, if it is there.
  template <typename Value>
  void read(const std::string& pointer, Value& value) const {
    if (has(pointer)) at(pointer).get_to(value);
  }
  /// Of an object, in document order and without "comment", or of an array, with "0", "1", ...
  struct Member {
    std::string key, pointer;
  };
  std::vector<Member> members(const std::string& pointer) const;
  /// Applies the `set` object at pointer to a scene and notes where each value came from.
  void apply_set(const std::string& pointer, json& scene, std::vector<Origin>& origins);
  /// Pointer of an alias in the scene; nothing (and a problem) when unknown.
  std::optional<std::string> resolve(const std::map<std::string, std::string>& aliases,
                                     const std::string& alias, const std::string& spec_pointer);
  std::optional<std::string> resolve(const SceneNames& names, const std::string& alias,
                                     const std::string& spec_pointer) {
    return resolve(names.aliases, alias, spec_pointer);
  }
  /// The names in a scene. Groups without a `set` of their own share them: making them takes
  /// milliseconds. Valid until the next call.
  const SceneNames& names_of(const json& scene);

  // count_cases.cc: from the document alone; 10^30 must be counted to be refused.
  bool check_count();
  struct CaseCount {
    long double n = 0;
    std::string words;  ///< how it comes about.
  };
  CaseCount count_cases(const std::string& design);
  std::vector<std::string> parts_of(const std::string& design) const;
  std::optional<std::pair<long double, long double>> count_samples(const std::string& design) const;

  // read_design.cc
  void read_designs(const std::string& pointer, const std::string& prefix, const json& scene,
                    const std::vector<Origin>& origins);
  void read_groups(const std::string& pointer, const std::string& prefix, const json& scene,
                   const std::vector<Origin>& origins);
  void read_design(const std::string& pointer, const SceneNames& names, Group& group);
  /// Adds columns to parameters, which are empty.
  void read_list(const std::string& pointer, const SceneNames& names, Design& design,
                 std::vector<Parameter>& parameters);
  /// samples.cc: the samples of a file, each file read once.
  std::string names_column(const std::string& design) const;
  const SampleFile& sample_file(const std::string& design);
  Parameter named_rows(const std::string& pointer, const SampleFile& file) const;
  std::optional<Parameter> given_parameter(const SampleFile::Column& column,
                                           const std::string& pointer, const SceneNames& names);
  void read_samples(const std::string& pointer, const SceneNames& names, Design& design,
                    std::vector<Parameter>& parameters);
  void read_sampling(const std::string& pointer, Design& design);
  void check_targets(const Group& group);
  bool check_group_count();
  std::size_t count_groups(const std::string& design) const;
  void check_zip(const std::vector<Parameter>& parameters);
  void read_correlations(const std::string& pointer, const std::vector<Parameter>& parameters,
                         Design& design);
  void check_morris(const Design& design, const std::vector<Parameter>& parameters);

  // choices.cc
  std::optional<Parameter> read_parameter(const std::string& pointer, const std::string& name,
                                          const SceneNames& names, DesignKind design);
  void check_stray_keys(const std::string& pointer);
  /// Of a parameter of a grid; 1 where it is incomplete, which is said elsewhere.
  long double count_values(const std::string& pointer) const;
  void check_change_count(Parameter& parameter);
  void read_targets(const SceneNames& names, Parameter& parameter);
  void read_values(const std::string& pointer, const SceneNames& names, Parameter& parameter);
  void read_range(const SceneNames& names, Parameter& parameter, DesignKind design);
  bool check_distribution_keys(const std::string& pointer);
  bool check_distribution(const std::string& pointer, const Marginal& marginal, DesignKind design);
  void read_distribution(const SceneNames& names, Parameter& parameter, DesignKind design);
  void read_scale(const SceneNames& names, Parameter& parameter);
  void read_variants(const SceneNames& names, Parameter& parameter);
  /// One value for all targets; nothing (and a problem) when it is not what the scene wants.
  std::optional<Choice> make_choice(const json& value, const std::string& pointer,
                                    const SceneNames& names, const Parameter& parameter);
  void set_base_choice(const SceneNames& names, Parameter& parameter);
  static void unify_kind(Parameter& parameter);

  // expressions.cc
  void collect_identifiers();
  void add_identifier(SpecIdentifier one);
  void add_other_aliases(const std::string& text);
  bool check_expression_length();
  void read_derived();
  void sort_derived();
  void read_exclusions();
  void embed_tables();
  void read_rank_by();
  void read_rounds();

  // read_limits.cc
  long double count_scan() const;
  void read_limits(const SceneNames& names, Group& group);
  void read_limit(const Member& one, const SceneNames& names, Group& group);
  void read_tolerance(const std::string& pointer, LimitSearch& search);
  std::optional<Expression> parse(const std::string& pointer, const Symbols& known);

  CampaignSpec spec_;
  nlohmann::ordered_json ordered_;  ///< the document with its keys in order.
  std::vector<faultsim::Problem> problems_;
  std::unordered_set<std::string> said_;            ///< pointer and text of each.
  std::optional<SceneNames> names_;                 ///< those that names_of gave last.
  Symbols symbols_;                                 ///< of spec_.identifiers.
  std::map<std::string, SampleFile> sample_files_;  ///< by name as given and names_column.
  long double n_cases_ = 0;                         ///< before exclusions.
};

}  // namespace faultsweep
