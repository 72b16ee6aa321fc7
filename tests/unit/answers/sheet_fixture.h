#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "campaign/answers/fault_sheet.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/answers/resolved_design.h"

namespace faultsweep::testing {

inline constexpr double kSheetYear = 3.15576e7;  // s
/// Δp at the ends of the load steps, Pa: production falls, injection rises, storage falls and
/// rises.
inline const std::vector<double> kSheetPressures = {
    0, -50e5, -100e5, -150e5, -200e5, -170e5, -140e5, -110e5, -80e5, -100e5, -80e5, -100e5, -80e5};
/// p0 of the reference field at 2,100 m, the middle of its reservoir: 231.01 bar.
inline constexpr double kSheetStart = 9.81e3 * 2100 + 2.5e6;

/// Campaigns on the reference field, two of whose faults have results that are made by hand.
class SheetFixture {
 public:
  explicit SheetFixture(const std::string& campaign = "sweep") {
    std::string name = ::testing::TempDir() + "sheet_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    const std::string scene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";
    std::ostringstream text;
    text << std::ifstream(scene).rdbuf();
    s_.name = campaign;
    s_.source = "/somebody/secret/spec.json";
    s_.spec_given = R"({"title": "What F2 does"})";
    s_.scenes = {{scene, text.str()}};
    s_.families = {{"family-a", 1000, 100, 1, 1}};
    s_.parameters = {{"friction", faultsim::Dimension::number, false},
                     {"offset", faultsim::Dimension::length, false}};
  }
  ~SheetFixture() {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  SheetFixture(const SheetFixture&) = delete;
  SheetFixture& operator=(const SheetFixture&) = delete;

  /// A full history in which nothing slides; χ̄ of F2 is 0.3 at the start and `chi` at most.
  static faultsim::CaseResult quiet(double chi) {
    faultsim::CaseResult result = made_up_result(0.1);
    for (faultsim::StepResult& step : result.steps) {
      const double change = kSheetPressures.at(static_cast<std::size_t>(step.step));
      step.pressure_change = {change, change};
      step.faults[1].chi_bar = step.step == 0 ? 0.3 : chi;
    }
    for (faultsim::StageMetrics* stage : stages_of(result)) stage->faults[1].chi_bar = chi;
    return result;
  }
  /// F2 begins to slide at the end of a step, at 2,050 m depth beside the western compartment.
  static void slide(faultsim::CaseResult& result, int step, double slip) {
    const double change = kSheetPressures.at(static_cast<std::size_t>(step));
    const double absolute = 9.81e3 * 2050 + 2.5e6 + change;
    const faultsim::SidePressures sides{"west", "east", change, change, absolute, absolute, change};
    const std::string& name = result.steps.at(static_cast<std::size_t>(step)).stage;
    for (faultsim::StageMetrics* stage : stages_of(result)) {
      if (!stage->stage.empty() && stage->stage != name) continue;
      faultsim::FaultStageMetrics& fault = stage->faults[1];
      stage->activated = fault.activated = fault.slips = true;
      fault.max_slip = std::max(fault.max_slip, slip);
      fault.moment = 1e12 * slip;
      if (!fault.activation || fault.activation->step > step)
        fault.activation = faultsim::FaultOnset{step, 2050, sides};
    }
  }
  /// Whether F2 slides in a stage, and in the whole history, is left open by the cells.
  static void leave_open(faultsim::CaseResult& result, const std::string& name) {
    for (faultsim::StageMetrics* stage : stages_of(result)) {
      if (!stage->stage.empty() && stage->stage != name) continue;
      stage->activation_resolved = stage->faults[1].activation_resolved = false;
    }
  }
  static void add_event(faultsim::CaseResult& result, int step, double moment, bool resolved) {
    faultsim::SlipEvent event;
    event.step = step;
    event.stage = result.steps.at(static_cast<std::size_t>(step)).stage;
    event.time = kSheetYear * step;
    event.fault = "F2";
    event.depth = 2080;
    event.moment = moment;
    event.magnitude = faultsim::moment_magnitude(moment);
    event.resolved = resolved;
    event.evidence_holds = true;
    event.max_slip = 0.02;
    result.events.push_back(event);
    result.outcome = resolved ? faultsim::Outcome::event : faultsim::Outcome::unresolved_event;
    result.weakening_resolved = resolved;
    for (faultsim::StageMetrics* stage : stages_of(result)) {
      if (!stage->stage.empty() && stage->stage != event.stage) continue;
      for (faultsim::Measures* m : {static_cast<faultsim::Measures*>(stage),
                                    static_cast<faultsim::Measures*>(&stage->faults[1])}) {
        ++m->n_events;
        m->event_moment = std::max(m->event_moment, moment);
        m->event_magnitude = faultsim::moment_magnitude(m->event_moment);
      }
    }
  }
  static std::vector<faultsim::StageMetrics*> stages_of(faultsim::CaseResult& result) {
    std::vector<faultsim::StageMetrics*> all = {&result.whole};
    for (faultsim::StageMetrics& stage : result.stages) all.push_back(&stage);
    return all;
  }

  /// Changes the base scene, before the campaign is submitted.
  void set(const std::string& pointer, const std::string& value) {
    nlohmann::json base = nlohmann::json::parse(s_.scenes[0].document);
    base[nlohmann::json::json_pointer(pointer)] = value;
    s_.scenes[0].document = base.dump();
  }
  /// @param offset  m, of the eastern block.
  void add(faultsim::CaseResult result, double offset = 0) {
    const std::size_t n = s_.cases.size();
    s_.cases.push_back(
        {"identity-" + std::to_string(n),
         0,
         0,
         offset == 0
             ? "{}"
             : nlohmann::json{{"/geometry/blocks/1/offset", std::to_string(offset) + " m"}}.dump(),
         {{0, 0.1 * static_cast<double>(n), std::to_string(n)},
          {1, offset, std::to_string(offset) + " m"}}});
    RunRecord run;
    run.case_id = static_cast<long>(n) + 1;
    run.status = RunStatus::completed;
    run.result = std::move(result);
    runs_.push_back(std::move(run));
  }
  /// Five cases: nothing happens; F2 slides at step 3; at steps 4 and 10, with events; it is open
  /// in production, with χ̄ of 0.9; the history ends early.
  void add_five() {
    add(quiet(0.5));
    faultsim::CaseResult early_slide = quiet(0.95);
    slide(early_slide, 3, 0.004);
    add_event(early_slide, 3, 5e13, false);
    add(early_slide, 40);
    faultsim::CaseResult late_slide = quiet(0.95);
    slide(late_slide, 4, 0.003);
    slide(late_slide, 10, 0.002);
    add_event(late_slide, 4, 2e13, true);
    add(late_slide);
    faultsim::CaseResult open = quiet(0.9);
    leave_open(open, "primary_production");
    add(open, 100);
    faultsim::CaseResult ends = quiet(0.4);
    ends.outcome = faultsim::Outcome::unconverged;
    ends.reason = "no";
    add(ends);
  }
  void submit_as(const std::string& kind) {
    s_.spec_resolved = resolved_design(kind);
    store_->submit(s_);
    campaign_ = store_->campaign("");
    store_->record_runs(campaign_.id, runs_);
    campaign_ = store_->campaign("");
  }
  FaultSheet sheet(SheetRequest request = {}) const {
    if (request.fault.empty()) request.fault = "F2";
    return find_fault_sheets(*store_, campaign_, request).at(0);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  Submission s_;
  CampaignInfo campaign_;
  std::vector<RunRecord> runs_;
};

}  // namespace faultsweep::testing
