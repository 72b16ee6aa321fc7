#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

const char* infix(Operation operation) {
  switch (operation) {
    case Operation::add:
      return " + ";
    case Operation::subtract:
      return " - ";
    case Operation::multiply:
      return " * ";
    case Operation::divide:
      return " / 1.0 / ";  // by itself SQLite divides whole numbers without remainder
    case Operation::less:
      return " < ";
    case Operation::less_equal:
      return " <= ";
    case Operation::greater:
      return " > ";
    case Operation::greater_equal:
      return " >= ";
    case Operation::equal:
      return " = ";
    case Operation::not_equal:
      return " <> ";
    case Operation::logical_and:
      return " AND ";
    case Operation::logical_or:
      return " OR ";
    default:
      return nullptr;
  }
}

/// What stands before the arguments of the others.
const char* opening(Operation operation) {
  switch (operation) {
    case Operation::power:
      return "pow(";
    case Operation::minimum:
      return "min(";
    case Operation::maximum:
      return "max(";
    case Operation::absolute:
      return "abs(";
    case Operation::square_root:
      return "sqrt(";
    case Operation::log10:
      return "log10(";
    case Operation::exponential:
      return "exp(";
    case Operation::tangent:
      return "tan(";
    case Operation::negate:
      return "(-";
    case Operation::logical_not:
      return "(NOT ";
    default:
      return nullptr;
  }
}

struct Spelling {
  const char* before;
  const char* between;
};

Spelling spelling_of(Operation operation) {
  if (const char* between = infix(operation)) return {"(", between};
  const char* before = opening(operation);
  FAULTSIM_DEMAND(before != nullptr, "operation ", static_cast<int>(operation));
  return {before, ", "};
}

void write(const Node& node, const std::vector<Symbol>& symbols, SqlFragment& out) {
  if (node.operation == Operation::literal) {
    out.text += '?';
    out.parameters.push_back(node.literal);
    return;
  }
  if (node.operation == Operation::name) {
    const std::string& column = symbols[node.name].sql;
    FAULTSIM_DEMAND(!column.empty(), "no column for name ", node.name);
    out.text += column;
    return;
  }
  const Spelling spelling = spelling_of(node.operation);
  out.text += spelling.before;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    if (i > 0) out.text += spelling.between;
    write(*node.children[i], symbols, out);
  }
  out.text += ')';
}

}  // namespace

SqlFragment applied(Operation operation, const std::vector<SqlFragment>& operands) {
  const Spelling spelling = spelling_of(operation);
  SqlFragment all;
  for (const SqlFragment& one : operands) {
    all.text += all.text.empty() ? spelling.before : spelling.between;
    all.text += one.text;
    all.parameters.insert(all.parameters.end(), one.parameters.begin(), one.parameters.end());
  }
  all.text += ')';
  return all;
}

SqlFragment sql_of(const Node& node, const std::vector<Symbol>& symbols) {
  SqlFragment fragment;
  write(node, symbols, fragment);
  return fragment;
}

SqlFragment Expression::sql() const { return sql_of(*root_, symbols_); }

}  // namespace faultsweep
