#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "simulator/common/dates.h"
#include "simulator/common/near_miss.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/scene_reader.h"

/// Stages and compartments, and CSV tables (read_csv_histories.cc), become one pressure history per
/// region.
namespace faultsim {
namespace {

class LoadingReader {
 public:
  LoadingReader(SceneReader& reader, Scene& scene)
      : reader_(reader), scene_(scene), regions_(region_names(scene)) {
    for (const std::string& region : regions_) {
      temperature_.push_back({static_cast<int>(scene.pressure.size()), {0}, {0}});
      scene.pressure.push_back({region, {}, {}, 1, 0});
    }
  }

  void read_stage(std::size_t index) {
    const std::string at = element("/stages", index) + "/";
    Stage stage;
    read_keys(reader_, at, stage);
    stage.duration = duration(at);
    require_advance(at, stage);
    if (stage.stress_change) reader_.require_symmetric(at + "stress_change", *stage.stress_change);
    const int cycles = reader_.integer(at + "cycles", 1);
    check_keys(at, stage, cycles);
    const bool between = reader_.has(at + "pressure_between");
    // More half cycles than steps are a problem already, and may be millions.
    const int n_halves = between && 2 * cycles <= stage.n_steps ? 2 * cycles : 1;
    const bool has_field = reader_.has("/pressure_field");
    for (std::size_t region = 0; region < regions_.size() && !has_field; ++region) {
      const std::array<double, 2> targets = {target(at, region, 1), target(at, region, 2)};
      for (int half = 1; half <= n_halves; ++half) {
        const double time = start_ + stage.duration * half / n_halves;
        add_point(region, time, targets[half % 2 == 1 ? 0 : 1]);
      }
    }
    start_ += stage.duration;
    read_temperatures(at);
    scene_.stages.push_back(stage);
    count_steps(at, stage);
  }
  /// False once there are too many steps; no more stages are read then.
  bool has_room() const { return n_steps_ <= kMostSteps; }

  /// Of the regions whose temperature changes at all.
  void keep_temperatures() {
    for (TemperatureHistory& history : temperature_) {
      const bool changes =
          std::ranges::any_of(history.change, [](double change) { return change != 0; });
      if (changes) scene_.temperature.push_back(std::move(history));
    }
  }

  void read_compartments() {
    for (const std::string& region : reader_.keys("/compartments")) {
      const std::string at = "/compartments/" + pointer_token(region);
      require_region(at, region);
      for (PressureHistory& history : scene_.pressure) {
        if (history.region == region) read_keys(reader_, at + "/", history);
      }
    }
  }

 private:
  static constexpr long kMostSteps = 100'000;  ///< a step is a row of every table

  /// Of a stage that ends after a time or at a date, s.
  double duration(const std::string& at) {
    const std::string date = reader_.text(at + "until");
    const std::string stage = at.substr(0, at.size() - 1);
    if (reader_.has(at + "duration") == reader_.has(at + "until")) {
      const bool both = reader_.has(at + "until");
      reader_.problem(both ? at + "until" : stage,
                      both ? "the stage has a duration too" : "the stage has no duration",
                      both ? "keep one of the two"
                           : "add \"duration\": \"10 year\", or the date at which it ends: "
                             "\"until\": \"2000-01-31\"");
      return kNaN;
    }
    if (date.empty()) return reader_.real(at + "duration");
    const std::optional<double> end = parse_date(date), start = start_date(reader_, scene_);
    if (!end) {
      reader_.problem(at + "until", "\"" + date + "\" is not a date",
                      "write it as year-month-day: 2000-01-31");
    } else if (!start && !reader_.has("/start_date") && !reader_.has("/pressure_field")) {
      reader_.problem(at + "until", "nothing says which date is time 0",
                      "add \"start_date\": \"1990-01-31\" to the scene");
    }
    if (!end || !start) return kNaN;
    const double length = *end - *start - start_;
    if (length > 0) return length;
    reader_.problem(at + "until",
                    concat("the stage ends before it begins, at ", date_text(*start + start_)),
                    "write a later date");
    return kNaN;
  }

  /// Ends of steps must differ when they are rounded, or the loads of a stage are lost.
  void require_advance(const std::string& at, const Stage& stage) {
    const double step = stage.duration / stage.n_steps, end = start_ + stage.duration;
    if (!(step < 2 * std::numeric_limits<double>::epsilon() * end)) return;
    reader_.problem(
        at + (reader_.has(at + "until") ? "until" : "duration"),
        formatted("a step of %.3g s is too short to be told from none after %.6g s", step, start_),
        stage.n_steps > 1 ? "make the stage longer, write fewer steps, or leave it out"
                          : "make the stage longer, or leave it out");
  }

  void count_steps(const std::string& at, const Stage& stage) {
    n_steps_ += stage.n_steps;
    if (has_room()) return;
    const std::string pointer = at + (reader_.has(at + "steps") ? "steps" : "name");
    reader_.problem(pointer, concat("the stages up to this one have ", n_steps_, " load steps"),
                    concat("a scene has at most ", kMostSteps, "; write fewer"));
  }

  /// Silent when a mistake in the geometry may have hidden the region.
  void require_region(const std::string& pointer, const std::string& region) {
    const bool certain = reader_.sound("/geometry/kind") && reader_.sound("/geometry/blocks") &&
                         reader_.sound("/geometry/regions") && reader_.sound("/geometry/file") &&
                         reader_.sound("/geometry/volumes") && is_body_known(reader_, scene_);
    if (certain && region.empty()) {
      reader_.problem(pointer, "a pressure region cannot have an empty name",
                      suggest(region, regions_));
    } else if (certain) {
      reader_.require_known(pointer, region, "pressure region", regions_);
    }
  }

  void check_keys(const std::string& at, const Stage& stage, int cycles) {
    std::vector<std::string> given;
    for (const char* key : {"pressure_change", "pressure", "pressure_between"}) {
      if (reader_.has(at + key)) given.emplace_back(key);
    }
    if (!given.empty() && reader_.has("/pressure_field")) {
      reader_.problem(at + given[0], "the pressures are those of /pressure_field",
                      "remove one of the two");
      return;
    }
    if (given.size() > 1) {
      reader_.problem(at + given[1], "the stage has " + given[0] + " too", "keep one of the two");
    }
    for (const std::string& key : given) check_regions(at + key, "pressure");
    if (reader_.has(at + "cycles") && !reader_.has(at + "pressure_between")) {
      reader_.problem(at + "cycles", "there are cycles but no \"pressure_between\"",
                      "add for example \"pressure_between\": [\"-120 bar\", \"-60 bar\"]");
    } else if (reader_.sound(at + "cycles") && stage.n_steps % (2 * cycles) != 0 &&
               reader_.has(at + "pressure_between")) {
      reader_.problem(
          reader_.has(at + "steps") ? at + "steps" : at.substr(0, at.size() - 1),
          concat(stage.n_steps, " steps cannot be shared among ", 2 * cycles, " half cycles"),
          concat("write a multiple of ", 2 * cycles));
    }
  }

  /// Changes at the end of the stage; the last one where nothing is said.
  void read_temperatures(const std::string& at) {
    const char* const key = "temperature_change";
    check_temperatures(at + key);
    for (std::size_t region = 0; region < regions_.size(); ++region) {
      const std::string pointer = place(at, key, region);
      TemperatureHistory& history = temperature_[region];
      history.time.push_back(start_);
      history.change.push_back(pointer.empty() ? history.change.back() : reader_.real(pointer));
    }
  }
  void check_temperatures(const std::string& pointer) {
    if (!reader_.has(pointer)) return;
    if (!reader_.has("/temperature_field")) return check_regions(pointer, "temperature");
    reader_.problem(pointer, "the temperatures are those of /temperature_field",
                    "remove one of the two");
  }
  /// The regions that a value is given for, one by one or all.
  void check_regions(const std::string& pointer, const std::string& what) {
    if (reader_.find(pointer)->is_object()) {
      for (const std::string& region : reader_.keys(pointer))
        require_region(pointer + "/" + pointer_token(region), region);
    } else if (regions_.empty() && is_body_known(reader_, scene_)) {
      reader_.problem(pointer, "there is no region whose " + what + " could change",
                      cure_of_no_region(reader_) + " or remove this line");
    }
  }

  /// Pointer to the value of key for a region; "" when the stage does not say.
  std::string place(const std::string& at, const char* key, std::size_t region) const {
    const std::string pointer = at + key;
    const nlohmann::json* value = reader_.find(pointer);
    if (value == nullptr) return "";
    if (!value->is_object()) return pointer;
    const std::string inner = pointer + "/" + pointer_token(regions_[region]);
    return reader_.has(inner) ? inner : "";
  }

  /// Change at the end of the half cycle (1, 2, ...) or stage; the last value when nothing is said.
  double target(const std::string& at, std::size_t region, int half) const {
    const auto& history = scene_.pressure[region].pressure_change;
    if (const auto pointer = place(at, "pressure_change", region); !pointer.empty()) {
      return reader_.real(pointer);
    }
    if (const auto pointer = place(at, "pressure_between", region); !pointer.empty()) {
      return reader_.real(pointer + (half % 2 == 1 ? "/0" : "/1"));
    }
    if (const auto pointer = place(at, "pressure", region); !pointer.empty()) {
      const bool ready = reader_.sound("/geometry") && reader_.sound("/initial_state") &&
                         reader_.sound("/materials");
      if (!ready) return kNaN;
      const double top = region_top(scene_, region);
      return reader_.real(pointer) - initial_region_pressure(scene_, region, top);
    }
    return history.empty() ? 0 : history.back();
  }

  void add_point(std::size_t region, double time, double change) {
    scene_.pressure[region].time.push_back(time);
    scene_.pressure[region].pressure_change.push_back(change);
  }

  SceneReader& reader_;
  Scene& scene_;
  std::vector<std::string> regions_;
  std::vector<TemperatureHistory> temperature_;  ///< per region.
  double start_ = 0;
  long n_steps_ = 0;
};

}  // namespace

void read_loading(SceneReader& reader, Scene& scene) {
  LoadingReader loading(reader, scene);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < reader.size("/stages") && loading.has_room(); ++i) {
    loading.read_stage(i);
    names.push_back(scene.stages.back().name);
  }
  reader.require_unique("/stages", "/name", names);
  loading.keep_temperatures();
  choose_reports(reader, scene);
  read_csv_histories(reader, scene);
  loading.read_compartments();
}

}  // namespace faultsim
