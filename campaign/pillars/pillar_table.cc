#include "campaign/pillars/pillar_table.h"

#include <algorithm>
#include <array>
#include <set>

#include "campaign/common/names.h"
#include "simulator/common/dates.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"

namespace faultsweep {

using faultsim::table_quote;
using faultsim::TableColumn;
using faultsim::TableReader;

namespace {

constexpr std::size_t kMostBytes = 200'000'000;
constexpr const char* kPillarCure = "write a line of column names, then a line for each pillar";

struct RoleInfo {
  PillarRole role;
  const char* name;
  Dimension dimension;  ///< number: a text.
};
constexpr std::array<RoleInfo, 13> kRoles = {{
    {PillarRole::id, "id", Dimension::number},
    {PillarRole::fault, "fault", Dimension::number},
    {PillarRole::x, "x", Dimension::length},
    {PillarRole::y, "y", Dimension::length},
    {PillarRole::azimuth, "azimuth", Dimension::angle},
    {PillarRole::depth, "depth", Dimension::length},
    {PillarRole::offset, "offset", Dimension::length},
    {PillarRole::thickness, "thickness", Dimension::length},
    {PillarRole::thickness_foot, "thickness_foot", Dimension::length},
    {PillarRole::thickness_hanging, "thickness_hanging", Dimension::length},
    {PillarRole::dip, "dip", Dimension::angle},
    {PillarRole::dip_from_horizontal, "dip_from_horizontal", Dimension::angle},
    {PillarRole::until, "until", Dimension::number},
}};

/// Reads rows into pillars.
class Reader {
 public:
  Reader(const std::string& text, const std::string& source, const ColumnNames& names)
      : reader_(text, source), names_(names) {
    table_.source = source;
  }

  PillarTable read() {
    read_header();
    reader_.require_sound();
    while (reader_.next_row()) read_pillar();
    reader_.require_rows(kPillarCure);
    return std::move(table_);
  }

 private:
  struct Column {
    const RoleInfo* role = nullptr;
    int parameter = -1;  ///< in table_.parameters; both unset: ignored.
    double factor = 1;   ///< of a role's unit.
    bool is_number() const {
      return parameter >= 0 || (role != nullptr && role->dimension != Dimension::number);
    }
  };

  /// What we call a column of the file; "" = nobody asks for it. The unit given with our name wins.
  TableColumn ours(const TableColumn& given) const {
    if (names_.empty()) return given;
    for (const auto& [name, theirs] : names_) {
      const TableColumn wanted = faultsim::table_column(theirs);
      if (wanted.name != given.name) continue;
      TableColumn own = given;
      own.name = name;
      if (wanted.unit) own.unit = wanted.unit;
      return own;
    }
    return {};
  }

  void read_header() {
    if (!reader_.has_header(kPillarCure)) return;
    std::set<std::string> seen;
    columns_.resize(reader_.columns().size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const TableColumn given = reader_.columns()[i], own = ours(given);
      if (own.name.empty()) {
        table_.ignored.push_back(given.name);
      } else if (!seen.insert(own.name).second) {
        reader_.refuse(table_quote(given.name) + " has two columns", "remove one");
      } else {
        find_meaning(own, given.name, i);
      }
    }
    for (const auto& [name, theirs] : names_) {
      if (!seen.contains(name))
        reader_.refuse(concat("there is no column ",
                              table_quote(faultsim::table_column(theirs).name), " for ", name),
                       "correct its name");
    }
    require_columns();
  }

  void find_meaning(const TableColumn& own, const std::string& given, std::size_t i) {
    Column& column = columns_[i];
    const auto role = std::ranges::find(kRoles, own.name, &RoleInfo::name);
    if (role == kRoles.end()) {
      if (!own.words.empty())
        reader_.refuse(
            table_quote(own.text) + " ends with " + table_quote(own.words) + " after its unit",
            "remove what follows the unit");
      column.parameter = static_cast<int>(table_.parameters.size());
      table_.parameters.push_back({own.name, own.unit.value_or(""), {}, given});
      return;
    }
    column.role = &*role;
    table_.headings[role->role] = given;
    if (role->dimension == Dimension::number) return;
    table_.numbers[role->role];
    const bool angle = role->dimension == Dimension::angle;
    const std::string usual = angle ? "deg" : "m";
    reader_.rename(i, own);
    const bool has_unit =
        reader_.set_unit(i, role->dimension, angle ? faultsim::kAngleRange : faultsim::kLengthRange,
                         concat("write ", table_quote(given + " [" + usual + "]")));
    if (!has_unit || own.unit == usual) return;
    const double one = faultsim::parse_quantity("1 " + *own.unit, role->dimension).value;
    column.factor = angle ? one / faultsim::kDegree : one;
  }

  bool has(PillarRole role) const { return table_.numbers.contains(role); }

  void require_columns() {
    for (const PillarRole role : {PillarRole::x, PillarRole::y}) {
      if (!has(role))
        reader_.refuse(concat("there is no column \"", name_of(role), "\""),
                       concat("add \"", name_of(role), " [m]\""));
    }
    const bool one_side = has(PillarRole::thickness_foot) != has(PillarRole::thickness_hanging);
    if (one_side || (has(PillarRole::thickness) && has(PillarRole::thickness_foot)))
      reader_.refuse("the thickness is given for one side only, or twice",
                     "give \"thickness\", or \"thickness_foot\" and \"thickness_hanging\"");
    if (has(PillarRole::dip) && has(PillarRole::dip_from_horizontal))
      reader_.refuse("there are two dips", "give one of them");
  }

  /// A line, cell by cell.
  struct Line {
    std::string id, fault, until;
    std::vector<double> numbers;  ///< by column.
    PillarTable::Refused refused;
  };

  void read_pillar() {
    Line line;
    line.id = std::to_string(reader_.line());
    line.numbers.resize(columns_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) read_cell(k, line);
    if (!ids_.insert(line.id).second) {
      const auto heading = table_.headings.find(PillarRole::id);
      line.refused.problems.push_back(
          {heading == table_.headings.end() ? "" : heading->second, reader_.line(),
           concat("pillar ", table_quote(line.id), " is on an earlier line"),
           "give each pillar an id of its own"});
    }
    if (line.refused.problems.empty()) return keep_pillar(line);
    line.refused.id = line.id;
    line.refused.fault = line.fault;
    line.refused.line = reader_.line();
    table_.refused.push_back(std::move(line.refused));
  }

  void read_cell(std::size_t k, Line& line) {
    const Column& column = columns_[k];
    const std::string& heading = reader_.columns()[k].name;
    if (column.is_number()) {
      const faultsim::TableNumber number = reader_.check_number(k);
      line.numbers[k] = number.value * column.factor;
      if (!number.what.empty())
        line.refused.problems.push_back({heading, reader_.line(), number.what, number.cure});
      else if (column.role != nullptr)
        line.refused.numbers[column.role->role] = line.numbers[k];
      return;
    }
    if (column.role == nullptr) return;
    const std::string text(reader_.cell(k));
    if (column.role->role == PillarRole::id && !text.empty()) line.id = text;
    if (column.role->role == PillarRole::fault) line.fault = text;
    if (column.role->role != PillarRole::until) return;
    line.until = text;
    if (!faultsim::parse_date(text))
      line.refused.problems.push_back({heading, reader_.line(),
                                       concat(table_quote(text), " in column ", k + 1, " ",
                                              table_quote(heading), " is not a date"),
                                       "write it as year-month-day: 2005-07-31"});
  }

  void keep_pillar(const Line& line) {
    table_.lines.push_back(reader_.line());
    table_.ids.push_back(line.id);
    table_.faults.push_back(line.fault);
    if (table_.headings.contains(PillarRole::until)) table_.until.push_back(line.until);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Column& column = columns_[k];
      if (column.parameter >= 0)
        table_.parameters[static_cast<std::size_t>(column.parameter)].values.push_back(
            line.numbers[k]);
      else if (column.is_number())
        table_.numbers[column.role->role].push_back(line.numbers[k]);
    }
  }

  TableReader reader_;
  const ColumnNames& names_;
  PillarTable table_;
  std::vector<Column> columns_;
  std::set<std::string> ids_;
};

}  // namespace

std::optional<double> PillarTable::number(PillarRole role, std::size_t pillar) const {
  const auto column = numbers.find(role);
  if (column == numbers.end()) return std::nullopt;
  return column->second.at(pillar);
}

std::string PillarTable::heading(PillarRole role) const {
  const auto found = headings.find(role);
  return found == headings.end() ? "" : found->second;
}

PillarTable::Refused PillarTable::as_refused(std::size_t pillar) const {
  Refused line{ids[pillar], faults[pillar], lines[pillar], {}, std::vector<faultsim::Problem>(1)};
  for (const auto& [role, values] : numbers) line.numbers[role] = values[pillar];
  return line;
}

const char* name_of(PillarRole role) {
  return std::ranges::find(kRoles, role, &RoleInfo::role)->name;
}

PillarTable parse_pillar_table(const std::string& text, const std::string& source,
                               const ColumnNames& names) {
  return Reader(text, source, names).read();
}

PillarTable read_pillar_table(const std::filesystem::path& file, const ColumnNames& names) {
  return parse_pillar_table(faultsim::read_input_or_throw(file.string(), kMostBytes), file.string(),
                            names);
}

}  // namespace faultsweep
