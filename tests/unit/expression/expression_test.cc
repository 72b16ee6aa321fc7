#include "campaign/expression/expression.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <map>
#include <random>

namespace faultsweep {
namespace {

using faultsim::Dimension;

const std::map<std::string, Value> kValues = {
    {"offset", 120.0},
    {"friction_angle", 0.25},
    {"chi_bar", 1.5},
    {"salt.youngs_modulus", 4e10},
    {"activated", true},
    {"rule", std::string("mean")},
    {"magnitude", std::monostate{}},
    {"zero", 0.0},
};

Symbols symbols() {
  const Type text{Kind::text, {}};
  return {
      {"offset", {"c_offset", number_type(Dimension::length)}},
      {"friction_angle", {"c_angle", number_type(Dimension::angle)}},
      {"chi_bar", {"c_chi", number_type(Dimension::number)}},
      {"salt.youngs_modulus", {"c_salt", number_type(Dimension::pressure)}},
      {"activated", {"c_activated", Type{Kind::boolean, {}}}},
      {"rule", {"c_rule", text}},
      {"magnitude", {"c_magnitude", number_type(Dimension::number)}},
      {"zero", {"c_zero", number_type(Dimension::number)}},
  };
}

Value evaluate(const std::string& text) {
  const Expression expression = Expression::parse(text, symbols());
  return expression.evaluate([&](std::size_t i) { return kValues.at(expression.names()[i]); });
}

std::string error_of(const std::string& text) {
  try {
    Expression::parse(text, symbols());
  } catch (const ExpressionError& error) {
    return error.message();
  }
  return "no error";
}

/// Metrics of faults and stages, as campaign/report spells them.
Symbols scoped_symbols() {
  Symbols all = symbols();
  const Type length = number_type(Dimension::length), flag{Kind::boolean, {}};
  all["slip"] = {"c_slip", length};
  all["slip in storage"] = {"c_slip_storage", length};
  all["F2.slip"] = {"c_f2", length};
  all["F2.slip in storage"] = {"c_f2_storage", length};
  all["F2.slides in the last stage"] = {"c_slides", flag};
  all["Fault 3.slip in storage"] = {"c_f3", length};
  return all;
}
const Scopes kScopes = {{"F2", "Fault 3"}, {"storage", "the last stage"}};

std::string scoped_sql(const std::string& text) {
  return Expression::parse(text, scoped_symbols(), kScopes).sql().text;
}
std::string scoped_error(const std::string& text) {
  try {
    Expression::parse(text, scoped_symbols(), kScopes);
  } catch (const ExpressionError& error) {
    return error.message();
  }
  return "no error";
}

/// A name that is not a word stands in quotes; the words of a text parameter stay words.
TEST(Expression, NamesInQuotes) {
  Symbols all = symbols();
  all["my offset"] = {"c_mine", number_type(Dimension::length)};
  all["/tier"] = {"c_tier", Type{Kind::text, {}}};
  all["/rule"] = {"c_other", Type{Kind::text, {}}};
  all["2 m"] = {"c_2m", number_type(Dimension::length)};
  const auto sql = [&](const std::string& text) {
    return Expression::parse(text, all, kScopes).sql().text;
  };
  EXPECT_EQ(sql("\"my offset\" > 50 m"), "(c_mine > ?)");
  EXPECT_EQ(sql("2 * 'my offset'"), "(? * c_mine)");
  EXPECT_EQ(sql("abs(\"my offset\") < \"2 m\""), "(abs(c_mine) < c_2m)");
  EXPECT_EQ(sql("\"/tier\" = \"standard\""), "(c_tier = ?)");
  EXPECT_EQ(sql("\"/tier\" = \"/rule\""), "(c_tier = c_other)");
  EXPECT_EQ(sql("rule = \"my offset\""), "(c_rule = ?)") << "text is compared with a text";
  EXPECT_EQ(sql("rule = \"/tier\""), "(c_rule = ?)") << "as it was where no such name is known";
  EXPECT_EQ(sql("\"my offset\" = \"/tier\""), "(? = c_tier)");
  const auto message_of = [&](const std::string& text) -> std::string {
    try {
      Expression::parse(text, all);
    } catch (const ExpressionError& wrong) {
      return wrong.message();
    }
    return "no error";
  };
  EXPECT_EQ(message_of("my_offset > 1 m"),
            "unknown name \"my_offset\"; did you mean \"my offset\"?\n    my_offset > 1 m\n    ^");
  EXPECT_EQ(message_of("\"my offset\" = \"wide\""),
            "my offset is a length, \"wide\" is text; compare things of one kind\n"
            "    \"my offset\" = \"wide\"\n                  ^");
}

TEST(Expression, NamesMayBeOfAFaultAndInAStage) {
  EXPECT_EQ(scoped_sql("slip in storage > 5 mm"), "(c_slip_storage > ?)");
  EXPECT_EQ(scoped_sql("F2.slip > slip in storage"), "(c_f2 > c_slip_storage)");
  EXPECT_EQ(scoped_sql("F2.slip in storage * 2 > F2.slip"), "((c_f2_storage * ?) > c_f2)");
  EXPECT_EQ(scoped_sql("not F2.slides in \"the last stage\" and activated"),
            "((NOT c_slides) AND c_activated)");
  EXPECT_EQ(scoped_sql("'Fault 3'.slip in 'storage' < 1 in"), "(c_f3 < ?)")
      << "a number may still be in inches";
  EXPECT_EQ(scoped_sql("rule = \"F2\""), "(c_rule = ?)") << "quoted text is text";
}

TEST(Expression, WrongFaultsAndStagesAreSaid) {
  EXPECT_EQ(scoped_error("F3.slip > 1 m"),
            "there is no fault \"F3\" in the results; did you mean F2? there are: F2, Fault 3\n"
            "    F3.slip > 1 m\n"
            "    ^");
  EXPECT_EQ(scoped_error("F2.slip in strage > 1 m"),
            "there is no stage \"strage\" in the results; did you mean storage? there are: "
            "storage, the last stage\n"
            "    F2.slip in strage > 1 m\n"
            "               ^");
  EXPECT_EQ(scoped_error("F2.slop in storage > 1 m").substr(0, 68),
            "unknown name \"F2.slop in storage\"; did you mean F2.slip in storage?\n");
  EXPECT_EQ(scoped_error("slip in").substr(0, 34), "a stage is missing after \"in\"; nam");
  EXPECT_EQ(scoped_error("slip in 3").substr(0, 34), "a stage is missing after \"in\"; nam");
  EXPECT_EQ(scoped_error("slip in 'storage").substr(0, 28), "this quote is not closed; ad");
  EXPECT_EQ(scoped_error("salt.youngs_modules > 1 Pa").substr(0, 36),
            "unknown name \"salt.youngs_modules\"; ");
}

TEST(Expression, Precedence) {
  EXPECT_EQ(evaluate("1 + 2 * 3"), Value(7.0));
  EXPECT_EQ(evaluate("(1 + 2) * 3"), Value(9.0));
  EXPECT_EQ(evaluate("-2 ^ 2"), Value(-4.0));
  EXPECT_EQ(evaluate("2 ^ -1"), Value(0.5));
  EXPECT_EQ(evaluate("2 ^ 3 ^ 2"), Value(512.0));
  EXPECT_EQ(evaluate("8 / 4 / 2"), Value(1.0));
  EXPECT_EQ(evaluate("10 - 4 - 3"), Value(3.0));
  EXPECT_EQ(evaluate("true or false and false"), Value(true));
  EXPECT_EQ(evaluate("not activated or activated"), Value(true));
  EXPECT_EQ(evaluate("not chi_bar > 2"), Value(true));
}

TEST(Expression, UnitsAreConverted) {
  EXPECT_EQ(evaluate("200 bar = 20 MPa"), Value(true));
  EXPECT_EQ(evaluate("\"30 deg\" = 30 deg"), Value(true));
  EXPECT_EQ(evaluate("0.1 km"), Value(100.0));
  EXPECT_EQ(evaluate("1e-3 m < 2 mm"), Value(true));
  EXPECT_EQ(evaluate("1 year = 365.25 d"), Value(true));
  EXPECT_EQ(evaluate("2000 kg/m3 * 9.81 m / (1 s)^2 * 100 m > 1.9 MPa"), Value(true));
  EXPECT_EQ(evaluate("\"1 Pa s\" / 1 s = 1 Pa"), Value(true));
  EXPECT_EQ(evaluate("40 GPa/salt.youngs_modulus"), Value(1.0));
}

TEST(Expression, Functions) {
  EXPECT_EQ(evaluate("min(3, 1, 2)"), Value(1.0));
  EXPECT_EQ(evaluate("max(offset, 1 km)"), Value(1000.0));
  EXPECT_EQ(evaluate("abs(-3 m)"), Value(3.0));
  EXPECT_EQ(evaluate("sqrt(16 m2) = 4 m"), Value(true));
  EXPECT_EQ(evaluate("log10(1000)"), Value(3.0));
  EXPECT_EQ(evaluate("exp(0)"), Value(1.0));
  EXPECT_NEAR(std::get<double>(evaluate("tan(45 deg)")), 1.0, 1e-15);
}

TEST(Expression, TextAndFlags) {
  EXPECT_EQ(evaluate("rule = \"mean\""), Value(true));
  EXPECT_EQ(evaluate("rule != 'mean'"), Value(false));
  EXPECT_EQ(evaluate("rule = \"2 m\""), Value(false)) << "a quantity beside text is text";
  EXPECT_EQ(evaluate("activated = true and offset > 100 m"), Value(true));
}

TEST(Expression, MissingIsThreeValued) {
  EXPECT_EQ(evaluate("magnitude + 1"), Value(std::monostate{}));
  EXPECT_EQ(evaluate("magnitude > 1"), Value(std::monostate{}));
  EXPECT_EQ(evaluate("magnitude > 1 and chi_bar > 2"), Value(false));
  EXPECT_EQ(evaluate("chi_bar > 1 or magnitude > 1"), Value(true));
  EXPECT_EQ(evaluate("magnitude > 1 or chi_bar > 1"), Value(true));
  EXPECT_EQ(evaluate("not magnitude > 1"), Value(std::monostate{}));
  EXPECT_EQ(evaluate("1 / zero"), Value(std::monostate{}));
  EXPECT_EQ(evaluate("sqrt(-1)"), Value(std::monostate{}));
  const auto condition = Expression::parse("magnitude > 1", symbols());
  EXPECT_FALSE(condition.holds([](std::size_t) { return Value(); }));
}

TEST(Expression, NamesOnceInOrder) {
  const auto expression =
      Expression::parse("chi_bar > 1 and offset > 1 m and chi_bar < 3", symbols());
  EXPECT_EQ(expression.names(), (std::vector<std::string>{"chi_bar", "offset"}));
  EXPECT_EQ(expression.type().kind, Kind::boolean);
}

TEST(Expression, DimensionsMultiply) {
  const auto area = Expression::parse("offset ^ 2", symbols());
  EXPECT_EQ(area.type(), number_type(Dimension::area));
  const auto force = Expression::parse("salt.youngs_modulus * offset ^ 2 * offset", symbols());
  EXPECT_EQ(force.type(), number_type(Dimension::moment));
  EXPECT_EQ(describe(Expression::parse("offset / 1 s", symbols()).type().units), "in m s-1");
}

struct Wrong {
  const char* text;
  const char* message;
};
class ExpressionErrors : public testing::TestWithParam<Wrong> {};

TEST_P(ExpressionErrors, SayWhatAndWhere) {
  EXPECT_EQ(error_of(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, ExpressionErrors,
    testing::Values(
        Wrong{"ofset > 150 m",
              "unknown name \"ofset\"; did you mean offset?\n    ofset > 150 m\n    ^"},
        Wrong{"chi_bar > 1 and youngs_modulus > 1 GPa",
              "unknown name \"youngs_modulus\"; did you mean salt.youngs_modulus?\n"
              "    chi_bar > 1 and youngs_modulus > 1 GPa\n                    ^"},
        Wrong{"q > 1",
              "unknown name \"q\"; known names: activated, chi_bar, friction_angle, magnitude, "
              "offset, rule, salt.youngs_modulus, zero\n    q > 1\n    ^"},
        Wrong{"offset > 150",
              "offset is a length, 150 is a plain number; write 150 m\n"
              "    offset > 150\n             ^"},
        Wrong{"friction_angle < 15 m",
              "friction_angle is an angle, 15 m is a length; both sides need the same dimension\n"
              "    friction_angle < 15 m\n                     ^"},
        Wrong{"offset + 3 deg > 1 m",
              "offset is a length, 3 deg is an angle; both sides need the same dimension\n"
              "    offset + 3 deg > 1 m\n             ^"},
        Wrong{"offset > 1 m < 2 m",
              "comparisons cannot be chained; write a < b and b < c\n"
              "    offset > 1 m < 2 m\n                 ^"},
        Wrong{"offset > 3 offset",
              "unknown unit \"offset\"; write 3 * offset\n"
              "    offset > 3 offset\n               ^"},
        Wrong{"offset > 3 furlngs",
              "unknown unit \"furlngs\"; some known units: m, km, m2, bar, MPa, GPa, deg, "
              "year\n    offset > 3 furlngs\n               ^"},
        Wrong{"activated && chi_bar > 1",
              "\"&&\" is unknown; write and\n    activated && chi_bar > 1\n              ^"},
        Wrong{"(chi_bar > 1", "this \"(\" is not closed; add \")\"\n    (chi_bar > 1\n    ^"},
        Wrong{"chi_bar > 1)",
              "\")\" closes nothing; remove it or add \"(\" before\n    chi_bar > 1)\n"
              "               ^"},
        Wrong{"chi_bar >",
              "the expression ends too early; add the value that is missing here\n    chi_bar >\n"
              "             ^"},
        Wrong{"", "the expression is empty; write a condition such as offset > 100 m\n    \n    ^"},
        Wrong{"chi_bar and activated",
              "chi_bar is a plain number where a condition is needed; compare it with something, "
              "for example > 0\n    chi_bar and activated\n    ^"},
        Wrong{"rule > \"max\"",
              "rule is text, which has no order; compare it with = or !=\n    rule > \"max\"\n"
              "         ^"},
        Wrong{"rule = 3",
              "rule is text, 3 is a plain number; compare things of one kind\n"
              "    rule = 3\n           ^"},
        Wrong{"rule = \"mean",
              "this quote is not closed; add the closing quote\n"
              "    rule = \"mean\n           ^"},
        Wrong{"tan(30)",
              "30 is a plain number, but the function takes an angle; write for example "
              "tan(30 deg)\n    tan(30)\n        ^"},
        Wrong{"log10(offset)",
              "offset is a length, but the function takes a plain number; divide "
              "by a unit first\n    log10(offset)\n          ^"},
        Wrong{"sqrt(offset)",
              "offset is a length, which has no square root with a unit; divide by "
              "a unit first\n    sqrt(offset)\n         ^"},
        Wrong{"offset ^ 0.5 > 1 m",
              "offset is a length, so its power must be a whole number; write "
              "for example ^2, or divide by a unit first\n"
              "    offset ^ 0.5 > 1 m\n             ^"},
        Wrong{"squrt(4)", "unknown function \"squrt\"; did you mean sqrt?\n    squrt(4)\n    ^"},
        Wrong{"max(4)", "max takes two or more values, not 1; write max(a, b)\n    max(4)\n    ^"},
        Wrong{"chi_bar > 1; drop table runs",
              "unexpected character; remove it\n"
              "    chi_bar > 1; drop table runs\n"
              "               ^"},
        Wrong{"\"χ\" = rule and χ",
              "unexpected character; remove it\n"
              "    \"χ\" = rule and χ\n                   ^"},
        Wrong{"1e999 > chi_bar",
              "\"1e999\" overflows; write a finite number\n"
              "    1e999 > chi_bar\n    ^"}));

TEST(Expression, DeepNestingIsRefused) {
  EXPECT_NE(error_of(std::string(5000, '(') + "1").find("nested too deeply"), std::string::npos);
  EXPECT_NE(error_of(std::string(5000, '-') + "1").find("nested too deeply"), std::string::npos);
  std::string nots;
  for (int i = 0; i < 2000; ++i) nots += "not ";
  EXPECT_NE(error_of(nots + "true").find("nested too deeply"), std::string::npos);
}

TEST(Expression, SumsAndListsAreAsLongAsSqlTakesThem) {
  const auto chain = [](int n, const std::string& between) {
    std::string text = "zero";
    for (int i = 1; i < n; ++i) text += between + "zero";
    return text;
  };
  EXPECT_EQ(error_of(chain(200, "+")), "no error");
  EXPECT_NE(error_of(chain(201, "+")).find("there are more than 200 terms here"),
            std::string::npos);
  EXPECT_EQ(error_of("max(" + chain(100, ",") + ")"), "no error");
  EXPECT_NE(error_of("max(" + chain(101, ",") + ")").find("max takes at most 100 values"),
            std::string::npos);
}

TEST(Expression, SqlBindsEveryLiteral) {
  const auto sql =
      Expression::parse("not (offset > 150 m and rule = \"x'); drop\") or abs(-chi_bar) ^ 2 > 1",
                        symbols())
          .sql();
  EXPECT_EQ(sql.text, "((NOT ((c_offset > ?) AND (c_rule = ?))) OR (pow(abs((-c_chi)), ?) > ?))");
  EXPECT_EQ(sql.parameters, (std::vector<Value>{150.0, std::string("x'); drop"), 2.0, 1.0}));
}

/// Runs the fragment in SQLite with the same values and gives what it gives.
class Database {
 public:
  Database() {
    EXPECT_EQ(sqlite3_open(":memory:", &db_), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db_,
                           "CREATE TABLE t (c_offset REAL, c_angle REAL, c_chi REAL, c_salt REAL,"
                           "c_activated INTEGER, c_rule TEXT, c_magnitude REAL, c_zero REAL);"
                           "INSERT INTO t VALUES (120, 0.25, 1.5, 4e10, 1, 'mean', NULL, 0)",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
  }
  ~Database() { sqlite3_close(db_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// The number (booleans as 0 and 1), or nothing for NULL.
  std::optional<double> run(const SqlFragment& fragment) {
    sqlite3_stmt* statement = nullptr;
    const std::string text = "SELECT " + fragment.text + " FROM t";
    EXPECT_EQ(sqlite3_prepare_v2(db_, text.c_str(), -1, &statement, nullptr), SQLITE_OK) << text;
    for (std::size_t i = 0; i < fragment.parameters.size(); ++i) {
      const int position = static_cast<int>(i) + 1;
      const Value& value = fragment.parameters[i];
      if (const auto* real = std::get_if<double>(&value)) {
        sqlite3_bind_double(statement, position, *real);
      } else if (const auto* flag = std::get_if<bool>(&value)) {
        sqlite3_bind_int(statement, position, *flag ? 1 : 0);
      } else {
        sqlite3_bind_text(statement, position, std::get<std::string>(value).c_str(), -1,
                          SQLITE_TRANSIENT);
      }
    }
    EXPECT_EQ(sqlite3_step(statement), SQLITE_ROW);
    std::optional<double> result;
    if (sqlite3_column_type(statement, 0) != SQLITE_NULL) {
      result = sqlite3_column_double(statement, 0);
    }
    sqlite3_finalize(statement);
    return result;
  }

 private:
  sqlite3* db_ = nullptr;
};

std::optional<double> as_number(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1.0 : 0.0;
  return std::nullopt;
}

/// A random well-typed expression of plain numbers or conditions.
std::string random_expression(std::mt19937& random, bool condition, int depth) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto sub = [&](bool kind) { return random_expression(random, kind, depth - 1); };
  if (!condition) {
    static const char* leaves[] = {"chi_bar", "zero", "magnitude", "2", "0.5", "(offset / 1 m)"};
    if (depth <= 0) return leaves[pick(6)];
    switch (pick(8)) {
      case 0:
        return "(" + sub(false) + " + " + sub(false) + ")";
      case 1:
        return "(" + sub(false) + " - " + sub(false) + ")";
      case 2:
        return "(" + sub(false) + " * " + sub(false) + ")";
      case 3:
        return "(" + sub(false) + " / " + sub(false) + ")";
      case 4:
        return "-(" + sub(false) + ")";
      case 5:
        return "min(" + sub(false) + ", " + sub(false) + ", 3)";
      case 6:
        return "sqrt(" + sub(false) + ")";
      default:
        return "abs(" + sub(false) + ")";
    }
  }
  static const char* comparisons[] = {"<", "<=", ">", ">=", "=", "!="};
  if (depth <= 0) return pick(2) == 0 ? "activated" : "rule = 'mean'";
  switch (pick(4)) {
    case 0:
      return "(" + sub(true) + " and " + sub(true) + ")";
    case 1:
      return "(" + sub(true) + " or " + sub(true) + ")";
    case 2:
      return "not (" + sub(true) + ")";
    default:
      return "(" + sub(false) + " " + comparisons[pick(6)] + " " + sub(false) + ")";
  }
}

TEST(Expression, SqlAgreesWithEvaluate) {
  Database database;
  std::mt19937 random(20240607);
  int n_present = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = random_expression(random, i % 2 == 0, 1 + i % 5);
    const auto here = as_number(evaluate(text));
    const auto there = database.run(Expression::parse(text, symbols()).sql());
    ASSERT_EQ(here.has_value(), there.has_value()) << text;
    if (!here) continue;
    ++n_present;
    ASSERT_DOUBLE_EQ(*here, *there) << text;
  }
  EXPECT_GT(n_present, 1000);
}

/// In the middle of a statement, as deep as the store's are.
SqlFragment as_column(SqlFragment sql) {
  sql.text = "(SELECT x.c_offset FROM t x WHERE x.c_zero = 0 AND x.c_chi = 1.5 AND iif(" +
             sql.text + ", 1, 0))";
  return sql;
}

TEST(Expression, SqlTakesLongChainsAsEvaluateDoes) {
  Database database;
  const struct {
    const char *term, *between;
    int n;
  } chains[] = {{"chi_bar > 2", " or ", 600},   {"chi_bar < 2", " and ", 600},
                {"0.1 * chi_bar", " + ", 200},  {"0.1", " / ", 200},
                {"chi_bar", " / 1.25 * ", 100}, {"activated and zero > 1", " or ", 350}};
  for (const auto& [term, between, n] : chains) {
    std::string text = term;
    for (int i = 1; i < n; ++i) text += std::string(between) + term;
    const SqlFragment sql = Expression::parse(text, symbols()).sql();
    EXPECT_EQ(as_number(evaluate(text)), database.run(sql)) << "to the last bit: " << text;
    database.run(as_column(sql));
  }
  std::string mixed = "(chi_bar - 0.3)";
  for (int i = 0; i < 80; ++i) mixed = mixed + (i % 2 == 0 ? " - 0.7" : " + 0.1");
  EXPECT_EQ(as_number(evaluate(mixed)), database.run(Expression::parse(mixed, symbols()).sql()));
  const std::string right = "(1 - (2 - 3)) / (2 / (3 / 4))";
  EXPECT_EQ(database.run(Expression::parse(right, symbols()).sql()), 0.75);
}

/// Of whatever nesting, what is not refused as it is read is not refused by SQLite either.
TEST(Expression, WhatIsNotTooDeepIsTakenBySql) {
  Database database;
  const struct {
    const char *begin, *end;
    bool is_condition;
  } levels[] = {{"not ", "", true},
                {"-", "", false},
                {"(activated or ", ")", true},
                {"(", " and activated)", true},
                {"(2 + ", ")", false},
                {"(", " ^ 2)", false},
                {"max(1, ", ")", false},
                {"abs(", ")", false},
                {"2 / (3 * ", ")", false},
                {"(not activated and (activated or ", "))", true}};
  for (const auto& [begin, end, is_condition] : levels) {
    std::string text = is_condition ? "activated" : "chi_bar";
    int n_levels = 0;
    for (; n_levels < 300; ++n_levels) {
      const std::string deeper = begin + text + end;
      try {
        database.run(as_column(Expression::parse(deeper, symbols()).sql()));
      } catch (const ExpressionError& error) {
        EXPECT_NE(error.message().find("nested too deeply"), std::string::npos);
        break;
      }
      ASSERT_FALSE(HasFailure()) << deeper;
      text = deeper;
    }
    EXPECT_GE(n_levels, 6) << text;
    EXPECT_LT(n_levels, 300) << text;
  }
}

TEST(Expression, RandomBytesNeverCrash) {
  std::mt19937 random(7);
  static const std::string letters = "offset chi_bar 1.5e m()<>=+-*/^\"',.andornt\xcf\x87";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (auto n = random() % 30; n > 0; --n) text += letters[random() % letters.size()];
    try {
      Expression::parse(text, symbols());
    } catch (const ExpressionError& error) {
      ASSERT_LE(error.position(), text.size());
    }
  }
}

/// Whatever a fault or stage is called, it can be spelled.
TEST(SpelledName, ComesBackFromEveryName) {
  std::mt19937 random(11);
  const std::string letters = "ab1_ .,\"\"''\\()=+-<>\t\xC3\xA9";
  const auto name = [&] {
    std::string text;
    for (auto n = 1 + random() % 8; n > 0; --n) text += letters[random() % letters.size()];
    return text;
  };
  for (int i = 0; i < 20000; ++i) {
    const std::string fault = name(), stage = name();
    const std::string metric = fault + ".slides in " + stage;
    const Symbols known = {{metric, {"column", Type{Kind::boolean, {}}}}};
    const std::string text = spelled_name(fault) + ".slides in " + spelled_name(stage);
    const Expression read = Expression::parse(text + " and true", known, {{fault}, {stage}});
    ASSERT_EQ(read.names(), std::vector<std::string>{metric}) << text;
  }
  EXPECT_EQ(spelled_name("F2"), "F2");
  EXPECT_EQ(spelled_name("Fault 2"), "\"Fault 2\"");
  EXPECT_EQ(spelled_name("5\""), "'5\"'");
  EXPECT_EQ(spelled_name("5\" 'old'"), "\"5\"\" 'old'\"");
}

TEST(Nearest, FarWordsAreNotSuggested) {
  EXPECT_EQ(nearest("ofsfet", {"offset", "other"}), "offset");
  EXPECT_EQ(nearest("banana", {"offset", "other"}), std::nullopt);
  EXPECT_EQ(nearest("Offset", {"offset"}), "offset");
}

}  // namespace
}  // namespace faultsweep
