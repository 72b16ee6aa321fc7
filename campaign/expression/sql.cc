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
      return " / ";
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

void write(const Node& node, const std::vector<std::string>& columns, SqlFragment& out) {
  if (node.operation == Operation::literal) {
    out.text += '?';
    out.parameters.push_back(node.literal);
    return;
  }
  if (node.operation == Operation::name) {
    FAULTSIM_DEMAND(!columns[node.name].empty(), "no column for name ", node.name);
    out.text += columns[node.name];
    return;
  }
  const char* between = infix(node.operation);
  if (between == nullptr) {
    const char* name = opening(node.operation);
    FAULTSIM_DEMAND(name != nullptr, "operation ", static_cast<int>(node.operation));
    out.text += name;
    between = ", ";
  } else {
    out.text += '(';
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    if (i > 0) out.text += between;
    write(*node.children[i], columns, out);
  }
  out.text += ')';
}

}  // namespace

SqlFragment Expression::sql() const {
  SqlFragment fragment;
  write(*root_, columns_, fragment);
  return fragment;
}

}  // namespace faultsweep
