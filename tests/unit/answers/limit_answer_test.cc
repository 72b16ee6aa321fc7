// What is said of limits, as one value in four renderings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/answers/limit_table.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using faultsim::InputError;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kBar = 1e5;  // Pa

/// Storage pressures from -110 bar up, tried each 10 bar and, where it changes, to 1 bar.
LimitSearch storage() {
  LimitSearch limit;
  limit.name = "storage_pressure";
  limit.faults = {"F2"};
  limit.stage = "gas_storage";
  limit.tolerance = 1;
  limit.unit = "bar";
  limit.dimension = faultsim::Dimension::pressure;
  for (int k = 0; k <= 11; ++k) limit.scan.push_back(-110 + 10 * k);
  return limit;
}

SearchPoint point(double value, PointState state, bool resolved = true) {
  return {value, state, resolved, 200 + static_cast<long>(value)};
}

/// Of points each 10 bar, unsafe above `limit`, which the last ones narrow to 1 bar; those within
/// `unsure` of it are not resolved.
LimitCell searched(double limit, double unsure = 0) {
  std::vector<SearchPoint> points;
  const auto add = [&](double value) {
    const bool is_sure = std::abs(value - limit) > unsure;
    points.push_back(point(value, value > limit ? PointState::unsafe : PointState::safe, is_sure));
  };
  for (const double value : storage().scan) add(value);
  const double safe = std::floor(limit), whole = std::floor(limit / 10) * 10;
  if (limit > -110 && limit < 0) {
    if (safe != whole) add(safe);
    if (safe + 1 != whole + 10) add(safe + 1);
  }
  return {judge(points, true, 1), std::nullopt};
}

LimitRow row(long configuration, const std::string& offset, const std::string& angle,
             LimitCell cell, std::optional<double> width = std::nullopt) {
  LimitRow one;
  one.configuration = configuration;
  one.settings = {offset, angle};
  one.fault = "F2";
  one.cells = {std::move(cell)};
  one.width = width;
  return one;
}

LimitTable table_of(std::vector<LimitRow> rows) {
  LimitTable table;
  table.campaign.name = "storage-limit";
  table.parameters = {"offset", "friction_angle"};
  table.limits = {storage()};
  table.rows = std::move(rows);
  table.is_finished = true;
  return table;
}

/// A limit, one that the cells leave open, none because all is safe, none because nothing is.
LimitTable all_kinds() {
  LimitTable table = table_of({row(1, "200 m", "20 deg", searched(-200), 0),
                               row(2, "200 m", "24 deg", searched(-70.5), 39),
                               row(3, "100 m", "20 deg", searched(-30.5, 20), 79),
                               row(4, "100 m", "24 deg", searched(10), 110)});
  table.rows[1].cells[0]->datum = DatumPressure{"east", 2000, 150e5};
  table.rows[3].is_open = true;
  return table;
}

TEST(LimitAnswer, SaysWhatIsSafeInWordsThatAreNotReadAsTheirContrary) {
  const Answer answer = to_answer(all_kinds(), 0);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("unsafe already at -110 bar"));
  EXPECT_THAT(text, HasSubstr("[-71, -70] bar"));
  EXPECT_THAT(text, HasSubstr("safe in the whole range tried (-110 to 0 bar)"));
  EXPECT_THAT(text, HasSubstr("≥ 110 bar"));
  for (const char* word : {"never", "always"}) EXPECT_THAT(text, Not(HasSubstr(word)));
  EXPECT_EQ(
      answer.headline.at(0),
      "storage_pressure: 1 of 4 is safe in the whole range tried (-110 to 0 bar), 1 is unsafe "
      "already at -110 bar, 2 are safe up to a limit. The first limit, starting from -110 bar, is "
      "that of F2 at offset = 200 m, friction_angle = 24 deg: safe at -71 bar, unsafe at -70 "
      "bar.");
}

/// Both ends of the bracket of the third are not resolved: it may be anywhere between -60 and -10.
TEST(LimitAnswer, TellsWhatIsSureFromWhatCameOut) {
  const Answer answer = to_answer(all_kinds(), 0);
  const auto rows = render_json(answer).at("limits");
  EXPECT_EQ(rows[1].at("resolved"), true);
  EXPECT_EQ(rows[1].at("surely_safe").get<double>(), -71 * kBar);
  EXPECT_EQ(rows[2].at("safe").get<double>(), -31 * kBar);
  EXPECT_EQ(rows[2].at("unsafe").get<double>(), -30 * kBar);
  EXPECT_EQ(rows[2].at("resolved"), false);
  EXPECT_EQ(rows[2].at("surely_safe").get<double>(), -60 * kBar);
  EXPECT_EQ(rows[2].at("surely_unsafe").get<double>(), -10 * kBar);
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("[-60, -10] bar"));
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("between which it is undecided"));
  // One end that is open is enough.
  std::vector<SearchPoint> points = searched(-30.5).finding.points;
  for (SearchPoint& one : points) one.resolved = one.value != -30;
  const Answer half = to_answer(
      table_of({row(1, "100 m", "20 deg", {judge(points, true, 1), std::nullopt}, 79)}), 0);
  EXPECT_EQ(render_json(half).at("limits")[0].at("resolved"), false);
  EXPECT_EQ(render_json(half).at("limits")[0].at("surely_unsafe").get<double>(), -20 * kBar);
  LimitTable sure = all_kinds();
  sure.rows.erase(sure.rows.begin() + 2);
  EXPECT_THAT(render_text(to_answer(sure, 0), 1000), Not(HasSubstr("undecided")));
  // One limit alone, and open: the headline says so.
  const Answer one = to_answer(table_of({row(1, "100 m", "20 deg", searched(-30.5, 20), 79)}), 0);
  EXPECT_THAT(one.headline.at(0),
              HasSubstr("safe at -31 bar, unsafe at -30 bar; surely safe at -60 bar, surely unsafe "
                        "at -10 bar."));
}

/// Pieces of a row of the chart as "safe end, other end, fill".
std::vector<std::array<double, 3>> pieces(const Answer& answer, std::size_t row) {
  std::vector<std::array<double, 3>> all;
  for (const AnswerBlock& block : answer.blocks) {
    const auto* chart = std::get_if<AnswerChart>(&block);
    if (chart == nullptr) continue;
    for (const auto& one : std::get<faultsim::figure::RangeBars>(*chart).rows.at(row).ranges)
      all.push_back({one.from, one.to, static_cast<double>(one.fill)});
  }
  return all;
}

/// 0: safe, 1: turns within, 2: unsafe, 4: not known or not resolved.
TEST(LimitAnswer, DrawsWhatWasTried) {
  using Pieces = std::vector<std::array<double, 3>>;
  const Answer answer = to_answer(all_kinds(), 0);
  EXPECT_EQ(pieces(answer, 0), (Pieces{{-110, 0, 2}}));
  EXPECT_EQ(pieces(answer, 1), (Pieces{{-110, -71, 0}, {-71, -70, 1}, {-70, 0, 2}}));
  EXPECT_EQ(pieces(answer, 2), (Pieces{{-110, -60, 0}, {-60, -10, 4}, {-10, 0, 2}}))
      << "between what is surely safe and surely unsafe";
  EXPECT_EQ(pieces(answer, 3), (Pieces{{-110, 0, 0}}));
  // A value without a result is known on neither side, nor is what was not tried.
  std::vector<SearchPoint> points = {point(-110, PointState::safe), point(-60, PointState::safe),
                                     point(-50, PointState::unknown), point(-40, PointState::safe),
                                     point(-30, PointState::safe)};
  const LimitTable table =
      table_of({row(1, "100 m", "20 deg", {judge(points, true, 1), std::nullopt}, 79)});
  EXPECT_EQ(pieces(to_answer(table, 0), 0),
            (Pieces{{-110, -60, 0}, {-60, -40, 4}, {-40, -30, 0}, {-30, 0, 4}}));
  const std::string svg = first_chart(answer);
  for (const char* text : {">200 m, 24 deg, F2<", ">[-71, -70]<", ">[-31, -30] ?<",
                           "storage_pressure, bar (rows: offset, friction_angle, fault)<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_EQ(first_chart(to_answer(table_of({}), 0)), "") << "nothing was tried";
}

TEST(LimitAnswer, OfARangeThatIsSafeSaysHowFarThatIsSure) {
  const Answer answer = to_answer(table_of({row(1, "100 m", "24 deg", searched(5, 30), 110)}), 0);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("safe in the whole range tried (-110 to 0 bar)"));
  EXPECT_THAT(text, HasSubstr("safe to -30 bar"));
  EXPECT_EQ(render_json(answer).at("limits")[0].at("resolved"), false);
}

TEST(LimitAnswer, KeepsEveryCrossingOfWhatIsNotMonotone) {
  const std::vector<SearchPoint> points = {
      point(-110, PointState::safe),  point(-60, PointState::safe), point(-59, PointState::unsafe),
      point(-40, PointState::unsafe), point(-39, PointState::safe), point(0, PointState::safe)};
  const Answer answer = to_answer(
      table_of({row(1, "100 m", "24 deg", {judge(points, true, 1), std::nullopt}, 50)}), 0);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 1000),
              HasSubstr("[-60, -59] bar, non-monotone: unsafe -59 to -40 bar"));
  const auto crossings = render_json(answer).at("crossings");
  ASSERT_EQ(crossings.size(), 2u);
  EXPECT_EQ(crossings[1].at("after").get<double>(), -39 * kBar);
  EXPECT_EQ(crossings[1].at("safe_first"), false);
}

TEST(LimitAnswer, WhatIsNotKnownHasNoRank) {
  std::vector<SearchPoint> points = searched(-70.5).finding.points;
  points[0].state = PointState::unknown;
  const LimitTable table = table_of({row(1, "100 m", "24 deg", {judge(points, true, 1), {}})});
  const Answer answer = to_answer(table, 0);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("not known: no result at the safe end"));
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("1 case not known"));
  EXPECT_TRUE(render_json(answer).at("limits")[0].at("safe").is_null());
}

TEST(LimitAnswer, AScreenHasTheFirstRowsAndFilesAll) {
  const Answer answer = to_answer(all_kinds(), 2);
  EXPECT_THAT(render_text(answer), HasSubstr("and 2 more rows"));
  EXPECT_EQ(render_json(answer).at("limits").size(), 4u);
  EXPECT_EQ(testing::lines_of(render_csv(table_named(answer, ""))).size(), 5u);
  EXPECT_THAT(render_csv(table_named(answer, "limits")),
              HasSubstr("2,200 m,24 deg,F2,storage_pressure,Pa,limit,\"[-71, -70] bar\",-7100000,"
                        "-7e+06,-71 bar,-70 bar,129,130,1,1,-7100000,-7e+06,east,2000,"
                        "1.5e+07,"));
}

TEST(LimitAnswer, AMapHasBracketsAndUnmistakableWords) {
  const Answer answer = map_answer(all_kinds(), "offset", "friction_angle");
  testing::expect_same_renderings(answer);
  const std::vector<std::string> lines = testing::lines_of(render_text(answer, 100));
  EXPECT_THAT(lines, ::testing::Contains("friction_angle  200 m       100 m"));
  EXPECT_THAT(lines, ::testing::Contains("20 deg          all unsafe  [-31, -30] ?"));
  EXPECT_THAT(lines, ::testing::Contains("24 deg          [-71, -70]  all safe"));
  EXPECT_THAT(render_text(answer, 1000),
              HasSubstr("all safe: safe in the whole range tried (-110 to 0 bar); all unsafe: "
                        "unsafe already at -110 bar"));
  EXPECT_EQ(render_json(answer).at("limits"), render_json(to_answer(all_kinds(), 0)).at("limits"));
  EXPECT_THROW(map_answer(all_kinds(), "offset", "cohesion"), InputError);
  EXPECT_THROW(map_answer(all_kinds(), "offset", "offset"), InputError) << "others vary";
}

/// A production limit goes down, a storage limit up: both stand in the row of their fault.
TEST(LimitAnswer, TwoLimitsStandSideBySide) {
  LimitTable table = all_kinds();
  LimitSearch production = storage();
  production.name = "production_pressure";
  std::reverse(production.scan.begin(), production.scan.end());
  table.limits.push_back(production);
  for (LimitRow& one : table.rows) one.cells.emplace_back(std::nullopt);
  table.rows[0].cells[1] =
      LimitCell{judge({point(0, PointState::safe), point(-59, PointState::safe),
                       point(-60, PointState::unsafe), point(-110, PointState::unsafe)},
                      false, 1),
                std::nullopt};
  const Answer answer = to_answer(table, 0);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("production_pressure [safe, unsafe]"));
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("[-59, -60] bar"));
  EXPECT_EQ(render_json(answer).at("limits").size(), 5u);
  ASSERT_EQ(answer.headline.size(), 2u);
  EXPECT_THAT(answer.headline[1], HasSubstr("The first limit, starting from 0 bar,"));
}

}  // namespace
}  // namespace faultsweep
