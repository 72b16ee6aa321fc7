#include <algorithm>
#include <cmath>
#include <functional>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/render/shown.h"
#include "campaign/reports/measure_columns.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/spec/metrics.h"

namespace faultsweep {

namespace {

/// A row of the ranking, and what its cells are made of.
struct Row {
  const RankedCase& row;
  StageMetrics metrics;              ///< of the case or of the fault asked for.
  std::vector<AnswerCell> measures;  ///< in the order of measure_columns.
  std::string place;                 ///< "3", "+1", "*".
};

/// Where its rank stands. Cases that the cells do not resolve compete among themselves, cases
/// without a full history not at all.
class PlaceNames {
 public:
  /// Behind the rows of other pages, which go class by class.
  explicit PlaceNames(const Ranking& ranking) {
    const long skipped = ranking.request.skip.value_or(0);
    complete_ = std::min(skipped, ranking.n_rows[0]);
    unresolved_ = std::clamp(skipped - ranking.n_rows[0], 0L, ranking.n_rows[1]);
  }
  std::string next(int rank_class) {
    if (rank_class == 0) return std::to_string(++complete_);
    return rank_class == 1 ? concat("+", ++unresolved_) : "*";
  }

 private:
  long complete_ = 0, unresolved_ = 0;
};

/// A ranking of one fault says nothing of what another one does.
bool is_unexpected(const RankedCase& row) {
  return !row.unexpected_fault.empty() &&
         (!row.fault_metrics || row.fault_metrics->fault == row.unexpected_fault);
}

AnswerCell rank_cell(const Row& one) {
  if (one.row.rank_class != 0) return AnswerCell({}, NAN, one.place);
  return std::stol(one.place);
}

AnswerCell outcome_cell(const Row& one) {
  const RankedCase& row = one.row;
  std::string why;
  if (!row.weakening_resolved) {
    why = "mesh too coarse for its weakening";
  } else if (row.outcome == to_string(faultsim::Outcome::unresolved_event)) {
    why = "evidence of an event does not hold";
  }
  return {row.outcome, NAN, why};
}

AnswerCell unexpected_cell(const Row& one) {
  const bool is = is_unexpected(one.row);
  return {is, NAN, is ? one.row.unexpected_fault : ""};
}

/// A column and how its cell comes about.
struct RankingColumn {
  AnswerColumn column;
  std::function<AnswerCell(const Row&)> cell;
};

/// The cell that a member of the case, or of its metrics, is.
template <typename Member>
auto of(Member member) {
  return [member](const Row& one) -> AnswerCell {
    if constexpr (std::is_invocable_v<Member, const RankedCase&>)
      return std::invoke(member, one.row);
    else
      return std::invoke(member, one.metrics);
  };
}

/// The columns of measures, those per metre of strike and in total apart where there are both.
class MeasureColumns {
 public:
  explicit MeasureColumns(const Ranking& ranking) : ranking_(ranking) {
    columns_ = measure_columns(ranking.kinds.plane_strain && !ranking.kinds.total);
    if (ranking.kinds.mixed()) per_metre_ = measure_columns(true);
    if (!ranking.by_default) asked_for_ = measure_called(ranking.request.by);
  }
  /// What is ranked by is one of the measures.
  bool has_score() const { return asked_for_.has_value(); }

  void add(std::string_view name, std::vector<RankingColumn>& columns) const {
    add(measure_called(name).value(), columns);
  }
  /// Those that are not there yet.
  void add_others(std::vector<RankingColumn>& columns) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const auto same = [&](const RankingColumn& one) { return one.column.key == columns_[k].key; };
      if (std::ranges::none_of(columns, same)) add(k, columns);
    }
  }

 private:
  void add(std::size_t k, std::vector<RankingColumn>& columns) const {
    const bool apart = !per_metre_.empty() && per_metre_[k].key != columns_[k].key;
    columns.push_back({needed(k, columns_[k]), [this, k, apart](const Row& one) {
                         return apart && one.row.plane_strain ? AnswerCell() : cell(k, one);
                       }});
    if (!apart) return;
    columns.push_back({needed(k, per_metre_[k]), [this, k](const Row& one) {
                         return one.row.plane_strain ? cell(k, one) : AnswerCell();
                       }});
  }
  /// What is ranked by is never left out.
  AnswerColumn needed(std::size_t k, AnswerColumn column) const {
    if (asked_for_ == k) column.need = Need::always;
    return column;
  }
  AnswerCell cell(std::size_t k, const Row& one) const {
    AnswerCell found = one.measures[k];
    if (columns_[k].key == "slides" && one.metrics.slips && !one.metrics.activated)
      found.note = "slips";
    for (const ErrorBar& bar : ranking_.error_bars)
      if (measure_called(bar.metric) == k) found.error = bar.rms;
    return found;
  }

  const Ranking& ranking_;
  std::vector<AnswerColumn> columns_, per_metre_;
  std::optional<std::size_t> asked_for_;
};

/// In the order in which a screen that becomes narrower leaves them out, the last first.
std::vector<RankingColumn> columns_of(const Ranking& ranking, const MeasureColumns& measures) {
  const Need always = Need::always, wanted = Need::wanted, data = Need::data;
  std::vector<RankingColumn> columns;
  const auto add = [&](const std::string& key, const std::string& heading, Need need,
                       const auto& cell, const ShownUnit& unit = {}, int digits = 4) {
    columns.push_back({{key, heading, unit, digits, need}, cell});
  };
  measures.add("slides", columns);
  add("resolved", "resolved", always, of([](const RankedCase& row) { return is_resolved(row); }));
  measures.add("chi_bar", columns);
  measures.add("max_slip", columns);
  if (!ranking.by_default) {
    add("score", ranking.request.by, measures.has_score() ? data : always, of(&RankedCase::score),
        ranking.by_unit);
  }
  add("activated_fault", "fault", wanted,
      [](const Row& one) { return words_or_nothing(one.metrics.activated_fault); });
  add("activation_step", "from step", wanted, of(&StageMetrics::activation_step));
  add("outcome", "outcome", wanted, outcome_cell);
  measures.add("activated_area", columns);
  measures.add("moment", columns);
  add("unexpected", "unexpected", wanted, unexpected_cell);
  measures.add("n_events", columns);
  add("pressure_margin_pa", "margin", wanted, of(&RankedCase::pressure_margin),
      shown_unit(Dimension::pressure), 3);
  measures.add_others(columns);
  add("opened_fault", "first to open", Need::extra,
      [](const Row& one) { return words_or_nothing(one.metrics.opened_fault); });
  add("opening_step", "open from step", data, of(&StageMetrics::opening_step));
  add("rank_class", "rank class", data, of(&RankedCase::rank_class));
  add("weakening_resolved", "weakening resolved", data, of(&RankedCase::weakening_resolved));
  add("interpolated", "interpolated", data, of(&RankedCase::interpolated));
  add("plane_strain", "plane strain", data, of(&RankedCase::plane_strain));
  add("jumps", "jumps", data, of([](const StageMetrics& m) { return m.n_events > 0; }));
  return columns;
}

/// Which columns a table has.
enum class For { all, page };

/// Leaves out the cells of columns that only files have.
void drop_cells_of_files(const std::vector<AnswerColumn>& columns, std::vector<AnswerCell>& cells) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (columns[k].need == Need::data) continue;
    if (kept != k) cells[kept] = std::move(cells[k]);
    ++kept;
  }
  cells.resize(kept);
  cells.shrink_to_fit();
}

AnswerTable table_of(const Ranking& ranking, For reader) {
  std::vector all = mapped(ranking.rows, [&](const RankedCase& row) { return &row.parameters; });
  const ParameterColumns parameters(ranking.campaign.parameters, all);
  const MeasureColumns measures(ranking);
  const std::vector<RankingColumn> columns = columns_of(ranking, measures);
  const Need data = Need::data;

  AnswerTable table{
      "cases", "", {{"rank", "rank", {}, 4, Need::always}, {"case", "case", {}, 4, Need::always}}};
  table.is_sortable = true;
  append(table.columns, parameters.columns());
  for (const RankingColumn& one : columns) table.columns.push_back(one.column);
  std::vector<AnswerColumn> slides = onset_columns(ranking.pressures, "activation", data);
  slides.front().need = data;  // activation_step stands further in front
  std::vector<AnswerColumn> opens = onset_columns(ranking.pressures, "opening", data);
  for (AnswerColumn& one : opens) one.need = data;
  append(table.columns, slides);
  append(table.columns, opens);

  PlaceNames places(ranking);
  for (const RankedCase& row : ranking.rows) {
    const StageMetrics m = metrics_of(row);
    const Row one{row, m, measure_cells(m), places.next(row.rank_class)};
    std::vector<AnswerCell> cells = {rank_cell(one), row.position};
    parameters.add_cells(row.parameters, cells);
    for (const RankingColumn& column : columns) cells.push_back(column.cell(one));
    add_onset(first_activation(m), cells);
    add_onset(first_opening(m), cells);
    if (reader == For::page) drop_cells_of_files(table.columns, cells);
    table.rows.push_back(std::move(cells));
  }
  if (reader == For::page)
    std::erase_if(table.columns, [](const AnswerColumn& one) { return one.need == Need::data; });
  return table;
}

std::vector<std::string> notes_of(const Ranking& ranking) {
  const auto any = [&](auto&& holds) { return std::ranges::any_of(ranking.rows, holds); };
  std::vector<std::string> notes;
  if (any([](const RankedCase& row) { return row.rank_class == 1; })) {
    notes.emplace_back(
        "+ complete, but whether a fault slides (resolved: no) or how large its slip events are "
        "depends on the mesh, or an event lacks evidence: ranked separately");
  }
  if (any([](const RankedCase& row) { return row.rank_class > 1; }))
    notes.emplace_back("* history ends early: listed separately, not ranked");
  if (any(is_unexpected)) {
    notes.emplace_back(
        "unexpected: a fault that slid before slides again after its pressure has recovered; "
        "`faultsweep show CASE` shows where");
  }
  if (any([](const RankedCase& row) { return metrics_of(row).activated; }))
    notes.push_back(pressure_note(ranking.pressures));
  if (ranking.plane_strain_apart) {
    notes.emplace_back(
        "plane-strain cases are not ranked here, as their areas and moments are per metre of "
        "strike: use --where plane_strain");
  }
  if (!ranking.approximation.empty()) notes.push_back(ranking.approximation);
  for (const ErrorBar& bar : ranking.error_bars) {
    notes.push_back(concat("± of ", bar.metric, " is its rms error at ", bar.tier, " against ",
                           bar.reference, " over ", bar.n_cases, " cases of the campaign, at most ",
                           format_number(bar.largest, 2), " (faultsweep tradeoff)"));
  }
  return notes;
}

json error_bars_json(const std::vector<ErrorBar>& error_bars) {
  json bars = json::array();
  for (const ErrorBar& bar : error_bars) {
    bars.push_back({{"metric", bar.metric},
                    {"tier", bar.tier},
                    {"reference", bar.reference},
                    {"n_cases", bar.n_cases},
                    {"rms", bar.rms},
                    {"largest", bar.largest}});
  }
  return bars;
}

/// "case 17: F2 slides from step 7 on, χ̄ 1, slip 0.047 m".
std::string case_words(const RankedCase& row) {
  const StageMetrics m = metrics_of(row);
  std::string does = "nothing slides";
  if (m.activated) {
    does = concat(m.activated_fault.empty() ? "a fault" : m.activated_fault, " slides");
    if (m.activation_step) does += concat(" from step ", *m.activation_step, " on");
  } else if (m.slips) {
    does += ", something slips";
  }
  return concat("case ", row.position, ": ", does, is_resolved(row) ? "" : " (not resolved)",
                ", χ̄ ", format_number(m.chi_bar, 3), ", slip ", format_number(m.max_slip, 3), " m");
}

/// Which comes first, and of those that the cells do not resolve where the first slides for none.
std::string first_sentence(const Ranking& ranking) {
  const RankRequest& request = ranking.request;
  const RankedCase& first = ranking.rows.front();
  const std::string by = ranking.by_default ? "Riskiest is "
                                            : concat(request.ascending ? "Lowest" : "Highest",
                                                     " by ", request.by, " is ");
  std::string text = by + case_words(first);
  if (!ranking.by_default && first.score) {
    const ShownUnit& unit = ranking.by_unit;
    text += concat(", ", request.by, " ", format_number(*first.score / unit.size),
                   unit.name.empty() ? "" : " ", unit.name);
  }
  text += ".";
  if (metrics_of(first).activated || request.ascending) return text;
  for (const RankedCase& row : ranking.rows) {
    if (row.rank_class == 1 && metrics_of(row).activated)
      return text + concat(" Ranked separately, as the cells do not resolve it, is ",
                           case_words(row), ".");
  }
  return text;
}

/// "Rows 41 to 60 of 1440.", of a page behind the first.
std::string page_sentence(const Ranking& ranking) {
  const long skipped = *ranking.request.skip;
  const std::string all = counted(ranking.n_all(), "row", "rows");
  if (ranking.rows.empty())
    return concat("The ranking has ", all, ", none after row ", skipped, ".");
  return concat("Rows ", skipped + 1, " to ", skipped + static_cast<long>(ranking.rows.size()),
                " of ", ranking.n_all(), ".");
}

std::vector<std::string> headline_of(const Ranking& ranking) {
  const bool is_behind = ranking.request.skip.value_or(0) > 0 && ranking.n_all() > 0;
  if (is_behind) return {page_sentence(ranking)};
  if (ranking.rows.empty()) return {"No case of " + ranking.campaign.name + " matches."};
  std::vector<std::string> sentences;
  if (ranking.counts) sentences.push_back(sliding_sentence(*ranking.counts, ranking.request));
  sentences.push_back(first_sentence(ranking));
  return sentences;
}

}  // namespace

std::string sliding_sentence(const SlidingCounts& counts, const RankRequest& request) {
  const std::string cases = counted(counts.n_cases, "case", "cases");
  std::string text =
      !request.fault.empty() ? concat(request.fault, " slides in ", counts.n_slide, " of ", cases)
      : counts.n_slide == 0
          ? concat("None of ", cases, " slides")
          : concat(counts.n_slide, " of ", cases, counts.n_slide == 1 ? " slides" : " slide");
  if (!request.stage.empty()) text += " in " + request.stage;
  if (counts.n_unresolved > 0) {
    const bool all = counts.n_unresolved == counts.n_slide;
    text += concat("; ", all ? std::string("all") : std::to_string(counts.n_unresolved),
                   " of these are not resolved by the cells");
  }
  if (counts.n_perhaps > 0)
    text += concat("; ", counts.n_perhaps, " more may slide, which the cells do not resolve");
  return text + ".";
}

namespace {

Answer answer_for(const Ranking& ranking, For reader) {
  const RankRequest& request = ranking.request;
  Answer answer{headline_of(ranking)};
  answer.facts = {{"campaign", ranking.campaign.name},
                  {"error_bars", error_bars_json(ranking.error_bars)},
                  {"by", request.by},
                  {"stage", request.stage},
                  {"fault", request.fault},
                  {"where", request.where},
                  {"plane_strain_apart", ranking.plane_strain_apart}};
  if (ranking.counts) {
    answer.facts["counted"] = ranking.counts->n_cases;
    answer.facts["sliding"] = ranking.counts->n_slide;
    answer.facts["sliding_unresolved"] = ranking.counts->n_unresolved;
    answer.facts["perhaps_sliding"] = ranking.counts->n_perhaps;
  }
  if (request.skip) {
    answer.facts["skipped"] = *request.skip;
    answer.facts["rows"] = ranking.n_all();
  }
  answer.add(table_of(ranking, reader)).notes = notes_of(ranking);
  return answer;
}

}  // namespace

Answer to_answer(const Ranking& ranking) { return answer_for(ranking, For::all); }

Answer answer_of_page(const Ranking& ranking) { return answer_for(ranking, For::page); }

Answer metrics_answer() {
  AnswerTable table{"metrics",
                    "",
                    {{"name", "metric", {}, 4, Need::always},
                     {"synonym", "or", {}, 4, Need::wanted},
                     {"unit", "unit", {}, 4, Need::always},
                     {"unit_of_plane_strain", "in plane strain", {}, 4, Need::wanted},
                     {"is_flag", "yes or no", {}, 4, Need::wanted},
                     {"per_stage", "per stage", {}, 4, Need::wanted},
                     {"per_fault", "per fault", {}, 4, Need::wanted},
                     {"description", "meaning", {}, 4, Need::always}}};
  for (const MetricInfo& metric : metric_catalogue()) {
    const std::string unit = metric_unit(metric, false), strike = metric_unit(metric, true);
    table.rows.push_back({metric.name, metric.synonym, unit, strike, metric.is_flag,
                          has_stages(metric.name), has_faults(metric.name), metric.description});
  }
  table.notes = {
      "per fault and stage: F2.max_slip in gas_storage; a unit per m is that of plane strain"};
  Answer answer{{concat(metric_catalogue().size(), " metrics can be used to rank and filter.")}};
  answer.add(std::move(table));
  return answer;
}

}  // namespace faultsweep
