#include <algorithm>
#include <cmath>

#include "campaign/answers/sheet_parts.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

AnswerCell cell_of(const std::optional<double>& value) { return {value}; }
AnswerCell number_cell(double value) {
  return std::isnan(value) ? AnswerCell() : AnswerCell(value);
}

AnswerColumn data(std::string key) {
  AnswerColumn column{std::move(key), ""};
  column.heading = column.key;
  column.need = Need::data;
  return column;
}
AnswerColumn shown(std::string key, std::string heading, ShownUnit unit = {}, int digits = 4,
                   Need need = Need::always) {
  return {std::move(key), std::move(heading), std::move(unit), digits, need};
}

/// The fault in front of a row; on the screen only where there are several.
AnswerColumn fault_column(const std::vector<FaultSheet>& sheets) {
  return sheets.size() > 1 ? shown("fault", "fault") : data("fault");
}

AnswerTable place_table(const std::vector<FaultSheet>& sheets) {
  AnswerTable table{"place", "", {fault_column(sheets)}};
  for (const char* key :
       {"datum_m", "x_m", "dip_from_vertical_rad", "strike_rad", "length_m", "top_m", "bottom_m",
        "offset_low_m", "offset_high_m", "dip_low_rad", "dip_high_rad"})
    table.columns.push_back(shown(key, key));
  for (const FaultSheet& sheet : sheets) {
    const SheetPlace& p = sheet.place;
    table.rows.push_back({sheet.fault, sheet.datum, p.is_field ? AnswerCell(p.x) : AnswerCell(),
                          p.dip_from_vertical, p.strike, p.length, p.depths.top, p.depths.bottom,
                          number_cell(p.throws.low), number_cell(p.throws.high),
                          number_cell(p.dips.low), number_cell(p.dips.high)});
  }
  table.on_screen = false;
  return table;
}

AnswerTable initial_table(const std::vector<FaultSheet>& sheets) {
  AnswerTable table{
      "initial",
      sheets.size() > 1 ? "Initial state at the datum"
                        : concat("Initial state of ", sheets.front().fault, " at ",
                                 depth_text(sheets.front().datum)),
      {fault_column(sheets), shown("quantity", "quantity"), shown("base", "base scene", bars()),
       shown("low", "cases from", bars()), shown("high", "to", bars())}};
  for (const FaultSheet& sheet : sheets) {
    const SheetInitial& i = sheet.initial;
    const auto add = [&](const char* what, double base, const CaseRange& range) {
      table.rows.push_back(
          {sheet.fault, what, number_cell(base), number_cell(range.low), number_cell(range.high)});
    };
    add("effective normal stress", -i.base.normal, {-i.normal.high, -i.normal.low});
    add("shear stress", i.base.shear, i.shear);
    add("pore pressure in the fault", i.base.pressure, i.pressure);
    add("pressure of compartments", kNotKnown, i.region_pressure);
  }
  table.in_files = false;
  return table;
}

/// The same for files, in SI.
AnswerTable initial_numbers(const std::vector<FaultSheet>& sheets) {
  AnswerTable table{"initial_state", "", {fault_column(sheets)}};
  for (const char* key :
       {"normal_base_pa", "normal_low_pa", "normal_high_pa", "shear_base_pa", "shear_low_pa",
        "shear_high_pa", "fault_pressure_base_pa", "fault_pressure_low_pa",
        "fault_pressure_high_pa", "region_pressure_low_pa", "region_pressure_high_pa",
        "chi_bar_low", "chi_bar_high", "chi_bar_cases"})
    table.columns.push_back(shown(key, key));
  for (const FaultSheet& sheet : sheets) {
    const SheetInitial& i = sheet.initial;
    std::vector<AnswerCell> row = {sheet.fault, i.base.normal};
    const auto add = [&](const CaseRange& range) {
      append(row, {number_cell(range.low), number_cell(range.high)});
    };
    add(i.normal);
    row.emplace_back(i.base.shear);
    add(i.shear);
    row.emplace_back(i.base.pressure);
    add(i.pressure);
    add(i.region_pressure);
    add(i.chi_bar);
    row.emplace_back(i.n_chi_bar);
    table.rows.push_back(std::move(row));
  }
  table.on_screen = false;
  return table;
}

AnswerTable band_table(const std::vector<FaultSheet>& sheets) {
  AnswerTable table{"bands",
                    "",
                    {fault_column(sheets),
                     shown("name", "in"),
                     data("stage"),
                     data("from_limits"),
                     data("unsafe_condition"),
                     shown("way", "pressure"),
                     shown("safe_pa", "no case slides up or down to", bars()),
                     shown("unsafe_pa", "the first slides by", bars()),
                     shown("safe_change_pa", "Δp there", bars(), 4, Need::wanted),
                     shown("unsafe_change_pa", "Δp by then", bars(), 4, Need::wanted),
                     data("surely_safe_pa"),
                     shown("reached_low_pa", "cases go from", bars(), 4, Need::extra),
                     shown("reached_high_pa", "to", bars(), 4, Need::extra),
                     data("safe_case"),
                     shown("unsafe_case", "case", {}, 9, Need::wanted),
                     shown("unsafe", "slide"),
                     shown("rows", "of"),
                     data("at_once"),
                     shown("undecided", "undecided by cells", {}, 4, Need::wanted),
                     shown("unknown", "no full history", {}, 4, Need::wanted)}};
  for (const FaultSheet& sheet : sheets) {
    for (const PressureBand& b : sheet.bands) {
      table.rows.push_back({sheet.fault,
                            words_of_stage(b.name),
                            b.stage,
                            b.of_limits,
                            b.unsafe_condition,
                            to_string(b.way),
                            cell_of(b.safe),
                            cell_of(b.unsafe),
                            cell_of(b.safe_change),
                            cell_of(b.unsafe_change),
                            cell_of(b.surely_safe),
                            number_cell(b.reached.low),
                            number_cell(b.reached.high),
                            case_cell(b.safe_case),
                            case_cell(b.unsafe_case),
                            b.n_unsafe,
                            b.n,
                            b.n_at_once,
                            b.n_undecided,
                            b.n_unknown});
    }
  }
  table.on_screen = false;
  return table;
}

/// "by 4 years (3 to 4), 180 to 160 bar, case 7".
AnswerCell moment_cell(const std::optional<StageSliding::Moment>& moment) {
  if (!moment) return {};
  const auto years = [](double time) { return format_number(time / kYear, 3); };
  const auto pressure = [](double value) { return format_number(value / kBar, 3); };
  std::string text = concat(years(moment->time_before), " to ", year_text(moment->time));
  if (!std::isnan(moment->pressure)) {
    text += concat(", ",
                   std::isnan(moment->pressure_before)
                       ? std::string()
                       : concat(pressure(moment->pressure_before), " to "),
                   pressure(moment->pressure), " bar");
  }
  return concat(text, ", case ", moment->position);
}

void add_moment_data(const std::optional<StageSliding::Moment>& moment,
                     std::vector<AnswerCell>& row) {
  if (!moment) {
    row.resize(row.size() + 5);
    return;
  }
  append(row,
         {case_cell(moment->position), number_cell(moment->time_before), number_cell(moment->time),
          number_cell(moment->pressure_before), number_cell(moment->pressure)});
}

AnswerTable stage_table(const std::vector<FaultSheet>& sheets) {
  const FaultSheet& any = sheets.front();
  AnswerTable table{
      "stages",
      concat("Sliding, stage by stage: ", share_word(any), ", and where it begins"),
      {fault_column(sheets), data("stage"), shown("label", "stage"),
       shown("estimate", "slides", percent(), 3), shown("low", "from", percent(), 3),
       shown("high", "to", percent(), 3), shown("holds", "true in"), shown("rows", "of"),
       shown("undecided", "undecided by cells", {}, 4, Need::wanted),
       shown("unknown", "no full history", {}, 4, Need::wanted)}};
  for (const char* which : {"first", "half", "last"}) {
    table.columns.push_back(shown(concat(which, "_words"),
                                  which == std::string("half")    ? "half of them by"
                                  : which == std::string("first") ? "first to slide"
                                                                  : "last",
                                  {}, 4, Need::wanted));
  }
  for (const char* which : {"first", "half", "last"})
    for (const char* key :
         {"_case", "_time_before_s", "_time_s", "_pressure_before_pa", "_pressure_pa"})
      table.columns.push_back(data(concat(which, key)));
  for (const FaultSheet& sheet : sheets) {
    for (const StageSliding& s : sheet.stages) {
      const ShareCounts& c = s.counts;
      std::vector<AnswerCell> row = {
          sheet.fault, s.stage, words_of_stage(s.stage), c.estimate(), s.bounds.low, s.bounds.high,
          c.n_holds,   c.n,     c.n_undecided,           c.n_unknown};
      append(row, {moment_cell(s.first), moment_cell(s.half), moment_cell(s.last)});
      for (const auto* one : {&s.first, &s.half, &s.last}) add_moment_data(*one, row);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

AnswerTable event_table(const std::vector<FaultSheet>& sheets) {
  AnswerTable table{"events", "", {fault_column(sheets)}};
  for (const char* key : {"plane_strain", "cases", "with_events", "ended_early", "case", "stage",
                          "time_s", "depth_m", "magnitude_mw", "moment_nm", "potency_m3",
                          "max_slip_m", "resolved", "evidence_holds", "largest_resolved_case",
                          "largest_resolved_moment_nm", "slip_case", "slip_m", "slip_moment_nm"})
    table.columns.push_back(shown(key, key));
  for (const FaultSheet& sheet : sheets) {
    for (const SheetEvents& one : sheet.events) {
      std::vector<AnswerCell> row = {sheet.fault, one.plane_strain, one.n_cases, one.n_with,
                                     one.n_early};
      if (one.largest) {
        const faultsim::SlipEvent& e = one.largest->event;
        append(row,
               {case_cell(one.largest->position), e.stage, e.time, e.depth, cell_of(e.magnitude),
                e.moment, e.potency, e.max_slip, e.resolved, e.evidence_holds});
      } else {
        row.resize(row.size() + 10);
      }
      if (one.largest_resolved) {
        append(row,
               {case_cell(one.largest_resolved->position), one.largest_resolved->event.moment});
      } else {
        row.resize(row.size() + 2);
      }
      append(row, {case_cell(one.slip_case), one.slip, one.moment});
      table.rows.push_back(std::move(row));
    }
  }
  table.on_screen = false;
  return table;
}

AnswerTable level_table(const std::vector<FaultSheet>& sheets) {
  const FaultSheet& any = sheets.front();
  AnswerTable table{
      "levels",
      concat("Escalation levels", any.table.title.empty() ? "" : ": " + any.table.title, ", ",
             share_word(any), " at each"),
      {fault_column(sheets), shown("level", "level"), shown("words", "meaning"),
       shown("condition", "where", {}, 4, Need::wanted), data("colour"),
       shown("estimate", "share", percent(), 3), shown("low", "from", percent(), 3),
       shown("high", "to", percent(), 3), shown("holds", "true in"), shown("rows", "of"),
       shown("undecided", "undecided by cells", {}, 4, Need::wanted),
       shown("unknown", "no full history", {}, 4, Need::wanted)}};
  for (const FaultSheet& sheet : sheets) {
    for (const LevelShare& one : sheet.levels) {
      const ShareCounts& c = one.counts;
      table.rows.push_back(
          {sheet.fault, one.level.name, one.level.words,
           one.level.condition.empty() ? "none of the others" : one.level.condition,
           to_string(one.level.colour), c.estimate(), one.bounds.low, one.bounds.high, c.n_holds,
           c.n, c.n_undecided, c.n_unknown});
    }
  }
  return table;
}

figure::RangeBars level_chart(const FaultSheet& sheet) {
  figure::RangeBars chart;
  chart.title = concat("Cases at each level, ", sheet.fault);
  chart.label = concat(share_word(sheet), ", %");
  chart.axis = figure::axis_between(chart.label, 0, 100, 5);
  for (const LevelShare& one : sheet.levels) {
    const ShareCounts& c = one.counts;
    figure::RangeBars::Row row{one.level.name, {}};
    const double estimate = 100 * c.estimate();
    if (!std::isnan(estimate)) row.ranges.push_back({0, estimate, fill_of(one.level.colour)});
    row.bounds = figure::Bounded{kNotKnown, 100 * one.bounds.low, 100 * one.bounds.high};
    row.note = std::isnan(estimate)
                   ? "not known"
                   : concat(format_percent(c.estimate()), " % (", format_percent(one.bounds.low),
                            " to ", format_percent(one.bounds.high), "), ", grouped(c.n_holds),
                            " of ", grouped(c.n_known()));
    chart.rows.push_back(std::move(row));
  }
  return chart;
}

/// Pressures that all cases went through without sliding, the load step in which the first slides,
/// and beyond.
figure::RangeBars band_chart(const FaultSheet& sheet) {
  figure::RangeBars chart;
  chart.title = concat("Pressures at which ", sheet.fault, " is safe");
  chart.label = concat("absolute pressure of the compartment beside ", sheet.fault, ", bar at ",
                       depth_text(sheet.datum));
  chart.key = {"no case slides", "the first begins to slide within", "some case slides", "",
               "not all cases go this far"};
  const CaseRange& start = sheet.initial.region_pressure;
  for (const PressureBand& b : sheet.bands) {
    std::string name = words_of_stage(b.name);
    if (!b.of_limits && b.way != PressureWay::holds)
      name += b.way == PressureWay::falls ? ", falling" : ", rising";
    figure::RangeBars::Row row{name, {}};
    const auto add = [&](double from, double to, figure::RangeFill fill) {
      if (std::isnan(from) || std::isnan(to)) return;
      row.ranges.push_back({std::min(from, to) / kBar, std::max(from, to) / kBar, fill});
    };
    const double end = b.way == PressureWay::falls ? b.reached.low : b.reached.high;
    if (b.safe && b.begin) add(*b.begin, *b.safe, figure::RangeFill::good);
    if (b.safe && b.unsafe) add(*b.safe, *b.unsafe, figure::RangeFill::between);
    if (b.unsafe) add(*b.unsafe, end, figure::RangeFill::bad);
    if (b.safe && !b.unsafe) add(*b.safe, end, figure::RangeFill::undecided);
    row.note = b.safe     ? concat("safe ", to_word(b.way), bar_text(*b.safe))
               : b.unsafe ? concat("unsafe by ", bar_text(*b.unsafe))
                          : "not known";
    chart.rows.push_back(std::move(row));
  }
  if (start.is_known()) {
    chart.marks.push_back({start.low / kBar, "initial"});
    if (start.varies()) chart.marks.push_back({start.high / kBar, ""});
  }
  return chart;
}

/// Of the first band with an end, else of the first.
std::string band_headline(const FaultSheet& sheet) {
  if (sheet.bands.empty()) return "";
  const auto limited = std::ranges::find_if(
      sheet.bands, [](const PressureBand& one) { return one.unsafe.has_value(); });
  const PressureBand& b = limited == sheet.bands.end() ? sheet.bands.front() : *limited;
  const std::string in = b.stage.empty() ? "" : concat(" in ", words_of_stage(b.stage));
  const char* all = b.of_limits ? " configurations" : " cases";
  if (b.safe && b.unsafe) {
    return concat("Safe", in, " ", to_word(b.way), bar_text(*b.safe), " (absolute, at ",
                  depth_text(sheet.datum), ") in all ", grouped(b.n), all, "; by ",
                  bar_text(*b.unsafe), " the first is not.", open_words(b));
  }
  if (b.safe) {
    return concat("Safe", in, " ", to_word(b.way), bar_text(*b.safe), " (absolute, at ",
                  depth_text(sheet.datum), "), as far as all ", grouped(b.n - b.n_unknown), all,
                  " go.", open_words(b));
  }
  return concat("No safe band", in, " is known.");
}

/// Without its full stop, to stand within a sentence.
std::string without_stop(std::string words) {
  if (words.ends_with('.')) words.pop_back();
  return words;
}

/// "Highest level reached: amber (words), in 6 of 24 cases; red is possible in 9 more."
std::string level_headline(const FaultSheet& sheet) {
  std::string text, possible;
  for (auto level = sheet.levels.rbegin(); level != sheet.levels.rend(); ++level) {
    const LevelShare& one = *level;
    const long n_open = one.counts.n_undecided + one.counts.n_unknown;
    if (one.counts.n_holds > 0) {
      text = concat("Highest level reached: ", one.level.name, " (", without_stop(one.level.words),
                    "), in ", grouped(one.counts.n_holds), " of ", grouped(one.counts.n_known()),
                    " cases");
      break;
    }
    if (n_open > 0) possible += concat("; ", one.level.name, " is possible in ", grouped(n_open));
  }
  return text.empty() ? concat("Which level is reached is not known", possible, ".")
                      : text + possible + ".";
}

ordered_json facts_of(const std::vector<FaultSheet>& sheets) {
  const FaultSheet& any = sheets.front();
  ordered_json texts = ordered_json::array();
  for (const FaultSheet& sheet : sheets) {
    std::vector<std::string> bands, headline = headline_of(sheet);
    for (const PressureBand& band : sheet.bands) bands.push_back(band_words(band));
    texts.push_back({{"fault", sheet.fault},
                     {"headline", headline},
                     {"place", place_words(sheet)},
                     {"bands", bands},
                     {"events", event_words(sheet)},
                     {"errors", sheet.errors},
                     {"provenance", sheet.provenance}});
  }
  return {{"campaign", any.campaign.name},
          {"title", any.title},
          {"field", any.base.title},
          {"confidence", any.confidence},
          {"is_probability", share_word(any) == "probability"},
          {"says", texts}};
}

/// The words and charts of one fault around its tables.
void add_sheet(const FaultSheet& sheet, Answer& answer) {
  const std::vector<FaultSheet> alone = {sheet};
  answer.headline = headline_of(sheet);
  for (const std::string& text : place_words(sheet)) answer.note(text);
  answer.add(place_table(alone));
  answer.add(initial_table(alone));
  answer.note(initial_note(sheet));
  answer.add(initial_numbers(alone));
  for (const PressureBand& band : sheet.bands) answer.note(band_words(band));
  answer.note(pressure_note(sheet));
  answer.blocks.emplace_back(AnswerChart(band_chart(sheet)));
  answer.add(band_table(alone));
  answer.add(stage_table(alone));
  answer.note(share_note(sheet));
  for (const std::string& text : event_words(sheet)) answer.note(text);
  answer.add(event_table(alone));
  answer.add(level_table(alone));
  answer.blocks.emplace_back(AnswerChart(level_chart(sheet)));
  for (const std::string& text : sheet.errors) answer.note(text);
  for (const std::string& text : sheet.provenance) answer.note(text);
}

}  // namespace

figure::RangeFill fill_of(LevelColour colour) {
  switch (colour) {
    case LevelColour::green:
      return figure::RangeFill::good;
    case LevelColour::amber:
      return figure::RangeFill::between;
    case LevelColour::red:
      return figure::RangeFill::bad;
    case LevelColour::grey:
      return figure::RangeFill::plain;
  }
  faultsim::throw_internal("known colour", "", __FILE__, __LINE__);
}

std::vector<std::string> headline_of(const FaultSheet& sheet) {
  std::vector<std::string> sentences;
  sentences.push_back(
      concat(sheet.fault, " slides in ",
             share_sentence(sheet.stages.back().counts, sheet.sampling, sheet.confidence), "."));
  for (const std::string& one : {band_headline(sheet), level_headline(sheet)})
    if (!one.empty()) sentences.push_back(one);
  return sentences;
}

std::string initial_note(const FaultSheet& sheet) {
  const CaseRange& chi = sheet.initial.chi_bar;
  return concat("Compression is positive, pressures are absolute. χ̄ of the whole fault is ",
                range_words(chi, plain(), 3), " before production, in ",
                counted(sheet.initial.n_chi_bar, "case.", "cases."));
}

std::string pressure_note(const FaultSheet& sheet) {
  const bool of_limits = std::ranges::any_of(sheet.bands, &PressureBand::of_limits);
  return concat(
      "Absolute pressures of the compartment beside the fault that changed more, referred "
      "to ",
      depth_text(sheet.datum), " along its fluid. ",
      of_limits ? "Limits were searched for, and both ends are cases; what lies between "
                  "the values tried is not known."
                : "Bands are by load steps of histories; what happens within a step is "
                  "not known.");
}

std::string share_note(const FaultSheet& sheet) {
  const std::string open = "what cells leave undecided and what has no full history may be either";
  if (share_word(sheet) == "probability") {
    return concat("From and to contain the probability with a confidence of ",
                  confidence_text(sheet.confidence), ": ", open, ".",
                  sheet.sampling.remark.empty() ? "" : " ", sheet.sampling.remark);
  }
  return concat("From and to: ", open, ". ", sheet.sampling.remark);
}

Answer to_answer(const std::vector<FaultSheet>& sheets) {
  FAULTSIM_DEMAND(!sheets.empty(), "a sheet");
  Answer answer;
  answer.facts = facts_of(sheets);
  if (sheets.size() == 1) {
    add_sheet(sheets.front(), answer);
    return answer;
  }
  for (const FaultSheet& sheet : sheets) answer.headline.push_back(headline_of(sheet).front());
  answer.note("Pressures are absolute, referred to the datum of each fault.");
  for (AnswerTable table :
       {place_table(sheets), initial_table(sheets), initial_numbers(sheets), band_table(sheets),
        stage_table(sheets), event_table(sheets), level_table(sheets)})
    answer.add(std::move(table));
  answer.note(share_note(sheets.front()));
  return answer;
}

}  // namespace faultsweep
