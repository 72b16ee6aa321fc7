#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/common/printable.h"
#include "simulator/common/text.h"
#include "simulator/flow/field_file.h"
#include "simulator/flow/flow_field.h"
#include "simulator/flow/report_choice.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/scene_reader.h"

/// The result of a flow simulator becomes the pressures of all regions.
namespace faultsim {
namespace {

constexpr double kDay = 86400;  // s

/// A field as a scene names it.
struct FieldKey {
  const char* at;
  FlowQuantity quantity;
  FlowLoad Scene::*load;
  double tolerance;  ///< Pa or K: the default.
};
constexpr FieldKey kFields[] = {
    {"/pressure_field", FlowQuantity::pressure, &Scene::pressure_field, 1e4},
    {"/temperature_field", FlowQuantity::temperature, &Scene::temperature_field, 0.1}};

/// The dates of some reports, for a message.
std::string dates_of(const FlowField& field) {
  constexpr std::size_t kMost = 5;
  std::string text =
      joined(std::span(field.date).first(std::min(field.date.size(), kMost)), ", ", date_text);
  if (field.date.size() > kMost) text += ", ..., " + date_text(field.date.back());
  return text;
}

/// The report of the day that a text says; none where there is none.
std::optional<int> report_at(const FlowField& field, const std::string& date) {
  const std::optional<double> wanted = parse_date(date);
  if (!wanted) return std::nullopt;
  const auto found =
      std::ranges::find_if(field.date, [&](double day) { return std::abs(day - *wanted) < kDay; });
  if (found == field.date.end()) return std::nullopt;
  return static_cast<int>(found - field.date.begin());
}

/// Opens the file where the scene, or "fields" of it, says.
std::optional<FieldFile> open_field(SceneReader& reader, const FieldKey& key,
                                    const std::string& name) {
  const std::string at = std::string(key.at) + "/file";
  const JsonDocument& document = reader.document();
  const FieldPlace place = field_place(document.value, document.source, name);
  const std::string path = std::filesystem::absolute(place.path).lexically_normal().string();
  if (const std::string odd = first_unprintable(path); !odd.empty()) {
    reader.problem(
        at, "the file lies in a folder whose name contains \"" + odd + "\": " + printable(path),
        "rename the folder");
    return std::nullopt;
  }
  try {
    FieldFile file = read_field_file(place.path, key.quantity);
    if (place.fingerprint.empty() || place.fingerprint == file.fingerprint) return file;
    reader.problem(
        at, "\"" + name + "\" is no longer what it was: the file has changed",
        "put the old file back, or remove its entry under \"fields\" to take the new one");
  } catch (const InputError& error) {
    reader.table_problems(at, name, error);
  }
  return std::nullopt;
}

/// The reports must end where the stages do, or the scene says what is meant.
void check_end(SceneReader& reader, const std::string& at, const Scene& scene,
               const FlowField& field, double last, double end) {
  const Stage& stage = scene.stages.back();
  const double near = kMetShare * stage.duration / stage.n_steps;
  const std::string rule = reader.text(at + "/end", "exact");
  const auto years = [](double time) { return in_unit(time, Dimension::time, "year"); };
  const std::string until = "end the stages there (\"until\": \"" + date_text(field.date.back()) +
                            "\"), or write \"end\": ";
  if (last < end - near && rule != "hold") {
    reader.problem(at, "its reports end at " + years(last) + ", the stages at " + years(end),
                   until + "\"hold\" to keep the last values");
  } else if (last > end + near && rule != "cut") {
    reader.problem(at, "its reports go on to " + years(last) + ", the stages end at " + years(end),
                   until + "\"cut\" to leave the rest out");
  }
}

/// Plane strain takes the field at one y: that of the scene's own section if nothing is said.
void read_section(SceneReader& reader, const std::string& at, Scene& scene, FlowLoad& load) {
  if (scene.numerics.plane_strain != Switch::on) {
    if (reader.has(at + "/y"))
      scene.remarks.push_back({at + "/y", "has no effect: it is for plane strain"});
    return;
  }
  const bool is_box = scene.geometry_kind == GeometryKind::box;
  load.y = reader.real(at + "/y", is_box ? 0.5 * (scene.box.from[1] + scene.box.to[1]) : 0);
}

void read_field(SceneReader& reader, const FieldKey& key, Scene& scene) {
  const std::string at = key.at, name = reader.text(at + "/file");
  if (name.empty()) return;
  FlowLoad& load = scene.*key.load;
  if (region_names(scene).empty() && is_body_known(reader, scene)) {
    reader.problem(at, "there is no region that it could act on",
                   cure_of_no_region(reader) + " or remove the field");
  }
  load.outside_given = reader.has(at + "/outside");
  read_keys(reader, at + "/", load);
  read_section(reader, at, scene, load);
  const std::optional<FieldFile> file = open_field(reader, key, name);
  if (!file) return;
  if (const std::string date = reader.text(at + "/reference"); !date.empty()) {
    const std::optional<int> report = report_at(*file->field, date);
    if (!report) {
      return reader.problem(at + "/reference", "there is no report on \"" + date + "\"",
                            "choose one of " + dates_of(*file->field));
    }
    load.reference = *report;
  }
  load.field = file->field;
  load.fingerprint = file->fingerprint;
  for (const std::string& note : file->field->notes) scene.remarks.push_back({at, note});
  if (key.quantity != FlowQuantity::pressure) return;
  if (const std::string doubt = pressure_doubt(*load.field); !doubt.empty())
    scene.remarks.push_back({at, "looks wrong: " + doubt});
}

double reference_date(const FlowLoad& load) {
  return load.field->date[static_cast<std::size_t>(load.reference)];
}

void choose(SceneReader& reader, const FieldKey& key, double start, Scene& scene) {
  FlowLoad& load = scene.*key.load;
  if (!load.is_given()) return;
  const FlowField& field = *load.field;
  const std::string at = key.at;
  if (reference_date(load) < start) {
    return reader.problem(
        reader.has("/start_date") ? "/start_date" : at,
        "time 0, " + date_text(start) + ", lies after the reference of " + at.substr(1),
        "begin at " + date_text(reference_date(load)) + ", or choose a later reference");
  }
  const double end = end_time(scene);
  check_end(reader, at, scene, field, field.date.back() - start, end);
  // Up to the first report at or after the end.
  std::vector<double> time;
  for (std::size_t i = static_cast<std::size_t>(load.reference); i < field.date.size(); ++i) {
    time.push_back(field.date[i] - start);
    if (time.back() >= end) break;
  }
  const auto n = static_cast<Eigen::Index>(time.size());
  const double tolerance = reader.real(at + "/tolerance", key.tolerance);
  if (!(tolerance >= 0)) return;
  for (const int i : needed_reports(time, field.value.middleCols(load.reference, n), tolerance)) {
    load.reports.push_back(load.reference + i);
    load.time.push_back(time[static_cast<std::size_t>(i)]);
  }
}

/// How symmetric a field is, where half of the domain may be modelled.
void measure_symmetry(const Scene& scene, FlowLoad& load) {
  if (scene.geometry_kind != GeometryKind::field || scene.numerics.half_domain == Switch::off ||
      scene.numerics.plane_strain == Switch::on)
    return;
  load.asymmetry = asymmetry(*field_in_scene(load));
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
  for (const FieldKey& key : kFields) {
    if ((scene.*key.load).is_given()) return reference_date(scene.*key.load);
  }
  return std::nullopt;
}

void read_flow_loads(SceneReader& reader, Scene& scene) {
  for (const FieldKey& key : kFields) read_field(reader, key, scene);
}

void choose_reports(SceneReader& reader, Scene& scene) {
  const std::optional<double> start = start_date(reader, scene);
  if (!start || !reader.sound("/stages") || scene.stages.empty()) return;
  for (const FieldKey& key : kFields) choose(reader, key, *start, scene);
}

void check_flow_loads(Scene& scene) {
  for (const FieldKey& key : kFields) {
    if ((scene.*key.load).is_given()) measure_symmetry(scene, scene.*key.load);
  }
}

}  // namespace faultsim
