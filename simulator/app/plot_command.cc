#include <optional>

#include "simulator/app/commands.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/documents/json_document.h"
#include "simulator/page/run_page.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_json.h"
#include "simulator/result_files/field_reader.h"

namespace faultsim {
namespace {

CaseChart chart_named(const std::string& name) {
  if (const CaseChartInfo* info = case_chart_named(name)) return info->chart;
  throw InputError("chart", concat("\"", name, "\" is not a chart"),
                   "choose one of " + joined(case_charts(), ", ", &CaseChartInfo::name));
}

/// A folder that `run` wrote.
class StoredRun {
 public:
  explicit StoredRun(const std::string& name)
      : folder_(name),
        scene_document_(read_part("scene.json", name)),
        result_(result_from_json(read_part("result.json", name).value)),
        scene_(read_scene(scene_document_)) {
    if (std::filesystem::exists(folder_ / "faults.h5")) fields_.emplace(folder_ / "faults.h5");
  }

  CasePicture picture() const { return {result_, scene_, fields_ ? &*fields_ : nullptr, {}}; }
  std::string scene_text() const { return scene_document_.value.dump(); }
  /// Files that a picture must not replace.
  std::vector<std::filesystem::path> files() const {
    return {folder_ / "scene.json", folder_ / "result.json", folder_ / "faults.h5"};
  }

 private:
  JsonDocument read_part(const char* part, const std::string& name) const {
    if (std::filesystem::exists(folder_ / part)) return read_json_file((folder_ / part).string());
    throw InputError("result", concat("\"", name, "\" is not a result folder"),
                     "name a folder that faultsim run wrote");
  }

  std::filesystem::path folder_;
  JsonDocument scene_document_;
  CaseResult result_;
  Scene scene_;
  std::optional<FieldReader> fields_;
};

}  // namespace

ExitCode plot_command(const PlotArguments& arguments) {
  const CaseChart chart = chart_named(arguments.chart);
  const StoredRun run(arguments.result);
  require_picture_file(arguments.output, {".svg", ".png"}, run.files());
  write_picture(arguments.output,
                draw_case(run.picture(), {chart, arguments.fault, arguments.step, false}));
  return ExitCode::done;
}

ExitCode report_command(const ReportArguments& arguments) {
  const StoredRun run(arguments.result);
  require_picture_file(arguments.output, {".html"}, run.files());
  write_picture(arguments.output, run_page(run.picture(), run.scene_text(), arguments.program));
  return ExitCode::done;
}

}  // namespace faultsim
