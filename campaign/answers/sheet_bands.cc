#include <algorithm>
#include <cmath>

#include "campaign/answers/limit_words.h"
#include "campaign/answers/sheet_parts.h"
#include "campaign/common/names.h"

namespace faultsweep {

namespace {

constexpr double kAlike = 1;  // Pa

/// A pressure as a place on its way, which always goes up.
double sign_of(PressureWay way) { return way == PressureWay::falls ? -1 : 1; }

/// The ways in which pressures beside the fault go within the stage of the first full history.
std::vector<PressureWay> ways_in(const SheetSource& source, const FaultOfSheet& fault,
                                 const std::string& stage) {
  bool falls = false, rises = false;
  for (std::size_t k = 1; k < source.steps.size(); ++k) {
    if (source.steps[k].stage != stage) continue;
    const std::vector<double>&now = source.steps[k].pressure_change,
          &before = source.steps[k - 1].pressure_change;
    for (const std::size_t region : fault.regions) {
      if (region >= now.size() || region >= before.size()) continue;
      falls = falls || now[region] < before[region] - kAlike;
      rises = rises || now[region] > before[region] + kAlike;
    }
  }
  std::vector<PressureWay> ways;
  if (falls) ways.push_back(PressureWay::falls);
  if (rises) ways.push_back(PressureWay::rises);
  if (ways.empty()) ways.push_back(PressureWay::holds);
  return ways;
}

/// Which of the ways a case was on as it began to slide; the first where that is not known.
PressureWay way_of(const CaseOnsets::Onset& onset, const std::vector<PressureWay>& ways) {
  PressureWay way = PressureWay::holds;
  if (onset.change < onset.change_before - kAlike) way = PressureWay::falls;
  if (onset.change > onset.change_before + kAlike) way = PressureWay::rises;
  return contains(ways, way) ? way : ways.front();
}

/// The farthest that the pressure of some region beside the fault went, absolute at the datum.
double farthest(const StageRow& row, const CaseStart& start, double sign) {
  double place = kNotKnown;
  for (std::size_t r = 0; r < row.change.size() && r < start.region_pressure.size(); ++r) {
    const double change = sign < 0 ? row.change[r].low : row.change[r].high;
    if (std::isnan(change)) continue;
    const double here = sign * (start.region_pressure[r] + change);
    place = std::isnan(place) ? here : std::max(place, here);
  }
  return sign * place;
}

/// The first of places on the way, and what is said there.
struct FirstPlace {
  std::optional<double> absolute, change;
  long position = 0;
  /// NaN absolute: one that is not known, so that no place is known to come first.
  void add(double sign, double at, double its_change, long its_position) {
    if (absolute && !(sign * at < sign * *absolute) && !std::isnan(at)) return;
    if (absolute && std::isnan(*absolute)) return;
    absolute = at, change = its_change, position = its_position;
  }
};

/// The ends of a band; where one is not known in absolute terms, its change is.
void set_ends(PressureBand& band, const FirstPlace& safe, const FirstPlace& unsafe) {
  band.safe = safe.absolute, band.safe_change = safe.change, band.safe_case = safe.position;
  band.unsafe = unsafe.absolute, band.unsafe_change = unsafe.change;
  band.unsafe_case = unsafe.position;
  for (std::optional<double>* one :
       {&band.safe, &band.unsafe, &band.safe_change, &band.unsafe_change, &band.surely_safe})
    if (*one && std::isnan(**one)) one->reset();
}

/// A limit of one configuration: the values on either side, Δp in Pa.
struct Edges {
  std::optional<double> safe, unsafe, surely_safe;
  double p0 = kNotKnown;  ///< at the datum, of the region that takes the value.
  long safe_case = 0, unsafe_case = 0;
};

const SearchPoint* known_point(const LimitFinding& finding, bool from_the_end) {
  const SearchPoint* found = nullptr;
  for (const SearchPoint& one : finding.points) {
    if (one.state == PointState::unknown || one.position == 0) continue;
    found = &one;
    if (!from_the_end) break;
  }
  return found;
}

/// p0 at the datum of the region beside the fault whose change is the point's value in some step.
double start_of_point(const SheetSource& source, const FaultOfSheet& fault,
                      const SearchPoint* point, const LimitSearch& limit) {
  if (point == nullptr) return kNotKnown;
  const CaseStart& start = fault.starts.at(static_cast<std::size_t>(point->position - 1));
  if (!start.is_read) return kNotKnown;
  const double change = si_of(point->value, limit);
  const StoredCase one =
      source.store.stored_case(source.campaign.id, std::to_string(point->position));
  for (std::size_t r = 0; r < fault.regions.size(); ++r) {
    const bool has_it =
        std::ranges::any_of(one.result.steps, [&](const faultsim::StepResult& step) {
          return fault.regions[r] < step.pressure_change.size() &&
                 std::abs(step.pressure_change[fault.regions[r]] - change) < kAlike;
        });
    if (has_it) return start.region_pressure[r];
  }
  return kNotKnown;
}

Edges edges_of(const SheetSource& source, const FaultOfSheet& fault, const LimitCell& cell,
               const LimitSearch& limit) {
  const LimitFinding& f = cell.finding;
  Edges edges;
  const SearchPoint *first = known_point(f, false), *last = known_point(f, true);
  if (const Crossing* crossing = f.limit()) {
    edges.safe = crossing->before.value, edges.safe_case = crossing->before.position;
    edges.unsafe = crossing->after.value, edges.unsafe_case = crossing->after.position;
    edges.p0 = start_of_point(source, fault, &crossing->before, limit);
  } else if (f.verdict == LimitVerdict::safe_throughout && last != nullptr) {
    edges.safe = last->value, edges.safe_case = last->position;
    edges.p0 = start_of_point(source, fault, last, limit);
  } else if (f.verdict != LimitVerdict::unknown && first != nullptr) {
    edges.unsafe = first->value, edges.unsafe_case = first->position;
    edges.p0 = start_of_point(source, fault, first, limit);
  }
  if (f.surely_safe) edges.surely_safe = f.surely_safe->value;
  for (std::optional<double>* one : {&edges.safe, &edges.unsafe, &edges.surely_safe})
    if (*one) *one = si_of(**one, limit);
  return edges;
}

void count_row(PressureBand& band, const LimitCell& cell, const Edges& edges) {
  const bool is_unknown = cell.finding.verdict == LimitVerdict::unknown;
  ++band.n;
  band.n_unknown += is_unknown ? 1 : 0;
  band.n_undecided += !is_unknown && !is_resolved(cell) ? 1 : 0;
  band.n_unsafe += edges.unsafe ? 1 : 0;
  band.n_at_once += edges.unsafe && !edges.safe ? 1 : 0;
}

PressureBand band_of_limit(const SheetSource& source, const FaultOfSheet& fault, std::size_t l) {
  const LimitSearch& limit = source.limits->limits[l];
  PressureBand band;
  band.of_limits = true;
  band.name = limit.name;
  band.stage = limit.stage;
  band.unsafe_condition = limit.unsafe;
  band.way = limit.scan.back() > limit.scan.front() ? PressureWay::rises : PressureWay::falls;
  std::vector<Edges> all;
  bool all_sure = true, all_absolute = true;
  FirstPlace safe, unsafe, sure;
  for (const LimitRow& row : source.limits->rows) {
    if (row.fault != fault.id.name || !row.cells[l]) continue;
    all.push_back(edges_of(source, fault, *row.cells[l], limit));
    count_row(band, *row.cells[l], all.back());
    all_sure = all_sure && all.back().surely_safe.has_value();
    const bool has_end = all.back().safe || all.back().unsafe;
    all_absolute = all_absolute && !(has_end && std::isnan(all.back().p0));
  }
  const double sign = sign_of(band.way);
  for (const Edges& one : all) {
    // Of changes alone the first is known too: those of all configurations start from 0.
    const auto at = [&](double value) { return all_absolute ? one.p0 + value : value; };
    if (one.safe) safe.add(sign, at(*one.safe), *one.safe, one.safe_case);
    if (one.unsafe) unsafe.add(sign, at(*one.unsafe), *one.unsafe, one.unsafe_case);
    if (one.surely_safe) sure.add(sign, at(*one.surely_safe), *one.surely_safe, 0);
    for (const double end : {limit.scan.front(), limit.scan.back()})
      band.reached.add(all_absolute ? at(si_of(end, limit)) : kNotKnown);
  }
  if (band.n_at_once > 0) safe = {};
  if (!all_absolute)
    for (FirstPlace* one : {&safe, &unsafe, &sure})
      if (one->absolute) one->absolute = kNotKnown;
  if (all_sure) band.surely_safe = sure.absolute;
  if (band.reached.is_known())
    band.begin = band.way == PressureWay::falls ? band.reached.high : band.reached.low;
  set_ends(band, safe, unsafe);
  return band;
}

void count_stage_row(PressureBand& band, const StageRow& row) {
  ++band.n;
  band.n_unknown += row.slides == Held::unknown ? 1 : 0;
  band.n_undecided += row.slides == Held::undecided_no || row.slides == Held::undecided_yes ? 1 : 0;
}

}  // namespace

std::vector<PressureBand> bands_of_stage(const SheetSource& source, const FaultOfSheet& fault,
                                         const std::string& stage,
                                         const std::vector<StageRow>& rows) {
  std::vector<PressureBand> bands;
  const std::vector<PressureWay> ways = ways_in(source, fault, stage);
  for (const PressureWay way : ways) {
    PressureBand band;
    band.name = band.stage = stage;
    band.unsafe_condition = "slides";
    band.way = way;
    FirstPlace safe, unsafe;
    CaseRange begin;
    for (const StageRow& row : rows) {
      count_stage_row(band, row);
      const CaseStart& start = fault.starts.at(static_cast<std::size_t>(row.position - 1));
      if (row.is_complete) {
        band.reached.add(farthest(row, start, sign_of(way)));
        begin.add(farthest(row, start, -sign_of(way)));
      }
      if (!row.onset || way_of(*row.onset, ways) != way) continue;
      const CaseOnsets::Onset& onset = *row.onset;
      ++band.n_unsafe;
      safe.add(sign_of(way), row.onset_p0 + onset.change_before, onset.change_before, row.position);
      unsafe.add(sign_of(way), row.onset_p0 + onset.change, onset.change, row.position);
    }
    set_ends(band, safe, unsafe);
    if (band.n_unsafe == 0 && band.reached.is_known())
      band.safe = way == PressureWay::falls ? band.reached.high : band.reached.low;
    if (begin.is_known()) band.begin = way == PressureWay::falls ? begin.high : begin.low;
    bands.push_back(band);
  }
  return bands;
}

std::vector<PressureBand> bands_of_limits(const SheetSource& source, const FaultOfSheet& fault) {
  std::vector<PressureBand> bands;
  if (!source.limits) return bands;
  for (std::size_t l = 0; l < source.limits->limits.size(); ++l) {
    const LimitSearch& limit = source.limits->limits[l];
    if (limit.dimension == Dimension::pressure && contains(limit.faults, fault.id.name))
      bands.push_back(band_of_limit(source, fault, l));
  }
  return bands;
}

}  // namespace faultsweep
