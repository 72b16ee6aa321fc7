#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"

/// The one expression grammar of faultsweep: `rank --where`, exclusions, derived parameters,
/// scores.
///
///   or         := and ("or" and)*
///   and        := not ("and" not)*
///   not        := "not" not | comparison
///   comparison := sum (("<" | "<=" | ">" | ">=" | "=" | "==" | "!=") sum)?
///   sum        := product (("+" | "-") product)*
///   product    := unary (("*" | "/") unary)*
///   unary      := "-" unary | power
///   power      := primary ("^" unary)?
///   primary    := number unit? | "quoted" | name | of_fault | function "(" or ("," or)* ")" | "("
///   or ")"
///               | "true" | "false"
///   of_fault   := (fault "." name | name) ("in" stage)?
///
/// `F2.max_slip in gas_storage` is the metric max_slip of fault F2 in that stage; without fault
/// that of all faults together, without stage that of the stage asked for. Names of faults and
/// stages that are not words stand in quotes: `"Fault 2".slides in "gas storage"`. Quotes are
/// double or single ones; within them the same kind is written twice.
///
/// A number may carry a unit: `30 deg`, `200 bar`, `2.5e3 kg/m3`; a unit that is not one word plus
/// "/" and words stands in quotes: `"1 Pa s"`. Quoted text that is not a number with a unit is a
/// string. Names are letters, digits, "_" and dots. A known name that is not so stands in quotes:
/// `"my offset" > 50 m`; beside a name that is text, quoted text is text all the same. Functions:
/// min max abs sqrt log10 exp tan.
namespace faultsweep {

/// Exponents of length, mass, time and angle. Angle is a dimension of its own, so that degrees do
/// not pass for numbers; tan takes an angle and gives a number.
struct Units {
  std::array<int, 5> exponents = {0, 0, 0, 0, 0};
  bool operator==(const Units&) const = default;
};
/// Of pressure: {-1, 1, -2, 0}.
Units units_of(faultsim::Dimension dimension);
/// "pressure", "length", "a plain number", "m2 s-1".
std::string describe(const Units& units);

enum class Kind { number, boolean, text };
/// The type of a (sub)expression.
struct Type {
  Kind kind = Kind::number;
  Units units = {};  ///< kind number only.
  bool operator==(const Type&) const = default;
};
Type number_type(faultsim::Dimension dimension);

/// A value: missing, number (SI), boolean or text. Missing makes what it meets missing, and a
/// condition that is missing counts as false, as in SQL.
using Value = std::variant<std::monostate, double, bool, std::string>;

/// What a name stands for.
struct Symbol {
  std::string sql;  ///< column expression, trusted; empty where SQL is not wanted.
  Type type;
  /// SQL condition, trusted, on which the value is not resolved: a flag may then be either, a
  /// number or text anything, missing too. "" = always resolved; missing counts as resolved.
  std::string unresolved = {};
  /// Of a number, half-width of its stated error, SI: it lies in [value − error, value + error].
  double error = 0;
};
using Symbols = std::map<std::string, Symbol>;

/// Names of faults and stages, for messages. Symbols spell what is of them "F2.max_slip",
/// "max_slip in gas_storage" and "F2.max_slip in gas_storage", whatever was in quotes.
struct Scopes {
  std::vector<std::string> faults, stages;
};

/// A fault or stage as an expression spells it: in quotes where it is not one word.
std::string spelled_name(const std::string& name);

/// What stands in quotes, and the place behind them.
struct QuotedText {
  std::string inside;
  std::size_t end = 0;
};
/// Nothing where they are not closed. @pre text[start] is a quote.
std::optional<QuotedText> quoted_at(std::string_view text, std::size_t start);

/// The grammar was not met, or the types do not fit. what() carries the line, a caret and the cure.
class ExpressionError : public faultsim::InputError {
 public:
  /// @param position  byte offset of the trouble in text.
  ExpressionError(const std::string& text, std::size_t position, const std::string& what,
                  const std::string& cure);
  std::size_t position() const { return position_; }
  /// "what; cure" plus the two lines with text and caret.
  const std::string& message() const { return message_; }

 private:
  std::size_t position_;
  std::string message_;
};

/// SQL text with `?` for each value; no part of the user's text is in it.
struct SqlFragment {
  std::string text;
  std::vector<Value> parameters;
  int depth = 0;   ///< what SQLite's parser puts on its stack for it, at most.
  char chain = 0;  ///< '+' or '*': brackets around a sum or product; 0 = anything else.
  SqlFragment& operator+=(const SqlFragment& part);
};

/// A condition that may be undecided, as SQL: yes where `certain` holds, undecided where only
/// `possible` does, else no. Missing counts as false in both.
struct VerdictSql {
  SqlFragment certain;   ///< holds however what is not resolved turns out.
  SqlFragment possible;  ///< holds for some way in which it may turn out; wherever certain holds.
};

struct Node;

/// A parsed and type-checked expression. Cheap to copy, immutable.
class Expression {
 public:
  /// Parses and checks. Throws ExpressionError: syntax, unknown names (with the nearest), types,
  /// dimensions ("offset is a length, 15 deg an angle").
  static Expression parse(const std::string& text, const Symbols& symbols,
                          const Scopes& scopes = {});

  const std::string& text() const { return text_; }
  Type type() const;
  /// The names it uses, each once, in order of appearance.
  const std::vector<std::string>& names() const { return names_; }
  /// Its value; lookup gives the value of a name (SI), called with an index into names().
  Value evaluate(const std::function<Value(std::size_t)>& lookup) const;
  /// Evaluates a condition: missing = false. @pre type() is boolean.
  bool holds(const std::function<Value(std::size_t)>& lookup) const;
  /// As SQL over Symbol::sql of the symbols given to parse.
  SqlFragment sql() const;
  /// A condition, with what is not resolved and the errors of its names (see Symbol). Sound:
  /// certain only where it holds for all values that names may have, each by itself, and possible
  /// wherever it holds for some; sharp where each name occurs once and is compared behind + and -,
  /// * and / by constants, min, max and abs. Wider than need be, a number may be anything: where
  /// for some values an operation has none (root, logarithm, division by 0, tan beyond 90 deg),
  /// where a power has an error and neither base nor exponent is a constant, and where its SQL
  /// would pass 20,000 characters. Where all is resolved and exact both have the value of sql().
  /// Numbers that overflow are not followed. @pre type() is boolean.
  VerdictSql verdict_sql() const;

 private:
  std::string text_;
  std::vector<std::string> names_;
  std::vector<Symbol> symbols_;  ///< per name.
  std::shared_ptr<const Node> root_;
};

/// What there is and which of it was meant: "did you mean F2? There are: F1, F2".
std::string cure_of_name(std::string_view word, const std::vector<std::string>& candidates);

/// The candidate nearest to word, if near enough to be meant: at most a third of its letters wrong.
std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates);

}  // namespace faultsweep
