#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/flow/field_file.h"
#include "simulator/flow/report_choice.h"
#include "simulator/scene/csv_tables.h"
#include "simulator/scene/load_times.h"
#include "simulator/scene/scene_reader.h"

/// The result of a flow simulator becomes the pressures of all regions.
namespace faultsim {
namespace {

const std::string kAt = "/pressure_field";
constexpr double kDay = 86400;  // s

/// The dates of some reports, for a message.
std::string dates_of(const FlowField& field) {
  constexpr std::size_t kMost = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, field.date.size()); ++i)
    text += (i == 0 ? "" : ", ") + date_text(field.date[i]);
  if (field.date.size() > kMost) text += ", ..., " + date_text(field.date.back());
  return text;
}

/// The report of the day that a text says; none where there is none.
std::optional<int> report_at(const FlowField& field, const std::string& date) {
  const std::optional<double> wanted = parse_date(date);
  if (!wanted) return std::nullopt;
  for (std::size_t i = 0; i < field.date.size(); ++i) {
    if (std::abs(field.date[i] - *wanted) < kDay) return static_cast<int>(i);
  }
  return std::nullopt;
}

/// Opens the file where the scene, or "fields" of it, says.
std::optional<FieldFile> open_field(SceneReader& reader, const std::string& name) {
  const JsonDocument& document = reader.document();
  const FieldPlace place = field_place(document.value, document.source, name);
  try {
    FieldFile file = read_field_file(place.path);
    if (place.fingerprint.empty() || place.fingerprint == file.fingerprint) return file;
    reader.problem(kAt + "/file", "\"" + name + "\" is no longer what it was: the file has changed",
                   "put the old file back, or remove its entry under \"fields\" to take the new one");
  } catch (const InputError& error) {
    for (const Problem& one : error.problems()) {
      const std::string line = one.line > 0 ? concat(" line ", one.line, ": ") : ": ";
      reader.problem(kAt + "/file", name + line + one.what, one.cure);
    }
  }
  return std::nullopt;
}

/// The reports must end where the stages do, or the scene says what is meant.
void check_end(SceneReader& reader, const Scene& scene, double last, double end) {
  const Stage& stage = scene.stages.back();
  const double near = kMetShare * stage.duration / stage.n_steps;
  const std::string rule = reader.text(kAt + "/end", "exact");
  const auto years = [](double time) { return in_unit(time, Dimension::time, "year"); };
  if (last < end - near && rule != "hold") {
    reader.problem(kAt, "its reports end at " + years(last) + ", the stages at " + years(end),
                   "end the stages there (\"until\": \"" + date_text(scene.flow.field->date.back()) +
                       "\"), or write \"end\": \"hold\" to keep the last pressures");
  } else if (last > end + near && rule != "cut") {
    reader.problem(kAt, "its reports go on to " + years(last) + ", the stages end at " + years(end),
                   "end the stages there (\"until\": \"" + date_text(scene.flow.field->date.back()) +
                       "\"), or write \"end\": \"cut\" to leave the rest out");
  }
}

}  // namespace

std::optional<double> start_date(SceneReader& reader, const Scene& scene) {
  const std::string text = reader.text("/start_date");
  if (!text.empty()) {
    const std::optional<double> date = parse_date(text);
    if (!date) {
      reader.problem("/start_date", "\"" + text + "\" is not a date",
                     "write it as year-month-day: 1990-01-31");
    }
    return date;
  }
  if (!scene.flow.is_given()) return std::nullopt;
  return scene.flow.field->date[static_cast<std::size_t>(scene.flow.reference)];
}

void read_flow_load(SceneReader& reader, Scene& scene) {
  const std::string name = reader.text(kAt + "/file");
  if (name.empty()) return;
  FlowLoad& flow = scene.flow;
  if (region_names(scene).empty() && reader.sound("/geometry"))
    reader.problem(kAt, "there is no region whose pressure could change",
                   "add \"regions\" to the geometry or remove the field");
  if (reader.text(kAt + "/outside") == "unchanged") flow.outside = OutsideRule::unchanged;
  const std::optional<FieldFile> file = open_field(reader, name);
  if (!file) return;
  if (const std::string date = reader.text(kAt + "/reference"); !date.empty()) {
    const std::optional<int> report = report_at(*file->field, date);
    if (!report) {
      return reader.problem(kAt + "/reference", "\"" + date + "\" is the day of no report",
                            "choose one of " + dates_of(*file->field));
    }
    flow.reference = *report;
  }
  flow.field = file->field;
  flow.fingerprint = file->fingerprint;
  if (const std::string doubt = pressure_doubt(*flow.field); !doubt.empty())
    scene.remarks.push_back({kAt, "looks wrong: " + doubt});
}

void choose_reports(SceneReader& reader, Scene& scene) {
  FlowLoad& flow = scene.flow;
  const std::optional<double> start = start_date(reader, scene);
  if (!flow.is_given() || !start || !reader.sound("/stages") || scene.stages.empty()) return;
  const FlowField& field = *flow.field;
  if (field.date[static_cast<std::size_t>(flow.reference)] < *start) {
    return reader.problem("/start_date", "lies after the reference of the pressure field",
                          "move it to " + date_text(field.date[flow.reference]) +
                              ", or choose a later reference");
  }
  double end = 0;
  for (const Stage& stage : scene.stages) end += stage.duration;
  check_end(reader, scene, field.date.back() - *start, end);
  // Up to the first report at or after the end.
  std::vector<double> time;
  for (std::size_t i = static_cast<std::size_t>(flow.reference); i < field.date.size(); ++i) {
    time.push_back(field.date[i] - *start);
    if (time.back() >= end) break;
  }
  const auto n = static_cast<Eigen::Index>(time.size());
  constexpr double kTolerance = 1e4;  // Pa: a tenth of a bar
  const double tolerance = reader.quantity(kAt + "/tolerance", kTolerance);
  if (!(tolerance >= 0)) return;
  for (const int i :
       needed_reports(time, field.pressure.middleCols(flow.reference, n), tolerance)) {
    flow.reports.push_back(flow.reference + i);
    flow.time.push_back(time[static_cast<std::size_t>(i)]);
  }
}

/// A field's influence is that of the elastic operator, on one mesh, of all of the domain.
void check_flow_load(SceneReader& reader, const Scene& scene) {
  if (!reader.has(kAt)) return;
  if (has_viscous_material(scene) && scene.numerics.creep != Switch::off) {
    reader.problem(kAt, "salt creeps, and a field acts on elastic rock only",
                   "set /numerics/creep to \"off\", or say the pressures by compartments");
  }
  if (scene.numerics.half_domain == Switch::on) {
    reader.problem(kAt,
                   "a field need not be symmetric, and half of the domain is modelled",
                   "set /numerics/half_domain to \"off\", and choose another tier than one for half "
                   "domains");
  }
  if (scene.numerics.surface.wanted()) {
    reader.problem(kAt, "a surface of operators has no influence of single cells",
                   "remove /numerics/surface, or say the pressures by compartments");
  }
}

}  // namespace faultsim
