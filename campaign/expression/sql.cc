#include <algorithm>

#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

/// Whose operations SQL takes from left to right without brackets, as `evaluate` does.
char chain_of(Operation operation) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
      return '+';
    case Operation::multiply:
    case Operation::divide:
      return '*';
    default:
      return 0;
  }
}

/// What stands on the stack of SQLite's parser while it reads the k-th operand: "(", "(NOT" or
/// "(-"; "(x AND"; "pow(" and what makes a list of arguments.
int waiting_before(Operation operation, std::size_t k, std::size_t n) {
  const bool is_operator = *info(operation).before == '(';
  constexpr int kBracket = 1, kOperator = 2, kFunction = 3;
  if (!is_operator) return kFunction + (k > 0 ? kOperator : 0);
  return kBracket + (n == 1 ? 1 : 0) + (k > 0 ? kOperator : 0);
}

}  // namespace

SqlFragment& SqlFragment::operator+=(const SqlFragment& part) {
  text += part.text;
  parameters.insert(parameters.end(), part.parameters.begin(), part.parameters.end());
  depth = std::max(depth, part.depth);
  chain = 0;
  return *this;
}

SqlFragment applied(Operation operation, const std::vector<SqlFragment>& operands) {
  const OperationInfo& spelling = info(operation);
  const char chain = chain_of(operation);
  SqlFragment all;
  if (chain != 0 && operands.front().chain == chain) {
    all = operands.front();  // "(a + b)" goes on as "(a + b + c)"
    all.text.pop_back();
  } else {
    all += {spelling.before + operands.front().text, operands.front().parameters,
            operands.front().depth + waiting_before(operation, 0, operands.size())};
  }
  for (std::size_t k = 1; k < operands.size(); ++k) {
    SqlFragment next = operands[k];
    next.text.insert(0, spelling.between);
    next.depth += waiting_before(operation, k, operands.size());
    all += next;
  }
  all.text += ')';
  all.chain = chain;
  return all;
}

SqlFragment sql_of(const Node& node, const std::vector<Symbol>& symbols) {
  if (node.operation == Operation::literal) return {"?", {node.literal}};
  if (node.operation == Operation::name) {
    const std::string& column = symbols[node.name].sql;
    FAULTSIM_DEMAND(!column.empty(), "no column for name ", node.name);
    return {column, {}};
  }
  std::vector<SqlFragment> operands;
  for (const auto& child : node.children) operands.push_back(sql_of(*child, symbols));
  return applied(node.operation, operands);
}

SqlFragment Expression::sql() const { return sql_of(*root_, symbols_); }

}  // namespace faultsweep
