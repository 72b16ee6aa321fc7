#include "campaign/common/names.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/spec/metrics.h"

namespace faultsweep {

Answer metrics_answer() {
  AnswerTable table{"metrics",
                    "",
                    {{"name", "metric", {}, 4, Need::always},
                     {"synonym", "or", {}, 4, Need::wanted},
                     {"unit", "unit", {}, 4, Need::always},
                     {"unit_of_plane_strain", "in plane strain", {}, 4, Need::wanted},
                     {"is_flag", "yes or no", {}, 4, Need::wanted},
                     {"per_stage", "per stage", {}, 4, Need::wanted},
                     {"per_fault", "per fault", {}, 4, Need::wanted},
                     {"description", "meaning", {}, 4, Need::always}}};
  for (const MetricInfo& metric : metric_catalogue()) {
    const std::string unit = metric_unit(metric, false), strike = metric_unit(metric, true);
    table.rows.push_back({metric.name, metric.synonym, unit, strike, metric.is_flag,
                          has_stages(metric.name), has_faults(metric.name), metric.description});
  }
  table.notes = {
      "per fault and stage: F2.max_slip in gas_storage; a unit per m is that of plane strain"};
  Answer answer{{concat(metric_catalogue().size(), " metrics can be ranked by and filtered by.")}};
  answer.add(std::move(table));
  return answer;
}

}  // namespace faultsweep
