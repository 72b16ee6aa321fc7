#include "python/bindings/case_drawing.h"

#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/near_miss.h"

namespace faultsim::python {
namespace {

const CaseChartInfo& chart_of(const std::string& name) {
  if (const CaseChartInfo* info = case_chart_named(name)) return *info;
  std::vector<std::string> names;
  for (const CaseChartInfo& info : case_charts()) names.emplace_back(info.name);
  throw InputError("chart", concat("there is no chart \"", name, "\""), suggest(name, names));
}

}  // namespace

std::string drawn_case(const CasePicture& picture, const std::string& chart,
                       const std::string& fault, std::optional<int> step, const std::string& show) {
  const CaseChartInfo& info = chart_of(chart);
  const MapField shown = field_shown("show", show);
  require_shows(info, shown);
  if (info.needs_fields && picture.fields == nullptr)
    throw InputError("chart", concat("the fields that \"", chart, "\" draws were not kept"),
                     "run with fields=True");
  return draw_case(picture, {.chart = info.chart, .fault = fault, .step = step, .show = shown});
}

}  // namespace faultsim::python
