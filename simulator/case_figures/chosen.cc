#include "simulator/case_figures/chosen.h"

#include <algorithm>

#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/palette.h"

namespace faultsim {
namespace case_figures {
namespace {

constexpr double kYearInSeconds = 365.25 * 86400, kDayInSeconds = 86400;

/// By χ̄ and, where both have reached their strength, by the area that is near to it.
bool is_more_critical(const FaultMetrics& a, const FaultMetrics& b) {
  const double chi_a = std::min(a.chi_bar, figure::kChiAtLimit),
               chi_b = std::min(b.chi_bar, figure::kChiAtLimit);
  return chi_a != chi_b ? chi_a > chi_b : a.area_chi_080 > b.area_chi_080;
}

}  // namespace

void refuse(const std::string& option, const std::string& what, const std::string& cure) {
  throw InputError(option, what, cure);
}

std::size_t n_steps_of(const CaseResult& result) {
  std::size_t n = 0;
  while (n < result.steps.size() && result.steps[n].faults.size() == result.fault_names.size()) {
    ++n;
  }
  return n;
}

std::string with_blanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string subject_of(const CasePicture& picture) {
  return picture.name.empty() ? picture.result.title : picture.name;
}

std::string words_of_original(const CasePicture& picture, bool is_drawn, const std::string& place) {
  if (picture.original == nullptr) return "";
  const std::string& name = picture.original->name;
  const std::string what = name.empty() ? "before the change" : name;
  if (!is_drawn) return concat("not kept: ", what, "; ");
  return concat("thin: ", what, place.empty() ? "" : ", ", place, "; ");
}

std::string same_scale_words(const CasePicture& picture, bool of_original) {
  const std::string words = "same scale at all load steps";
  if (!of_original) return words;
  const std::string& name = picture.original->name;
  return concat(words, name.empty() ? " and before the change" : " and in " + name);
}

std::optional<std::size_t> place_of(const std::vector<std::string>& names,
                                    const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

bool in_days(const CaseResult& result) {
  return !result.steps.empty() && result.steps.back().time < 2 * kYearInSeconds;
}
double time_of(const CaseResult& result, double seconds) {
  return seconds / (in_days(result) ? kDayInSeconds : kYearInSeconds);
}

std::string time_unit_text(const CasePicture& picture) {
  const std::string unit = in_days(picture.result) ? "days" : "years";
  return picture.scene.start_date ? concat(unit, " since ", date_text(*picture.scene.start_date))
                                  : unit;
}

std::vector<figure::Tick> date_ticks(const CasePicture& picture) {
  if (!picture.scene.start_date || picture.result.steps.empty()) return {};
  constexpr double kMonthInSeconds = kYearInSeconds / 12;
  constexpr int kMost = 9, kMonths = 12;
  const double start = *picture.scene.start_date;
  double last = picture.result.steps.back().time;
  if (picture.original != nullptr && !picture.original->result.steps.empty())
    last = std::max(last, picture.original->result.steps.back().time);
  // Dates have four digits.
  if (start + last > parse_date("9999-12-31").value()) return {};
  int step = 1;  // months
  for (const int one : {2, 3, 6, 12, 24, 60, 120, 240, 600, 1200, 2400, 6000, 12000}) {
    if (last > kMost * kMonthInSeconds * step) step = one;
  }
  std::vector<figure::Tick> ticks;
  const std::string first = date_text(start);
  const int before = std::stoi(first.substr(0, 4)) * kMonths / step * step;
  for (int month = std::max(before, step);; month += step) {  // there is no year 0
    const std::string day = formatted("%04d-%02d-01", month / kMonths, month % kMonths + 1);
    const std::optional<double> date = parse_date(day);
    if (!date) break;  // the year 10000
    const double time = *date - start;
    if (time > last * (1 + 1e-9)) break;
    if (time < 0) continue;
    ticks.push_back(
        {time_of(picture.result, time), step < kMonths ? day.substr(0, 7) : day.substr(0, 4)});
  }
  return ticks;
}

std::string moment_text(const Chosen& chosen) {
  const StepResult& step = chosen.result().steps[chosen.step];
  const std::string time = concat(figure::plain_number(time_of(chosen.result(), step.time)),
                                  in_days(chosen.result()) ? " days" : " years");
  const std::optional<double>& start = chosen.scene().start_date;
  return concat("load step ", step.step, ", ", with_blanks(step.stage), ", ",
                start ? concat(date_text(*start + step.time), " (", time, ")") : time);
}

Chosen choose(const CasePicture& picture, const CaseChartRequest& request) {
  const CaseResult& result = picture.result;
  const std::size_t n = n_steps_of(result);
  if (result.fault_names.empty() || n == 0) {
    refuse("case", "the result has no faults or no load step to draw", "choose another case");
  }
  const CriticalMoment critical = critical_moment(result);
  Chosen chosen{picture, request, critical.fault, critical.step};
  if (!request.fault.empty()) {
    const auto found = std::ranges::find(result.fault_names, request.fault);
    if (found == result.fault_names.end()) {
      refuse("--fault", "\"" + request.fault + "\" is not a fault of the case",
             "choose one of " + joined(result.fault_names, ", "));
    }
    chosen.fault = static_cast<std::size_t>(found - result.fault_names.begin());
    chosen.step = 0;
    for (std::size_t k = 1; k < n; ++k) {
      const std::size_t f = chosen.fault;
      if (is_more_critical(result.steps[k].faults[f], result.steps[chosen.step].faults[f]))
        chosen.step = k;
    }
  }
  if (request.step) {
    const auto found = std::ranges::find(result.steps, *request.step, &StepResult::step);
    if (found == result.steps.end() ||
        static_cast<std::size_t>(found - result.steps.begin()) >= n) {
      refuse("--step", concat("the history has no load step ", *request.step),
             concat("choose 0 to ", result.steps[n - 1].step));
    }
    chosen.step = static_cast<std::size_t>(found - result.steps.begin());
  }
  return chosen;
}

}  // namespace case_figures

CriticalMoment critical_moment(const CaseResult& result) {
  using case_figures::is_more_critical, case_figures::n_steps_of;
  CriticalMoment critical;
  const FaultMetrics* most = nullptr;
  for (std::size_t k = 0; k < n_steps_of(result); ++k) {
    for (std::size_t f = 0; f < result.steps[k].faults.size(); ++f) {
      const FaultMetrics& now = result.steps[k].faults[f];
      if (most != nullptr && !is_more_critical(now, *most)) continue;
      most = &now;
      critical = {f, k};
    }
  }
  return critical;
}

}  // namespace faultsim
