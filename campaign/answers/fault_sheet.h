#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/escalation.h"
#include "campaign/answers/shares.h"
#include "campaign/render/answer.h"
#include "campaign/store/store.h"
#include "simulator/initial_state/on_fault.h"
#include "simulator/scene/field_depths.h"

/// The sheet of a fault: what an authority asks of it, from the cases of a campaign. One value; the
/// screen, JSON, CSV and the page (campaign/figures/fault_sheet_page.h) are renderings of it.
///
/// Pressures are absolute, of a compartment beside the fault, its fluid referred to one depth for
/// all cases, the *datum* of the sheet. They are those of the side that changed more where a fault
/// slides.
namespace faultsweep {

struct SheetRequest {
  std::string fault = {};            ///< "" = all, each a sheet of its own.
  std::optional<double> datum = {};  ///< m; none = the middle of the reservoirs beside the fault.
  double confidence = 0.95;          ///< of bounds.
  EscalationTable levels = default_levels();
  std::string program = {};  ///< with version and commit, for the provenance.
};

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// From the least to the largest over cases, SI; NaN where no case has a value.
struct CaseRange {
  double low = kNotKnown, high = kNotKnown;
  void add(double value);  ///< NaN does not take part.
  bool is_known() const { return low <= high; }
  bool varies() const { return low < high; }
};

/// Where the fault is: of the base scene, and over the cases where it varies.
struct SheetPlace {
  bool is_field = true;          ///< else a box.
  double x = 0;                  ///< m, of a field: across the faults, at the datum.
  double dip_from_vertical = 0;  ///< rad, > 0 east (of strike 0; else to the right of strike).
  double strike = 0;             ///< rad from north (+y) to east.
  double length = 0;             ///< m, along strike.
  faultsim::DepthInterval depths = {};  ///< of the fault, m.
  struct Region {
    std::string name;
    faultsim::DepthInterval depths = {};
    bool is_west = false;  ///< of a field.
  };
  std::vector<Region> regions;   ///< beside it; of a box all, as the mesh decides.
  std::optional<double> throw_;  ///< m, top of the eastern reservoir below that of the western one;
                                 ///< none where there is one only.
  CaseRange dips, throws;        ///< over the cases.
};

/// Of the fault at the datum, before any production.
struct SheetInitial {
  faultsim::InitialOnFault base;      ///< of the base scene.
  CaseRange normal, shear, pressure;  ///< over the cases, Pa; normal is t'_N, tension > 0.
  CaseRange region_pressure;          ///< p0 of the regions beside the fault, Pa.
  CaseRange chi_bar;                  ///< of the results' first step.
  long n_chi_bar = 0;                 ///< cases that have it.
};

/// Which way a pressure goes within a stage.
enum class PressureWay { falls, rises, holds };
constexpr auto words(PressureWay) { return std::array{"falls", "rises", "holds"}; }

/// How far a pressure may go before a fault slides, over all cases: from the limits that the
/// campaign searched, or from the load steps of its histories.
struct PressureBand {
  bool of_limits = false;
  std::string name;              ///< of the limit, else of the stage.
  std::string stage;             ///< "" = the whole history.
  std::string unsafe_condition;  ///< of the limit, else "slides".
  PressureWay way = PressureWay::falls;
  /// Absolute at the datum, Pa: as far as no case slides, and by where the first has, the end of
  /// its load step (of limits: the values of the search that were computed); none where that is not
  /// known, or no case slides: then `safe` is as far as all cases go.
  std::optional<double> safe, unsafe;
  std::optional<double> safe_change, unsafe_change;  ///< Pa, Δp there since the start.
  std::optional<double> surely_safe;  ///< of limits: what does not depend on the cells.
  /// Where the way begins, the farthest back of all cases, absolute, Pa; none = not known.
  std::optional<double> begin;
  /// Of histories how far full ones go, of limits the range tried, absolute, Pa.
  CaseRange reached;
  long safe_case = 0, unsafe_case = 0;  ///< that say so; 0 = none.
  long n = 0;                           ///< cases, or configurations of the limit.
  long n_unsafe = 0;                    ///< in which it happens, as computed.
  long n_at_once = 0;                   ///< of limits: already at the safe end of the range tried.
  long n_undecided = 0, n_unknown = 0;  ///< by cells; without a full history, or not found.
};

/// The sliding of a fault in a stage.
struct StageSliding {
  std::string stage;  ///< "" = the whole history.
  ShareCounts counts;
  Interval bounds;  ///< see bounds_of.
  /// A case that slides, as computed, and where it begins: somewhere within its load step.
  struct Moment {
    long position = 0;
    double time_before = kNotKnown, time = kNotKnown;          ///< s.
    double pressure_before = kNotKnown, pressure = kNotKnown;  ///< absolute at the datum, Pa.
  };
  std::optional<Moment> first, half, last;  ///< in time: half of those that slide have by then.
};

/// The largest slip event that nucleated on the fault.
struct SheetEvent {
  long position = 0;  ///< of its case.
  bool plane_strain = false;
  faultsim::SlipEvent event;
};
/// Of one kind of results, as numbers per metre of strike and totals are not compared.
struct SheetEvents {
  bool plane_strain = false;
  long n_cases = 0;  ///< with a result.
  long n_with = 0;   ///< with events on the fault.
  long n_early = 0;  ///< of n_cases: history ends early.
  std::optional<SheetEvent> largest, largest_resolved;
  long slip_case = 0;  ///< of the largest slip, event or not; 0 = nothing slips.
  double slip = 0;     ///< m.
  double moment = 0;   ///< M0 of that case's fault, N m or N m/m.
};

struct LevelShare {
  EscalationLevel level;
  ShareCounts counts;
  Interval bounds;
};

/// What became of the campaign's cases.
struct SheetCounts {
  long n_cases = 0, n_complete = 0, n_unresolved = 0, n_early = 0, n_failed = 0, n_waiting = 0;
  long n_unread = 0;  ///< whose scene cannot be read any more.
};

struct FaultSheet {
  CampaignInfo campaign;
  std::string title;  ///< of the campaign; "" = none.
  std::string fault;
  std::size_t fault_index = 0;  ///< in the base scene.
  faultsim::Scene base;         ///< before what the campaign varies.
  double datum = 0;             ///< m.
  double confidence = 0.95;
  Sampling sampling;
  SheetCounts counts;
  SheetPlace place;
  SheetInitial initial;
  std::vector<PressureBand> bands;
  std::vector<StageSliding> stages;  ///< in the order of the history; the whole one last.
  std::vector<SheetEvents> events;   ///< one, or one for each kind of results.
  EscalationTable table;
  std::vector<LevelShare> levels;
  std::vector<std::string> errors;      ///< of the model, in sentences.
  std::vector<std::string> provenance;  ///< in sentences.
};

/// How a level's colour is drawn.
faultsim::figure::RangeFill fill_of(LevelColour colour);

/// A sheet for each fault asked for, in the order of the scene. Throws InputError: no such fault,
/// no case with a result, the base scene cannot be read any more, a wrong condition of a level.
std::vector<FaultSheet> find_fault_sheets(const Store& store, const CampaignInfo& campaign,
                                          const SheetRequest& request);

/// Tables `place`, `initial_state`, `bands`, `stages`, `events` and `levels`, a row or more for
/// each fault, and what each sheet says in sentences (`says`). Of one sheet its sentences and
/// charts too.
/// @pre sheets are of one campaign, and not empty.
Answer to_answer(const std::vector<FaultSheet>& sheets);

// The sentences of a sheet ------------------------------------------------------------------------

std::string depth_text(double depth);  ///< "2,100 m".
/// What an authority asks first.
std::vector<std::string> headline_of(const FaultSheet& sheet);
std::vector<std::string> place_words(const FaultSheet& sheet);
std::string initial_note(const FaultSheet& sheet);
std::string band_words(const PressureBand& band);
std::vector<std::string> event_words(const FaultSheet& sheet);
std::string pressure_note(const FaultSheet& sheet);  ///< which pressures those of bands are.
std::string share_note(const FaultSheet& sheet);     ///< what `from` and `to` of shares are.

}  // namespace faultsweep
