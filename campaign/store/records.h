#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/spec/spec.h"
#include "simulator/result/result.h"

/// What goes into the store and comes out of it, as plain structs. SI; times of day in seconds
/// since 1970. JSON is text here: the store does not look into it.
namespace faultsweep {

using faultsim::CaseResult, faultsim::StageMetrics, faultsim::StepResult;

/// How the fault fields of a case stand in a campaign.
enum class FieldsState {
  none,    ///< not asked for.
  wanted,  ///< to be written, by the run of the case or, where it has a result, by one for them
           ///< only.
  kept,    ///< in Store::fields_folder.
  failed,  ///< the case has a result, but the run that was to add its fields failed.
};
constexpr auto words(FieldsState) { return std::array{"none", "wanted", "kept", "failed"}; }

/// A family as submitted.
struct FamilyRecord {
  std::string fingerprint;
  long unknowns = 0;
  long jump_unknowns = 0;
  double operator_seconds = 0;  ///< predicted.
  double memory_bytes = 0;      ///< predicted peak.
  int n_operators = 1;  ///< more where salt creeps: one per step length and the elastic one.
  /// Salt creeps: every worker on the family builds its operators and holds them; none is on file.
  bool creeps() const { return n_operators > 1; }
};

/// A base scene that cases are changes of.
struct BaseScene {
  std::string source;    ///< file that relative paths in the document start from.
  std::string document;  ///< JSON text.
};

/// A parameter of a campaign; those of a case are CaseParameters.
struct StoredParameter {
  std::string name;
  Dimension dimension = Dimension::number;
  bool is_text = false;
  bool operator==(const StoredParameter&) const = default;
};

/// The JSON array of {"name", "dimension"} that the store keeps.
std::string parameters_to_json(const std::vector<StoredParameter>& parameters);
/// Throws StorageError when the text is not what parameters_to_json writes.
std::vector<StoredParameter> parameters_from_json(const std::string& text);

/// A row of case_parameters: the value of a campaign's parameter in one of its cases.
struct CaseParameter {
  int index = 0;             ///< from 0, in Submission::parameters.
  std::optional<double> si;  ///< nothing for words.
  std::string text;          ///< as given, with its unit.
  bool operator==(const CaseParameter&) const = default;
};
/// By index, ascending; those that the case does not have (of other groups) are missing.
using CaseParameters = std::vector<CaseParameter>;

/// A case as submitted.
struct CaseRecord {
  std::string identity;
  int family = 0;       ///< index in Submission::families.
  int scene = 0;        ///< index in Submission::scenes.
  std::string changes;  ///< JSON object: pointer -> value, applied to the base scene.
  CaseParameters parameters;
};

/// A row of a design and the case that it became.
struct DesignRow {
  int design = 0;     ///< from 0: index in `groups` of the resolved spec.
  long row = 0;       ///< from 1, in the order of the design.
  long position = 0;  ///< of the case in the campaign, from 1; rows that are merged share it.
};

/// A campaign as submitted: the three copies of the spec and what became of it.
struct Submission {
  std::string name;
  std::string source;         ///< file name.
  std::string spec_given;     ///< text as given.
  std::string spec_resolved;  ///< canonical text with all defaults.
  std::vector<StoredParameter> parameters;
  std::string rank_by;  ///< expression over the metrics.
  long n_excluded = 0;
  long n_merged = 0;
  Policy policy;
  KeepFields keep_fields = KeepFields::none;
  std::vector<BaseScene> scenes;
  std::vector<FamilyRecord> families;
  std::vector<CaseRecord> cases;  ///< in the order of the expansion.
  std::vector<DesignRow>
      design_rows;  ///< of all designs, if one is sampled or rows were merged; else none.
};

/// A round of a campaign as stored; its place in the list is its number.
struct RoundRecord {
  long first_position = 1;  ///< of its cases in the campaign, which are consecutive.
  long n_cases = 0;         ///< that no earlier round has.
  std::string design;       ///< JSON, as in a spec; "" of round 0, whose design is the spec's.
  std::string reason;       ///< why it was proposed.
  double proposed_at = 0;
};

struct SubmitOutcome {
  std::int64_t campaign = 0;
  std::string name;      ///< "sweep-2" where a different campaign has the name.
  bool existed = false;  ///< the very same campaign is there already: nothing was added.
  long n_cached = 0;     ///< cases with a result from earlier.
  long n_fields = 0;     ///< of these: to be run again, for their fields only.
  /// The submission's, or that of the campaign that is there.
  KeepFields keep_fields = KeepFields::none;
};

/// How the cases of a campaign, or of one of its families, stand.
struct CaseCounts {
  long n_cases = 0, n_done = 0, n_failed = 0, n_waiting = 0;
  long n_converged = 0;   ///< of done.
  long n_event = 0;       ///< of done: complete, with slip events.
  long n_unresolved = 0;  ///< of done: complete, but the size of the events is the mesh's.
  /// Of waiting: those with a result, for their fields only; of done where only the fields of the
  /// cases shown first are kept.
  long n_fields_waiting = 0;
  /// Of failed: those with a result whose fields could not be added; of done in the same place.
  long n_fields_failed = 0;
  long n_fields_kept = 0;  ///< of done.
  /// Done with a history to its end.
  long n_complete() const { return n_converged + n_event + n_unresolved; }
  CaseCounts& operator+=(const CaseCounts& more);
};

/// A campaign in short. Counts are those of the campaign: a case whose fields it still wants waits,
/// one whose fields could not be added has failed, although both have a result; not so where only
/// the fields of the cases shown first are kept (KeepFields::shown), which are an extra.
struct CampaignInfo : CaseCounts {
  std::int64_t id = 0;
  std::string name;
  double submitted_at = 0;
  bool cancelled = false;
  std::string source;
  std::vector<StoredParameter> parameters;
  std::string rank_by;
  long n_excluded = 0, n_merged = 0;
  Policy policy;
  KeepFields keep_fields = KeepFields::none;
  std::string conclusion;  ///< why no further round was proposed; "" = none was asked for, or is.
};

/// A family with cases that still wait.
struct WaitingFamily {
  std::int64_t family = 0;
  FamilyRecord predicted;
  std::string operator_fingerprint;        ///< "" = not known yet.
  std::optional<double> seconds_per_case;  ///< mean of what this family's cases took.
  std::vector<std::int64_t> cases;         ///< ids, by position.
  std::vector<std::int64_t> fields_only;   ///< those of them that have a result already.
};

/// A case with a result, by what a further run for its fields would take.
struct DecidedCase {
  long position = 0;
  FieldsState fields = FieldsState::none;
  double seconds = 0;                ///< that the run took which decided it.
  double operator_seconds = 0;       ///< of building its operator: measured, or else predicted.
  std::string operator_fingerprint;  ///< "" = not known.
  bool creeps = false;               ///< see FamilyRecord.
};

/// What is needed to run a case.
struct CaseInput {
  std::int64_t id = 0;
  std::int64_t scene = 0;
  long position = 0;  ///< in the campaign asked for.
  std::string changes;
  std::string identity = "";
};

/// How a run ended; only `completed` has a result.
enum class RunStatus {
  completed,  ///< a result, whatever its outcome.
  refused,    ///< the simulator says that the scene is wrong.
  crashed,    ///< the process was killed by a signal or ended by itself.
  hung,       ///< over the time limit; killed.
  garbled,    ///< the process wrote something that is not a reply.
  memory,     ///< over the memory limit, or killed for want of memory.
  world,      ///< the simulator reports disk or file trouble.
  bug,        ///< the simulator reports an internal error.
};
constexpr auto words(RunStatus) {
  return std::array{"completed", "refused", "crashed", "hung", "garbled", "memory", "world", "bug"};
}

/// One attempt at a case, as the manager commits it.
struct RunRecord {
  std::int64_t case_id = 0;
  RunStatus status = RunStatus::crashed;
  std::string reason;  ///< "" when converged.
  std::optional<int> signal;
  std::optional<int> exit_code;
  std::string log_tail;
  std::string host;
  int rank = 0;
  double wall_seconds = 0;
  bool final = true;  ///< false: the case waits for another attempt.
  bool has_fields =
      false;  ///< completed, and the fields that the campaign keeps are in their files.
  bool fields_only = false;  ///< of a case that had its result before; decides its fields alone.
  std::optional<faultsim::CaseResult> result;  ///< iff completed.
};

/// An operator as the simulator reports it.
struct OperatorRecord {
  std::string fingerprint;
  bool from_cache = false;
  double seconds = 0;
  std::int64_t unknowns = 0, jump_unknowns = 0, bytes = 0, peak_bytes = 0;
};

/// What to do about a damaged store.
inline constexpr const char* kDamageCure =
    "restore a backup (faultsweep backup), or move the file away and submit again";

/// Of this machine, as OwnerInfo has it.
std::string host_name();

/// Another process kept the database locked for the whole waiting time; the only storage error that
/// may go away by itself. Exit code 4 like its base.
class StoreBusy : public faultsim::StorageError {
  using StorageError::StorageError;
};

/// Who manages the store.
struct OwnerInfo {
  std::string host;
  std::int64_t pid = 0;
  double heartbeat_at = 0;
  std::int64_t campaign = 0;
  int n_workers = 0;
  std::string progress;  ///< JSON.
  bool alive = false;
};

struct EventRecord {
  double at = 0;
  std::string kind;
  std::string text;
};

/// One run of a case as stored.
struct StoredRun {
  std::int64_t id = 0;
  int attempt = 0;
  double ended_at = 0, wall_seconds = 0;
  std::string status, outcome, reason, log_tail, operator_fingerprint, host;
  int rank = 0;
  std::optional<std::int64_t> signal, exit_code;
  bool fields_only = false;
};

/// A case of a campaign with all that is stored about it.
struct StoredCase {
  std::int64_t id = 0;
  long position = 0;
  std::string identity, family, state, changes;
  CaseParameters parameters;
  std::int64_t scene = 0;
  FieldsState fields = FieldsState::none;
  std::filesystem::path fields_folder;  ///< where faults.h5 and faults.xmf are, or would be.
  std::vector<StoredRun> runs;
  bool has_result = false;
  faultsim::CaseResult
      result;  ///< without observations and fields; identity, steps, stages, whole.
};

/// A name in the store, of a stage or a fault.
struct NamedId {
  std::int64_t id = 0;
  std::string name;
};

/// See RankedCase, and stage_metrics in schemas/store_3.sql and store_10.sql.
int rank_class(faultsim::Outcome outcome, bool activation_resolved);

/// One row of a ranking: a case and its metrics of one stage ("" = whole history).
struct RankedCase {
  std::int64_t id = 0;
  long position = 0;
  CaseParameters parameters;
  std::optional<double> score;  ///< what it was ranked by; none in the default order.
  int rank_class = 0;  ///< 0 complete, 1 complete with an unresolved activation or events, 2
                       ///< unstable, 3 ended early otherwise.
  std::string outcome;
  bool weakening_resolved = true;
  std::string unexpected_fault;  ///< slides again after its pressure has recovered; "" = none.
  bool plane_strain = false;     ///< areas, potency and moments are per metre of strike.
  bool interpolated = false;     ///< its operator, on an operator surface.
  std::optional<double> pressure_margin;  ///< Pa.
  faultsim::StageMetrics metrics;         ///< of its faults those that slide and open first.
  std::optional<faultsim::FaultStageMetrics> fault_metrics;  ///< where one fault is ranked.
};

/// A value of a table that is read row by row: missing, whole number (flags: 0, 1), number, text.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

/// A case of a campaign as one row of a table, whether it has a result or not.
struct CaseRow {
  std::int64_t id = 0;  ///< the same number: one stored result, shared by campaigns.
  long position = 0;
  std::string identity, state;
  std::string outcome;            ///< of the result; "" without one.
  std::string status;             ///< how the run that decided the case ended; "" before.
  std::string reason;             ///< why that is not a full history.
  std::optional<int> rank_class;  ///< see RankedCase; none without a result in the stage.
  CaseParameters parameters;
  std::vector<Cell> metrics;  ///< the columns asked for.
  /// A history to its end: what statistics may take.
  bool complete() const { return rank_class && *rank_class < 2; }
};

/// When each fault of a case began to slide in a stage.
struct CaseOnsets {
  struct Onset {
    std::int64_t fault = 0;  ///< id, of Store::faults.
    int step = 0;            ///< the first at whose end it slides.
    double time = 0;         ///< s, of the end of that step, or of its bracket (FaultOnset).
    double change = 0;  ///< Pa, Δp there of the side that changed more, or of the fault's fluid.
    double began =
        0;  ///< s, of the end of the step before, or the bracket's start: it began after.
    double change_before = 0;  ///< Pa, Δp then of the region that `change` is of; NaN = not known.
  };
  long position = 0;
  std::optional<int> rank_class;  ///< as of CaseRow.
  int last_step = 0;              ///< of the stage that has a result.
  double end = 0;                 ///< s, of that step, where the history ends early; else 0.
  std::vector<Onset> onsets;      ///< of the faults that slide.
  /// Faults of which the cells do not resolve whether they slide in the stage.
  std::vector<std::int64_t> unresolved;
  bool complete() const { return rank_class && *rank_class < 2; }
};

/// A slip event of a case, as statements about what was seen speak of it.
struct SeenEvent {
  long position = 0;       ///< of its case.
  std::int64_t fault = 0;  ///< id, of Store::faults, where it nucleated.
  double time = 0;         ///< s, of onset.
  double change = 0;  ///< Pa, Δp there of the side that changed more, or of the fault's fluid.
  std::optional<double> magnitude;  ///< none in plane strain.
};

/// Counts of what went wrong, for status.
struct FailureCount {
  std::string status;
  std::string reason;
  long count = 0;
};

// Nights of `faultsweep nightly`; columns: schemas/store_6.sql ------------------------------------

struct NightCaseRecord {
  std::string campaign;
  long position = 0;
  std::string identity, label;
  std::string verdict;  ///< to_string(Verdict).
  bool regressed = false;
  double max_ulps = 0;
  std::optional<int> load_step;
  std::string place, quantity, remark;
  std::string digest;  ///< of all numbers of the result; "" = no result.
  std::optional<double> wall_seconds;
  std::string outcome;
  std::optional<double> activated_area, moment, chi_bar;
};

struct NightRecord {
  std::int64_t id = 0;
  double at = 0, wall_seconds = 0;  ///< s since 1970; s.
  std::string suite;
  std::string environment, environment_fields, baseline_environment;
  std::string program_version;
  int numerics_version = 0;
  long n_compared = 0, n_regressed = 0;
  int exit_code = 0;
  std::optional<std::string> blessed;  ///< the reason, where the night became the baseline.
  std::vector<NightCaseRecord> cases{};
};

// Trades of accuracy for speed; columns: schemas/store_7.sql
// ---------------------------------------

/// How far the cases of a campaign are off at a tier, measured on a sample of them.
struct ErrorBar {
  std::string campaign;  ///< its name in the spec.
  std::string tier;
  std::string metric;     ///< of the whole history; SI.
  std::string reference;  ///< the tier that it was measured against.
  long n_cases = 0;
  double rms = 0, largest = 0;
  std::int64_t trade = 0;  ///< TradeRecord::id; given by the store.
};

struct TradeRecord {
  double at = 0;         ///< s since 1970.
  std::string source;    ///< the scene's or spec's file.
  std::string campaign;  ///< in this store, whose cases are the choices.
  std::string program_version;
  std::string report;  ///< JSON.
  std::vector<ErrorBar> error_bars;
  std::int64_t id = 0;  ///< given by the store.
};

}  // namespace faultsweep
