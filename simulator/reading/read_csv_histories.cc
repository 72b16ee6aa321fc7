#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/near_miss.h"
#include "simulator/common/ranges.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/pressure_csv.h"
#include "simulator/reading/scene_reader.h"

/// CSV tables replace what the stages say of a region's pressure.
namespace faultsim {
namespace {

std::string years(double seconds) { return in_unit(seconds, Dimension::time, "year"); }
std::string bars(double pascals) { return in_unit(pascals, Dimension::pressure, "bar"); }

class CsvHistories {
 public:
  CsvHistories(SceneReader& reader, Scene& scene)
      : reader_(reader), scene_(scene), regions_(region_names(scene)) {}

  void read() {
    start_ = start_date(reader_, scene_);
    read_tables();
    remark_idle();
    scene_.start_date = start_ ? start_ : first_start_;
  }

 private:
  void read_tables() {
    refuse_beside_field();
    if (const std::string file = reader_.text("/pressure_csv"); !file.empty()) {
      const PressureCsv csv = open(file, "/pressure_csv");
      for (const PressureColumn& column : csv.columns) {
        take_column(csv, column, file, "/pressure_csv");
      }
    }
    for (const std::string& region : reader_.keys("/compartments")) {
      const std::string pointer = "/compartments/" + pointer_token(region) + "/csv";
      const std::string file = reader_.text(pointer);
      if (file.empty() || !contains(regions_, region)) continue;
      const PressureCsv csv = open(file, pointer);
      const auto column = std::ranges::find(csv.columns, region, &PressureColumn::region);
      if (column != csv.columns.end()) {
        take_column(csv, *column, file, pointer);
      } else if (!csv.columns.empty()) {
        reader_.problem(pointer, "\"" + file + "\" has no column \"" + region + "\"",
                        "give a column the compartment's name");
      }
    }
  }

  /// A flow result says the pressures of all regions.
  void refuse_beside_field() {
    if (!reader_.has("/pressure_field")) return;
    std::vector<std::string> idle = {"/pressure_csv"};
    for (const std::string& region : reader_.keys("/compartments"))
      idle.push_back("/compartments/" + pointer_token(region));
    for (const std::string& pointer : idle) {
      if (reader_.has(pointer))
        reader_.problem(pointer, "the pressures are those of /pressure_field",
                        "remove one of the two");
    }
  }

  void remark(const std::string& pointer, const std::string& why) {
    if (reader_.has(pointer)) scene_.remarks.push_back({pointer, "has no effect: " + why});
  }
  /// What there is no table for.
  void remark_idle() {
    if (!has_table_) remark("/pressure_csv_end", "there is no CSV table");
    if (!has_dates_ && !scene_.has_field() && !ends_at_dates() && !has_fault_table())
      remark("/start_date", "no CSV table has dates");
    for (const std::string& region : regions_) {
      if (contains(absolute_, region)) continue;
      remark("/compartments/" + pointer_token(region) + "/datum",
             "no CSV table gives its absolute pressure");
    }
  }

  /// Whose dates count from it, and which is told by dates.
  bool has_fault_table() const {
    return std::ranges::any_of(scene_.faults, [](const Fault& fault) {
      return fault.pressure.rule == FaultPressureRule::table;
    });
  }

  bool ends_at_dates() const {
    for (std::size_t i = 0; i < scene_.stages.size(); ++i) {
      if (reader_.has(element("/stages", i) + "/until")) return true;
    }
    return false;
  }

  /// Without columns after a refusal.
  PressureCsv open(const std::string& file, const std::string& pointer) {
    const JsonDocument& document = reader_.document();
    PressureCsv csv;
    try {
      csv = parse_pressure_csv(table_text(document.value, document.source, file), file, start_);
    } catch (const InputError& error) {
      reader_.table_problems(pointer, file, error);
      return {};
    }
    has_table_ = true;
    has_dates_ = has_dates_ || csv.has_dates;
    check_start(csv, file, pointer);
    check_end(csv.time.back(), file, pointer);
    return csv;
  }

  /// Tables with dates must agree on what time 0 is.
  void check_start(const PressureCsv& csv, const std::string& file, const std::string& pointer) {
    if (start_ || !csv.has_dates) return;
    if (!first_start_) first_start_ = csv.start;
    if (*first_start_ == *csv.start) return;
    reader_.problem(pointer, file + " begins at a different date from the tables before",
                    "say which date is time 0: \"start_date\": \"1990-01-31\" in the scene");
  }

  /// A table that ends elsewhere than the stages is right only where the scene says so.
  void check_end(double last, const std::string& file, const std::string& pointer) {
    if (!reader_.sound("/stages") || scene_.stages.empty()) return;
    const double end = end_time(scene_);
    const Stage& stage = scene_.stages.back();
    const double near = kMetShare * stage.duration / stage.n_steps;
    const std::string rule = reader_.text("/pressure_csv_end", "exact");
    if (last < end - near && rule != "hold") {
      reader_.problem(pointer, file + " ends at " + years(last) + ", the stages at " + years(end),
                      "add rows up to there, or write \"pressure_csv_end\": \"hold\" to keep the "
                      "last pressures");
    } else if (last > end + near && rule != "cut") {
      reader_.problem(pointer,
                      file + " goes on to " + years(last) + ", the stages end at " + years(end),
                      "make the stages longer, or write \"pressure_csv_end\": \"cut\" to leave "
                      "the rest out");
    }
  }

  void take_column(const PressureCsv& csv, const PressureColumn& column, const std::string& file,
                   const std::string& pointer) {
    const auto region = std::ranges::find(regions_, column.region);
    if (region == regions_.end()) {
      reader_.problem(pointer, "its column \"" + column.region + "\" is not a pressure region",
                      suggest(column.region, regions_));
      return;
    }
    const auto index = static_cast<std::size_t>(region - regions_.begin());
    PressureHistory& history = scene_.pressure[index];
    if (history.from_csv) {
      scene_.remarks.push_back({"/pressure_csv", "has no effect on " + history.region + ": " +
                                                     pointer + " replaces it"});
    }
    history.time = csv.time;
    history.pressure_change = column.pressure;
    history.from_csv = true;
    if (!column.is_absolute) return;
    absolute_.push_back(column.region);
    subtract_initial(index, file, pointer);
  }

  /// Pressures at the region's datum become changes of the initial pressure there.
  void subtract_initial(std::size_t region, const std::string& file, const std::string& pointer) {
    PressureHistory& history = scene_.pressure[region];
    const bool ready = reader_.sound("/geometry") && reader_.sound("/initial_state") &&
                       reader_.sound("/materials");
    const std::string datum = "/compartments/" + pointer_token(history.region) + "/datum";
    const double depth = reader_.real(datum, region_top(scene_, region));
    const double initial =
        ready && !std::isnan(depth) ? initial_region_pressure(scene_, region, depth) : kNaN;
    for (std::size_t i = 0; i < history.time.size(); ++i) {
      const double change = history.pressure_change[i] - initial;
      constexpr double kAgrees = 1e4;  // Pa: tables are written to a tenth of a bar
      if (history.time[i] == 0 && std::abs(change) > kAgrees) {
        reader_.problem(
            pointer,
            concat(file, ": \"", history.region, "\" begins at ", bars(history.pressure_change[i]),
                   ", its initial pressure at ", in_unit(depth, Dimension::length, "m"),
                   " depth is ", bars(initial)),
            "give the block an \"overpressure\" that makes them equal, or the depth that the "
            "pressures refer to as \"datum\" of the compartment");
      }
      history.pressure_change[i] = history.time[i] == 0 ? 0 : change;
    }
  }

  SceneReader& reader_;
  Scene& scene_;
  std::vector<std::string> regions_;
  std::optional<double> start_;        ///< s since 1970, as the scene says.
  std::optional<double> first_start_;  ///< of the first table with dates.
  bool has_table_ = false, has_dates_ = false;
  std::vector<std::string> absolute_;  ///< regions.
};

}  // namespace

void read_csv_histories(SceneReader& reader, Scene& scene) { CsvHistories(reader, scene).read(); }

}  // namespace faultsim
