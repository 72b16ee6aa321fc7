#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "campaign/pillars/pillar_table.h"
#include "campaign/spec/sample_file.h"
#include "simulator/flow/flow_csv.h"
#include "simulator/reading/fault_pressure_csv.h"
#include "simulator/reading/pressure_csv.h"
#include "tests/fuzz/mutator.h"

/// Random tables for every reader of tables with units, in any style that programs write. A sound
/// one is read as the numbers it was made of; one with a cell or heading that must not be taken is
/// refused at its line; one with changed bytes is read or refused. Each kind tries tables 0, 1, 2,
/// ... up to FAULTSIM_FUZZ_TABLES (default 200).
namespace faultsim {
namespace {

using Numbers = std::vector<double>;

class Random {
 public:
  explicit Random(unsigned long seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return engine_() % n; }
  bool one_in(std::size_t n) { return below(n) == 0; }
  template <typename T>
  const T& pick(const std::vector<T>& list) {
    return list[below(list.size())];
  }

 private:
  std::mt19937_64 engine_;
};

struct Unit {
  const char* name;
  double size;  ///< SI
};
const std::vector<Unit> kPressures = {
    {"bar", 1e5}, {"MPa", 1e6}, {"Pa", 1}, {"psi", 6894.757293168361}};
const std::vector<Unit> kLengths = {{"m", 1}, {"km", 1000}, {"ft", 0.3048}};
const std::vector<Unit> kYears = {{"year", 365.25 * 86400}, {"d", 86400}};

/// A table as cells, and the numbers that its reader must find, in SI.
struct Table {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
  std::size_t first_number = 0;  ///< column.
  Numbers expected;
};

/// Hundredths as people and programs write them.
std::string written(long hundredths, Random& random) {
  char text[40];
  const double value = static_cast<double>(hundredths) / 100;
  const char* format = random.one_in(4) ? "%.8e" : random.one_in(3) ? "%.3f" : "%.10g";
  std::snprintf(text, sizeof text, format, value);
  return hundredths > 0 && random.one_in(10) ? "+" + std::string(text) : text;
}

/// A kind of table: how one is made, and how it is read into numbers.
struct Kind {
  const char* name;
  std::function<Table(Random&)> make;
  std::function<Numbers(const std::string& text)> read;
};

std::string heading(const std::string& name, const Unit& unit) {
  return name + " [" + unit.name + "]";
}

Table pressure_table(Random& random) {
  Table table;
  const std::size_t n_columns = 1 + random.below(4), n_rows = 1 + random.below(8);
  const Unit& time = random.pick(kYears);
  table.headings = {heading("time", time)};
  std::vector<Unit> units;
  for (std::size_t k = 0; k < n_columns; ++k) {
    units.push_back(random.pick(kPressures));
    const std::string name = random.pick<std::string>({"a,b", "c;d", "say \"e\"", "west",
                                                       "S\xC3\xBC"
                                                       "d"});
    table.headings.push_back(heading(name + std::to_string(k), units.back()));
  }
  for (std::size_t i = 0; i < n_rows; ++i) {
    const long when = 100 * static_cast<long>(i);
    table.rows.push_back({written(when, random)});
    table.expected.push_back(static_cast<double>(when) / 100 * time.size);
    for (const Unit& unit : units) {
      const long value = i == 0 ? 0 : static_cast<long>(random.below(40000)) - 20000;
      table.rows.back().push_back(written(value, random));
      table.expected.push_back(static_cast<double>(value) / 100 * unit.size);
    }
  }
  return table;
}
Numbers read_pressures(const std::string& text) {
  const PressureCsv csv = parse_pressure_csv(text, "t.csv", std::nullopt);
  Numbers numbers;
  for (std::size_t i = 0; i < csv.time.size(); ++i) {
    numbers.push_back(csv.time[i]);
    for (const PressureColumn& column : csv.columns) numbers.push_back(column.pressure.at(i));
  }
  return numbers;
}

Table fault_table(Random& random) {
  Table table;
  const Unit &length = random.pick(kLengths), &pressure = random.pick(kPressures);
  const std::size_t n_times = 2 + random.below(4);
  table.headings = {heading("depth", length)};
  for (std::size_t k = 0; k < n_times; ++k)
    table.headings.push_back(heading(std::to_string(k) + " year", pressure));
  for (std::size_t i = 0, n_rows = 1 + random.below(6); i < n_rows; ++i) {
    const long depth = 100 + 50 * static_cast<long>(i);
    table.rows.push_back({written(depth, random)});
    table.expected.push_back(static_cast<double>(depth) / 100 * length.size);
    long first = 0;
    for (std::size_t k = 0; k < n_times; ++k) {
      const long value = static_cast<long>(random.below(40000));
      if (k == 0) first = value;
      table.rows.back().push_back(written(value, random));
      table.expected.push_back(static_cast<double>(value - first) / 100 * pressure.size);
    }
  }
  return table;
}
Numbers read_fault(const std::string& text) {
  const FaultPressureTable table = parse_fault_pressure_csv(text, "t.csv", std::nullopt).table;
  Numbers numbers;
  for (std::size_t i = 0; i < table.dip.size(); ++i) {
    numbers.push_back(table.dip[i]);
    for (std::size_t k = 0; k < table.time.size(); ++k)
      numbers.push_back(table.change.at(i * table.time.size() + k));
  }
  return numbers;
}

/// Cells of a grid of up to 3 x 3 x 3: with sizes, or as points.
Table flow_table(Random& random) {
  Table table;
  const Unit &length = random.pick(kLengths), &pressure = random.pick(kPressures);
  const bool has_sizes = random.one_in(2), is_long = random.one_in(2);
  const std::size_t n_dates = 1 + random.below(3), n = 2 + random.below(2);
  if (is_long) table.headings = {"date"};
  table.first_number = is_long ? 1 : 0;
  std::vector<std::string> names = {"x", "y", "depth"};
  if (has_sizes) names.insert(names.end(), {"dx", "dy", "dz"});
  for (const std::string& name : names) table.headings.push_back(heading(name, length));
  const auto date = [](std::size_t t) { return std::to_string(1990 + t) + "-01-01"; };
  for (std::size_t t = 0; t < n_dates && !is_long; ++t)
    table.headings.push_back(heading(date(t), pressure));
  if (is_long) table.headings.push_back(heading("pressure", pressure));
  for (std::size_t t = 0; t < (is_long ? n_dates : 1); ++t) {
    for (std::size_t cell = 0; cell < n * n * n; ++cell) {
      std::vector<std::string> row;
      if (is_long) row.push_back(date(t));
      Numbers box;
      for (const std::size_t i : {cell % n, cell / n % n, cell / n / n}) {
        const long at = 10000 * static_cast<long>(i);
        row.push_back(written(at, random));
        box.push_back(static_cast<double>(at - 5000) / 100 * length.size);
      }
      for (std::size_t k = 0; k < 3 && has_sizes; ++k) row.push_back(written(10000, random));
      if (t == 0) table.expected.insert(table.expected.end(), box.begin(), box.end());
      for (std::size_t k = 0; k < (is_long ? 1 : n_dates); ++k)
        row.push_back(written(static_cast<long>(random.below(40000)), random));
      table.rows.push_back(row);
    }
  }
  for (const auto& row : table.rows) {
    for (std::size_t k = table.first_number + names.size(); k < row.size(); ++k)
      table.expected.push_back(std::atof(row[k].c_str()) * pressure.size);
  }
  return table;
}
Numbers read_flow(const std::string& text) {
  const FlowField field = parse_flow_csv(text, "t.csv");
  Numbers numbers;
  for (const FlowCell& cell : field.cells)
    numbers.insert(numbers.end(), {cell.low.x(), cell.low.y(), -cell.high.z()});
  // The wide form has a row per cell, the long form one per date and cell.
  const bool is_long = text.find("pressure") != std::string::npos;
  const Eigen::MatrixXd rows = is_long ? field.value : field.value.transpose();
  numbers.insert(numbers.end(), rows.data(), rows.data() + rows.size());
  return numbers;
}

Table sample_table(Random& random) {
  Table table;
  const std::size_t n_columns = 2 + random.below(4);  // an empty cell alone is an empty line
  for (std::size_t k = 0; k < n_columns; ++k)
    table.headings.push_back("p" + std::to_string(k) + (random.one_in(2) ? " [bar]" : ""));
  for (std::size_t i = 0, n_rows = 1 + random.below(6); i < n_rows; ++i) {
    table.rows.emplace_back();
    for (std::size_t k = 0; k < n_columns; ++k) {
      const long value = static_cast<long>(random.below(40000)) - 20000;
      table.rows.back().push_back(written(value, random));
      table.expected.push_back(static_cast<double>(value) / 100);
    }
  }
  return table;
}
Numbers read_samples(const std::string& text) {
  const faultsweep::SampleFile file = faultsweep::parse_samples(text, "t.csv");
  Numbers numbers;
  for (std::size_t i = 0; i < static_cast<std::size_t>(file.n_rows); ++i) {
    for (const auto& column : file.columns) numbers.push_back(column.values.at(i));
  }
  return numbers;
}

Table pillar_table(Random& random) {
  Table table;
  const Unit &x = random.pick(kLengths), &y = random.pick(kLengths);
  table.headings = {"id", heading("x", x), heading("y", y), "dip [deg]", "biot"};
  table.first_number = 1;
  for (std::size_t i = 0, n_rows = 1 + random.below(6); i < n_rows; ++i) {
    table.rows.push_back({random.pick<std::string>({"P", "a,b;", "\"q\""}) + std::to_string(i)});
    for (const double size : {x.size, y.size, 1.0, 1.0}) {
      const long value = static_cast<long>(random.below(4000));
      table.rows.back().push_back(written(value, random));
      table.expected.push_back(static_cast<double>(value) / 100 * size);
    }
  }
  return table;
}
/// Pillars that are refused alone count as the table's problems.
Numbers read_pillars(const std::string& text) {
  const faultsweep::PillarTable table = faultsweep::parse_pillar_table(text, "t.csv", {});
  std::vector<Problem> problems;
  for (const auto& one : table.refused)
    problems.insert(problems.end(), one.problems.begin(), one.problems.end());
  if (!problems.empty()) throw InputError("t.csv", problems);
  Numbers numbers;
  using faultsweep::PillarRole;
  for (std::size_t i = 0; i < table.n_pillars(); ++i) {
    for (const PillarRole role : {PillarRole::x, PillarRole::y, PillarRole::dip})
      numbers.push_back(table.number(role, i).value_or(0));
    for (const auto& one : table.parameters) numbers.push_back(one.values.at(i));
  }
  return numbers;
}

/// A table as text in some style, and where its rows stand.
struct Written {
  std::string text;
  int header_line = 0;
  std::vector<int> lines;
};
Written text_of(const Table& table, Random& random) {
  Written written;
  const std::string separator = random.pick<std::string>({",", ", ", ";", " ; ", "\t"});
  const std::string end = random.pick<std::string>({"\n", "\r\n", "\r"});
  int line = 0;
  const auto add = [&](const std::vector<std::string>& cells) {
    while (random.one_in(6)) {
      written.text += random.pick<std::string>({"", "  ", "# \"a\", b; c", "#\xFF"}) + end;
      ++line;
    }
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k > 0) written.text += separator;
      const bool plain = cells[k].find_first_of(",;\"") == std::string::npos;
      if (plain && !random.one_in(8)) {
        written.text += cells[k];
        continue;
      }
      written.text += '"';
      for (const char c : cells[k]) written.text += c == '"' ? "\"\"" : std::string(1, c);
      written.text += '"';
    }
    written.text += end;
    return ++line;
  };
  if (random.one_in(4)) written.text = "\xEF\xBB\xBF";
  written.header_line = add(table.headings);
  for (const auto& row : table.rows) written.lines.push_back(add(row));
  return written;
}

/// What is said of a text; empty: it was read.
std::vector<Problem> problems_of(const Kind& kind, const std::string& text) {
  try {
    for (const double number : kind.read(text))
      EXPECT_TRUE(std::isfinite(number)) << kind.name << ":\n" << text;
  } catch (const InputError& error) {
    for (const Problem& one : error.problems())
      EXPECT_TRUE(!one.what.empty() && !one.cure.empty() && one.what.size() < 1000) << text;
    return error.problems();
  }
  return {};
}

void expect_read(const Kind& kind, const Table& table, const std::string& text) {
  Numbers numbers;
  try {
    numbers = kind.read(text);
  } catch (const InputError& error) {
    FAIL() << kind.name << ": " << error.what() << "\n" << text;
  }
  ASSERT_EQ(numbers.size(), table.expected.size()) << kind.name << ":\n" << text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double wanted = table.expected[i];
    ASSERT_NEAR(numbers[i], wanted, 1e-12 * std::abs(wanted) + 1e-9) << kind.name << ":\n" << text;
  }
}

void expect_refused_at(const Kind& kind, const std::string& text, int line) {
  bool is_said = false;
  for (const Problem& one : problems_of(kind, text)) is_said = is_said || one.line == line;
  EXPECT_TRUE(is_said) << kind.name << " is not refused at line " << line << ":\n" << text;
}

/// Puts something into a cell or a heading that nothing may be read from.
int poison(Table& table, bool has_ranges, Random& random) {
  const bool in_header = random.one_in(8);
  if (in_header) {
    std::string& one = table.headings.back();
    one += one.back() == ']' ? random.pick<std::string>({" gauge", " x", "x", " 1"}) : " [bar] x";
    return -1;
  }
  std::vector<std::string> nothings = {"0x10",
                                       "0X1P2",
                                       "nan",
                                       "-nan",
                                       "inf",
                                       "-inf",
                                       "1e999",
                                       "-1e999",
                                       "1,5",
                                       "1.5.1",
                                       "1 2",
                                       "",
                                       "1 bar",
                                       "bar",
                                       "--1",
                                       "1e",
                                       std::string("1\0"
                                                   "2",
                                                   3),
                                       "\x1b[1m",
                                       "\xFF",
                                       "1\xE2\x80\xAE"};
  if (has_ranges) nothings.insert(nothings.end(), {"1e300", "-1e300", "1e308"});
  const std::size_t row = random.below(table.rows.size());
  const std::size_t n_numbers = table.headings.size() - table.first_number;
  table.rows[row][table.first_number + random.below(n_numbers)] = random.pick(nothings);
  return static_cast<int>(row);
}

class TableFuzz : public testing::TestWithParam<Kind> {};

TEST_P(TableFuzz, ReadsWhatIsSoundAndRefusesWhatIsNot) {
  const char* wanted = std::getenv("FAULTSIM_FUZZ_TABLES");
  const long n_tables = wanted == nullptr ? 200 : std::atol(wanted);
  const Kind& kind = GetParam();
  const bool has_ranges = std::string(kind.name) != "samples";
  for (long seed = 0; seed < n_tables && !HasFailure(); ++seed) {
    Random random(static_cast<unsigned long>(seed));
    Table table = kind.make(random);
    const std::string sound = text_of(table, random).text;
    expect_read(kind, table, sound);
    const std::vector<std::string> corpus = {sound};
    problems_of(kind, Mutator(corpus, static_cast<unsigned long>(seed)).bytes());
    const int row = poison(table, has_ranges && table.headings.back() != "biot", random);
    const Written bad = text_of(table, random);
    expect_refused_at(kind, bad.text,
                      row < 0 ? bad.header_line : bad.lines[static_cast<std::size_t>(row)]);
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, TableFuzz,
                         testing::Values(Kind{"pressure", pressure_table, read_pressures},
                                         Kind{"fault", fault_table, read_fault},
                                         Kind{"flow", flow_table, read_flow},
                                         Kind{"samples", sample_table, read_samples},
                                         Kind{"pillars", pillar_table, read_pillars}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace faultsim
