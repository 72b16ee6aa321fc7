#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "simulator/common/units.h"
#include "simulator/documents/json_document.h"
#include "simulator/documents/schema.h"
#include "simulator/scene/scene.h"

/// Inside of read_scene. A value that is missing or wrong has been reported once and reads as NaN
/// (numbers) or "" (texts); checks are written such that NaN and "" never cause a second report.
namespace faultsim {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A value by the key of an object; its pointer is written where it is needed.
struct KeyPlace {
  const nlohmann::json* value = nullptr;  ///< none: it is not there.
  std::string_view object;                ///< pointer to the object, with a slash at its end.
  std::string_view key;
  std::string pointer() const { return std::string(object).append(key); }
};

class SceneReader {
 public:
  /// Checks document against the schema and reads all quantities of it.
  /// @param members     of the document that are checked and read; none = all.
  /// @param quantities  of the others, as far as they are asked for.
  SceneReader(const JsonDocument& document, std::vector<Problem>& problems,
              std::span<const std::string> members = {},
              std::unordered_map<const nlohmann::json*, double> quantities = {});
  /// Of a document that was found sound. @param quantities  all of it.
  SceneReader(const JsonDocument& document, std::vector<Problem>& problems,
              std::unordered_map<const nlohmann::json*, double> quantities)
      : document_(document), problems_(problems), quantities_(std::move(quantities)) {}
  /// What was read, for later.
  std::unordered_map<const nlohmann::json*, double>& quantities() { return quantities_; }
  /// Reads a number or quantity that has taken the place of a sound one. @returns false where it is
  /// something else, or wrong.
  bool read_again(std::string_view pointer);

  const JsonDocument& document() const { return document_; }
  /// The value at pointer; nullptr when it is not there.
  const nlohmann::json* find(const std::string& pointer) const;
  bool has(const std::string& pointer) const { return find(pointer) != nullptr; }
  /// No problem at the value or below it (a parent that lacks a key leaves its children sound).
  bool sound(const std::string& pointer) const {
    return problems_.empty() || !unsound_.contains(pointer);
  }
  /// Elements of a list, 0 if it is none or has more than the schema allows.
  std::size_t size(const std::string& pointer) const;
  /// Keys of an object without "comment".
  std::vector<std::string> keys(const std::string& pointer) const;

  /// A number, of a quantity in SI.
  double real(const KeyPlace& place, double fallback = kNaN) const;
  int integer(const KeyPlace& place, int fallback) const;
  std::string text(const KeyPlace& place, const std::string& fallback = "") const;
  bool boolean(const KeyPlace& place, bool fallback) const;
  double real(const std::string& pointer, double fallback = kNaN) const {
    return real(place(pointer), fallback);
  }
  int integer(const std::string& pointer, int fallback) const {
    return integer(place(pointer), fallback);
  }
  std::string text(const std::string& pointer, const std::string& fallback = "") const {
    return text(place(pointer), fallback);
  }
  KeyPlace place(const std::string& pointer) const { return {find(pointer), pointer, {}}; }
  /// Empty unless there is one factor per time.
  TimeTable table(const std::string& pointer);

  /// Adds a problem unless the same was said before.
  void problem(const std::string& pointer, const std::string& what, const std::string& cure);
  /// Adds the problems of a table, "NAME line 3: WHAT", at the place that names it.
  void table_problems(const std::string& pointer, const std::string& name, const InputError& error);
  /// Adds a problem when name is not one of known; "" is silent.
  void require_known(const std::string& pointer, const std::string& name, const std::string& what,
                     const std::vector<std::string>& known);
  /// Adds a problem where a tensor, row-major, is not symmetric.
  void require_symmetric(const std::string& pointer, const std::array<double, 9>& tensor);
  /// Adds a problem per name that was there before. @param suffix  of each element's pointer.
  void require_unique(const std::string& list, const std::string& suffix,
                      const std::vector<std::string>& names);
  /// Where a key of a fault's pressure is given: by the fault, or for all.
  std::string fault_pressure_key(std::size_t fault, const std::string& key) const;
  /// The value as it stands in the file, without quotes.
  std::string as_given(const std::string& pointer) const;

 private:
  bool is_sound(const KeyPlace& place) const { return problems_.empty() || sound(place.pointer()); }
  /// False where there is something to explain.
  bool read_quantity(const nlohmann::json& value, const SchemaViews& views);
  void explain_quantity(const std::string& pointer, const nlohmann::json& value,
                        const SchemaViews& views);

  const JsonDocument& document_;
  std::vector<Problem>& problems_;
  Ancestry unsound_;                                    ///< where the problems are.
  std::unordered_set<std::string> said_;                ///< pointer and text of each.
  std::unordered_set<const nlohmann::json*> too_long_;  ///< lists.
  std::unordered_map<const nlohmann::json*, double> quantities_;
  /// Neighbours are asked for one after the other: where the last ones stood.
  struct Parent {
    std::string pointer;
    const nlohmann::json* value;
  };
  mutable Parent last_{"", &document_.value}, before_ = last_;
};

/// "-3.8 bar": for messages, at most six digits.
std::string in_unit(double value, Dimension dimension, const std::string& unit);
/// The same of a length: "2080 m".
inline std::string metres(double value) { return in_unit(value, Dimension::length, "m"); }

/// Whether the body is a mesh, from a file or built of horizons.
inline bool is_of_mesh(const SceneReader& reader) {
  const std::string kind = reader.text("/geometry/kind");
  return kind == "mesh" || kind == "horizons";
}
inline bool is_of_horizons(const SceneReader& reader) {
  return reader.text("/geometry/kind") == "horizons";
}

/// False where what is wrong with the body has been said, and its regions are not known.
inline bool is_body_known(const SceneReader& reader, const Scene& scene) {
  return reader.sound("/geometry") && (!is_of_mesh(reader) || scene.box.mesh.has_value());
}
/// A body without pressure regions, and what it lacks.
inline std::string cure_of_no_region(const SceneReader& reader) {
  return is_of_horizons(reader) ? "add \"compartments\" to the geometry"
                                : "add \"regions\" to the geometry";
}

// Parts of read_scene, one file each.
void read_materials(SceneReader& reader, Scene& scene);
void read_geometry(SceneReader& reader, Scene& scene);
void read_mesh(SceneReader& reader, Scene& scene);
void read_faults(SceneReader& reader, Scene& scene);
void read_initial_state(SceneReader& reader, Scene& scene);
void read_loading(SceneReader& reader, Scene& scene);
void read_csv_histories(SceneReader& reader, Scene& scene);  ///< part of read_loading.
/// The files of /pressure_field and /temperature_field. @pre before faults and stages, whose dates
/// may count from them.
void read_flow_loads(SceneReader& reader, Scene& scene);
/// Initial pressures of blocks from the report that the pressure field counts from, where
/// /initial_state/pressure_from says so: each block's overpressure is the mean over its volume, as
/// far as flow cells cover it, of what the report has above hydrostatic (above the profile). Of a
/// column `overpressure`, which the horizontal stress goes with, is the mean over all blocks. @pre
/// geometry, faults, initial state and flow loads are read.
void take_first_report(SceneReader& reader, Scene& scene);
/// Part of read_loading: which of their reports are taken, once it is known when the stages end.
void choose_reports(SceneReader& reader, Scene& scene);
/// The date of time 0, s since 1970: /start_date, else that of the reference of the pressure field,
/// else of the temperature field. None = it
/// is not known, or was refused.
std::optional<double> start_date(SceneReader& reader, const Scene& scene);
void read_output(SceneReader& reader, Scene& scene);
/// Relations between parts: geometry of faults, observation points, pressures below zero, creep.
void check_geometry(SceneReader& reader, const Scene& scene);
void check_pressures(SceneReader& reader, const Scene& scene);
void check_creep(SceneReader& reader, const Scene& scene);
/// Sets Scene::opens_at_start. @pre the scene is sound.
void find_openings(Scene& scene);
/// Tables of fault pressure meet their fault.
void check_fault_tables(SceneReader& reader, const Scene& scene);
/// Reads /numerics/surface and holds its parameters against the rest. @pre the rest is read.
void read_surface(SceneReader& reader, Scene& scene);
/// Measures how symmetric fields are, where half of the domain may be modelled.
void check_flow_loads(Scene& scene);
/// No more load steps are added at turning points than /numerics/max_added_steps.
void check_turning_points(SceneReader& reader, const Scene& scene);

/// All of these, and then remarks if there are no problems.
void relate_parts(SceneReader& reader, const std::vector<Problem>& problems, Scene& scene);

/// Fills Scene::remarks. @pre the scene has no problems.
void add_remarks(const SceneReader& reader, Scene& scene);
/// Part of it: what is made up beyond the places and times of tables of fault pressure.
void remark_fault_tables(SceneReader& reader, Scene& scene);

}  // namespace faultsim
