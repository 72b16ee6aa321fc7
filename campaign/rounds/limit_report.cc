#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"
#include "campaign/rounds/limit_table.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::counted;
using faultsim::InputError;
using nlohmann::json;

namespace {

std::string value_text(double value, const LimitSearch& limit) {
  return concat(shortest_text(value), limit.unit.empty() ? "" : " ", limit.unit);
}

/// "non-monotone: unsafe -50 to -41, -12 to 0", as far as they are known.
std::string unsafe_parts(const LimitCell& cell, const LimitSearch& limit) {
  std::string text = "non-monotone: unsafe";
  const auto& points = cell.finding.points;
  const SearchPoint* first = nullptr;
  const SearchPoint* last = nullptr;
  const char* separator = " ";
  const auto close = [&] {
    if (first == nullptr) return;
    text += concat(separator, shortest_text(first->value));
    if (last != first) text += concat(" to ", shortest_text(last->value));
    separator = ", ";
    first = nullptr;
  };
  for (const SearchPoint& one : points) {
    if (one.state == PointState::safe) close();
    if (one.state != PointState::unsafe) continue;
    if (first == nullptr) first = &one;
    last = &one;
  }
  close();
  return concat(text, limit.unit.empty() ? "" : " ", limit.unit);
}

/// What a reader must know of a limit beside its two values.
std::string remark_of(const LimitCell& cell, const LimitSearch& limit) {
  const LimitFinding& f = cell.finding;
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  switch (f.verdict) {
    case LimitVerdict::unknown:
      add("the safe end is not known");
      break;
    case LimitVerdict::safe_throughout:
      add(concat("safe up to ", value_text(limit.scan.back(), limit)));
      break;
    case LimitVerdict::unsafe_throughout:
      add(concat("unsafe from ", value_text(limit.scan.front(), limit), " on"));
      break;
    case LimitVerdict::non_monotone:
      add(unsafe_parts(cell, limit));
      break;
    case LimitVerdict::limit:
      break;
  }
  if (f.n_unknown > 0) add(concat(counted(f.n_unknown, "case", "cases"), " not known"));
  const Crossing* crossing = f.limit();
  if (crossing != nullptr && !crossing->narrow) add("not narrowed yet");
  const bool is_sure =
      crossing == nullptr || (crossing->before.resolved && crossing->after.resolved);
  if (!is_sure) {
    add(concat("cells: sure safe to ",
               f.surely_safe ? shortest_text(f.surely_safe->value) : "nowhere", ", unsafe from ",
               f.surely_unsafe ? shortest_text(f.surely_unsafe->value) : "nowhere"));
  }
  return text;
}

std::string case_text(const SearchPoint& point) { return std::to_string(point.position); }

void add_cells(const LimitRow& row, std::size_t l, const LimitSearch& limit,
               std::vector<std::string>& texts) {
  const std::optional<LimitCell>& cell = row.cells[l];
  const Crossing* crossing = cell ? cell->finding.limit() : nullptr;
  texts.push_back(crossing != nullptr ? shortest_text(crossing->before.value) : "");
  texts.push_back(crossing != nullptr ? shortest_text(crossing->after.value) : "");
  const bool has_datum = cell && cell->datum;
  texts.push_back(has_datum ? format_number(cell->datum->absolute / kBar, 5) : "");
  texts.push_back(crossing != nullptr
                      ? concat(case_text(crossing->before), "|", case_text(crossing->after))
                      : "");
  texts.push_back(cell ? remark_of(*cell, limit) : "");
}

long count(const LimitTable& table, LimitVerdict verdict) {
  long n = 0;
  for (const LimitRow& row : table.rows) {
    n += std::count_if(row.cells.begin(), row.cells.end(),
                       [&](const auto& cell) { return cell && cell->finding.verdict == verdict; });
  }
  return n;
}

std::string question_text(const LimitSearch& limit) {
  const bool up = limit.scan.back() > limit.scan.front();
  std::string faults;
  for (const std::string& fault : limit.faults) faults += (faults.empty() ? "" : ", ") + fault;
  return concat(limit.name, ": the ", up ? "highest" : "lowest", " value from ",
                value_text(limit.scan.front(), limit), " to ", value_text(limit.scan.back(), limit),
                " without \"", limit.unsafe, "\" on ", faults, limit.stage.empty() ? "" : " in ",
                limit.stage, ", to ", value_text(limit.tolerance, limit), "\n");
}

json point_to_json(const SearchPoint& point, const LimitSearch& limit) {
  return {{"value", point.value},
          {"text", value_text(point.value, limit)},
          {"case", point.position > 0 ? json(point.position) : json()},
          {"resolved", point.resolved}};
}

json cell_to_json(const LimitCell& cell, const LimitSearch& limit) {
  const LimitFinding& f = cell.finding;
  json crossings = json::array();
  for (const Crossing& one : f.crossings) {
    crossings.push_back({{"before", point_to_json(one.before, limit)},
                         {"after", point_to_json(one.after, limit)},
                         {"safe_first", one.is_limit()},
                         {"narrow", one.narrow},
                         {"unknown", one.n_unknown}});
  }
  const Crossing* crossing = f.limit();
  const auto point = [&](const std::optional<SearchPoint>& one) {
    return one ? point_to_json(*one, limit) : json();
  };
  json datum;
  if (cell.datum) {
    datum = {{"region", cell.datum->region},
             {"depth_m", cell.datum->depth},
             {"absolute_pa", cell.datum->absolute}};
  }
  return {{"limit", limit.name},
          {"verdict", to_string(f.verdict)},
          {"safe", crossing != nullptr ? point_to_json(crossing->before, limit) : json()},
          {"unsafe", crossing != nullptr ? point_to_json(crossing->after, limit) : json()},
          {"narrow", crossing != nullptr && crossing->narrow},
          {"surely_safe", point(f.surely_safe)},
          {"surely_unsafe", point(f.surely_unsafe)},
          {"unknown_points", f.n_unknown},
          {"points", f.points.size()},
          {"crossings", crossings},
          {"at_datum", datum},
          {"remark", remark_of(cell, limit)}};
}

}  // namespace

std::string limits_to_text(const LimitTable& table, long top) {
  std::string text;
  for (const LimitSearch& limit : table.limits) text += question_text(limit);
  text += "\n";
  std::vector<std::string> header = {"rank"};
  header.insert(header.end(), table.parameters.begin(), table.parameters.end());
  header.insert(header.end(), {"fault", "band"});
  for (const LimitSearch& limit : table.limits) {
    const std::string name = table.limits.size() > 1 ? limit.name + " " : "";
    const std::string unit = limit.unit.empty() ? "" : "/" + limit.unit;
    for (const std::string& column : {"safe" + unit, "unsafe" + unit, std::string("datum/bar"),
                                      std::string("cases"), std::string("remark")})
      header.push_back(name + column);
  }
  TextTable rows(header);
  const auto n = static_cast<long>(table.rows.size());
  for (long k = 0; k < (top == 0 ? n : std::min(top, n)); ++k) {
    const LimitRow& row = table.rows[static_cast<std::size_t>(k)];
    std::vector<std::string> texts = {row.width ? std::to_string(k + 1) : "*"};
    texts.insert(texts.end(), row.settings.begin(), row.settings.end());
    texts.push_back(row.fault);
    texts.push_back(row.width ? (row.is_open ? "≥ " : "") + shortest_text(*row.width) : "-");
    for (std::size_t l = 0; l < table.limits.size(); ++l) add_cells(row, l, table.limits[l], texts);
    rows.add_row(texts);
  }
  text += rows.text();
  if (top != 0 && n > top) text += concat("and ", n - top, " more rows\n");
  text += concat("\n", counted(n, "row", "rows"),
                 ", narrowest band first: ", count(table, LimitVerdict::limit), " with a limit, ",
                 count(table, LimitVerdict::safe_throughout), " safe throughout, ",
                 count(table, LimitVerdict::unsafe_throughout), " unsafe throughout, ",
                 count(table, LimitVerdict::non_monotone), " non-monotone, ",
                 count(table, LimitVerdict::unknown), " not known\n",
                 "`safe` and `unsafe` were computed, each as the case given (faultsweep show); "
                 "between values tried that are alike nothing was\n");
  if (!table.is_finished) text += "The search has not ended: faultsweep run\n";
  return text;
}

std::string limit_map_to_text(const LimitTable& table, const std::string& across,
                              const std::string& down) {
  const auto place = [&](const std::string& name) {
    const auto found = std::find(table.parameters.begin(), table.parameters.end(), name);
    if (found != table.parameters.end())
      return static_cast<std::size_t>(found - table.parameters.begin());
    std::string known;
    for (const std::string& one : table.parameters) known += (known.empty() ? "" : ", ") + one;
    throw InputError("--map", {{"", 0, concat("there is no parameter '", name, "' in the design"),
                                concat("there are ", known)}});
  };
  const std::size_t a = place(across), d = place(down);
  std::vector<const LimitRow*> rows;
  for (const LimitRow& row : table.rows) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(), [](const LimitRow* one, const LimitRow* other) {
    return one->configuration < other->configuration;
  });
  std::vector<std::string> columns, lines;
  const auto note = [](std::vector<std::string>& all, const std::string& one) {
    if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
  };
  for (const LimitRow* row : rows) note(columns, row->settings[a]), note(lines, row->settings[d]);
  std::map<std::pair<std::size_t, std::string>,
           std::map<std::pair<std::string, std::string>, std::string>>
      maps;
  for (const LimitRow* row : rows) {
    for (std::size_t l = 0; l < table.limits.size(); ++l) {
      if (!row->cells[l]) continue;
      const LimitFinding& f = row->cells[l]->finding;
      std::string text = f.limit() != nullptr ? shortest_text(f.limit()->before.value)
                                              : std::string(to_string(f.verdict));
      if (f.limit() != nullptr && f.verdict == LimitVerdict::non_monotone) text += " *";
      auto& cells = maps[{l, row->fault}];
      if (!cells.emplace(std::pair(row->settings[d], row->settings[a]), text).second) {
        throw InputError("--map", {{"", 0, "the design varies more than these two parameters",
                                    "use --csv, or a design with two"}});
      }
    }
  }
  std::string text;
  for (const auto& [key, cells] : maps) {
    const LimitSearch& limit = table.limits[key.first];
    text += concat(text.empty() ? "" : "\n", limit.name, " that is safe for ", key.second,
                   limit.unit.empty() ? "" : ", ", limit.unit, "; down: ", down,
                   ", across: ", across, "\n");
    std::vector<std::string> header = {down};
    header.insert(header.end(), columns.begin(), columns.end());
    TextTable map(header);
    for (const std::string& line : lines) {
      std::vector<std::string> texts = {line};
      for (const std::string& column : columns) {
        const auto found = cells.find({line, column});
        texts.push_back(found == cells.end() ? "" : found->second);
      }
      map.add_row(texts);
    }
    text += map.text();
  }
  return text +
         "never: safe in the whole range; always: unsafe in all of it; *: and safe again "
         "behind the limit\n";
}

json limits_to_json(const LimitTable& table) {
  json limits = json::array(), rows = json::array();
  for (const LimitSearch& one : table.limits) {
    limits.push_back({{"parameter", one.name},
                      {"faults", one.faults},
                      {"stage", one.stage},
                      {"unsafe", one.unsafe},
                      {"unit", one.unit},
                      {"tolerance", one.tolerance},
                      {"scan", one.scan}});
  }
  for (const LimitRow& row : table.rows) {
    json settings = json::object(), cells = json::array();
    for (std::size_t p = 0; p < table.parameters.size(); ++p)
      settings[table.parameters[p]] = row.settings[p];
    for (std::size_t l = 0; l < table.limits.size(); ++l)
      if (row.cells[l]) cells.push_back(cell_to_json(*row.cells[l], table.limits[l]));
    rows.push_back({{"row", row.configuration},
                    {"parameters", settings},
                    {"fault", row.fault},
                    {"band", row.width ? json(*row.width) : json()},
                    {"band_may_be_wider", row.is_open},
                    {"limits", cells}});
  }
  return {{"campaign", table.campaign.name},
          {"finished", table.is_finished},
          {"limits", limits},
          {"rows", rows}};
}

std::string limits_to_csv(const LimitTable& table) {
  std::string text = "row";
  for (const std::string& name : table.parameters) text += "," + csv_name(name);
  text +=
      ",fault,limit,unit,verdict,safe,unsafe,safe_case,unsafe_case,surely_safe,surely_unsafe,"
      "region,datum_m,absolute_pa,unknown_points,band,remark\n";
  const auto number = [](const std::optional<SearchPoint>& point) {
    return point ? shortest_text(point->value) : std::string();
  };
  for (const LimitRow& row : table.rows) {
    for (std::size_t l = 0; l < table.limits.size(); ++l) {
      if (!row.cells[l]) continue;
      const LimitCell& cell = *row.cells[l];
      const Crossing* crossing = cell.finding.limit();
      text += std::to_string(row.configuration);
      for (const std::string& setting : row.settings) text += "," + csv_name(setting);
      const std::string fields[] = {
          row.fault,
          table.limits[l].name,
          table.limits[l].unit,
          to_string(cell.finding.verdict),
          crossing != nullptr ? shortest_text(crossing->before.value) : "",
          crossing != nullptr ? shortest_text(crossing->after.value) : "",
          crossing != nullptr ? case_text(crossing->before) : "",
          crossing != nullptr ? case_text(crossing->after) : "",
          number(cell.finding.surely_safe),
          number(cell.finding.surely_unsafe),
          cell.datum ? cell.datum->region : "",
          cell.datum ? exact_number(cell.datum->depth) : "",
          cell.datum ? exact_number(cell.datum->absolute) : "",
          std::to_string(cell.finding.n_unknown),
          row.width ? shortest_text(*row.width) : "",
          remark_of(cell, table.limits[l])};
      for (const std::string& field : fields) text += "," + csv_name(field);
      text += "\n";
    }
  }
  return text;
}

}  // namespace faultsweep
