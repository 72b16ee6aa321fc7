#include "campaign/expression/node.h"

namespace faultsweep {

SqlFragment& SqlFragment::operator+=(const SqlFragment& part) {
  text += part.text;
  parameters.insert(parameters.end(), part.parameters.begin(), part.parameters.end());
  return *this;
}

SqlFragment applied(Operation operation, const std::vector<SqlFragment>& operands) {
  const OperationInfo& spelling = info(operation);
  SqlFragment all;
  for (const SqlFragment& one : operands) {
    all.text += all.text.empty() ? spelling.before : spelling.between;
    all += one;
  }
  all.text += ')';
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
