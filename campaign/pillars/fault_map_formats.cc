#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include "campaign/common/names.h"
#include "campaign/pillars/fault_map.h"
#include "campaign/query/table_output.h"
#include "simulator/common/base64.h"
#include "simulator/common/printable.h"
#include "simulator/common/units.h"

namespace faultsweep {

namespace {

constexpr double kNoData = -99999;

/// Where the panel of a place ends below: it dips to the right of its strike.
std::array<double, 2> foot_of(const FaultMap::Place& place) {
  const double azimuth = place.azimuth * faultsim::kDegree;
  const double reach =
      (place.base_depth - place.top_depth) * std::tan(place.dip * faultsim::kDegree);
  return {place.x + reach * std::cos(azimuth), place.y - reach * std::sin(azimuth)};
}

/// Places of each fault that has a name, in their order; faults in order of appearance.
std::vector<std::vector<std::size_t>> traces(const FaultMap& map) {
  std::vector<std::vector<std::size_t>> all;
  std::map<std::string, std::size_t> number;
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    const std::string& fault = map.places[i].fault;
    if (fault.empty() || !map.places[i].has_panel()) continue;
    const auto [found, is_new] = number.try_emplace(fault, all.size());
    if (is_new) all.emplace_back();
    all[found->second].push_back(i);
  }
  return all;
}

/// Bytes of numbers as VTK's inline binary: their count in bytes (8 of them), then they, in base64.
template <typename Number>
std::string binary(const std::vector<Number>& numbers) {
  static_assert(std::endian::native == std::endian::little);
  const std::uint64_t count = numbers.size() * sizeof(Number);
  std::string bytes(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(numbers.data()), count);
  return faultsim::base64(bytes);
}

template <typename Number>
std::string data_array(const std::string& type, const std::string& name, int components,
                       const std::vector<Number>& numbers) {
  return concat("<DataArray type=\"", type, "\" Name=\"", name, "\" NumberOfComponents=\"",
                components, "\" format=\"binary\">", binary(numbers), "</DataArray>\n");
}

/// Places that have a panel; their points in the VTU file follow each other, top and foot.
std::vector<std::size_t> panels(const FaultMap& map) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < map.places.size(); ++i)
    if (map.places[i].has_panel()) all.push_back(i);
  return all;
}

/// Cells of the VTU file, by points: 2 i is the top of panel i, 2 i + 1 its foot.
struct Cells {
  std::vector<std::int64_t> points, ends;
  std::vector<std::uint8_t> types;
  void add(std::initializer_list<std::size_t> of, std::uint8_t type) {
    for (const std::size_t point : of) points.push_back(static_cast<std::int64_t>(point));
    ends.push_back(static_cast<std::int64_t>(points.size()));
    types.push_back(type);
  }
};

Cells cells_of(const FaultMap& map, const std::vector<std::size_t>& shown) {
  constexpr std::uint8_t kLine = 3, kQuad = 9;  // VTK's numbers
  Cells cells;
  std::vector<std::size_t> panel(map.places.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    panel[shown[i]] = i;
    cells.add({2 * i, 2 * i + 1}, kLine);
  }
  for (const std::vector<std::size_t>& trace : traces(map)) {
    for (std::size_t k = 0; k + 1 < trace.size(); ++k) {
      const std::size_t a = 2 * panel[trace[k]], b = 2 * panel[trace[k + 1]];
      cells.add({a, b, b + 1, a + 1}, kQuad);
    }
  }
  return cells;
}

/// "F 3" as GOCAD has it: names in quotes where they have blanks.
std::string gocad_name(const std::string& name) {
  return name.find(' ') == std::string::npos ? name : "\"" + name + "\"";
}

void add_surface(const FaultMap& map, const std::vector<std::size_t>& trace, std::string& text) {
  text +=
      concat("GOCAD TSurf 1\nHEADER {\nname:", faultsim::printable(map.places[trace.front()].fault),
             "\n}\n");
  text +=
      "GOCAD_ORIGINAL_COORDINATE_SYSTEM\nNAME Default\nAXIS_NAME \"X\" \"Y\" \"Z\"\n"
      "AXIS_UNIT \"m\" \"m\" \"m\"\nZPOSITIVE Depth\nEND_ORIGINAL_COORDINATE_SYSTEM\n";
  std::string names, missing, units;
  for (const FaultMap::Property& one : map.properties) {
    names += " " + one.name;
    missing += concat(" ", kNoData);
    units += " " + (one.unit == "1" ? std::string("unitless") : gocad_name(one.unit));
  }
  text += concat("PROPERTIES", names, "\nNO_DATA_VALUES", missing, "\nUNITS", units, "\nTFACE\n");
  int n_points = 0;
  for (const std::size_t i : trace) {
    const FaultMap::Place& place = map.places[i];
    std::string values;
    for (const FaultMap::Property& one : map.properties)
      values += " " + rounded_number(std::isnan(one.values[i]) ? kNoData : one.values[i]);
    const auto [x, y] = foot_of(place);
    text += concat("PVRTX ", ++n_points, " ", rounded_number(place.x), " ", rounded_number(place.y),
                   " ", rounded_number(place.top_depth), values, "\n");
    text += concat("PVRTX ", ++n_points, " ", rounded_number(x), " ", rounded_number(y), " ",
                   rounded_number(place.base_depth), values, "\n");
  }
  for (int a = 1; a + 3 <= n_points; a += 2)
    text += concat("TRGL ", a, " ", a + 2, " ", a + 3, "\nTRGL ", a, " ", a + 3, " ", a + 1, "\n");
  text += "END\n";
}

/// "m2/m" as "_m2_per_m".
std::string column_unit(const std::string& unit) {
  if (unit == "1") return "";
  std::string text = "_";
  for (const char c : unit) text += c == '/' ? "_per_" : std::string(1, c == ' ' ? '_' : c);
  return text;
}

}  // namespace

std::string fault_map_to_csv(const FaultMap& map) {
  std::string text = "id,fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m,outcome";
  for (const FaultMap::Property& one : map.properties) {
    text += "," + one.name + column_unit(one.unit);
  }
  const bool has_dates =
      std::ranges::any_of(map.first_dates, [](const std::string& one) { return !one.empty(); });
  text += has_dates ? ",first_sliding_date\n" : "\n";
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    const FaultMap::Place& place = map.places[i];
    text += csv_name(place.id) + "," + csv_name(place.fault);
    for (const double number :
         {place.x, place.y, place.azimuth, place.dip, place.top_depth, place.base_depth})
      text += "," + (std::isnan(number) ? "" : rounded_number(number));
    text += "," + map.outcomes[i];
    for (const FaultMap::Property& one : map.properties)
      text += "," + (std::isnan(one.values[i]) ? "" : rounded_number(one.values[i]));
    text += has_dates ? "," + map.first_dates[i] + "\n" : "\n";
  }
  return text;
}

std::string fault_map_to_vtu(const FaultMap& map) {
  const std::vector<std::size_t> shown = panels(map);
  std::vector<double> points;
  for (const std::size_t i : shown) {
    const FaultMap::Place& place = map.places[i];
    const auto [x, y] = foot_of(place);
    points.insert(points.end(), {place.x, place.y, -place.top_depth, x, y, -place.base_depth});
  }
  const Cells cells = cells_of(map, shown);
  std::string text = concat(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece "
      "NumberOfPoints=\"",
      2 * shown.size(), "\" NumberOfCells=\"", cells.types.size(), "\">\n<PointData>\n");
  for (const FaultMap::Property& one : map.properties) {
    std::vector<double> values;
    for (const std::size_t i : shown) values.insert(values.end(), 2, one.values[i]);
    const std::string unit = one.unit == "1" ? "" : " [" + one.unit + "]";
    text += data_array("Float64", one.name + unit, 1, values);
  }
  text += "</PointData>\n<Points>\n" + data_array("Float64", "Points", 3, points) +
          "</Points>\n<Cells>\n" + data_array("Int64", "connectivity", 1, cells.points) +
          data_array("Int64", "offsets", 1, cells.ends) +
          data_array("UInt8", "types", 1, cells.types) +
          "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return text;
}

std::string fault_map_to_tsurf(const FaultMap& map) {
  std::string text;
  for (const std::vector<std::size_t>& trace : traces(map)) {
    if (trace.size() > 1) add_surface(map, trace, text);
  }
  return text;
}

}  // namespace faultsweep
