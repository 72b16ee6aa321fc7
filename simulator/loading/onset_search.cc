#include "simulator/loading/onset_search.h"

#include <algorithm>
#include <cmath>

#include "simulator/contact/load_path.h"

namespace faultsim {
namespace {

constexpr int kMostHalvings = 24;
/// Of a step in which no pressure beside the place changes: temperatures alone, say.
constexpr double kStillWidth = 1e-3;

/// Of the side that the onset's pressures are led by; see FaultOnset::change_before.
double change_of_leading_side(const SidePressures& led, const SidePressures& of) {
  const std::optional<double> leading = leading_change(led);
  if (!leading) return of.change_in_fault;
  return (leading == led.change_minus ? of.change_minus : of.change_plus).value_or(0);
}

}  // namespace

SidePressures OnsetSearch::pressures(const Step& step, int place, double factor) const {
  return neighbours_.at(place, neighbours_.depth(place), between(step.before, step.after, factor));
}

/// In units of the tolerance; of load factors where no pressure changes.
double OnsetSearch::width(const Step& step, int place, double from, double to) const {
  const SidePressures a = pressures(step, place, from), b = pressures(step, place, to);
  double largest = std::abs(b.change_in_fault - a.change_in_fault);
  for (const auto side : {&SidePressures::change_minus, &SidePressures::change_plus}) {
    if (a.*side && b.*side) largest = std::max(largest, std::abs(*(b.*side) - *(a.*side)));
  }
  return largest > 0 ? largest / tolerance_ : (to - from) / kStillWidth;
}

FaultOnset OnsetSearch::narrowed(const Step& step, const StageSummary::Began& began,
                                 const FaultOnset& at_end, const Eigen::VectorXd& reference) const {
  const LoadPath path{step.before.locked, step.after.locked};
  ContactState rests = step.start;
  double from = 0, to = 1;
  int place = began.place;
  NodalState nodal;
  for (int k = 0; k < kMostHalvings && width(step, place, from, to) > 1; ++k) {
    const double middle = 0.5 * (from + to);
    ContactState tried = rests;
    const auto report = solver_.part_of_step(path.at(from), path.at(middle), tried);
    if (!report || !in_equilibrium(report->outcome)) break;
    meter_.evaluate(tried, nodal);
    const Activation slip = meter_.activation(began.fault, nodal, tried, reference);
    if (slip.activated) {
      to = middle;
      place = slip.place;
    } else {
      from = middle;
      rests = std::move(tried);
    }
  }
  FaultOnset onset = at_end;
  if (to < 1) {  // else they are the step's own, to the last bit
    onset.depth = neighbours_.depth(place);
    onset.pressures = pressures(step, place, to);
  }
  onset.load_before = from;
  onset.load_after = to;
  onset.change_before = change_of_leading_side(onset.pressures, pressures(step, place, from));
  return onset;
}

void OnsetSearch::narrow(const Step& step, StageSummary& whole, StageSummary& stage) const {
  for (const StageSummary::Began& one : whole.began())
    whole.onset(one) = narrowed(step, one, whole.onset(one), whole.reference());
  const bool is_first = stage.reference().size() == 0;  // slip counts from the same
  for (const StageSummary::Began& one : stage.began()) {
    stage.onset(one) =
        is_first ? whole.onset(one) : narrowed(step, one, stage.onset(one), stage.reference());
  }
}

}  // namespace faultsim
