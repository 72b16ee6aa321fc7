#include <optional>

#include "simulator/app/commands.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/documents/json_document.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_json.h"

namespace faultsim {
namespace {

CaseChart chart_named(const std::string& name) {
  if (const CaseChartInfo* info = case_chart_named(name)) return info->chart;
  throw InputError("chart", concat("\"", name, "\" is not a chart"),
                   "choose one of " + joined(case_charts(), ", ", &CaseChartInfo::name));
}

}  // namespace

ExitCode plot_command(const PlotArguments& arguments) {
  const std::filesystem::path folder = arguments.result;
  const std::filesystem::path scene_file = folder / "scene.json",
                              result_file = folder / "result.json",
                              fields_file = folder / "faults.h5";
  const CaseChart chart = chart_named(arguments.chart);
  if (!std::filesystem::exists(result_file) || !std::filesystem::exists(scene_file)) {
    throw InputError("result", concat("\"", arguments.result, "\" is not a result folder"),
                     "name a folder that faultsim run wrote");
  }
  require_picture_file(arguments.output, {".svg", ".png"}, {scene_file, result_file, fields_file});
  const CaseResult result = result_from_json(read_json_file(result_file.string()).value);
  const Scene scene = read_scene(read_json_file(scene_file.string()));
  std::optional<FieldReader> fields;
  if (std::filesystem::exists(fields_file)) fields.emplace(fields_file);
  write_picture(arguments.output, draw_case({result, scene, fields ? &*fields : nullptr, {}},
                                            {chart, arguments.fault, arguments.step, false}));
  return ExitCode::done;
}

}  // namespace faultsim
