#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/expression/expression.h"
#include "campaign/statistics/copula.h"
#include "campaign/statistics/marginal.h"
#include "simulator/common/units.h"
#include "simulator/documents/json_document.h"
#include "simulator/documents/schema.h"

/// A campaign's specification: what to vary, checked and resolved against its base scene. The JSON
/// spelling is in schemas/campaign.schema.json, the meaning of each key in its descriptions.
namespace faultsweep {

/// The largest number of cases that one campaign may have before exclusions. More are refused by
/// their number, before any is made.
inline constexpr long kMaximumCases = 100'000;

/// One value put into the scene document.
using Change = faultsim::PlacedValue;

/// One value of a parameter and what it does to the scene.
struct Choice {
  std::string text;          ///< as given: "100 m", "0.5", "mean".
  std::optional<double> si;  ///< SI; nothing for words.
  std::string pointer;       ///< into the spec, for messages.
  std::vector<Change> changes;
};

/// What a sampled design draws values from; its ends are the parameter's two choices.
struct SampledRange {
  Marginal marginal;      ///< in `unit`.
  std::string unit;       ///< as given for `from`, the mean or the median; "" for plain numbers.
  bool is_given = false;  ///< values are those of a file; the marginal says only how far they go.
};

/// A value drawn from a SampledRange. There may be 10^5 per parameter.
struct DrawnValue {
  double number = 0;  ///< in SampledRange::unit: what the scene gets, as its shortest decimal text.
  double si = 0;
};

/// Something that varies between cases. A value is addressed by its number: -1 = base, then
/// `choices`, then `drawn`.
struct Parameter {
  std::string name;                         ///< alias, JSON Pointer or a name of the spec's own.
  std::string pointer;                      ///< into the spec.
  std::vector<std::string> targets;         ///< scene pointers that its choices may change.
  Dimension dimension = Dimension::number;  ///< of Choice::si.
  bool is_text = false;                     ///< its choices are words, without si.
  bool has_own_values = false;  ///< factors or variants: its value is not that of its targets.
  Choice base;  ///< the value where a design leaves the parameter alone; no changes.
  std::vector<Choice> choices;
  std::optional<SampledRange> range;  ///< of a sampled design: no row has one of the choices.
  std::vector<DrawnValue> drawn;      ///< from `range`, made by `expand`; those of a file as read.

  int n_values() const { return static_cast<int>(choices.size() + drawn.size()); }
  std::string text(int value) const;
  std::optional<double> si(int value) const;
  const std::string& place(int value) const;  ///< into the spec, for messages.
  void append_changes(int value, std::vector<Change>& changes) const;
  /// Draws values from the range: position 0 is its lower end, 1 its upper one.
  void draw(const std::vector<double>& positions);
};

/// Where a value of a group's scene that is not the base's comes from.
struct Origin {
  std::string scene_pointer;
  std::string spec_pointer;
};

enum class DesignKind {
  grid,             ///< every combination; the last parameter varies fastest.
  list,             ///< the rows as given.
  zip,              ///< the i-th choice of every parameter together.
  one_at_a_time,    ///< the base case, then each choice of each parameter alone.
  monte_carlo,      ///< n samples, each by itself: further ones leave the first as they are.
  latin_hypercube,  ///< n samples; each n-th part of every range has one.
  sobol,    ///< n base samples in blocks A, AB_1 .. AB_D, (BA_1 .. BA_D,) B (Saltelli 2010).
  samples,  ///< the rows of a file, drawn by somebody else.
  places,   ///< the rows of a file, each a place with a name: no sample of anything.
  morris,   ///< n trajectories of D + 1 rows; in each every parameter moves once, by half the
            ///< levels.
};
constexpr auto words(DesignKind) {
  return std::array{"grid",  "list",    "zip",    "one-at-a-time", "monte-carlo", "latin-hypercube",
                    "sobol", "samples", "places", "morris"};
}
/// True for those whose rows `expand` draws by their seed.
bool is_sampled(DesignKind kind);
/// True for those whose rows are the lines of a file.
constexpr bool is_of_file(DesignKind kind) {
  return kind == DesignKind::samples || kind == DesignKind::places;
}

/// The rows of consecutive parameters of a group.
struct Design {
  DesignKind kind = DesignKind::grid;
  std::string pointer;  ///< into the spec.
  std::size_t n_parameters = 0;
  /// Value per parameter, -1 = its base. Of a list as read, of sampled designs made by `expand`.
  std::vector<std::vector<int>> rows;
  long n = 0;                 ///< sampled: samples, base samples (sobol) or trajectories (morris).
  long first = 0;             ///< monte-carlo: number of the first sample.
  int levels = 0;             ///< morris: even.
  bool second_order = false;  ///< sobol: blocks BA too.
  /// Between parameters of the design, numbered as there, drawn from ranges; empty = independent.
  struct Correlated {
    std::vector<std::size_t> parameters;
    std::vector<std::vector<double>> rank;  ///< Spearman's; [row][column].
    GaussianCopula copula;
  };
  std::optional<Correlated> correlated = std::nullopt;
  std::int64_t seed = 1;
  std::string file;           ///< of a file: its name as given.
  std::string fingerprint;    ///< of a file: of its text.
  std::string names;          ///< places: the parameter that has their names, a name to each row.
  bool without_base = false;  ///< one_at_a_time: no row of the base case.
};

/// One design on one scene. A spec without groups has a single group named "".
struct Group {
  std::string name;
  std::string pointer;          ///< of its design in the spec.
  nlohmann::json scene;         ///< the base with all `set` applied.
  std::vector<Origin> origins;  ///< what `set` put there, for messages.
  /// One, or those of a nested design: each row of a design with every row of the next.
  std::vector<Design> designs;
  std::vector<Parameter> parameters;  ///< in document order, those of designs[0] first.
  /// Only these rows of the designs, from 0, in this order; empty = all.
  std::vector<long> picked = {};
};

/// `exclude`: cases for which the expression is true are left out.
struct Exclusion {
  std::string text;
  std::string pointer;
  Expression expression;
};

/// `derived`: a scene parameter computed from others.
struct Derived {
  std::string name;
  std::string pointer;        ///< into the spec.
  std::string scene_pointer;  ///< what it sets.
  std::string text;
  Dimension dimension = Dimension::number;
  Expression expression;
};

/// A name that expressions of the spec may use.
struct SpecIdentifier {
  std::string name;
  std::string scene_pointer;  ///< "" for a parameter with a name of its own.
  Type type;
};

enum class FailureAction {
  proceed,  ///< "continue": note it and go on.
  abort,    ///< stop the campaign.
  retry,    ///< again, up to Policy::retries times.
};
constexpr auto words(FailureAction) { return std::array{"continue", "abort", "retry"}; }

struct Policy {
  FailureAction on_failure = FailureAction::proceed;
  int retries = 1;
  std::optional<double> time_limit;           ///< s per case.
  std::optional<double> operator_time_limit;  ///< s per build; none = by its prediction.
  std::optional<double> memory_limit;         ///< bytes per simulator process.
};

/// `operators`: how they are made where each sample would have its own.
struct OperatorPolicy {
  enum class Kind {
    exact,
    surface,    ///< interpolated over what is drawn from ranges and changes the operator.
    automatic,  ///< the same where that takes fewer operators.
  };
  Kind kind = Kind::exact;
  double tolerance = 3e-3;      ///< in χ̄.
  bool for_comparison = false;  ///< exact ones in place of those chosen, on the same cells.
};
constexpr auto words(OperatorPolicy::Kind) { return std::array{"exact", "surface", "automatic"}; }

/// `keep_fields`: of which cases fault fields are written, and of which load steps. No part of a
/// case's identity.
enum class KeepFields {
  none,
  shown,   ///< the ends of stages, of the cases that are shown first, once all are decided.
  stages,  ///< the ends of stages, of all cases.
  all,     ///< all load steps, of all cases.
};
/// `rounds`: a Monte Carlo sample that grows until a probability is known well enough.
struct StagedSample {
  std::string condition;     ///< over results, as of `rank --where`: what the probability is of.
  double width = 0;          ///< of its interval, wanted.
  double confidence = 0.95;  ///< of the interval.
  long most = 0;             ///< samples, however wide it still is.
};

/// One of `limits`: how far a parameter may go, from the first of its values towards the last,
/// before something happens on a fault. Its Parameter is that of the same name in the group: its
/// values are those of the coarse scan.
struct LimitSearch {
  std::string name;                 ///< of the parameter.
  std::string pointer;              ///< into the spec.
  std::vector<std::string> faults;  ///< each has a limit of its own; empty = all of the scene.
  std::string stage;                ///< where it may happen; "" = the whole history.
  std::string unsafe = "slides";    ///< what may: a condition of the fault in the stage.
  double tolerance = 0;             ///< wanted width of brackets, in `unit`.
  std::string unit;                 ///< of values as given: "bar"; "" for plain numbers.
  Dimension dimension = Dimension::number;
  std::vector<double> scan;  ///< values of the coarse scan in `unit`, one way.
};

constexpr auto words(KeepFields) { return std::array{"none", "shown", "stages", "all"}; }
/// Each case is to have its fields, and waits until it has.
constexpr bool are_of_all_cases(KeepFields keep) {
  return keep == KeepFields::stages || keep == KeepFields::all;
}
/// The load steps that are written of a case whose fields are kept: `stages` or `all`.
constexpr KeepFields steps_of(KeepFields keep) {
  return keep == KeepFields::shown ? KeepFields::stages : keep;
}

struct CampaignSpec {
  std::string name;  ///< [A-Za-z0-9._-]+
  std::string title;
  std::string source;  ///< file name, for messages.
  std::string given;   ///< the text as given.
  std::string
      scene_source;  ///< what relative paths in the scene start from (JsonDocument::source).
  std::vector<Group> groups;
  std::vector<Exclusion> exclude;
  std::vector<Derived> derived;             ///< ordered so that each uses only earlier ones.
  std::vector<SpecIdentifier> identifiers;  ///< what exclude and derived may name.
  Policy policy;
  std::string rank_by = "activated_area";  ///< an expression over metrics.h.
  KeepFields keep_fields = KeepFields::shown;
  OperatorPolicy operators;
  std::optional<StagedSample> staged_sample;  ///< none = its design is all there is.
  /// Of `limits`. The group's last design then varies one of their parameters at a time.
  std::vector<LimitSearch> limits;
  faultsim::JsonDocument document;  ///< the spec, for pointers and lines.
  faultsim::JsonDocument base;      ///< the base scene as given.
  bool base_is_inline = false;      ///< base is document's /base.

  /// The second of the three copies: JSON text in which every alias is a
  /// pointer, every range its values (or, where values are drawn, its ends: design and seed make
  /// the same values again), and every group carries its scene.
  std::string resolved() const;
};

/// Reads a spec and its base scene. Throws InputError with *all* problems of the spec. Whether the
/// scenes that it describes are valid is for `expand` to say, which has the cases.
CampaignSpec read_campaign(const std::string& path);

/// The same from text; a relative `base` is looked for beside `source`.
CampaignSpec parse_campaign(const std::string& text, const std::string& source);

/// The schema of specs, embedded from schemas/campaign.schema.json.
const faultsim::Schema& campaign_schema();

/// Whether a name can stand in commands and as a folder: letters, digits, dots, dashes and
/// underscores, beginning with none of the last three.
bool is_plain_name(const std::string& name);
inline constexpr const char* kPlainNameCure =
    "use letters, digits, dots, dashes and underscores, beginning with a letter or digit";

}  // namespace faultsweep
