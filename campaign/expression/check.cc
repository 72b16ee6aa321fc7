#include <cmath>

#include "campaign/common/names.h"
#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

class Checker {
 public:
  Checker(const std::string& text, const std::vector<std::string>& names,
          const std::vector<Type>& name_types)
      : text_(text), names_(names), name_types_(name_types) {}

  void check(Node& node) {
    for (auto& child : node.children) check(*child);
    switch (info(node.operation).rule) {
      case Rule::literal:
        return;
      case Rule::name:
        node.type = name_types_[node.name];
        return;
      case Rule::same:
        return check_same(node);
      case Rule::product:
        return check_product(node, node.operation == Operation::multiply ? 1 : -1);
      case Rule::power:
        return check_power(node);
      case Rule::root:
        return check_square_root(node);
      case Rule::number:
        return check_argument(node, Dimension::number);
      case Rule::angle:
        return check_argument(node, Dimension::angle);
      case Rule::logical:
        return check_logical(node);
      case Rule::comparison:
        return check_comparison(node);
    }
  }

 private:
  [[noreturn]] void fail(const Node& at, const std::string& what, const std::string& cure) const {
    throw ExpressionError(text_, at.position, what, cure);
  }

  /// "offset is a length", "15 deg is an angle", "this is a condition".
  std::string sentence(const Node& node) const {
    std::string subject = "this";
    if (node.operation == Operation::name) subject = names_[node.name];
    if (node.operation == Operation::literal) {
      subject = text_.substr(node.position, node.end - node.position);
    }
    return subject + " is " + type_name(node.type);
  }
  static std::string type_name(const Type& type) {
    if (type.kind == Kind::boolean) return "a condition (true or false)";
    if (type.kind == Kind::text) return "text";
    return describe(type.units);
  }

  void require_number(const Node& node) const {
    if (node.type.kind == Kind::number) return;
    fail(node, sentence(node) + " where a number is needed",
         node.type.kind == Kind::text ? "write a number with its unit" : "compare numbers here");
  }

  /// Two numbers of different dimensions meet: say both and, for a bare number, the likely cure.
  [[noreturn]] void fail_units(const Node& left, const Node& right) const {
    std::string cure = "both sides need the same dimension";
    for (const auto& [bare, other] : {std::pair(&left, &right), std::pair(&right, &left)}) {
      if (bare->operation != Operation::literal || bare->type.units != Units{}) continue;
      for (const faultsim::DimensionInfo& one : faultsim::dimensions()) {
        if (one.dimension == Dimension::number) continue;
        if (one.powers != other->type.units.exponents) continue;
        const std::string number = text_.substr(bare->position, bare->end - bare->position);
        const std::string unit = one.usual;
        const bool quote = unit.find(' ') != std::string::npos;
        cure = "write " + (quote ? '"' + number + " " + unit + '"' : number + " " + unit);
      }
    }
    fail(right, sentence(left) + ", " + sentence(right), cure);
  }

  void check_same(Node& node) const {
    for (const auto& child : node.children) require_number(*child);
    for (std::size_t i = 1; i < node.children.size(); ++i) {
      if (node.children[i]->type.units != node.children[0]->type.units) {
        fail_units(*node.children[0], *node.children[i]);
      }
    }
    node.type = node.children[0]->type;
  }
  void check_product(Node& node, int sign) const {
    for (const auto& child : node.children) require_number(*child);
    node.type = node.children[0]->type;
    for (std::size_t i = 0; i < node.type.units.exponents.size(); ++i) {
      node.type.units.exponents[i] += sign * node.children[1]->type.units.exponents[i];
      require_small(node, node.type.units.exponents[i]);
    }
  }
  void check_power(Node& node) const {
    const Node& base = *node.children[0];
    const Node& exponent = *node.children[1];
    require_number(base);
    require_number(exponent);
    if (exponent.type.units != Units{}) {
      fail(exponent, sentence(exponent) + ", but a power needs a plain number", "remove the unit");
    }
    node.type = Type{};
    if (base.type.units == Units{}) return;
    const auto value = constant_of(exponent);
    if (!value || *value != std::round(*value)) {
      fail(exponent, sentence(base) + ", so its power must be a whole number",
           "write for example ^2, or divide by a unit first");
    }
    for (std::size_t i = 0; i < node.type.units.exponents.size(); ++i) {
      const double product = *value * base.type.units.exponents[i];
      require_small(node, product);
      node.type.units.exponents[i] = static_cast<int>(product);
    }
  }
  /// Keeps exponents far from integer overflow; nothing physical has such dimensions.
  void require_small(const Node& node, double exponent) const {
    if (std::abs(exponent) > 1000) fail(node, "this power of a unit is too large", "simplify it");
  }
  void check_square_root(Node& node) const {
    const Node& argument = *node.children[0];
    require_number(argument);
    node.type = Type{};
    for (std::size_t i = 0; i < node.type.units.exponents.size(); ++i) {
      if (argument.type.units.exponents[i] % 2 != 0) {
        fail(argument, sentence(argument) + ", which has no square root with a unit",
             "divide by a unit first");
      }
      node.type.units.exponents[i] = argument.type.units.exponents[i] / 2;
    }
  }
  void check_argument(Node& node, Dimension wanted) const {
    const Node& argument = *node.children[0];
    require_number(argument);
    if (argument.type.units != units_of(wanted)) {
      const bool angle = wanted == Dimension::angle;
      fail(argument, sentence(argument) + ", but the function takes " + describe(units_of(wanted)),
           angle ? "write for example tan(30 deg)" : "divide by a unit first");
    }
    node.type = Type{};
  }
  void check_logical(Node& node) const {
    for (const auto& child : node.children) {
      if (child->type.kind != Kind::boolean) {
        fail(*child, sentence(*child) + " where a condition is needed",
             "compare it with something, for example > 0");
      }
    }
    node.type = Type{Kind::boolean, {}};
  }
  void check_comparison(Node& node) const {
    Node& left = *node.children[0];
    Node& right = *node.children[1];
    as_text_beside(left, right);
    as_text_beside(right, left);
    const bool equality =
        node.operation == Operation::equal || node.operation == Operation::not_equal;
    if (left.type.kind != right.type.kind) {
      fail(right, sentence(left) + ", " + sentence(right), "compare things of one kind");
    }
    if (left.type.kind == Kind::number) {
      if (left.type.units != right.type.units) fail_units(left, right);
    } else if (!equality) {
      fail(node, sentence(left) + ", which has no order", "compare it with = or !=");
    }
    node.type = Type{Kind::boolean, {}};
  }
  /// "2 m" in quotes is text when what it is compared with is text (a group's name, say). So is
  /// what could be a name, unless the other side is another of its kind.
  static void as_text_beside(Node& quoted, const Node& other) {
    if (other.type.kind != Kind::text || !quoted.is_quoted) return;
    if (quoted.operation == Operation::name) {
      const bool are_two_names = other.is_quoted && quoted.type.kind == Kind::text;
      if (other.operation != Operation::name || are_two_names) return;
    }
    quoted.operation = Operation::literal;
    quoted.literal = quoted.quoted;
    quoted.type = Type{Kind::text, {}};
  }

  const std::string& text_;
  const std::vector<std::string>& names_;
  const std::vector<Type>& name_types_;
};

}  // namespace

std::optional<double> constant_of(const Node& node) {
  if (node.operation == Operation::literal) return std::get<double>(node.literal);
  if (node.operation == Operation::negate) {
    if (const auto inner = constant_of(*node.children[0])) return -*inner;
  }
  return std::nullopt;
}

void check_types(Node& root, const std::string& text, const std::vector<std::string>& names,
                 const std::vector<Type>& name_types) {
  Checker(text, names, name_types).check(root);
}

}  // namespace faultsweep
