#include "campaign/pillars/pillar_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "simulator/common/input_file.h"
#include "simulator/common/units.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::counted;
using faultsim::Dimension;
using faultsim::InputError;
using faultsim::Problem;

namespace {

constexpr std::size_t kMostBytes = 200'000'000;
constexpr std::size_t kMostProblems = 20;

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

std::string_view without_blanks(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view cell = without_blanks(line.substr(0, comma));
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"')
      cell = cell.substr(1, cell.size() - 2);
    cells.emplace_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// "offset [m]" as name and unit.
struct Header {
  std::string name, unit;
};
Header header_of(const std::string& cell) {
  const std::size_t open = cell.find('[');
  if (open == std::string::npos || cell.back() != ']') return {cell, ""};
  return {std::string(without_blanks(std::string_view(cell).substr(0, open))),
          cell.substr(open + 1, cell.size() - open - 2)};
}

class Reader {
 public:
  Reader(std::string source, const ColumnNames& names) : names_(names) {
    table_.source = std::move(source);
  }

  PillarTable read(std::string_view text) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    for (long number = 1; !text.empty(); ++number) {
      const std::size_t end = text.find('\n');
      const std::string_view line = without_blanks(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (line.empty() || line.front() == '#') continue;
      if (columns_.empty()) {
        read_header(cells_of(line), number);
        if (!problems_.empty()) break;
      } else {
        read_line(cells_of(line), number);
      }
    }
    if (columns_.empty() || (table_.lines.empty() && problems_.empty()))
      problem(0, "there is no pillar in it", "give a line of columns, and a line for each pillar");
    if (!problems_.empty()) {
      if (n_problems_ > problems_.size())
        problems_.push_back({"", 0, concat(n_problems_ - problems_.size(), " more are wrong"),
                             "correct these first"});
      throw InputError(table_.source, std::move(problems_));
    }
    return std::move(table_);
  }

 private:
  struct Column {
    const RoleInfo* role = nullptr;
    int parameter = -1;  ///< in table_.parameters; both unset: ignored.
    double factor = 1;   ///< of a role's unit.
    std::string name;    ///< in the file.
  };

  void problem(long line, std::string what, std::string cure) {
    if (++n_problems_ > kMostProblems) return;
    problems_.push_back({"", static_cast<int>(line), std::move(what), std::move(cure)});
  }

  /// What we call a column of the file; "" = nobody asks for it. The unit given with our name wins.
  Header ours(const Header& given) const {
    if (names_.empty()) return given;
    for (const auto& [name, theirs] : names_) {
      const Header wanted = header_of(theirs);
      if (wanted.name == given.name) return {name, wanted.unit.empty() ? given.unit : wanted.unit};
    }
    return {};
  }

  void read_header(const std::vector<std::string>& cells, long line) {
    std::set<std::string> seen;
    for (const std::string& cell : cells) {
      const Header given = header_of(cell), own = ours(given);
      Column column;
      column.name = given.name;
      if (own.name.empty()) {
        table_.ignored.push_back(given.name);
      } else if (!seen.insert(own.name).second) {
        problem(line, concat("\"", given.name, "\" has two columns"), "remove one");
      } else {
        find_meaning(own, line, column);
      }
      columns_.push_back(column);
    }
    for (const auto& [name, theirs] : names_) {
      if (!seen.contains(name))
        problem(line, concat("there is no column \"", header_of(theirs).name, "\" for ", name),
                "correct its name");
    }
    require_columns(line);
  }

  void find_meaning(const Header& own, long line, Column& column) {
    const auto role = std::find_if(kRoles.begin(), kRoles.end(),
                                   [&](const RoleInfo& one) { return own.name == one.name; });
    if (role == kRoles.end()) {
      column.parameter = static_cast<int>(table_.parameters.size());
      table_.parameters.push_back({own.name, own.unit, {}});
      return;
    }
    column.role = &*role;
    if (role->dimension == Dimension::number) return;
    table_.numbers[role->role];
    const bool angle = role->dimension == Dimension::angle;
    const std::string usual = angle ? "deg" : "m";
    if (own.unit == usual) return;
    const auto one = faultsim::parse_quantity("1 " + own.unit, role->dimension);
    if (!one.ok) {
      problem(line, concat("\"", column.name, "\" needs a unit of ", angle ? "angle" : "length"),
              concat("write \"", column.name, " [", usual, "]\""));
    }
    column.factor = angle ? one.value / faultsim::kDegree : one.value;
  }

  bool has(PillarRole role) const { return table_.numbers.contains(role); }

  void require_columns(long line) {
    for (const PillarRole role : {PillarRole::x, PillarRole::y}) {
      if (!has(role))
        problem(line, concat("there is no column \"", name_of(role), "\""),
                concat("add \"", name_of(role), " [m]\""));
    }
    const bool one_side = has(PillarRole::thickness_foot) != has(PillarRole::thickness_hanging);
    if (one_side || (has(PillarRole::thickness) && has(PillarRole::thickness_foot)))
      problem(line, "the thickness is not that of both sides",
              "give \"thickness\", or \"thickness_foot\" and \"thickness_hanging\"");
    if (has(PillarRole::dip) && has(PillarRole::dip_from_horizontal))
      problem(line, "there are two dips", "give one of them");
  }

  void read_line(const std::vector<std::string>& cells, long line) {
    if (cells.size() != columns_.size()) {
      problem(line,
              concat(counted(cells.size(), "cell", "cells"), ", and there are ",
                     counted(columns_.size(), "column", "columns")),
              "give a cell for each column");
      return;
    }
    table_.lines.push_back(line);
    table_.ids.push_back(std::to_string(line));
    table_.faults.emplace_back();
    for (std::size_t k = 0; k < cells.size(); ++k) read_cell(columns_[k], cells[k], line);
    if (!ids_.insert(table_.ids.back()).second)
      problem(line, concat("pillar \"", table_.ids.back(), "\" was there before"),
              "give each pillar an id of its own");
  }

  void read_cell(const Column& column, const std::string& cell, long line) {
    if (column.role == nullptr && column.parameter < 0) return;
    if (column.role != nullptr && column.role->role == PillarRole::id) {
      table_.ids.back() = cell;
    } else if (column.role != nullptr && column.role->role == PillarRole::fault) {
      table_.faults.back() = cell;
    } else {
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
        problem(line, concat("\"", cell, "\" of ", column.name, " is not a number"),
                "write a number, its unit in the first line");
      if (column.role != nullptr)
        table_.numbers[column.role->role].push_back(value * column.factor);
      else
        table_.parameters[static_cast<std::size_t>(column.parameter)].values.push_back(value);
    }
  }

  const ColumnNames& names_;
  PillarTable table_;
  std::vector<Column> columns_;
  std::vector<Problem> problems_;
  std::size_t n_problems_ = 0;
  std::set<std::string> ids_;
};

}  // namespace

std::optional<double> PillarTable::number(PillarRole role, std::size_t pillar) const {
  const auto column = numbers.find(role);
  if (column == numbers.end()) return std::nullopt;
  return column->second.at(pillar);
}

const char* name_of(PillarRole role) {
  return std::find_if(kRoles.begin(), kRoles.end(),
                      [&](const RoleInfo& one) { return one.role == role; })
      ->name;
}

PillarTable read_pillar_table(const std::filesystem::path& file, const ColumnNames& names) {
  return Reader(file.string(), names)
      .read(faultsim::read_input_or_throw(file.string(), kMostBytes));
}

}  // namespace faultsweep
