#pragma once

#include <filesystem>
#include <string>

#include "campaign/query/selection.h"
#include "campaign/store/store.h"

/// `faultsweep export`: a campaign's cases as tables for other programs (docs/campaign.md).
namespace faultsweep {

enum class ExportFormat {
  csv,     ///< a row per case, whatever became of it.
  dakota,  ///< annotated tabular file of Dakota; cases with a full history only.
  salib,   ///< a folder with what SALib's analyses take; a row per row of the design.
};

struct ExportRequest {
  ExportFormat format = ExportFormat::csv;
  std::filesystem::path target;  ///< file, or folder for salib; "" = stdout.
  std::string metrics;           ///< names with commas; "" = all that fit the format.
  std::string where;             ///< condition; "" = all cases.
  std::string stage;             ///< "" = the whole history.
  std::string fault;             ///< "" = all faults of a case together.
  bool histories = false;        ///< csv: χ histories instead, a row per case, fault and step.
};

/// Writes the export, one case in memory at a time, and returns what is to be said about it, in
/// lines. Throws InputError (stage, metrics, where, target) before anything is written.
std::string export_campaign(const Store& store, const CampaignInfo& campaign,
                            const ExportRequest& request);

/// The formats that statistics programs read (export_statistics.cc).
std::string export_dakota(const Store& store, const CampaignInfo& campaign,
                          const Selection& selection, const ExportRequest& request);
std::string export_salib(const Store& store, const CampaignInfo& campaign,
                         const Selection& selection, const ExportRequest& request);

}  // namespace faultsweep
