#include "campaign/pillars/place_line.h"

#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"

namespace faultsweep {

namespace {

constexpr std::size_t kMostPlacesBytes = 500'000'000;
constexpr std::size_t kColumns = 11, kOlderColumns = 9;  // without dates and refused pillars

/// Fields of a line of CSV, RFC 4180.
std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

PlaceLine line_of(const std::vector<std::string>& fields) {
  const auto number = [&](std::size_t k) { return faultsim::parse_number(fields[k]); };
  PlaceLine line{.id = fields[0],
                 .fault = fields[1],
                 .section_fault = fields[2],
                 .x = number(3),
                 .y = number(4),
                 .azimuth = number(5),
                 .dip = number(6),
                 .top_depth = number(7),
                 .base_depth = number(8),
                 .start_date = "",
                 .refused = ""};
  if (fields.size() == kOlderColumns) return line;
  line.start_date = fields[9];
  line.refused = fields[10];
  return line;
}

}  // namespace

std::string PlaceLine::header() {
  return "id,fault,section_fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m,start_date,"
         "refused\n";
}

std::string PlaceLine::text() const {
  std::string line = csv_field(id) + "," + csv_field(fault) + "," + csv_field(section_fault);
  for (const auto& one : {x, y, azimuth, dip, top_depth, base_depth})
    line += "," + (one ? rounded_number(*one) : std::string());
  return concat(line, ",", start_date, ",", csv_field(refused), "\n");
}

std::vector<PlaceLine> read_places(const std::filesystem::path& file) {
  const std::string text = faultsim::read_input_or_throw(file.string(), kMostPlacesBytes);
  std::vector<PlaceLine> places;
  std::size_t n_columns = 0;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::vector<std::string> fields = fields_of(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const bool is_header = number == 1;
    if (is_header) n_columns = fields.size();
    const bool is_known = n_columns == kColumns || n_columns == kOlderColumns;
    if (!is_known || fields.size() != n_columns || is_header != (fields[0] == "id"))
      throw InputError(file.string(), {{"", number, "is not a line of places.csv",
                                        "use the file that `faultsweep pillars` wrote"}});
    if (!is_header) places.push_back(line_of(fields));
  }
  return places;
}

}  // namespace faultsweep
