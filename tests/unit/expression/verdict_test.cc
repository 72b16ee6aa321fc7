// Conditions that may be undecided: what SQLite makes of both fragments, against the values that
// names may have, tried out one by one.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "campaign/expression/expression.h"

namespace faultsweep {
namespace {

const std::vector<std::string> kFlags = {"p", "q", "r"};
const std::vector<std::string> kNumbers = {"a", "b", "c", "d"};

/// What a name stands for in one trial.
struct Known {
  Value value;
  bool resolved = true;
  double error = 0;
};
using Row = std::map<std::string, Known>;

/// Columns are called like names, and "u_" and the name says that it is not resolved.
Symbols symbols_of(const Row& row) {
  Symbols symbols;
  for (const std::string& one : kFlags)
    symbols[one] = {one, Type{Kind::boolean, {}}, "u_" + one + " = 1"};
  for (const std::string& one : kNumbers)
    symbols[one] = {one, Type{}, "u_" + one + " = 1", row.at(one).error};
  symbols["w"] = {"w", Type{Kind::text, {}}, "u_w = 1"};
  return symbols;
}

class Table {
 public:
  Table() {
    EXPECT_EQ(sqlite3_open(":memory:", &db_), SQLITE_OK);
    std::string columns = "w TEXT, u_w INTEGER";
    for (const std::string& one : kFlags) columns += ", " + one + " INTEGER, u_" + one + " INTEGER";
    for (const std::string& one : kNumbers) columns += ", " + one + " REAL, u_" + one + " INTEGER";
    columns += ", whole INTEGER, seven INTEGER";
    run("CREATE TABLE t (" + columns + ")", {});
  }
  ~Table() { sqlite3_close(db_); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  void hold(const Row& row) {
    run("DELETE FROM t", {});
    std::string columns = "whole, seven", marks = "2, 7";
    std::vector<Value> values;
    for (const auto& [name, known] : row) {
      columns += ", " + name + ", u_" + name;
      marks += ", ?, ?";
      values.push_back(known.value);
      // A condition that is missing counts as resolved.
      values.push_back(known.resolved ? (values.size() % 3 == 0 ? Value() : Value(false))
                                      : Value(true));
    }
    run("INSERT INTO t (" + columns + ") VALUES (" + marks + ")", values);
  }
  /// 0, 1 or nothing for missing.
  std::optional<double> of_row(const SqlFragment& fragment) {
    return run("SELECT " + fragment.text + " FROM t", fragment.parameters);
  }
  bool holds(const SqlFragment& fragment) { return of_row(fragment).value_or(0) != 0; }
  std::string verdict(const VerdictSql& sql) {
    const bool certain = holds(sql.certain), possible = holds(sql.possible);
    EXPECT_TRUE(possible || !certain) << sql.certain.text;
    return certain ? "yes" : possible ? "undecided" : "no";
  }

 private:
  std::optional<double> run(const std::string& text, const std::vector<Value>& values) {
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(db_, text.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << text << sqlite3_errmsg(db_);
    int position = 0;
    for (const Value& value : values) {
      ++position;
      if (const auto* real = std::get_if<double>(&value)) {
        sqlite3_bind_double(statement, position, *real);
      } else if (const auto* flag = std::get_if<bool>(&value)) {
        sqlite3_bind_int(statement, position, *flag ? 1 : 0);
      } else if (const auto* words = std::get_if<std::string>(&value)) {
        sqlite3_bind_text(statement, position, words->c_str(), -1, SQLITE_TRANSIENT);
      }
    }
    const int code = sqlite3_step(statement);
    EXPECT_TRUE(code == SQLITE_ROW || code == SQLITE_DONE) << text << sqlite3_errmsg(db_);
    std::optional<double> found;
    if (code == SQLITE_ROW && sqlite3_column_type(statement, 0) != SQLITE_NULL)
      found = sqlite3_column_double(statement, 0);
    sqlite3_finalize(statement);
    return found;
  }

  sqlite3* db_ = nullptr;
};

/// A row in which everything is resolved and exact: flags true, false and missing, numbers 1, 2, 3
/// and missing.
Row plain_row() {
  return {{"p", {true}}, {"q", {false}}, {"r", {}},    {"w", {std::string("x")}},
          {"a", {1.0}},  {"b", {2.0}},   {"c", {3.0}}, {"d", {}}};
}

class VerdictOfRow : public ::testing::Test {
 protected:
  std::string verdict(const std::string& condition) {
    table_.hold(row_);
    return table_.verdict(Expression::parse(condition, symbols_of(row_)).verdict_sql());
  }
  Table table_;
  Row row_ = plain_row();
};

TEST_F(VerdictOfRow, AFlagThatIsNotResolvedMayBeEither) {
  row_["p"].resolved = row_["q"].resolved = false;
  EXPECT_EQ(verdict("p"), "undecided");
  EXPECT_EQ(verdict("q"), "undecided");
  EXPECT_EQ(verdict("not p"), "undecided");
  EXPECT_EQ(verdict("p = true"), "undecided");
  EXPECT_EQ(verdict("p != q"), "undecided");
  EXPECT_EQ(verdict("p and a > 5"), "no");
  EXPECT_EQ(verdict("p or a < 5"), "yes");
  EXPECT_EQ(verdict("p and a < 5"), "undecided");
  EXPECT_EQ(verdict("not (p or a < 5)"), "no");
  EXPECT_EQ(verdict("not (p and a > 5)"), "yes");
}

TEST_F(VerdictOfRow, WhatIsMissingCountsAsFalse) {
  EXPECT_EQ(verdict("r"), "no");
  EXPECT_EQ(verdict("not r"), "no");
  EXPECT_EQ(verdict("d > 0"), "no");
  EXPECT_EQ(verdict("not d > 0"), "no");
  EXPECT_EQ(verdict("r or p"), "yes");
  row_["d"].error = 1;
  EXPECT_EQ(verdict("d > 0 or not d > 0"), "no");
  row_["p"].resolved = false;
  EXPECT_EQ(verdict("p or r"), "undecided");
  EXPECT_EQ(verdict("p and r"), "no");
  EXPECT_EQ(verdict("not (p and r)"), "undecided");
}

TEST_F(VerdictOfRow, ANumberThatIsNotResolvedMayBeAnything) {
  row_["a"].resolved = false;
  row_["a"].error = 0.1;
  EXPECT_EQ(verdict("a > -1e9"), "undecided");
  EXPECT_EQ(verdict("max(a, 5) > 4"), "undecided") << "a may be missing";
  EXPECT_EQ(verdict("a = a"), "undecided");
  EXPECT_EQ(verdict("a != 77"), "undecided");
  EXPECT_EQ(verdict("b > 1"), "yes");
  EXPECT_EQ(verdict("a > 0 or b > 1"), "yes");
  row_["d"].resolved = false;
  EXPECT_EQ(verdict("d > 0"), "undecided");
}

TEST_F(VerdictOfRow, TextThatIsNotResolvedMayBeAnother) {
  EXPECT_EQ(verdict("w = 'x'"), "yes");
  row_["w"].resolved = false;
  EXPECT_EQ(verdict("w = 'x'"), "undecided");
  EXPECT_EQ(verdict("w != 'y' and a > 5"), "no");
}

TEST_F(VerdictOfRow, ErrorsDecideUpToTheThreshold) {
  row_["a"] = {0.75, true, 0.0625};
  EXPECT_EQ(verdict("a > 0.8125"), "no") << "at most 0.8125";
  EXPECT_EQ(verdict("a >= 0.8125"), "undecided");
  EXPECT_EQ(verdict("a > 0.6875"), "undecided") << "at least 0.6875";
  EXPECT_EQ(verdict("a >= 0.6875"), "yes");
  EXPECT_EQ(verdict("0.6875 <= a"), "yes");
  EXPECT_EQ(verdict("a < 0.6875"), "no");
  EXPECT_EQ(verdict("a <= 0.8125"), "yes");
  EXPECT_EQ(verdict("not a > 0.8"), "undecided");
  EXPECT_EQ(verdict("not a > 0.9"), "yes");
  EXPECT_EQ(verdict("a = 0.75"), "undecided");
  EXPECT_EQ(verdict("a = 0.9"), "no");
  EXPECT_EQ(verdict("a != 0.75"), "undecided");
  EXPECT_EQ(verdict("a != 0.9"), "yes");
}

TEST_F(VerdictOfRow, ErrorsOfBothSidesAdd) {
  row_["a"] = {1.0, true, 0.25};
  row_["b"] = {2.0, true, 0.5};
  EXPECT_EQ(verdict("b - a > 0.2"), "yes");
  EXPECT_EQ(verdict("b - a > 0.25"), "undecided");
  EXPECT_EQ(verdict("b - a >= 1.75"), "undecided");
  EXPECT_EQ(verdict("b - a > 1.75"), "no");
  EXPECT_EQ(verdict("max(a, b) < 2.6"), "yes");
  EXPECT_EQ(verdict("max(a, b) < 2.5"), "undecided");
  EXPECT_EQ(verdict("min(a, b) < 0.75"), "no");
  EXPECT_EQ(verdict("b > a"), "yes");
  EXPECT_EQ(verdict("-b < -a"), "yes");
  EXPECT_EQ(verdict("-2 * a > -2.6"), "yes");
  EXPECT_EQ(verdict("a / -2 >= -0.5"), "undecided");
  EXPECT_EQ(verdict("a * b >= 1.125"), "yes");
  EXPECT_EQ(verdict("a * b > 1.125"), "undecided");
  EXPECT_EQ(verdict("abs(a - 1) > 0.3"), "no");
  EXPECT_EQ(verdict("abs(a - 1) < 0"), "no");
}

/// Powers, roots and logarithms of values within their domain, and across its end.
TEST_F(VerdictOfRow, FunctionsFollowErrors) {
  row_["a"] = {0.5, true, 0.75};  // -0.25 to 1.25
  EXPECT_EQ(verdict("a ^ 2 <= 1.5625"), "yes");
  EXPECT_EQ(verdict("a ^ 2 < 0"), "no");
  EXPECT_EQ(verdict("a ^ 3 >= -0.015625"), "yes");
  EXPECT_EQ(verdict("sqrt(a) >= 0"), "undecided") << "the root may be missing";
  EXPECT_EQ(verdict("log10(a) > 5"), "undecided");
  EXPECT_EQ(verdict("1 / a > -100"), "undecided") << "the quotient may be of any size";
  EXPECT_EQ(verdict("a ^ -2 > 0.1"), "undecided");
  EXPECT_EQ(verdict("a ^ a < 1000"), "undecided");
  row_["a"] = {1.0, true, 0.75};
  EXPECT_EQ(verdict("sqrt(a) >= 0.5"), "yes");
  EXPECT_EQ(verdict("sqrt(a - 2) < 100"), "no") << "missing throughout";
  EXPECT_EQ(verdict("1 / a <= 4"), "yes");
  EXPECT_EQ(verdict("a ^ -1 <= 4"), "yes");
  EXPECT_EQ(verdict("2 ^ a > 1"), "yes");
  EXPECT_EQ(verdict("0.25 ^ a < 0.75"), "yes");
  EXPECT_EQ(verdict("0.25 ^ a < 0.7"), "undecided");
  EXPECT_EQ(verdict("tan(a * 10 deg) > 0"), "yes");
  EXPECT_EQ(verdict("tan(a * 90 deg) > -1e99"), "undecided") << "beyond a right angle";
  EXPECT_EQ(verdict("exp(a) > 1 and log10(a) < 0.3"), "yes");
}

TEST_F(VerdictOfRow, NestedProductsStayShort) {
  row_["a"].error = 0.125;
  std::string product = "a";
  for (int i = 0; i < 60; ++i) product = "(" + product + " * b)";
  const auto sql = Expression::parse(product + " > 0", symbols_of(row_)).verdict_sql();
  EXPECT_LT(sql.certain.text.size() + sql.possible.text.size(), 100000u);
  EXPECT_EQ(verdict(product + " > 0"), "undecided") << "too long to follow: wider, not wrong";
  EXPECT_EQ(verdict("a * b * b * b > 6.5"), "yes");
}

TEST_F(VerdictOfRow, NestedEquationsStayShort) {
  std::string nested = "p";
  for (int i = 0; i < 40; ++i) nested = "(" + nested + ") = (" + (i % 2 == 0 ? "a" : "b") + " > 0)";
  const auto sql = Expression::parse(nested, symbols_of(row_)).verdict_sql();
  EXPECT_LT(sql.certain.text.size() + sql.possible.text.size(), 200000u);
  EXPECT_EQ(verdict(nested), "yes");
  row_["a"].resolved = false;
  EXPECT_EQ(verdict(nested), "undecided");
  row_["a"].resolved = true;
  row_["b"].error = 0.1;
  EXPECT_EQ(verdict(nested), "undecided");
}

/// Beyond the 100 levels that SQLite's parser has, were every pair in brackets.
TEST_F(VerdictOfRow, LongAndDeepConditionsAreTaken) {
  row_["q"].resolved = false;
  row_["a"].error = 0.25;
  std::string any = "q", all = "a + b > 2", sum = "b";
  for (int i = 0; i < 300; ++i) {
    any += " or a > 1.5";
    all += " and p";
  }
  for (int i = 0; i < 180; ++i) sum += i % 2 == 0 ? " - a" : " + a";
  EXPECT_EQ(verdict(any), "undecided");
  EXPECT_EQ(verdict(any + " or a > 0.5"), "yes");
  EXPECT_EQ(verdict(all), "yes");
  EXPECT_EQ(verdict(all + " and q"), "undecided");
  EXPECT_EQ(verdict(sum + " > 100"), "no");
  EXPECT_EQ(verdict(sum + " > 1"), "undecided") << "errors add up";
  std::string deep = "a", equal = "q", products = "a > 2";
  for (int i = 0; i < 7; ++i) deep = "abs(2 - " + deep + ")";
  EXPECT_EQ(verdict(deep + " > 100"), "undecided") << "too deep or long to follow the error";
  for (int i = 0; i < 7; ++i) equal = "(p or (r = " + equal + "))";
  EXPECT_EQ(verdict(equal), "undecided") << "so is this: wider, not wrong";
  for (int i = 0; i < 5; ++i) products = "(p and (q or " + products + "))";
  EXPECT_EQ(verdict(products), "undecided");
}

TEST_F(VerdictOfRow, WholeNumbersAreDividedWithTheirRemainder) {
  Symbols symbols = symbols_of(row_);
  symbols["seven"] = {"seven", Type{}};
  symbols["two"] = {"whole", Type{}, "", 0.25};
  table_.hold(row_);
  for (const char* condition : {"seven / (two + 0) > 3.1", "1 / seven > 0", "seven / two >= 3"})
    EXPECT_EQ(table_.verdict(Expression::parse(condition, symbols).verdict_sql()), "yes");
  symbols["two"].error = 0;
  const Expression exact = Expression::parse("seven / two = 3.5", symbols);
  EXPECT_EQ(table_.verdict(exact.verdict_sql()), "yes");
  EXPECT_TRUE(table_.holds(exact.sql()));
}

// Random expressions ------------------------------------------------------------------------------

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return engine_() % n; }
  template <typename Item>
  const Item& of(const std::vector<Item>& items) {
    return items[below(items.size())];
  }
  double between(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }

  /// Everything is resolved and exact unless `doubtful`.
  Row row(bool doubtful) {
    Row row;
    const auto set = [&](const std::string& name, std::vector<Value> values) {
      row[name] = {of(values), !doubtful || below(4) > 0, 0};
    };
    for (const std::string& one : kFlags) set(one, {true, false, std::monostate{}});
    for (const std::string& one : kNumbers) {
      set(one, {-2.0, -0.5, 0.25, 1.0, 3.0, std::monostate{}});
      if (doubtful) row[one].error = of(std::vector<double>{0, 0.125, 0.5, 1.5});
    }
    set("w", {std::string("x"), std::string("y"), std::monostate{}});
    return row;
  }
  std::string number(int depth);
  std::string condition(int depth);

 private:
  std::mt19937 engine_;
};

std::string Random::number(int depth) {
  if (depth <= 0) {
    const std::string& name = of(kNumbers);
    return of(std::vector<std::string>{name, name, name, "2", "0.5", "-1", "(" + name + " ^ -1)"});
  }
  const std::string x = number(depth - 1), y = number(depth - 1);
  return of(std::vector<std::string>{
      "(" + x + " + " + y + ")", "(" + x + " - " + y + ")", "(" + x + " * " + y + ")",
      "(" + x + " / " + y + ")", "-" + x, "min(" + x + ", " + y + ", 3)",
      "max(" + x + ", " + y + ")", "abs(" + x + ")", "sqrt(" + x + ")", "log10(" + x + ")",
      "exp(min(" + x + ", 3))", "tan(" + x + " * 20 deg)", "(" + x + " ^ 2)", "(" + x + " ^ 3)",
      "(2 ^ min(" + x + ", 3))", "(0.5 ^ max(" + x + ", -3))", "(abs(" + x + ") ^ 0.5)"});
}

std::string Random::condition(int depth) {
  if (depth <= 0) {
    const std::string& flag = of(kFlags);
    return of(std::vector<std::string>{flag, flag, flag, "w = 'x'", "w != 'y'", "true", "false"});
  }
  const std::string a = condition(depth - 1), b = condition(depth - 1);
  const std::string x = number(depth - 1), y = number(depth - 1);
  const std::string compared =
      "(" + x + of(std::vector<std::string>{" < ", " <= ", " > ", " >= ", " = ", " != "}) + y + ")";
  return of(std::vector<std::string>{"(" + a + " and " + b + ")", "(" + a + " or " + b + ")",
                                     "not " + a, "(" + a + ") = (" + b + ")",
                                     "(" + a + ") != (" + b + ")", compared, compared, compared,
                                     compared});
}

/// Values that a name may have; of a number with an error the ends of its range first.
std::vector<Value> values_of(const std::string& name, const Known& known, Random& random) {
  if (!known.resolved) {
    if (name == "w") return {std::string("x"), std::string("y"), std::monostate{}};
    if (std::count(kFlags.begin(), kFlags.end(), name) > 0) return {true, false};
    return {-1e3, 1e3, 0.0, 0.75, 2.0, std::monostate{}};
  }
  const auto* number = std::get_if<double>(&known.value);
  if (number == nullptr || known.error == 0) return {known.value};
  const double low = *number - known.error, high = *number + known.error;
  return {low, high, *number, random.between(low, high), random.between(low, high)};
}

/// Whether the condition holds in all outcomes, and in any: of all where they are few, else of
/// some.
struct Outcomes {
  bool all = true, any = false;
};

Outcomes try_out(const Expression& condition, const Row& row, Random& random) {
  std::vector<std::vector<Value>> values;
  std::size_t n_outcomes = 1;
  for (const std::string& name : condition.names()) {
    values.push_back(values_of(name, row.at(name), random));
    n_outcomes *= values.back().size();
  }
  constexpr std::size_t kMost = 400;
  Outcomes found;
  for (std::size_t k = 0; k < std::min(n_outcomes, kMost); ++k) {
    std::size_t rest = n_outcomes <= kMost ? k : random.below(n_outcomes);
    std::vector<std::size_t> place;
    for (const auto& of_name : values) {
      place.push_back(rest % of_name.size());
      rest /= of_name.size();
    }
    const bool holds = condition.holds([&](std::size_t i) { return values[i][place[i]]; });
    found.all = found.all && holds;
    found.any = found.any || holds;
  }
  return found;
}

TEST(Verdict, OfRandomExpressionsIsSound) {
  Table table;
  Random random(20261125);
  std::map<std::string, int> seen;
  for (int trial = 0; trial < 6000; ++trial) {
    const Row row = random.row(true);
    table.hold(row);
    const std::string text = random.condition(1 + trial % 4);
    const Expression condition = Expression::parse(text, symbols_of(row));
    const std::string verdict = table.verdict(condition.verdict_sql());
    const Outcomes outcomes = try_out(condition, row, random);
    ASSERT_TRUE(outcomes.all || verdict != "yes") << text << " trial " << trial;
    ASSERT_TRUE(!outcomes.any || verdict != "no") << text << " trial " << trial;
    ++seen[verdict];
  }
  for (const auto& [verdict, count] : seen) EXPECT_GT(count, 500) << verdict;
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Verdict, IsTheConditionWhereAllIsResolvedAndExact) {
  Table table;
  Random random(7);
  int n_missing = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Row row = random.row(false);
    table.hold(row);
    const std::string text = random.condition(1 + trial % 5);
    const Expression condition = Expression::parse(text, symbols_of(row));
    const VerdictSql sql = condition.verdict_sql();
    const auto plain = table.of_row(condition.sql());
    ASSERT_EQ(table.of_row(sql.certain), plain) << text;
    ASSERT_EQ(table.of_row(sql.possible), plain) << text;
    n_missing += plain ? 0 : 1;
  }
  EXPECT_GT(n_missing, 300);
}

/// A condition in which each name stands once, behind operations that keep or turn order.
class OnceEach {
 public:
  explicit OnceEach(Random& random) : random_(random) {}
  std::string condition(int depth) {
    if (depth <= 0 || flags_.empty()) return compared();
    switch (random_.below(5)) {
      case 0:
        return "(" + condition(depth - 1) + " and " + condition(depth - 1) + ")";
      case 1:
        return "(" + condition(depth - 1) + " or " + condition(depth - 1) + ")";
      case 2:
        return "not " + condition(depth - 1);
      case 3:
        return taken(flags_);
      default:
        return compared();
    }
  }

 private:
  std::string compared() {
    const std::string left = number(2), right = number(1);
    static const std::vector<std::string> kSigns = {" < ", " <= ", " > ", " >= "};
    return "(" + left + random_.of(kSigns) + right + ")";
  }
  std::string number(int depth) {
    if (numbers_.empty()) return random_.of(std::vector<std::string>{"0.25", "1", "-2"});
    if (depth <= 0) return taken(numbers_);
    const std::string x = number(depth - 1), y = number(depth - 1);
    return random_.of(std::vector<std::string>{"(" + x + " + " + y + ")", "(" + x + " - " + y + ")",
                                               "min(" + x + ", " + y + ")",
                                               "max(" + x + ", " + y + ")", "(-2 * " + x + ")",
                                               "(" + x + " / 4)", "-" + x, "(" + x + " ^ 3)"});
  }
  std::string taken(std::vector<std::string>& names) {
    const std::size_t k = random_.below(names.size());
    const std::string name = names[k];
    names.erase(names.begin() + static_cast<long>(k));
    return name;
  }

  Random& random_;
  std::vector<std::string> flags_ = kFlags, numbers_ = kNumbers;
};

TEST(Verdict, IsSharpWhereEachNameStandsOnce) {
  Table table;
  Random random(3);
  std::map<std::string, int> seen;
  for (int trial = 0; trial < 4000; ++trial) {
    Row row = random.row(true);
    for (const std::string& one : kNumbers) row[one].resolved = true;
    table.hold(row);
    const std::string text = OnceEach(random).condition(3);
    const Expression condition = Expression::parse(text, symbols_of(row));
    Outcomes outcomes;
    const std::vector<std::string>& names = condition.names();
    for (std::size_t corner = 0; corner < (std::size_t{1} << names.size()); ++corner) {
      const bool holds = condition.holds([&](std::size_t i) {
        const auto ends = values_of(names[i], row.at(names[i]), random);
        return ends.size() == 1 ? ends[0] : ends[corner >> i & 1];
      });
      outcomes.all = outcomes.all && holds;
      outcomes.any = outcomes.any || holds;
    }
    const std::string expected = outcomes.all ? "yes" : outcomes.any ? "undecided" : "no";
    ASSERT_EQ(table.verdict(condition.verdict_sql()), expected) << text << " trial " << trial;
    ++seen[expected];
  }
  for (const auto& [verdict, count] : seen) EXPECT_GT(count, 300) << verdict;
}

}  // namespace
}  // namespace faultsweep
