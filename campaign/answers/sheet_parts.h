#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/fault_sheet.h"
#include "campaign/answers/limit_table.h"

/// Inside of the module: what the parts of a fault's sheet are made from.
namespace faultsweep {

/// What the scene of a case says of a fault before production.
struct CaseStart {
  bool is_read = false;  ///< else nothing below is known.
  faultsim::InitialOnFault at;
  double dip = kNotKnown, throw_ = kNotKnown;  ///< rad, m; see SheetPlace.
  std::vector<double> region_pressure;         ///< of FaultOfSheet::regions, at the datum, Pa.
  double gradient = 0;                         ///< of their fluid, Pa/m.
};

/// A fault that is asked for.
struct FaultOfSheet {
  NamedId id;
  std::size_t index = 0;             ///< in the base scene.
  double datum = 0;                  ///< m.
  std::vector<std::size_t> regions;  ///< beside it, in Scene::pressure.
  std::vector<CaseStart> starts;     ///< per case, by position.
};

/// What the sheets of all faults share, read once.
struct SheetSource {
  const Store& store;
  const CampaignInfo& campaign;
  const SheetRequest& request;
  Selection selection;  ///< of no stage and no fault.
  faultsim::Scene base;
  Sampling sampling;
  SampleRows sample;
  std::vector<faultsim::StepResult> steps;  ///< of the first full history; none = there is none.
  std::optional<LimitTable> limits;         ///< none = the campaign searched none.
  std::vector<FaultOfSheet> faults;
};
/// Throws as find_fault_sheets.
SheetSource read_sheet_source(const Store& store, const CampaignInfo& campaign,
                              const SheetRequest& request);

/// t'_N and τ of the base scene at the fault's datum, its regions' p0 there, its dip and throw.
CaseStart start_of(const faultsim::Scene& scene, const FaultOfSheet& fault);

/// A case in a stage.
struct StageRow {
  long position = 0;
  int count = 1;  ///< how often it is a row of the sample.
  bool is_complete = false;
  Held slides = Held::unknown;
  std::optional<CaseOnsets::Onset> onset;  ///< where it slides, as computed.
  double onset_p0 = kNotKnown;    ///< Pa, of the region that onset->change is of, at the datum.
  std::vector<CaseRange> change;  ///< of FaultOfSheet::regions from the stage's beginning on, Pa.
};
/// @param stage  "" = the whole history.
std::vector<StageRow> read_stage_rows(const SheetSource& source, const FaultOfSheet& fault,
                                      const std::string& stage);

/// The stages of the first full history, in its order; of the results where there is none.
std::vector<std::string> stages_of_sheet(const SheetSource& source);

StageSliding sliding_in(const SheetSource& source, const FaultOfSheet& fault,
                        const std::string& stage, const std::vector<StageRow>& rows);
/// One for each way in which the pressure beside the fault goes in the stage.
std::vector<PressureBand> bands_of_stage(const SheetSource& source, const FaultOfSheet& fault,
                                         const std::string& stage,
                                         const std::vector<StageRow>& rows);
/// One for each limit of a pressure that was searched on the fault.
std::vector<PressureBand> bands_of_limits(const SheetSource& source, const FaultOfSheet& fault);

/// What the results are off by, and which are left out, in sentences.
std::vector<std::string> model_errors(const SheetSource& source, const SheetCounts& counts);
std::vector<std::string> provenance_of(const SheetSource& source, const FaultSheet& sheet);

// Words ---------------------------------------------------------------------------------------

std::string open_words(const PressureBand& band);      ///< " Left open: 9 undecided by cells."; "".
const char* to_word(PressureWay way);                  ///< "down to ".
std::string bar_text(double pressure);                 ///< "231 bar".
std::string year_text(double time);                    ///< "3.5 years", "20 days".
std::string words_of_stage(const std::string& stage);  ///< "primary production"; "whole history".
/// "12 to 20 bar", "12 bar"; "not known".
std::string range_words(const CaseRange& range, const ShownUnit& unit, int digits = 4);
/// What the shares of this sheet are: "probability" or "share of cases".
std::string share_word(const FaultSheet& sheet);

}  // namespace faultsweep
