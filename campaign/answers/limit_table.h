#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/render/answer.h"
#include "campaign/rounds/limit_searcher.h"
#include "campaign/store/store.h"

/// `faultsweep limits`: the limits of a campaign as a table.
namespace faultsweep {

/// A limit as a regulator counts pressure: absolute, at a datum.
struct DatumPressure {
  std::string region;   ///< the first pressure region that changes by the last safe value.
  double depth = 0;     ///< m, its datum: its top.
  double absolute = 0;  ///< Pa, p0 of the region at the datum and the last safe change.
};

/// A limit of a configuration and a fault.
struct LimitCell {
  LimitFinding finding;
  std::optional<DatumPressure> datum;  ///< of limits along pressure changes of a region only.
};

struct LimitRow {
  long configuration = 0;             ///< row of the spec's design, from 1.
  std::vector<std::string> settings;  ///< per parameter of the table.
  std::string fault;
  std::vector<std::optional<LimitCell>> cells;  ///< per limit; none where it is not of this fault.
  /// Of the safe band, in the unit of the first limit: from the safe end of the range to the last
  /// value known to be safe; of limits in both directions from the one downwards to the one
  /// upwards, negative where they cross. None where some limit is unknown.
  std::optional<double> width;
  bool is_open = false;  ///< a limit lies beyond its range: the band may be wider.
};

struct LimitTable {
  CampaignInfo campaign;
  std::vector<std::string> parameters;  ///< of the design, in its order.
  std::vector<LimitSearch> limits;
  std::vector<LimitRow> rows;  ///< narrowest band first, those without one last.
  bool is_finished = false;    ///< every search has ended; else cases wait.
};

/// Throws InputError where the campaign has no limits.
LimitTable make_limit_table(const Store& store, const CampaignInfo& campaign);

/// Tables `limits`, a row per configuration, fault and limit, and `crossings`; on the screen a row
/// per configuration and fault.
/// @param top  rows on the screen; 0 = all.
Answer to_answer(const LimitTable& table, long top);
/// The same, but on the screen a table of two parameters of the design for each fault and limit:
/// its bracket. Throws InputError where there are no such parameters, or others have several
/// values.
Answer map_answer(const LimitTable& table, const std::string& across, const std::string& down);

}  // namespace faultsweep
