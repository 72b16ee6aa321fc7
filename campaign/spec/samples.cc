#include <algorithm>
#include <cctype>
#include <set>

#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"
#include "simulator/common/dates.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"

namespace faultsweep {
namespace {

constexpr std::size_t kMostSampleBytes = 100'000'000;  // 10^5 lines of a thousand bytes

constexpr const char* kDateUnit = "date";

/// Reads the rows of a file into its columns.
class Reader {
 public:
  Reader(const std::string& text, const std::string& name, const std::string& names_column)
      : reader_(text, name), names_column_(names_column) {
    file_.fingerprint = faultsim::fingerprint(text);
  }

  SampleFile read() {
    read_headings();
    for (; reader_.next_row(); ++file_.n_rows) {
      for (std::size_t k = 0; k < columns_.size(); ++k) read_cell(k);
    }
    reader_.require_rows("write a line of parameters, then a line of numbers for each case");
    return std::move(file_);
  }

 private:
  void read_headings() {
    std::set<std::string> seen;
    bool has_names = names_column_.empty();
    for (const faultsim::TableColumn& one : reader_.columns()) {
      const bool is_names = !names_column_.empty() && one.name == names_column_;
      has_names |= is_names;
      columns_.push_back(is_names ? -1 : static_cast<int>(file_.columns.size()));
      if (!is_names) file_.columns.push_back({one.name, one.unit.value_or(""), {}, {}});
      if (one.name.empty() || !one.words.empty() ||
          one.name.find_first_of("[]") != std::string::npos) {
        reader_.refuse(faultsim::table_quote(one.text) + " is not a parameter",
                       "write its name and its unit: cohesion [MPa]");
      } else if (!seen.insert(one.name).second) {
        reader_.refuse(faultsim::table_quote(one.name) + " has two columns", "remove one");
      }
    }
    if (!has_names)
      reader_.refuse("there is no column " + faultsim::table_quote(names_column_),
                     "give each line a name of its own there");
  }

  void read_cell(std::size_t k) {
    if (columns_[k] < 0) return read_name(std::string(reader_.cell(k)));
    SampleFile::Column& column = file_.columns[static_cast<std::size_t>(columns_[k])];
    if (column.unit != kDateUnit) {
      column.values.push_back(reader_.number(k).value_or(0));
      return;
    }
    column.dates.emplace_back(reader_.cell(k));
    if (!faultsim::parse_date(column.dates.back()))
      reader_.refuse(faultsim::table_quote(column.dates.back()) + " is not a date",
                     "write 1990-01-31");
  }

  void read_name(std::string name) {
    if (name.empty()) {
      reader_.refuse("the name is empty", "give each line a name of its own");
    } else if (!names_.insert(name).second) {
      reader_.refuse(faultsim::table_quote(name) + " is used by an earlier line",
                     "give each line a name of its own");
    }
    file_.names.push_back(std::move(name));
  }

  faultsim::TableReader reader_;
  const std::string& names_column_;
  SampleFile file_;
  std::vector<int> columns_;  ///< of the table, in file_.columns; -1 = the names.
  std::set<std::string> names_;
};

}  // namespace

SampleFile parse_samples(const std::string& text, const std::string& name,
                         const std::string& names_column) {
  return Reader(text, name, names_column).read();
}

/// Of places, the column of their names.
std::string SpecReader::names_column(const std::string& design) const {
  if (at(design + "/kind") != to_string(DesignKind::places)) return "";
  return has(design + "/names") ? at(design + "/names").get<std::string>() : "place";
}

const SampleFile& SpecReader::sample_file(const std::string& design) {
  const std::string place = design + "/file";
  const auto name = at(place).get<std::string>();
  const std::string names = names_column(design);
  const auto [found, is_new] = sample_files_.try_emplace(concat(name, "\n", names));
  SampleFile& file = found->second;
  if (!is_new) return file;
  const auto in_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  if (!std::ranges::all_of(names, in_word))
    problem(design + "/names", concat("\"", names, "\" is not a name"),
            "use letters, digits and _, so that conditions can refer to it");
  const std::size_t slash = spec_.source.rfind('/');
  const bool relative = name[0] != '/' && slash != std::string::npos;
  const auto input = faultsim::read_input_file(
      relative ? spec_.source.substr(0, slash + 1) + name : name, kMostSampleBytes);
  if (!input.what.empty()) {
    problem(place, input.what, input.cure + "; its path is relative to the folder of the spec");
    return file;
  }
  try {
    file = parse_samples(input.text, name, names);
  } catch (const InputError& error) {
    for (const Problem& one : error.problems())
      problem(place, concat(name, one.line > 0 ? concat(", line ", one.line) : "", ": ", one.what),
              one.cure);
  }
  return file;
}

/// A parameter of the file's own, which changes nothing: a name for each row.
Parameter SpecReader::named_rows(const std::string& pointer, const SampleFile& file) const {
  Parameter one;
  one.name = names_column(pointer);
  one.pointer = pointer + "/file";
  one.is_text = true;
  one.has_own_values = true;
  one.choices = mapped(file.names, [&](const std::string& name) {
    return Choice{.text = name, .si = {}, .pointer = one.pointer, .changes = {}};
  });
  return one;
}

/// The values of a column: dates as words that are chosen from, numbers as drawn ones. None after a
/// refusal.
std::optional<Parameter> SpecReader::given_parameter(const SampleFile::Column& column,
                                                     const std::string& pointer,
                                                     const SceneNames& names) {
  const auto target = resolve(names, column.name, pointer);
  if (!target) return std::nullopt;
  Parameter one;
  one.name = column.name;
  one.pointer = pointer;
  one.targets = {*target};
  set_base_choice(names, one);
  if (column.unit == kDateUnit) {
    one.is_text = true;
    for (const std::string& date : std::set(column.dates.begin(), column.dates.end()))
      if (auto choice = make_choice(date, pointer, names, one)) one.choices.push_back(*choice);
    unify_kind(one);
    return one;
  }
  const auto [low, high] = std::ranges::minmax_element(column.values);
  for (const double end : {*low, *high}) {
    if (auto choice = make_choice(spelled(end, column.unit), one.pointer, names, one))
      one.choices.push_back(std::move(*choice));
  }
  if (one.choices.size() < 2) return std::nullopt;  // of another dimension: said
  if (!one.choices[0].si) {
    problem(one.pointer,
            concat("\"", column.name, "\" has words for values, and samples are numbers"),
            "vary it by another design, nested around this one");
    return std::nullopt;
  }
  one.range = SampledRange{{Distribution::uniform, *low, *high}, column.unit, true};
  for (const double value : column.values) {
    one.drawn.push_back({value, 0});
    one.drawn.back().si =
        column.unit.empty()
            ? value
            : faultsim::parse_quantity(one.text(one.n_values() - 1), one.dimension).value;
  }
  return one;
}

void SpecReader::read_samples(const std::string& pointer, const SceneNames& names, Design& design,
                              std::vector<Parameter>& parameters) {
  const SampleFile& file = sample_file(pointer);
  design.file = at(pointer + "/file").get<std::string>();
  design.fingerprint = file.fingerprint;
  design.names = names_column(pointer);
  if (file.n_rows == 0) return;
  const auto n_rows = static_cast<std::size_t>(file.n_rows);
  design.rows.resize(n_rows);
  if (!file.names.empty()) {
    parameters.push_back(named_rows(pointer, file));
    for (std::size_t row = 0; row < n_rows; ++row) design.rows[row] = {static_cast<int>(row)};
  }
  for (const SampleFile::Column& column : file.columns) {
    if (column.name == "weight" || column.name == "weights") {
      problem(
          pointer + "/file", "samples with weights are not supported",
          "draw lines in proportion to their weights, with replacement, and leave the column out");
      continue;
    }
    auto one = given_parameter(column, pointer + "/file", names);
    if (!one) continue;
    constexpr int kFirstDrawn = 2;  // behind the ends
    for (std::size_t row = 0; row < n_rows; ++row) {
      int value = kFirstDrawn + static_cast<int>(row);
      if (!column.dates.empty()) {
        const auto found =
            std::ranges::lower_bound(one->choices, column.dates[row], {}, &Choice::text);
        value = static_cast<int>(found - one->choices.begin());
      }
      design.rows[row].push_back(value);
    }
    parameters.push_back(std::move(*one));
  }
}

}  // namespace faultsweep
