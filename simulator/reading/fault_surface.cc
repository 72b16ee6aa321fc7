#include "simulator/reading/fault_surface.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using horizons::DrawnSurface;

constexpr const char* kStickCure = "name the columns stick, x [m], y [m], depth [m]";

/// Words of a line; tabs of a table that has travelled with its scene are semicolons.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBetween = " \t;";
  std::vector<std::string_view> words;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBetween), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::string_view without_quotes(std::string_view word) {
  if (word.size() >= 2 && word.front() == '"' && word.back() == '"')
    word = word.substr(1, word.size() - 2);
  return word;
}

/// Words that begin lines behind a header, never within one.
bool is_behind_headers(std::string_view word) {
  constexpr std::array<std::string_view, 10> kWords = {
      "GOCAD",      "GOCAD_ORIGINAL_COORDINATE_SYSTEM",
      "TFACE",      "VRTX",
      "PVRTX",      "ATOM",
      "PATOM",      "TRGL",
      "PROPERTIES", "END"};
  return contains(kWords, word);
}

/// One TSurf of a file.
struct GocadSurface {
  std::string name;
  int line = 0;                   ///< where it begins.
  std::map<int, Vector3d> nodes;  ///< by their numbers in the file, as they stand there.
  std::vector<std::pair<std::array<int, 3>, int>> triangles;  ///< and the line of each.
  std::array<double, 3> unit = {1, 1, 1};                     ///< m.
  bool is_depth = false;
};

class GocadReader {
 public:
  GocadReader(std::string_view text, const std::string& given) : given_(given) {
    for (int line = 1; !text.empty(); ++line) read_line(next_table_line(text), line);
    if (header_line_ > 0) refuse_open_header();
    if (all_.empty()) refuse(first_other_, "is not a TSurf", "write the fault as a GOCAD TSurf");
  }
  DrawnSurface surface_of(const std::string& fault);

 private:
  void read_line(std::string_view line, int number);
  void begin_object(const std::vector<std::string_view>& words, int line);
  void read_header(std::string_view line);
  void refuse_open_header();
  void read_units(const std::vector<std::string_view>& words, int line);
  void read_node(const std::vector<std::string_view>& words, int line);
  void read_copy(const std::vector<std::string_view>& words, int line);
  void read_triangle(const std::vector<std::string_view>& words, int line);
  std::optional<int> number_at(const std::vector<std::string_view>& words, std::size_t at,
                               int line);
  const GocadSurface& chosen(const std::string& fault);
  void read_sense(std::string_view sense, int line);
  void refuse(int line, const std::string& what, const std::string& cure);
  void require_sound() const {
    if (!problems_.empty()) throw InputError(given_, problems_);
  }

  std::string given_;
  std::vector<GocadSurface> all_;
  bool is_in_other_ = false;  ///< in an object that is no TSurf: a line, points, a well.
  int first_other_ = 0;       ///< the line of the first of them.
  int header_line_ = 0;       ///< of the header that is being read; 0: none is.
  std::vector<Problem> problems_;
};

void GocadReader::refuse(int line, const std::string& what, const std::string& cure) {
  constexpr std::size_t kMost = 20;
  if (problems_.size() < kMost) problems_.push_back({"", line, what, cure});
}

void GocadReader::read_line(std::string_view line, int number) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.empty() || words[0].front() == '#') return;
  if (header_line_ > 0 && is_behind_headers(words[0])) refuse_open_header();
  if (words[0] == "GOCAD") return begin_object(words, number);
  if (is_in_other_) return;
  if (words[0].starts_with("HEADER")) header_line_ = number;
  if (header_line_ > 0) return read_header(line);
  if (words[0] == "AXIS_UNIT") return read_units(words, number);
  if (words[0] == "ZPOSITIVE" && words.size() > 1) return read_sense(words[1], number);
  if (words[0] == "VRTX" || words[0] == "PVRTX") return read_node(words, number);
  if (words[0] == "ATOM" || words[0] == "PATOM") return read_copy(words, number);
  if (words[0] == "TRGL") return read_triangle(words, number);
}

/// Objects of other kinds have points too, which are none of a surface's.
void GocadReader::begin_object(const std::vector<std::string_view>& words, int line) {
  is_in_other_ = words.size() < 2 || words[1] != "TSurf";
  if (!is_in_other_) all_.emplace_back().line = line;
  if (is_in_other_ && first_other_ == 0) first_other_ = line;
}

void GocadReader::refuse_open_header() {
  refuse(header_line_, "the HEADER is not closed", "end it with }");
  header_line_ = 0;
}

void GocadReader::read_sense(std::string_view sense, int line) {
  const auto is = [&](std::string_view word) {
    return std::ranges::equal(sense, word, [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == b;
    });
  };
  all_.back().is_depth = is("depth");
  if (!is("depth") && !is("elevation"))
    refuse(line, "the sense " + table_quote(std::string(sense)) + " of ZPOSITIVE is not known",
           "write Depth or Elevation");
}

/// "HEADER { name:F1 }", on one line or on several.
void GocadReader::read_header(std::string_view line) {
  constexpr std::string_view kName = "name:";
  const std::size_t at = line.find(kName);
  const bool is_own = at != std::string_view::npos && (at == 0 || line[at - 1] != '_');
  if (is_own && all_.back().name.empty()) {
    std::string_view name = line.substr(at + kName.size());
    name = name.substr(0, name.find('}'));
    const std::size_t begin = name.find_first_not_of(" \t");
    if (begin != std::string_view::npos) {
      name = name.substr(begin, name.find_last_not_of(" \t") - begin + 1);
      all_.back().name = without_quotes(name);
    }
  }
  if (line.find('}') != std::string_view::npos) header_line_ = 0;
}

void GocadReader::read_units(const std::vector<std::string_view>& words, int line) {
  constexpr double kFoot = 0.3048;
  for (std::size_t axis = 0; axis < 3 && axis + 1 < words.size(); ++axis) {
    const std::string_view unit = without_quotes(words[axis + 1]);
    if (unit == "ft") all_.back().unit[axis] = kFoot;
    if (unit == "m" || unit == "ft") continue;
    refuse(line, "the unit " + table_quote(unit) + " is not known", "write m or ft");
  }
}

std::optional<int> GocadReader::number_at(const std::vector<std::string_view>& words,
                                          std::size_t at, int line) {
  int number = -1;
  if (at < words.size()) {
    const char* end = words[at].data() + words[at].size();
    if (std::from_chars(words[at].data(), end, number).ptr == end) return number;
  }
  refuse(line, concat(words[0], " has no whole number at position ", at),
         "write the numbers of its points");
  return std::nullopt;
}

void GocadReader::read_node(const std::vector<std::string_view>& words, int line) {
  const std::optional<int> number = number_at(words, 1, line);
  if (!number) return;
  Vector3d at;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::size_t place = static_cast<std::size_t>(axis) + 2;
    const std::optional<double> value =
        place < words.size() ? parse_number(words[place]) : std::nullopt;
    if (!value)
      return refuse(line, concat(words[0], " ", *number, " does not have three coordinates"),
                    "write its x, y and z");
    if (!(std::abs(*value) <= kLengthRange.high))
      return refuse(line,
                    concat(words[0], " ", *number, ": ", table_quote(words[place]), " is beyond ",
                           kLengthRange.text),
                    "write coordinates in m or ft, as AXIS_UNIT says");
    at[axis] = *value;
  }
  if (!all_.back().nodes.emplace(*number, at).second)
    refuse(line, concat("point ", *number, " is given twice"), "give each point its own number");
}

void GocadReader::read_copy(const std::vector<std::string_view>& words, int line) {
  const std::optional<int> number = number_at(words, 1, line);
  const std::optional<int> of = number ? number_at(words, 2, line) : std::nullopt;
  if (!of) return;
  const auto found = all_.back().nodes.find(*of);
  if (found == all_.back().nodes.end())
    return refuse(line, concat("there is no point ", *of),
                  "write points before the lines that use them");
  const Vector3d at = found->second;
  if (!all_.back().nodes.emplace(*number, at).second)
    refuse(line, concat("point ", *number, " is given twice"), "give each point its own number");
}

void GocadReader::read_triangle(const std::vector<std::string_view>& words, int line) {
  std::array<int, 3> corners = {0, 0, 0};
  for (std::size_t v = 0; v < 3; ++v) {
    const std::optional<int> number = number_at(words, v + 1, line);
    if (!number) return;
    corners[v] = *number;
  }
  all_.back().triangles.emplace_back(corners, line);
}

const GocadSurface& GocadReader::chosen(const std::string& fault) {
  if (all_.size() == 1) return all_[0];
  const auto found = std::ranges::find(all_, fault, &GocadSurface::name);
  if (std::ranges::count(all_, fault, &GocadSurface::name) > 1) {
    refuse(0, "has several surfaces named " + table_quote(fault),
           "join them into one TSurf, or give each fault its own");
    require_sound();
  }
  if (found != all_.end()) return *found;
  std::string names;
  for (const GocadSurface& one : all_) names += (names.empty() ? "" : ", ") + table_quote(one.name);
  refuse(0, concat("has ", all_.size(), " surfaces (", names, "), none of them named ", fault),
         "give one of them the fault's name, or the fault a file of its own");
  require_sound();
  return all_[0];
}

/// Points at one place are one, so that triangles of different patches are joined.
DrawnSurface GocadReader::surface_of(const std::string& fault) {
  require_sound();
  const GocadSurface& one = chosen(fault);
  DrawnSurface surface;
  std::map<int, int> numbers;
  std::map<std::tuple<double, double, double>, int> known;
  for (const auto& [number, given] : one.nodes) {
    Vector3d at = given.cwiseProduct(Vector3d(one.unit[0], one.unit[1], one.unit[2]));
    if (one.is_depth) at.z() = -at.z();
    const auto [place, is_new] =
        known.emplace(std::tuple(at.x(), at.y(), at.z()), static_cast<int>(surface.points.size()));
    if (is_new) surface.points.push_back(at);
    numbers[number] = place->second;
  }
  for (const auto& [corners, line] : one.triangles) {
    std::array<int, 3> triangle = {-1, -1, -1};
    for (std::size_t v = 0; v < 3; ++v) {
      const auto found = numbers.find(corners[v]);
      if (found == numbers.end())
        refuse(line, concat("there is no point ", corners[v]), "write its VRTX");
      else
        triangle[v] = found->second;
    }
    surface.triangles.push_back(triangle);
  }
  if (one.triangles.empty()) refuse(one.line, "the surface has no triangles", "write its TRGL");
  require_sound();
  return surface;
}

/// Where the columns of sticks stand: stick, x, y, and depth or z.
struct StickColumns {
  std::array<std::optional<std::size_t>, 4> at;
  bool is_depth = false;
};

StickColumns stick_columns(TableReader& table) {
  StickColumns found;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    const std::string name = table.columns()[k].name;
    constexpr std::array<std::string_view, 5> kNames = {"stick", "x", "y", "z", "depth"};
    const auto number = static_cast<std::size_t>(std::ranges::find(kNames, name) - kNames.begin());
    const std::size_t place = std::min<std::size_t>(number, 3);
    if (number == kNames.size()) {
      table.refuse("column " + table_quote(name) + " does not describe sticks", kStickCure);
    } else if (found.at[place]) {
      table.refuse("column " + table_quote(name) + " repeats another one", kStickCure);
    } else if (number == 0 || table.set_unit(k, Dimension::length, kLengthRange, kStickCure)) {
      found.at[place] = k;
      found.is_depth = found.is_depth || name == "depth";
    }
  }
  const bool are_all = std::ranges::all_of(found.at, [](const auto& at) { return at.has_value(); });
  if (!are_all && table.is_sound()) table.refuse("a column is missing", kStickCure);
  return found;
}

class StickReader {
 public:
  StickReader(const std::string& text, const std::string& given) : table_(text, given) {}

  DrawnSurface read() {
    if (!table_.has_header(kStickCure)) table_.require_sound();
    const StickColumns columns = stick_columns(table_);
    table_.require_sound();
    while (table_.next_row()) read_row(columns);
    table_.require_rows("write a line for each point of each stick");
    for (std::size_t s = 0; s < names_.size(); ++s)
      if (made_.sticks[s].size() < 2)
        table_.refuse_at(0, "the stick " + table_quote(names_[s]) + " has only one point",
                         "give each stick two or more");
    if (names_.size() < 2) table_.refuse_at(0, "has only one stick", "give two or more, in order");
    table_.require_sound();
    for (std::vector<int>& stick : made_.sticks)
      if (made_.points[stick.front()].z() < made_.points[stick.back()].z())
        std::ranges::reverse(stick);
    return std::move(made_);
  }

 private:
  void read_row(const StickColumns& columns);
  void begin(const std::string& name);
  void check_depth(double z);

  TableReader table_;
  DrawnSurface made_;
  std::vector<std::string> names_;
};

void StickReader::begin(const std::string& name) {
  if (contains(names_, name))
    table_.refuse("the rows of stick " + table_quote(name) + " are not together",
                  "write the rows of a stick one after the other");
  names_.push_back(name);
  made_.sticks.emplace_back();
}

/// Of the next point of the last stick.
void StickReader::check_depth(double z) {
  const std::vector<int>& stick = made_.sticks.back();
  if (stick.empty()) return;
  const double before = made_.points[stick.back()].z();
  const double way = stick.size() > 1 ? before - made_.points[stick[stick.size() - 2]].z() : 0;
  const bool goes_on = stick.size() > 1 ? (z - before) * way > 0 : z != before;
  if (goes_on) return;
  table_.refuse("the stick " + table_quote(names_.back()) +
                    (z == before ? " has two points at one depth" : " turns back in depth"),
                "let each stick go down, or up, all the way");
}

void StickReader::read_row(const StickColumns& columns) {
  const std::string name(table_.cell(*columns.at[0]));
  const auto x = table_.value(*columns.at[1]), y = table_.value(*columns.at[2]),
             z = table_.value(*columns.at[3]);
  if (names_.empty() || names_.back() != name) begin(name);
  if (!x || !y || !z) return;
  const double up = columns.is_depth ? -*z : *z;
  check_depth(up);
  made_.sticks.back().push_back(static_cast<int>(made_.points.size()));
  made_.points.emplace_back(*x, *y, up);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// Comments may stand before the first object.
bool is_gocad(std::string_view text) {
  while (!text.empty()) {
    const std::vector<std::string_view> words = words_of(next_table_line(text));
    if (!words.empty() && words[0].front() != '#') return words[0] == "GOCAD";
  }
  return false;
}

}  // namespace

DrawnSurface parse_fault_surface(const std::string& text, const std::string& given,
                                 const std::string& fault) {
  const std::string_view gocad = without_byte_order_mark(text);
  if (is_gocad(gocad)) return GocadReader(gocad, given).surface_of(fault);
  return StickReader(text, given).read();
}

}  // namespace faultsim
