#include <algorithm>
#include <cmath>

#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

using R = Rule;
using O = OperationInfo;

// In the order of Operation.
constexpr std::array kOperations = {
    O{R::literal},
    O{R::name},
    O{R::same, "", "(-", "", [](double a, double) { return -a; }},
    O{R::same, "", "(", " + ", [](double a, double b) { return a + b; }},
    O{R::same, "", "(", " - ", [](double a, double b) { return a - b; }},
    O{R::product, "", "(", " * ", [](double a, double b) { return a * b; }},
    // by itself SQLite divides whole numbers without remainder
    O{R::product, "", "(", " / 1.0 / ", [](double a, double b) { return a / b; }},
    O{R::power, "", "pow(", ", ", [](double a, double b) { return std::pow(a, b); }},
    O{R::comparison, "", "(", " < "},
    O{R::comparison, "", "(", " <= "},
    O{R::comparison, "", "(", " > "},
    O{R::comparison, "", "(", " >= "},
    O{R::comparison, "", "(", " = "},
    O{R::comparison, "", "(", " <> "},
    O{R::logical, "", "(", " AND "},
    O{R::logical, "", "(", " OR "},
    O{R::logical, "", "(NOT ", ""},
    O{R::same, "min", "min(", ", ", [](double a, double b) { return std::min(a, b); }},
    O{R::same, "max", "max(", ", ", [](double a, double b) { return std::max(a, b); }},
    O{R::same, "abs", "abs(", "", [](double a, double) { return std::abs(a); }},
    O{R::root, "sqrt", "sqrt(", "", [](double a, double) { return std::sqrt(a); }},
    O{R::number, "log10", "log10(", "", [](double a, double) { return std::log10(a); }},
    O{R::number, "exp", "exp(", "", [](double a, double) { return std::exp(a); }},
    O{R::angle, "tan", "tan(", "", [](double a, double) { return std::tan(a); }},
};
static_assert(kOperations.size() == static_cast<std::size_t>(Operation::tangent) + 1);

}  // namespace

const OperationInfo& info(Operation operation) {
  return kOperations[static_cast<std::size_t>(operation)];
}

std::optional<Operation> function_named(std::string_view name) {
  for (std::size_t i = 0; i < kOperations.size(); ++i) {
    if (!name.empty() && kOperations[i].function == name) return static_cast<Operation>(i);
  }
  return std::nullopt;
}

std::vector<std::string> functions() {
  std::vector<std::string> names;
  for (const OperationInfo& one : kOperations) {
    if (!one.function.empty()) names.emplace_back(one.function);
  }
  return names;
}

}  // namespace faultsweep
