#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "campaign/spec/spec_reader.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/input_file.h"

namespace faultsweep {
namespace {

using faultsim::concat;
using faultsim::counted;

constexpr std::size_t kMostSampleBytes = 100'000'000;  // 10^5 lines of a thousand bytes
constexpr std::size_t kMostTroubles = 50;

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> sample_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(without_blanks(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// "cohesion [MPa]" in its two parts; the name is empty where brackets do not match.
SampleFile::Column column_of(std::string_view cell) {
  if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') {
    cell = without_blanks(cell.substr(1, cell.size() - 2));
  }
  const std::size_t bracket = cell.find('[');
  if (bracket == std::string_view::npos) return {std::string(cell), "", {}};
  if (cell.back() != ']') return {};
  return {std::string(without_blanks(cell.substr(0, bracket))),
          std::string(without_blanks(cell.substr(bracket + 1, cell.size() - bracket - 2))),
          {}};
}

void read_header(std::string_view line, long number, SampleFile& file) {
  std::set<std::string> seen;
  for (const std::string_view cell : sample_cells(line)) {
    file.columns.push_back(column_of(cell));
    const std::string& name = file.columns.back().name;
    if (name.empty()) {
      file.troubles.push_back({number, concat("\"", cell, "\" is not a parameter"),
                               "write its name and its unit: cohesion [MPa]"});
    } else if (!seen.insert(name).second) {
      file.troubles.push_back({number, concat("\"", name, "\" has two columns"), "remove one"});
    }
  }
}

void read_line(std::string_view line, long number, SampleFile& file) {
  const std::vector<std::string_view> cells = sample_cells(line);
  if (cells.size() != file.columns.size()) {
    file.troubles.push_back({number,
                             concat(counted(cells.size(), "value", "values"), ", and ",
                                    counted(file.columns.size(), "parameter", "parameters")),
                             "give a value of each"});
    return;
  }
  for (std::size_t k = 0; k < cells.size(); ++k) {
    double value = 0;
    const char* end = cells[k].data() + cells[k].size();
    const auto [rest, error] = std::from_chars(cells[k].data(), end, value);
    if (error != std::errc() || rest != end || !std::isfinite(value)) {
      file.troubles.push_back(
          {number,
           concat("\"", cells[k], "\" is not a number for ",
                  file.columns[k].name.empty() ? concat("column ", k + 1) : file.columns[k].name),
           "write a number; its unit stands in the first line"});
      value = 0;
    }
    file.columns[k].values.push_back(value);
  }
  ++file.n_rows;
}

}  // namespace

SampleFile parse_samples(const std::string& text) {
  SampleFile file;
  file.fingerprint = faultsim::fingerprint(text);
  std::string_view rest = text;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);
  for (long number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = without_blanks(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    if (file.columns.empty()) {
      read_header(line, number, file);
    } else {
      read_line(line, number, file);
    }
  }
  if (file.n_rows == 0 && file.troubles.empty()) {
    file.troubles.push_back({0, "there is no sample in it",
                             "give a line of parameters, and one of numbers for each case"});
  }
  return file;
}

const SampleFile& SpecReader::sample_file(const std::string& design) {
  const std::string place = design + "/file";
  const auto name = at(place).get<std::string>();
  const auto [found, is_new] = sample_files_.try_emplace(name);
  SampleFile& file = found->second;
  if (!is_new) return file;
  const std::size_t slash = spec_.source.rfind('/');
  const bool relative = name[0] != '/' && slash != std::string::npos;
  const auto input = faultsim::read_input_file(
      relative ? spec_.source.substr(0, slash + 1) + name : name, kMostSampleBytes);
  if (!input.what.empty()) {
    problem(place, input.what, input.cure + "; it is taken from the folder of the spec");
    return file;
  }
  file = parse_samples(input.text);
  for (std::size_t k = 0; k < std::min(file.troubles.size(), kMostTroubles); ++k) {
    const SampleFile::Trouble& one = file.troubles[k];
    problem(place, concat(name, one.line > 0 ? concat(", line ", one.line) : "", ": ", one.what),
            one.cure);
  }
  if (file.troubles.size() > kMostTroubles) {
    problem(place, concat(name, ": ", file.troubles.size() - kMostTroubles, " more are wrong"),
            "correct these first");
  }
  return file;
}

void SpecReader::read_samples(const std::string& pointer, const SceneNames& names, Design& design,
                              std::vector<Parameter>& parameters) {
  const SampleFile& file = sample_file(pointer);
  design.file = at(pointer + "/file").get<std::string>();
  design.fingerprint = file.fingerprint;
  if (!file.troubles.empty() || file.n_rows == 0) return;
  for (const SampleFile::Column& column : file.columns) {
    if (column.name == "weight" || column.name == "weights") {
      problem(pointer + "/file", "samples with weights are not taken",
              "draw from the lines in proportion to their weights, with replacement, and leave the "
              "column out");
      continue;
    }
    const auto target = resolve(names, column.name, pointer + "/file");
    if (!target) continue;
    Parameter one;
    one.name = column.name;
    one.pointer = pointer + "/file";
    one.targets = {*target};
    set_base_choice(names, one);
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    for (const double end : {*low, *high}) {
      const json value =
          column.unit.empty() ? json(end) : json(shortest_text(end) + " " + column.unit);
      if (auto choice = make_choice(value, one.pointer, names, one))
        one.choices.push_back(std::move(*choice));
    }
    if (one.choices.size() < 2) continue;  // of another dimension: said
    if (!one.choices[0].si) {
      problem(one.pointer, concat("\"", column.name, "\" takes words, and samples are numbers"),
              "vary it by another design, nested around this one");
      continue;
    }
    one.range = SampledRange{{Distribution::uniform, *low, *high}, column.unit, true};
    for (const double value : column.values) {
      one.drawn.push_back({value, 0});
      one.drawn.back().si =
          column.unit.empty()
              ? value
              : faultsim::parse_quantity(one.text(one.n_values() - 1), one.dimension).value;
    }
    parameters.push_back(std::move(one));
  }
  constexpr int kFirstDrawn = 2;  // behind the ends
  for (long row = 0; row < file.n_rows; ++row)
    design.rows.emplace_back(parameters.size(), kFirstDrawn + static_cast<int>(row));
}

}  // namespace faultsweep
