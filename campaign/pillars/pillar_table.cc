#include "campaign/pillars/pillar_table.h"

#include <algorithm>
#include <array>
#include <set>

#include "campaign/common/names.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"

namespace faultsweep {

using faultsim::table_quote;
using faultsim::TableColumn;
using faultsim::TableReader;

namespace {

constexpr std::size_t kMostBytes = 200'000'000;
constexpr const char* kPillarCure = "give a line of columns, and a line for each pillar";

struct RoleInfo {
  PillarRole role;
  const char* name;
  Dimension dimension;  ///< number: a text.
};
constexpr std::array<RoleInfo, 12> kRoles = {{
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
            table_quote(own.text) + " ends with " + table_quote(own.words) + " behind its unit",
            "end it with its unit");
      column.parameter = static_cast<int>(table_.parameters.size());
      table_.parameters.push_back({own.name, own.unit.value_or(""), {}});
      return;
    }
    column.role = &*role;
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
      reader_.refuse("the thickness is not that of both sides",
                     "give \"thickness\", or \"thickness_foot\" and \"thickness_hanging\"");
    if (has(PillarRole::dip) && has(PillarRole::dip_from_horizontal))
      reader_.refuse("there are two dips", "give one of them");
  }

  void read_pillar() {
    std::string id = std::to_string(reader_.line()), fault;
    std::vector<double> numbers(columns_.size());
    std::optional<Problem> why;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Column& column = columns_[k];
      if (column.is_number()) {
        const faultsim::TableNumber number = reader_.check_number(k);
        numbers[k] = number.value * column.factor;
        if (!number.what.empty() && !why)
          why = Problem{reader_.columns()[k].name, reader_.line(), number.what, number.cure};
      } else if (column.role != nullptr) {
        (column.role->role == PillarRole::id ? id : fault) = reader_.cell(k);
      }
    }
    if (!ids_.insert(id).second)
      reader_.refuse(concat("pillar ", table_quote(id), " was there before"),
                     "give each pillar an id of its own");
    if (why) {
      table_.refused.push_back({id, std::move(*why)});
    } else {
      keep_pillar(id, fault, numbers);
    }
  }

  void keep_pillar(const std::string& id, const std::string& fault,
                   const std::vector<double>& numbers) {
    table_.lines.push_back(reader_.line());
    table_.ids.push_back(id);
    table_.faults.push_back(fault);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Column& column = columns_[k];
      if (column.parameter >= 0)
        table_.parameters[static_cast<std::size_t>(column.parameter)].values.push_back(numbers[k]);
      else if (column.is_number())
        table_.numbers[column.role->role].push_back(numbers[k]);
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
