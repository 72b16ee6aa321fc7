#include "campaign/store/result_rows.h"
#include "campaign/common/names.h"

#include <algorithm>
#include <charconv>

namespace faultsweep {

RowInsert::RowInsert(const std::string& table, const std::string& columns) {
  std::string row;
  constexpr std::string_view kBetween = ", ";
  for (std::size_t at = 0; at < columns.size();) {
    const std::size_t end = std::min(columns.find(kBetween, at), columns.size());
    keys.push_back(RowDigest::column_key(table, std::string_view(columns).substr(at, end - at)));
    row += row.empty() ? "(?" : ", ?";
    at = end + kBetween.size();
  }
  row += ')';
  for (std::size_t k = 0; k < sql.size(); ++k) {
    sql[k] = concat("INSERT INTO ", table, " (", columns, ") VALUES ", row);
    for (std::size_t more = 1; more < kRows[k]; ++more) sql[k] += concat(kBetween, row);
  }
}

void RowWriter::take_statement() {
  FAULTSIM_DEMAND(n_left_ > 0, insert_.sql.back());
  std::size_t k = 0;
  while (RowInsert::kRows[k] > n_left_) ++k;
  if (!statement_ || RowInsert::kRows[k] != n_taken_) {
    statement_.reset();
    statement_.emplace(connection_.prepared(insert_.sql[k]));
    n_taken_ = RowInsert::kRows[k];
  }
  n_open_ = n_taken_;
  n_left_ -= n_taken_;
  statement_->bind();
}

void RowWriter::end() {
  FAULTSIM_DEMAND(column_ == insert_.keys.size(), insert_.sql.back());
  digest_.end_row();
  if (--n_open_ == 0) statement_->run();
}

TableColumns::TableColumns(Connection& connection, const std::string& table) {
  Statement columns = connection.prepared("SELECT name, \"notnull\" FROM pragma_table_info(?)");
  columns.bind(table);
  while (columns.step()) (columns.integer(1) != 0 ? needed_ : nullable_).insert(columns.text(0));
}

RowField TableColumns::of(const faultsim::Field& field, bool is_text,
                          const std::string& prefix) const {
  RowField found;
  const std::string column = concat(prefix, field.key), id = column + "_id";
  const auto has = [this](const std::string& name) {
    return needed_.contains(name) || nullable_.contains(name);
  };
  if (is_text && has(id)) {
    found = {RowField::Kind::name, id, concat("(SELECT name FROM names WHERE id = $.", id, ")"),
             nullable_.contains(id)};
  } else if (has(column)) {
    found = {RowField::Kind::plain, column, "$." + column, nullable_.contains(column)};
  }
  if (!field.sql.empty()) found.selected = field.sql;
  return found;
}

std::string json_array(const std::vector<double>& values) {
  std::string text = "[";
  char digits[32];
  for (const double value : values) {
    if (text.size() > 1) text += ',';
    constexpr int kAll = std::numeric_limits<double>::max_digits10;
    const auto [end, error] =
        std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, kAll);
    text.append(digits, end);
  }
  return text + "]";
}

std::vector<double> numbers_of(const std::string& json_array) {
  std::vector<double> numbers;
  const char* at = json_array.data();
  const char* end = at + json_array.size();
  while (at < end) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error == std::errc()) {
      numbers.push_back(number);
      at = next;
    } else {
      ++at;
    }
  }
  return numbers;
}

std::string join_lines(const std::vector<std::string>& lines) { return joined(lines, "\n"); }

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

ResultTables::ResultTables(Connection& db)
    : whole(db, "case_metrics"),
      surface(db, "case_surfaces"),
      stage(db, "stage_metrics"),
      fault(db, "fault_metrics"),
      onset(db, "fault_onsets"),
      step(db, "load_steps"),
      step_creep(db, "load_steps"),
      history(db, "chi_history"),
      history_creep(db, "chi_history", "creep_"),
      event(db, "slip_events"),
      episode(db, "episodes"),
      add_whole("case_metrics",
                "case_id, run_id, n_steps, n_episodes,"
                " unexpected_episode, unexpected_after" +
                    whole.columns()),
      add_surface("case_surfaces", "case_id" + surface.columns()),
      add_stage("stage_metrics", "case_id, rank_class, pressure_margin_pa" + stage.columns()),
      add_fault("fault_metrics", "case_id, stage_id, fault, rank_class" + fault.columns()),
      add_onset("fault_onsets", "case_id, stage_id, opening, fault_id" + onset.columns()),
      add_step("load_steps", "case_id" + step.columns() + step_creep.columns()),
      add_history("chi_history",
                  "case_id, fault, step, fault_id" + history.columns() + history_creep.columns()),
      add_event("slip_events", "case_id, number" + event.columns()),
      add_episode("episodes", "case_id, number" + episode.columns()),
      read_fault(concat("SELECT 1", fault.selected("q"),
                        " FROM fault_metrics q WHERE q.stage_id = ?1 AND q.fault_id = ?2"
                        " AND q.case_id = ?3")),
      read_onsets(concat("SELECT o.opening", onset.selected("o"),
                         " FROM fault_onsets o WHERE o.stage_id = ?1 AND o.fault_id = ?2"
                         " AND o.case_id = ?3")) {}

}  // namespace faultsweep
