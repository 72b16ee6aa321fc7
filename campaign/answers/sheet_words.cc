#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "campaign/answers/cell_errors.h"
#include "campaign/answers/sheet_parts.h"
#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/render/shown.h"
#include "simulator/common/fingerprint.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
ShownUnit degrees() { return {"deg", kDegree, "rad"}; }

std::string interval_text(const faultsim::DepthInterval& depths) {
  return concat(grouped(std::lround(depths.top)), " to ", depth_text(depths.bottom));
}

/// "vertical", "dips 65 deg to the east".
std::string dip_words(const FaultSheet& sheet) {
  const double dip = sheet.place.dip_from_vertical;
  constexpr double kUpright = 1e-6;
  if (std::abs(dip) < kUpright) return "is vertical";
  const char* side = sheet.place.is_field
                         ? (dip > 0 ? "to the east" : "to the west")
                         : (dip > 0 ? "to the right of its strike" : "to the left of its strike");
  return concat("dips ", format_number(90 - std::abs(dip) / kDegree, 4), " deg ", side);
}

std::string where_sentence(const FaultSheet& sheet) {
  const SheetPlace& place = sheet.place;
  const std::string extent =
      concat(", ", depth_text(place.length), " long, from ", interval_text(place.depths), " depth");
  if (!place.is_field) {
    return concat(sheet.fault, " strikes ", format_number(place.strike / kDegree, 4),
                  " deg from north and ", dip_words(sheet), extent, ".");
  }
  return concat(sheet.fault, " strikes north, at x = ", depth_text(place.x), " (at ",
                depth_text(sheet.datum), " depth), and ", dip_words(sheet), extent, ".");
}

std::string reservoirs_sentence(const FaultSheet& sheet) {
  const SheetPlace& place = sheet.place;
  std::string text;
  for (const SheetPlace::Region& one : place.regions) {
    const char* side = place.is_field ? (one.is_west ? "west: " : "east: ") : "";
    text += concat(text.empty() ? "" : "; ", side, one.name, ", ", interval_text(one.depths));
  }
  if (text.empty()) return "No pressure region lies beside it.";
  if (!place.is_field) return concat("Pressure regions of the box: ", text, ".");
  if (place.regions.size() == 1)
    text += concat("; no reservoir to the ", place.regions.front().is_west ? "east" : "west");
  return concat("Reservoir to the ", text, ".");
}

std::string varied_sentence(const FaultSheet& sheet) {
  const SheetPlace& place = sheet.place;
  std::string text;
  if (place.throws.is_known()) {
    text = place.throws.varies()
               ? concat("offset across it (east below west) ", range_words(place.throws, metres()))
               : concat("offset across it (east below west) ", in_unit(place.throws.low, metres()));
  }
  if (place.dips.varies())
    text += concat(text.empty() ? "" : "; ", "dip from the vertical ",
                   range_words(place.dips, degrees()));
  return text.empty() ? "" : concat("Over the cases: ", text, ".");
}

std::string limit_band_words(const PressureBand& band) {
  const std::string where =
      concat(words_of_stage(band.name),
             band.stage.empty() ? "" : concat(" (", words_of_stage(band.stage), ")"), ": \"",
             band.unsafe_condition, "\" ");
  const std::string all = concat(" of ", counted(band.n, "configuration", "configurations"));
  if (band.n_at_once > 0) {
    return concat(
        where, "in ", grouped(band.n_at_once), all,
        " already at the safe end of the range searched",
        band.reached.is_known() ? concat(" (", range_words(band.reached, bars()), ")") : "",
        ": no pressure is safe in all.", open_words(band));
  }
  const auto value = [](const std::optional<double>& absolute, double change) {
    return absolute ? bar_text(*absolute) : concat("a change of ", bar_text(change));
  };
  if (!band.safe_change) return concat(where, "is not known.", open_words(band));
  std::string text =
      concat(where, "in none", all, " ", to_word(band.way), value(band.safe, *band.safe_change));
  text += band.unsafe_change
              ? concat("; at ", value(band.unsafe, *band.unsafe_change), " in the first (cases ",
                       band.safe_case, " and ", band.unsafe_case, "; in ", grouped(band.n_unsafe),
                       all, " within the range searched).")
              : concat(", the end of the range searched.");
  if (band.n_undecided > 0 && band.surely_safe)
    text += concat(" Whatever the cells leave open, it is in none ", to_word(band.way),
                   bar_text(*band.surely_safe), ".");
  return text + open_words(band);
}

std::string stage_band_words(const PressureBand& band) {
  const std::string way = band.way == PressureWay::falls   ? "pressure falling"
                          : band.way == PressureWay::rises ? "pressure rising"
                                                           : "pressure held";
  const std::string where = concat(words_of_stage(band.stage), ", ", way, ": ");
  const std::string all = counted(band.n, "case", "cases");
  if (band.n_unsafe == 0) {
    if (!band.safe)
      return concat(where, "not known, as no case has a full history.", open_words(band));
    return concat(where, "no case slides ", to_word(band.way), bar_text(*band.safe),
                  band.way == PressureWay::holds ? "" : ", as far as all full histories go",
                  "; no limit was found.", open_words(band));
  }
  if (!band.unsafe) {
    return concat(where, grouped(band.n_unsafe), " of ", all,
                  " slide; at which absolute pressure is not known.", open_words(band));
  }
  const std::string first = concat("the first (case ", band.unsafe_case, "; ",
                                   grouped(band.n_unsafe), " of ", all, " slide)");
  return concat(where,
                band.safe
                    ? concat("no case slides ", to_word(band.way), bar_text(*band.safe), "; by ",
                             bar_text(*band.unsafe), ", one load step later, ", first, " does.")
                    : concat("by ", bar_text(*band.unsafe), " ", first,
                             " does; the pressure one load step earlier is not known there."),
                open_words(band));
}

std::string event_sentence(const FaultSheet& sheet, const SheetEvent& one, const char* which) {
  const faultsim::SlipEvent& e = one.event;
  const std::optional<double> absolute = leading_absolute(e.pressures);
  const std::string size =
      e.magnitude ? concat("Mw ", format_number(*e.magnitude, 3), ", ") : std::string();
  const char* per_metre = one.plane_strain ? " per m of strike" : "";
  return concat(
      which, " slip event that begins on ", sheet.fault, ": ", size, "M0 ",
      format_number(e.moment, 3), " N m", per_metre, ", potency ", format_number(e.potency, 3),
      " m3", per_metre, ", slip ", in_unit(e.max_slip, {"mm", 1e-3, "m"}, 3), ", in ",
      words_of_stage(e.stage), " at ", year_text(e.time), " and ", depth_text(e.depth), " depth",
      absolute ? concat(", at ", bar_text(*absolute), " there") : "", " (case ", one.position,
      "); ",
      !e.resolved ? "not resolved: the cells are too coarse, and its size depends on the mesh"
      : !e.evidence_holds ? "resolved, but its evidence does not hold"
                          : "resolved",
      ".");
}

std::string moment_words(const SheetEvents& events) {
  return concat("M0 ", format_number(events.moment, 3), " N m",
                events.plane_strain ? " per m of strike" : "");
}

}  // namespace

std::string open_words(const PressureBand& band) {
  std::string text;
  if (band.n_undecided > 0) text = concat(grouped(band.n_undecided), " undecided by cells");
  if (band.n_unknown > 0)
    text += concat(text.empty() ? "" : ", ", grouped(band.n_unknown),
                   band.of_limits ? " not known" : " without a full history");
  return text.empty() ? "" : concat(" Left open: ", text, ".");
}

const char* to_word(PressureWay way) {
  return way == PressureWay::falls ? "down to " : way == PressureWay::rises ? "up to " : "at ";
}

std::string depth_text(double depth) { return grouped(std::lround(depth)) + " m"; }

std::string bar_text(double pressure) {
  return in_unit(std::round(pressure / kBar * 10) / 10 * kBar, bars(), 6);
}

std::string year_text(double time) {
  constexpr double kDay = 86400;
  return time < kYear ? in_unit(time, {"days", kDay, "s"}, 3)
                      : in_unit(time, {"years", kYear, "s"}, 3);
}

std::string words_of_stage(const std::string& stage) {
  if (stage.empty()) return "whole history";
  std::string text = stage;
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string range_words(const CaseRange& range, const ShownUnit& unit, int digits) {
  if (!range.is_known()) return "not known";
  const std::string low = in_unit(range.low, unit, digits),
                    high = in_unit(range.high, unit, digits);
  return low == high ? high : concat(format_number(range.low / unit.size, digits), " to ", high);
}

std::string share_word(const FaultSheet& sheet) {
  return sheet.sampling.is_random ? "probability" : "share of cases";
}

std::vector<std::string> place_words(const FaultSheet& sheet) {
  std::vector<std::string> all = {where_sentence(sheet), reservoirs_sentence(sheet)};
  const std::string varied = varied_sentence(sheet);
  if (!varied.empty()) all.push_back(varied);
  return all;
}

std::string band_words(const PressureBand& band) {
  return band.of_limits ? limit_band_words(band) : stage_band_words(band);
}

std::vector<std::string> event_words(const FaultSheet& sheet) {
  std::vector<std::string> all;
  for (const SheetEvents& one : sheet.events) {
    const std::string kind = sheet.events.size() < 2 ? ""
                             : one.plane_strain      ? " in plane strain"
                                                     : " in three dimensions";
    const std::string early =
        one.n_early > 0 ? concat(", of which ", grouped(one.n_early), " end early") : "";
    if (!one.largest) {
      all.push_back(concat("No slip event begins on ", sheet.fault, " in ", grouped(one.n_cases),
                           " cases", kind, early, "."));
    } else {
      all.push_back(concat("Slip events begin on ", sheet.fault, " in ", grouped(one.n_with),
                           " of ", grouped(one.n_cases), " cases", kind, early, "."));
      all.push_back(event_sentence(sheet, *one.largest, "Largest"));
      const bool has_other =
          one.largest_resolved && one.largest_resolved->position != one.largest->position;
      if (has_other)
        all.push_back(event_sentence(sheet, *one.largest_resolved, "Largest resolved"));
      if (!one.largest_resolved) all.emplace_back("None is in a case whose cells resolve it.");
    }
    if (one.slip_case > 0) {
      all.push_back(concat("Largest slip, slow or not: ", in_unit(one.slip, {"mm", 1e-3, "m"}, 3),
                           ", ", moment_words(one), " (case ", one.slip_case, ")."));
    } else {
      all.push_back(concat("No node of ", sheet.fault, " slips in any case", kind, "."));
    }
  }
  return all;
}

std::vector<std::string> model_errors(const SheetSource& source, const SheetCounts& counts) {
  std::vector<std::string> all;
  const CellErrors cells = cell_errors(source.store, source.campaign, source.base);
  all.push_back(cells.mesh);
  if (!cells.measured.empty()) all.push_back(cells.measured);
  if (!cells.undecided.empty()) all.push_back(cells.undecided);
  if (!source.sampling.approximation.empty()) all.push_back(source.sampling.approximation);
  std::string left = concat(grouped(counts.n_complete), " of ", grouped(counts.n_cases),
                            " cases have a full history");
  const auto add = [&](long n, const char* what) {
    if (n > 0) left += concat(", ", grouped(n), what);
  };
  add(counts.n_unresolved, " of them with something left open by their cells");
  add(counts.n_early, " end early");
  add(counts.n_failed, " failed");
  add(counts.n_waiting, " have not run");
  const long n_without = counts.n_cases - counts.n_complete;
  all.push_back(left +
                (n_without > 0
                     ? "; those without a full history may be either, and bounds allow for it."
                     : "."));
  if (counts.n_unread > 0)
    all.push_back(concat("The scenes of ", grouped(counts.n_unread),
                         " cases can no longer be read: the initial state does not include them."));
  return all;
}

std::vector<std::string> provenance_of(const SheetSource& source, const FaultSheet& sheet) {
  const Store::SpecCopies spec = source.store.spec_copies(source.campaign.id);
  const int oldest = source.store.oldest_numerics(source.campaign.id);
  const SheetRequest& request = source.request;
  std::string command = concat("faultsweep sheet ", source.campaign.name, " --fault ",
                               faultsweep::spelled_name(sheet.fault));
  if (request.datum) command += concat(" --datum \"", format_number(*request.datum, 8), " m\"");
  if (request.confidence != SheetRequest{}.confidence)
    command += concat(" --confidence ", format_number(request.confidence, 6));
  if (!request.levels.source.empty()) command += concat(" --levels ", request.levels.source);
  return {concat("Campaign ", source.campaign.name, ", spec ",
                 std::filesystem::path(source.campaign.source).filename().string(),
                 ", expanded cases ", spec.expanded_hash, ", ", grouped(sheet.counts.n_cases),
                 " cases; numerics version ", faultsim::kNumericsVersion,
                 oldest < faultsim::kNumericsVersion ? concat(", of the oldest result ", oldest)
                                                     : std::string(),
                 "."),
          concat("Made by ", request.program, " with: ", command, " -o sheet.html")};
}

}  // namespace faultsweep
