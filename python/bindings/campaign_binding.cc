#include <pybind11/stl.h>

#include "campaign/answers/curves.h"
#include "campaign/answers/limit_table.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/answers/why.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/render/render.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/reports/status_report.h"
#include "python/bindings/bindings.h"
#include "python/bindings/stored_campaign.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

using namespace faultsweep;
using Stored = StoredCampaign;

CurveAxis axis_named(const std::string& word) {
  if (word == "step") return CurveAxis::step;
  if (word == "time") return CurveAxis::time;
  if (word == "pressure") return CurveAxis::pressure;
  throw InputError("against", concat("there is no axis \"", word, "\""),
                   "write step, time or pressure");
}

/// Its answers, each what the command of that name prints.
void bind_answers(py::class_<Stored>& campaign) {
  campaign
      .def("status",
           [](const Stored& self) { return to_answer(make_status(self.store, self.info.name)); })
      .def("ranking",
           [](const Stored& self, const std::string& by, const std::string& where,
              const std::string& stage, const std::string& fault, bool ascending, long top) {
             return to_answer(make_ranking(self.store, self.info,
                                           {by, stage, fault, where, ascending, top, {}}));
           })
      .def("probability",
           [](const Stored& self, const std::string& of, const std::string& where,
              const std::string& by, double confidence) {
             return to_answer(find_probability(self.store, self.info, {of, where, by, confidence}));
           })
      .def("curves",
           [](const Stored& self, const std::string& against, const std::string& where,
              const std::string& stage, double confidence) {
             return to_answer(probability_curves(self.store, self.info,
                                                 {axis_named(against), where, stage, confidence}));
           })
      .def("quantiles",
           [](const Stored& self, const std::string& metrics, const std::vector<double>& at,
              const std::string& where, double confidence) {
             return to_answer(
                 find_quantiles(self.store, self.info, {metrics, at, where, confidence}));
           })
      .def("posterior",
           [](const Stored& self, const std::vector<std::string>& seen,
              const std::vector<std::string>& of, const std::string& where, double confidence) {
             return to_answer(find_posterior(self.store, self.info, {seen, of, where, confidence}));
           })
      .def("sensitivity",
           [](const Stored& self, const std::string& metrics, const std::string& where,
              const std::string& stage, const std::string& fault, bool by_step, double confidence) {
             return what_matters(self.store, self.info,
                                 {{where, stage, fault}, metrics, confidence, by_step});
           })
      .def("limits", [](const Stored& self) {
        return to_answer(make_limit_table(self.store, self.info), 0);
      });
}

void bind_cases(py::class_<Stored>& campaign) {
  campaign
      .def("show",
           [](const Stored& self, const std::string& name, const std::string& stage,
              const std::string& fault) {
             return to_answer(
                 shown_case(self.store, self.info, self.case_named(name), {stage, fault}));
           })
      .def("why",
           [](const Stored& self, const std::string& name, const std::string& by) {
             RankRequest request;
             request.by = by;
             return to_answer(explain_rank(self.store, self.info, self.case_named(name), request));
           })
      .def("explain",
           [](const Stored& self, const std::string& name) {
             return explanation(self.store, self.info, self.case_named(name));
           })
      .def("case_info",
           [](const Stored& self, const std::string& name) { return self.summary(name); })
      .def("case_result",
           [](const Stored& self, const std::string& name) { return self.result_of(name); })
      .def("draw_case", &Stored::draw_case);
}

}  // namespace

void bind_campaign(py::module_& core) {
  py::class_<Answer>(core, "CoreAnswer", "An answer of a campaign.")
      .def("headline", [](const Answer& self) { return self.headline; })
      .def("value", [](const Answer& self) { return to_python(render_json(self)); })
      .def("text", [](const Answer& self) { return render_text(self); })
      .def("html", [](const Answer& self) { return render_html(self); })
      .def("drawn", [](const Answer& self) { return first_chart(self); });
  py::class_<Stored> campaign(core, "StoredCampaign", "A campaign of a store, to be read.");
  campaign.def(py::init<const std::string&, const std::string&>())
      .def("name", [](const Stored& self) { return self.info.name; })
      .def("refresh", &Stored::refresh)
      .def("counts", &Stored::counts)
      .def("draw_map", [](const Stored& self, const std::string& x, const std::string& y) {
        return draw_outcome_map(self.store, self.info, {x, y});
      });
  bind_answers(campaign);
  bind_cases(campaign);
  core.def("campaigns_of", [](const std::string& folder) {
    std::vector<std::string> names;
    for (const CampaignInfo& one : Store::open_reader(folder).campaigns())
      names.push_back(one.name);
    return names;
  });
  core.def("metrics", [] { return metrics_answer(); });
}

}  // namespace faultsim::python
