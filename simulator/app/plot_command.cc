#include <optional>

#include "simulator/app/program.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/common/version.h"
#include "simulator/documents/json_document.h"
#include "simulator/page/run_page.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_json.h"
#include "simulator/result_files/field_reader.h"

namespace faultsim {
namespace {

struct PlotArguments {
  std::string chart;             ///< a name of case_charts().
  std::string result;            ///< folder that `run` wrote.
  std::filesystem::path output;  ///< .svg or .png.
  std::string fault;             ///< "" = the most critical one.
  std::optional<int> step;       ///< load step; none = the most critical one.
  std::string show = "chi";      ///< of a fault map: a word of MapField.
  std::string before;            ///< folder of another run, drawn as thin lines; "" = none.
};

struct ReportArguments {
  std::string result;            ///< folder that `run` wrote.
  std::filesystem::path output;  ///< .html.
};

const CaseChartInfo& chart_named(const std::string& name) {
  if (const CaseChartInfo* info = case_chart_named(name)) return *info;
  throw InputError("chart", concat("\"", name, "\" is not a chart"),
                   "choose one of " + joined(case_charts(), ", ", &CaseChartInfo::name));
}

/// A folder that `run` wrote.
class StoredRun {
 public:
  /// @param option  that names it: "result", "--before".
  StoredRun(const std::string& name, const char* option)
      : folder_(name),
        scene_document_(read_part("scene.json", name, option)),
        result_(result_from_json(read_part("result.json", name, option).value)),
        scene_(read_scene(scene_document_)) {
    if (std::filesystem::exists(folder_ / "faults.h5")) fields_.emplace(folder_ / "faults.h5");
  }

  CasePicture picture() const { return {result_, scene_, fields_ ? &*fields_ : nullptr, {}}; }
  /// The last part of the folder's name: charts say no paths of a machine.
  std::string name() const {
    const std::filesystem::path whole = std::filesystem::absolute(folder_).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  }
  std::string scene_text() const { return scene_document_.value.dump(); }
  /// Files that a picture must not replace.
  std::vector<std::filesystem::path> files() const {
    return {folder_ / "scene.json", folder_ / "result.json", folder_ / "faults.h5"};
  }

 private:
  JsonDocument read_part(const char* part, const std::string& name, const char* option) const {
    if (std::filesystem::exists(folder_ / part)) return read_json_file((folder_ / part).string());
    throw InputError(option, concat("\"", name, "\" is not a result folder"),
                     "name a folder that faultsim run wrote");
  }

  std::filesystem::path folder_;
  JsonDocument scene_document_;
  CaseResult result_;
  Scene scene_;
  std::optional<FieldReader> fields_;
};

ExitCode plot_command(const PlotArguments& arguments) {
  const CaseChartInfo& info = chart_named(arguments.chart);
  const MapField show = field_shown("--show", arguments.show);
  require_shows(info, show);
  const StoredRun run(arguments.result, "result");
  std::vector<std::filesystem::path> inputs = run.files();
  CasePicture picture = run.picture();
  std::optional<StoredRun> earlier;
  std::optional<CasePicture> original;
  if (!arguments.before.empty()) {
    require_draws_original(info);
    earlier.emplace(arguments.before, "--before");
    for (const std::filesystem::path& one : earlier->files()) inputs.push_back(one);
    original.emplace(earlier->picture());
    original->name = earlier->name();
    picture.original = &*original;
  }
  require_picture_file(arguments.output, {".svg", ".png"}, inputs);
  write_picture(arguments.output,
                draw_case(picture, {info.chart, arguments.fault, arguments.step, false, show}));
  return ExitCode::done;
}

ExitCode report_command(const ReportArguments& arguments) {
  const StoredRun run(arguments.result, "result");
  require_picture_file(arguments.output, {".html"}, run.files());
  write_picture(arguments.output,
                run_page(run.picture(), run.scene_text(), version_text("faultsim")));
  return ExitCode::done;
}

}  // namespace

void add_plot(Program& program) {
  auto [command, a] = program.add("plot", "draw a chart of a result as SVG or PNG", plot_command);
  std::string charts = "one of:";
  for (const CaseChartInfo& info : case_charts()) {
    charts += concat("\n", info.name, ": ", info.meaning);
  }
  command->add_option("chart", a.chart, charts)->required();
  command->add_option("result", a.result, "folder that run wrote")->required();
  command->add_option("-o,--output", a.output, "file to write: *.svg, or *.png by rsvg-convert")
      ->required();
  command->add_option("--fault", a.fault, "default: the one with the largest χ̄");
  command->add_option("--step", a.step, "load step; default: that of its largest χ̄");
  command->add_option("--show", a.show, "of a fault-map: chi (default), slip, state, pressure");
  command->add_option("--before", a.before,
                      "another folder that run wrote: its curves as thin lines");
  command->footer(
      "Examples:\n"
      "  faultsim plot history out -o history.svg\n"
      "  faultsim plot history out --before earlier -o both.svg\n"
      "  faultsim plot section out --step 10 -o section.svg\n"
      "  faultsim plot profiles out --fault F2 -o profiles.png");
}

void add_report(Program& program) {
  auto [command, a] =
      program.add("report", "a result as one HTML page that needs no network", report_command);
  command->add_option("result", a.result, "folder that run wrote")->required();
  command->add_option("-o,--output", a.output, "file to write: *.html")->required();
  command->footer(
      "Examples:\n"
      "  faultsim report out -o out.html\n"
      "  faultsim run --from-report out.html -o again    the same scene, with the same bits");
}

}  // namespace faultsim
