#include <cmath>

#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

using Lookup = std::function<Value(std::size_t)>;

Value evaluate_node(const Node& node, const Lookup& lookup);

/// What has no value (0/0, the root of -1) is missing, as it is NULL in SQL.
Value number(double value) {
  if (!std::isfinite(value)) return std::monostate{};
  return value;
}

bool is_missing(const Value& value) { return std::holds_alternative<std::monostate>(value); }

Value evaluate_arithmetic(const Node& node, const Lookup& lookup) {
  const Value first = evaluate_node(*node.children[0], lookup);
  if (is_missing(first)) return first;
  double result = std::get<double>(first);
  const auto arithmetic = info(node.operation).arithmetic;
  if (node.children.size() == 1) return number(arithmetic(result, 0));
  for (std::size_t i = 1; i < node.children.size(); ++i) {
    const Value next = evaluate_node(*node.children[i], lookup);
    if (is_missing(next)) return next;
    result = arithmetic(result, std::get<double>(next));
  }
  return number(result);
}

Value evaluate_comparison(const Node& node, const Lookup& lookup) {
  const Value left = evaluate_node(*node.children[0], lookup);
  const Value right = evaluate_node(*node.children[1], lookup);
  if (is_missing(left) || is_missing(right)) return std::monostate{};
  FAULTSIM_DEMAND(left.index() == right.index(), "kinds ", left.index(), " ", right.index());
  switch (node.operation) {
    case Operation::less:
      return left < right;
    case Operation::less_equal:
      return left <= right;
    case Operation::greater:
      return left > right;
    case Operation::greater_equal:
      return left >= right;
    case Operation::equal:
      return left == right;
    default:
      return left != right;
  }
}

/// Three-valued: missing and false = false, missing or true = true, not missing = missing.
Value evaluate_logical(const Node& node, const Lookup& lookup) {
  const Value left = evaluate_node(*node.children[0], lookup);
  if (node.operation == Operation::logical_not) {
    return is_missing(left) ? left : Value(!std::get<bool>(left));
  }
  const bool decisive = node.operation == Operation::logical_or;
  if (left == Value(decisive)) return left;
  const Value right = evaluate_node(*node.children[1], lookup);
  if (right == Value(decisive)) return right;
  return is_missing(left) ? left : right;
}

Value evaluate_node(const Node& node, const Lookup& lookup) {
  switch (info(node.operation).rule) {
    case Rule::literal:
      return node.literal;
    case Rule::name: {
      Value value = lookup(node.name);
      if (const auto* real = std::get_if<double>(&value)) return number(*real);
      return value;
    }
    case Rule::comparison:
      return evaluate_comparison(node, lookup);
    case Rule::logical:
      return evaluate_logical(node, lookup);
    default:
      return evaluate_arithmetic(node, lookup);
  }
}

}  // namespace

Value Expression::evaluate(const std::function<Value(std::size_t)>& lookup) const {
  return evaluate_node(*root_, lookup);
}

bool Expression::holds(const std::function<Value(std::size_t)>& lookup) const {
  FAULTSIM_DEMAND(type().kind == Kind::boolean, text_);
  return evaluate(lookup) == Value(true);
}

}  // namespace faultsweep
