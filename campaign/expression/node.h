#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/expression/expression.h"

/// Inside of the module: the syntax tree and the steps from text to a checked tree.
namespace faultsweep {

enum class Operation {
  literal,
  name,
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  logical_not,
  minimum,
  maximum,
  absolute,
  square_root,
  log10,
  exponential,
  tangent,
};

/// What an operation takes and gives.
enum class Rule {
  literal,
  name,
  same,        ///< numbers of one dimension, which it gives too.
  product,     ///< numbers; multiply and divide.
  power,       ///< a number, and a plain one.
  root,        ///< a number of even powers of its units.
  number,      ///< a plain number, which it gives too.
  angle,       ///< an angle; gives a plain number.
  comparison,  ///< two things of one kind; gives a condition.
  logical,     ///< conditions.
};

struct OperationInfo {
  Rule rule;
  std::string_view function = "";  ///< its name where text writes it as one.
  /// In SQL, before the operands and between them; ")" stands behind them.
  const char *before = nullptr, *between = nullptr;
  /// Of numbers; of one operand the other counts for nothing. @pre rule is one of numbers.
  double (*arithmetic)(double, double) = nullptr;
};
/// Of SqlFragment::depth: the parser has place for 100. What is left is for the statement around
/// the expression and for the columns in it, of which some are statements themselves.
constexpr int kDeepestSql = 45;

const OperationInfo& info(Operation operation);
std::optional<Operation> function_named(std::string_view name);
/// Their names.
std::vector<std::string> functions();

struct Node {
  Operation operation = Operation::literal;
  std::size_t position = 0;  ///< byte offset in the text of what to point at.
  std::size_t end = 0;       ///< one past the last byte of a literal or name.
  Type type;                 ///< set by the parser for literals, by check for the rest.
  Value literal;
  std::string quoted;  ///< literal or name in quotes: what stood between them.
  bool is_quoted = false;
  std::size_t name = 0;  ///< into the names.
  std::vector<std::unique_ptr<Node>> children;
};

struct ParsedText {
  std::unique_ptr<Node> root;
  std::vector<std::string> names;  ///< each once, in order of appearance.
};

/// Text to tree. Throws ExpressionError on syntax, on what SQL could not say and on names that are
/// not among known_names, which are in ascending order; scopes serve messages.
ParsedText parse_expression(const std::string& text, const std::vector<std::string>& known_names,
                            const Scopes& scopes);

/// Fills in every Node::type. Throws ExpressionError. name_types: per name of the tree.
void check_types(Node& root, const std::string& text, const std::vector<std::string>& names,
                 const std::vector<Type>& name_types);

/// The value of a literal number, or of one behind minus signs; nothing of anything else.
std::optional<double> constant_of(const Node& node);

/// A tree in SQL over Symbol::sql; symbols: per name of the tree.
SqlFragment sql_of(const Node& node, const std::vector<Symbol>& symbols);
/// An operation in SQL over operands that are SQL themselves.
SqlFragment applied(Operation operation, const std::vector<SqlFragment>& operands);

}  // namespace faultsweep
