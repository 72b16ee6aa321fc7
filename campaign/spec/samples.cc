#include <algorithm>
#include <set>

#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"

namespace faultsweep {
namespace {

constexpr std::size_t kMostSampleBytes = 100'000'000;  // 10^5 lines of a thousand bytes

void read_headings(faultsim::TableReader& reader, SampleFile& file) {
  std::set<std::string> seen;
  for (const faultsim::TableColumn& one : reader.columns()) {
    file.columns.push_back({one.name, one.unit.value_or(""), {}});
    if (one.name.empty() || !one.words.empty() ||
        one.name.find_first_of("[]") != std::string::npos) {
      reader.refuse(faultsim::table_quote(one.text) + " is not a parameter",
                    "write its name and its unit: cohesion [MPa]");
    } else if (!seen.insert(one.name).second) {
      reader.refuse(faultsim::table_quote(one.name) + " has two columns", "remove one");
    }
  }
}

}  // namespace

SampleFile parse_samples(const std::string& text, const std::string& name) {
  SampleFile file;
  file.fingerprint = faultsim::fingerprint(text);
  faultsim::TableReader reader(text, name);
  read_headings(reader, file);
  for (; reader.next_row(); ++file.n_rows) {
    for (std::size_t k = 0; k < file.columns.size(); ++k)
      file.columns[k].values.push_back(reader.number(k).value_or(0));
  }
  reader.require_rows("give a line of parameters, and one of numbers for each case");
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
  try {
    file = parse_samples(input.text, name);
  } catch (const InputError& error) {
    for (const Problem& one : error.problems())
      problem(place, concat(name, one.line > 0 ? concat(", line ", one.line) : "", ": ", one.what),
              one.cure);
  }
  return file;
}

void SpecReader::read_samples(const std::string& pointer, const SceneNames& names, Design& design,
                              std::vector<Parameter>& parameters) {
  const SampleFile& file = sample_file(pointer);
  design.file = at(pointer + "/file").get<std::string>();
  design.fingerprint = file.fingerprint;
  if (file.n_rows == 0) return;
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
    const auto [low, high] = std::ranges::minmax_element(column.values);
    for (const double end : {*low, *high}) {
      if (auto choice = make_choice(spelled(end, column.unit), one.pointer, names, one))
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
