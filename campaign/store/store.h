#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "campaign/expression/expression.h"
#include "campaign/store/records.h"

namespace faultsweep {

class Checksums;
class RowDigest;
class Connection;
struct ResultTables;

/// What a metric is of. Ids are those of Store::stages and Store::faults.
struct MetricScope {
  std::optional<std::int64_t> fault = std::nullopt;  ///< none = all faults of the case together.
  std::optional<std::int64_t> stage = std::nullopt;  ///< none = the stage of the query.
};
/// The SQL of a metric of spec/metrics.h (or "outcome", "rank_class", ...) for Symbol::sql of
/// expressions and for columns, given to Store::ranking and Store::for_each_case. Of the row that
/// the query goes along: of its stage and, with `of_fault`, of its fault where the metric is one of
/// faults. @pre the metric is in metric_catalogue().
std::string metric_sql(const std::string& metric, bool of_fault = false);
/// Whether stages have values of their own of it, and faults.
bool has_stages(const std::string& metric);
bool has_faults(const std::string& metric);
/// The same of another fault or stage. @pre has_stages(metric), and has_faults for that of a fault.
std::string metric_sql(const std::string& metric, const MetricScope& scope,
                       std::int64_t stage_of_query);
/// Metrics of faults whose value at the end of each load step is kept, slip and what follows from
/// it since the start of the case.
std::vector<std::string> history_metrics();
/// The value of such a metric at a load step, as metric_sql. NULL where the case has no such step.
/// @param whole_history  id of the stage "".
std::string history_sql(const std::string& metric, std::int64_t fault, std::int64_t whole_history,
                        int step);
/// The least, or the largest, pressure change (Pa) of a region from the beginning of the stage of
/// the query, the end of the load step before, to its end, as metric_sql. NULL where the case has
/// no such steps or regions.
std::string stage_pressure_sql(std::size_t region, bool largest);
/// Ids of the faults and stages that have metrics in a campaign.
struct MetricIds {
  std::vector<std::int64_t> faults, stages;
};
/// Where the value of a metric is not resolved, as SQL for Symbol::unresolved, over the same row as
/// metric_sql of the same arguments: where there is no result; of all but `outcome` and
/// `plane_strain` where the history ended early; and besides
///   * slides: where activation_resolved is 0 in its row, which is that of the fault, stage or
///   whole
///     history that it is of;
///   * activation_..., activated_fault, activated_area: there too; of all faults together where it
///     is 0 for any of them. One that slides for certain resolves whether some fault does, but not
///     which is the first, when, and what the areas add up to;
///   * unexpected, unexpected_fault, n_episodes, which follow from slides, and pressure_margin,
///   which
///     is there if nothing slides: where it is 0 for any fault in any stage;
///   * jumps, n_events, event_..., and what an event makes, that is moment, max_slip, potency,
///     slipping_area, activated_area, magnitude_if_released_at_once: where the outcome is
///     unresolved_event or weakening_resolved is 0. Both are of the case: an event may be the
///     mesh's or unproven, its size is, and it loads all other faults. Magnitudes in plane strain
///     are missing for certain.
/// slips, opens and what is of openings, of χ̄ and χ are taken as of these cells. Missing counts as
/// resolved. @pre the metric is in metric_catalogue(), or outcome, activated_fault, opened_fault or
/// unexpected_fault.
std::string unresolved_sql(const std::string& metric, const MetricIds& all, bool of_fault = false);
/// The same of another fault or stage.
std::string unresolved_sql(const std::string& metric, const MetricIds& all,
                           const MetricScope& scope, std::int64_t stage_of_query);
/// The same for the index-th of a campaign's parameters: SI, or words.
std::string parameter_sql(int index, bool is_text);
/// The same for the number of the case in its campaign, from 1.
std::string case_sql();

/// Whether the files of fault fields that are said to be kept are in their folder.
bool fields_are_there(const std::filesystem::path& folder);

/// What lies in a folder's file system: STATFS's f_type; 0 = not known.
long file_system_type(const std::filesystem::path& folder);
/// Whether that is a network file system, where WAL must not be used.
bool is_network_file_system(long f_type);

/// The database of campaigns, campaign.sqlite in the store's folder. One named function per query.
///
/// Every function throws StorageError (exit 4) when the disk or the file fails; what was committed
/// before is intact. Who writes: the manager (open_owner) for as long as it lives; submit, cancel
/// and retry (open_writer) in one short transaction; readers never.
class Store {
 public:
  /// Opens for a short write; creates folder and file where missing. Migrates an older file and
  /// refuses a newer one. On a network file system: no WAL, and remark() says so.
  /// @param assume_network  treat the folder as on one (tests).
  static Store open_writer(const std::filesystem::path& folder, bool assume_network = false);
  /// The same for the manager, the only one that checkpoints.
  static Store open_owner(const std::filesystem::path& folder);
  /// Opens for reading. A missing store is a StorageError that names `faultsweep
  /// submit`.
  static Store open_reader(const std::filesystem::path& folder);
  /// From now on all queries see one state, that of the next one, whatever is written meanwhile.
  /// @pre opened for reading.
  void hold_state() const;
  void let_state_go() const;  ///< ends hold_state().
  /// It sees what is written later. False where the folder cannot be written and nobody wrote when
  /// it was opened: then SQLite takes the file for one that never changes.
  bool sees_changes() const;
  Store(Store&&) noexcept;
  Store& operator=(Store&&) = delete;
  ~Store();

  const std::string& remark() const { return remark_; }
  const std::filesystem::path& folder() const { return folder_; }

  // Campaigns -------------------------------------------------------------------------------------
  /// Adds a campaign, its families and the cases that are new, in one transaction. The same
  /// expanded spec under the same name is recognised; another one gets a number behind its name.
  SubmitOutcome submit(const Submission& submission);
  /// What submit would return, but nothing is added; campaign is 0 where it would be a new one.
  SubmitOutcome preview(const Submission& submission) const;
  /// Adds a further round, in one transaction: the cases that the campaign does not have yet,
  /// behind those that it has; rows of the design that are cases of earlier rounds point at these.
  /// Returns how many cases are new.
  long record_round(std::int64_t campaign, const Submission& submission, const std::string& design,
                    const std::string& reason);
  void conclude(std::int64_t campaign, const std::string& conclusion);
  std::vector<RoundRecord> rounds(std::int64_t campaign) const;
  std::vector<CampaignInfo> campaigns() const;  ///< newest last, without counts of cases.
  /// By name; "" = the newest. Throws InputError listing the names there are, StorageError when
  /// there is none. Counting takes about 0.5 µs per case: leave it out where it is not needed.
  CampaignInfo campaign(const std::string& name, bool with_counts = true) const;
  void cancel(std::int64_t campaign);
  bool is_cancelled(std::int64_t campaign) const;
  /// Failed cases (and, if asked, done ones whose history ends early) wait again; returns how many.
  /// Done results are replaced when the new run ends, not before.
  long retry(std::int64_t campaign, bool unconverged_too, std::optional<long> position);
  BaseScene base_scene(std::int64_t scene) const;
  struct SpecCopies {
    std::string given, resolved, expanded_hash;
  };
  SpecCopies spec_copies(std::int64_t campaign) const;
  /// Rows of the campaign's designs by design and row. Every latin-hypercube, sobol or morris
  /// design (or nested one with such) has them, but for its excluded rows; others only where rows
  /// were merged: elsewhere the cases of a design, by position, are its rows.
  std::vector<DesignRow> design_rows(std::int64_t campaign) const;

  // Running ---------------------------------------------------------------------------------------
  /// Families of the campaign with cases that wait, for a result or for their fields only.
  std::vector<WaitingFamily> waiting_families(std::int64_t campaign) const;
  /// The result of a case as stored; none = it has none.
  std::optional<faultsim::CaseResult> stored_result(std::int64_t case_id) const;
  /// Where the fault fields of a case are written: faults.h5 and faults.xmf in this folder.
  std::filesystem::path fields_folder(const std::string& campaign, long position) const {
    return fields_folder(campaign) / std::to_string(position);
  }
  std::filesystem::path fields_folder(const std::string& campaign) const {
    return folder_ / "fields" / campaign;
  }
  /// Fields that were kept but whose files are gone are wanted again; returns of how many cases.
  /// Where only those of the cases shown first are kept, these and what is still wanted are
  /// forgotten instead: they are chosen anew (want_fields).
  long requeue_missing_fields(const CampaignInfo& campaign);
  /// What fields of a case with a result would take. @pre the campaign has the case.
  DecidedCase decided_case(std::int64_t campaign, std::int64_t case_id) const;
  /// The fields of these cases are wanted, by a run for them only, and of no others. @pre they have
  /// results, and the campaign keeps fields of the cases shown first.
  void want_fields(std::int64_t campaign, const std::vector<std::int64_t>& cases);
  CaseInput case_input(std::int64_t campaign, std::int64_t case_id) const;
  /// Commits attempts, in one transaction each group: the run, and with a result also metrics,
  /// stage metrics, histories. A case that is not waiting any more keeps what it has: no second
  /// success. A run for fields only changes nothing but how the fields of its case stand.
  void record_runs(std::int64_t campaign, const std::vector<RunRecord>& runs);
  void record_operator(std::int64_t family, const OperatorRecord& record);
  void record_event(std::optional<std::int64_t> campaign, const std::string& kind,
                    const std::string& text);

  // The one manager -------------------------------------------------------------------------------
  /// Makes this process the owner. A dead owner (process gone, or, on another host, silent for
  /// 60 s) is taken over, noted as an event; a living one is a StorageError that names it.
  void claim_ownership(std::int64_t campaign, int n_workers);
  /// Says that this process lives. Throws StorageError, changing nothing, where the store has
  /// another owner by now.
  void heartbeat(const std::string& progress);
  void release_ownership();
  std::optional<OwnerInfo> owner() const;
  /// An owner that has died; none = it has none. Throws StorageError, naming a living one.
  std::optional<OwnerInfo> dead_owner() const;
  void checkpoint();
  /// How long each access waits where another process has locked the store, before it throws
  /// StoreBusy; 10 s unless set.
  void wait_for_locks(double seconds);
  /// Other processes of this host that hold a lock for writing, as "1234 (sqlite3)"; none = nobody
  /// is known to.
  std::vector<std::string> lock_holders() const;

  // Reading ---------------------------------------------------------------------------------------
  /// A case of the campaign by position from 1, or by (the beginning of) its identity. Throws
  /// InputError where there is none, or where that beginning fits several.
  StoredCase stored_case(std::int64_t campaign, const std::string& name) const;
  /// What to list and how to order it.
  struct RankingQuery {
    std::string stage;                                 ///< "" = the whole history.
    std::optional<std::int64_t> fault = std::nullopt;  ///< see faults(); none = all together.
    SqlFragment by;          ///< number, largest first; empty = default order.
    bool ascending = false;  ///< smallest first instead.
    SqlFragment where;       ///< condition; empty = all.
    long limit = 0;          ///< 0 = all.
    long skip = 0;           ///< rows left out before the first one.
    /// `skip` and `limit` count from the last row; rows come in their order all the same.
    bool from_end = false;
  };
  /// Cases of the campaign with metrics of the stage; rank classes stay apart, complete histories
  /// first, of these the ones with unresolved events last. Default order: activated area, open
  /// area, M0, then inactive cases by pressure margin, χ̄; of a fault the same without the margin.
  std::vector<RankedCase> ranking(std::int64_t campaign, const RankingQuery& query) const;
  /// How many cases the ranking has, whatever its limit, by rank class.
  using ClassCounts = std::array<long, 4>;
  ClassCounts class_counts(std::int64_t campaign, const RankingQuery& query) const;
  /// Whether there are results per metre of strike, and in total.
  struct Kinds {
    bool plane_strain = false, total = false;
    bool mixed() const { return plane_strain && total; }
  };
  /// Of the campaign's results that `where`, `stage` and `fault` of the query select.
  Kinds kinds(std::int64_t campaign, const RankingQuery& query) const;
  /// Stages that have metrics; "" is the whole history.
  std::vector<NamedId> stages(std::int64_t campaign) const;
  std::vector<NamedId> faults(std::int64_t campaign) const;  ///< that have metrics.
  /// Which cases to read, and what of them.
  struct TableQuery {
    std::string stage;                                 ///< "" = the whole history.
    std::optional<std::int64_t> fault = std::nullopt;  ///< whose metrics `of_fault` are.
    std::vector<SqlFragment> columns;                  ///< values or conditions, of metric_sql.
    SqlFragment where;                                 ///< condition; empty = all.
    bool by_design_row = false;  ///< order of design_rows: merged rows repeat their case.
  };
  /// Visits the campaign's cases by position, one in memory at a time.
  void for_each_case(std::int64_t campaign, const TableQuery& query,
                     const std::function<void(const CaseRow&)>& visit) const;
  /// Visits them with the onsets of the query's stage, which are kept apart: no history is read.
  /// Its fault, columns and order mean nothing here.
  void for_each_onset(std::int64_t campaign, const TableQuery& query,
                      const std::function<void(const CaseOnsets&)>& visit) const;
  /// Visits the slip events of the query's cases by position, in order of time; the same holds.
  void for_each_slip_event(std::int64_t campaign, const TableQuery& query,
                           const std::function<void(const SeenEvent&)>& visit) const;
  /// A load step of histories to their end.
  struct LoadStep {
    int step = 0;
    std::string stage;
    double earliest = 0, latest = 0;  ///< s, its end; alike unless durations differ.
    long n_cases = 0;                 ///< that have it in this stage.
  };
  /// Of the query's cases, in the query's stage; by step.
  std::vector<LoadStep> load_steps(std::int64_t campaign, const TableQuery& query) const;
  /// Columns of the χ histories, units in their names as in the view chi_history_wide; what is per
  /// metre of strike in plane strain has a column for each kind of result.
  static std::vector<std::string> history_columns(Kinds kinds);
  /// Visits the histories by position, fault and step; cells in the order of history_columns().
  void for_each_history_row(std::int64_t campaign, const TableQuery& query, Kinds kinds,
                            const std::function<void(const std::vector<Cell>&)>& visit) const;
  /// How many of its results are approximate beyond mesh and time steps, and the worst of them.
  struct Approximations {
    long n_results = 0;
    long n_interpolated = 0;  ///< on an operator surface; with its largest relative errors.
    double error_of_stiffness = 0, error_of_slip = 0;
    std::optional<double> error_of_chi_bar;  ///< of probing cases; none without any.
    long n_covered_in_part = 0;              ///< a flow result does not cover the compartments.
    double least_coverage = 1;               ///< share of their volume.
  };
  Approximations approximations(std::int64_t campaign) const;
  /// The smallest numerics version of its results; that of the program where it has none.
  int oldest_numerics(std::int64_t campaign) const;
  std::vector<FailureCount> failure_counts(std::int64_t campaign) const;
  std::vector<EventRecord> events(std::int64_t campaign, int limit) const;  ///< newest first.
  struct FamilyProgress : CaseCounts {
    std::string fingerprint, operator_fingerprint;
    std::optional<double> build_seconds;
    int n_operators = 1;                     ///< see FamilyRecord.
    double memory_bytes = 0;                 ///< predicted.
    std::optional<std::int64_t> peak_bytes;  ///< measured, of the process that built it; none of
                                             ///< one that was only read, which takes far less.
  };
  std::vector<FamilyProgress> family_progress(std::int64_t campaign) const;
  /// Whether some case of the store, of whatever campaign, has no result. Far cheaper than counts.
  bool lacks_results() const;
  /// Other campaigns that have this case.
  std::vector<std::string> campaigns_with(std::int64_t case_id) const;

  // Nights -------------------------------------------------------------------------------------
  void record_night(const NightRecord& night);
  /// Nights of a suite ("" = of all), oldest first, at most the last `limit`.
  std::vector<NightRecord> nights(const std::string& suite, int limit) const;

  // Trades -------------------------------------------------------------------------------------
  /// Its error bars replace those of the same campaign, tier and metric.
  void record_trade(const TradeRecord& trade);
  std::vector<ErrorBar> error_bars(const std::string& campaign) const;
  /// Newest first, without their error bars.
  std::vector<TradeRecord> trades() const;

  // Care ------------------------------------------------------------------------------------------
  /// Copies the database to a new file, also while it is being written, and checks the copy: sound,
  /// checksums included, and as many rows in every table. Throws StorageError, leaving no file.
  void backup_to(const std::filesystem::path& target) const;
  /// What PRAGMA integrity_check, foreign_key_check and the checksums of campaigns and results
  /// find; empty = sound. Linear in the size of the store.
  std::vector<std::string> integrity_problems() const;
  /// The same of the store in a folder, in one sentence with the cure, also where it cannot even be
  /// opened; none = it is sound, or there is none. Tells damage from a bug when something
  /// impossible was read.
  static std::optional<std::string> damage_of(const std::filesystem::path& folder);

 private:
  /// A case in a ranking.
  struct RankedPlace {
    std::int64_t id = 0;
    long position = 0;
    int rank_class = 0;
    std::optional<double> score = {};
  };
  struct KeptPlaces {
    std::string key;  ///< all that they depend on but the state of the store.
    std::vector<RankedPlace> places;
    std::optional<bool> ascending = std::nullopt;  ///< by score; none = by position.
  };
  static constexpr std::size_t kMostKept = 4;  ///< 4 MB each, of 10^5 cases.
  Store(std::filesystem::path folder, std::unique_ptr<Connection> connection, std::string remark);
  std::vector<RankedCase> first_ranked(std::int64_t campaign, const RankingQuery& query) const;
  /// The query's cases by position, whatever they are ordered by.
  const std::vector<RankedPlace>& selected(std::int64_t campaign, const RankingQuery& asked) const;
  /// Gives these, which lie by position, their scores.
  void score(std::int64_t campaign, const RankingQuery& query,
             std::vector<RankedPlace>& places) const;
  const std::vector<RankedPlace>& order_by_score(std::int64_t campaign,
                                                 const RankingQuery& query) const;
  void forget_if_changed() const;
  void record_run(std::int64_t campaign, const RunRecord& run, double now);
  RowDigest record_result(std::int64_t case_id, std::int64_t run_id,
                          const faultsim::CaseResult& result);
  void forget_result(std::int64_t case_id);
  std::int64_t name_id(const std::string& name);
  const ResultTables& result_tables() const;
  std::int64_t add_scene(const BaseScene& scene);
  long add_round(std::int64_t campaign, const Submission& submission, const std::string& design,
                 const std::string& reason);

  std::filesystem::path folder_;
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Checksums> checksums_;
  mutable std::unique_ptr<ResultTables> tables_;  ///< made when first asked for.
  std::string remark_;
  mutable std::deque<KeptPlaces> selected_, orders_;  ///< the newest last, of this state:
  mutable std::int64_t counted_state_ = -1;
  std::map<std::string, std::int64_t> names_;  ///< ids in table `names`, of those looked up.
};

}  // namespace faultsweep
