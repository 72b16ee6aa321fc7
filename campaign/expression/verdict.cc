#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/expression/node.h"

/// Conditions that may be undecided, as SQL.
///
/// However what is not resolved turns out, a condition is false, missing or true. In the order
/// false < missing < true SQL's `and` is the lesser of its sides, `or` the greater, and `not` turns
/// the order round. So the least and the most that a condition can be follow from those of its
/// parts: side by side through `and` and `or`, crossed through `not`. Certain is that the least is
/// true, possible that the most is.
namespace faultsweep {
namespace {

constexpr std::size_t kLongest = 20000;  // characters: nested products double their length
constexpr double kNearRightAngle = 1.57;

void add(SqlFragment& out, const char* text) { out.text += text; }
void add(SqlFragment& out, const SqlFragment& part) { out += part; }
template <typename... Parts>
SqlFragment joined(const Parts&... parts) {
  SqlFragment out;
  (add(out, parts), ...);
  return out;
}

SqlFragment both(const SqlFragment& a, const SqlFragment& b) {
  return applied(Operation::logical_and, {a, b});
}
SqlFragment either(const SqlFragment& a, const SqlFragment& b) {
  return applied(Operation::logical_or, {a, b});
}
SqlFragment negation(const SqlFragment& a) { return applied(Operation::logical_not, {a}); }
VerdictSql negation(const VerdictSql& a) { return {negation(a.possible), negation(a.certain)}; }
SqlFragment negative(const SqlFragment& a) { return applied(Operation::negate, {a}); }

/// The values that a number (or text) may have: from low to high, missing where these are; or
/// anything, missing too, where one of `any` holds.
struct Range {
  SqlFragment low, high;
  bool is_exact = true;  ///< low and high are the same.
  std::vector<SqlFragment> any;

  void may_be_anything_where(const SqlFragment& condition) {
    const bool is_known = std::ranges::any_of(any, [&](const SqlFragment& one) {
      return one.text == condition.text && one.parameters == condition.parameters;
    });
    if (!is_known) any.push_back(condition);
  }
  void may_be_anything() {
    low = high = {"NULL", {}};
    any = {{"1", {}}};
  }
};

/// low < 0 and high >= 0, say: there are values on both sides.
SqlFragment spans(const SqlFragment& low, const char* below, const SqlFragment& high,
                  const char* above) {
  return joined("(", low, below, " AND ", high, above, ")");
}

/// The bounds where none of the conditions holds; else it may be either.
VerdictSql unless_any(const std::vector<SqlFragment>& conditions, const VerdictSql& bounds) {
  if (conditions.empty()) return bounds;
  SqlFragment where = conditions.front();
  for (std::size_t i = 1; i < conditions.size(); ++i) where = joined(where, " OR ", conditions[i]);
  VerdictSql verdict = {joined("CASE WHEN ", where, " THEN 0 ELSE ", bounds.certain, " END"),
                        joined("CASE WHEN ", where, " THEN 1 ELSE ", bounds.possible, " END")};
  constexpr int kCase = 4;  // SqlFragment::depth of what stands before the bounds
  verdict.certain.depth += kCase;
  verdict.possible.depth += kCase;
  return verdict;
}

// Ranges through operations -----------------------------------------------------------------------
// The ends are rounded as the values between them would be: rounding keeps the order, that of
// functions of the C library but for the last bit.

void set_increasing(Range& range, Operation operation, const std::vector<Range>& of) {
  std::vector<SqlFragment> lows, highs;
  for (const Range& one : of) {
    lows.push_back(one.low);
    highs.push_back(one.high);
  }
  range.low = applied(operation, lows);
  range.high = applied(operation, highs);
}

/// Of a product or quotient: the least and greatest of what its ends give.
void set_product(Range& range, Operation operation, const Range& a, const Range& b) {
  std::vector<SqlFragment> corners;
  for (const SqlFragment* x : {&a.low, &a.high}) {
    for (const SqlFragment* y : {&b.low, &b.high}) {
      const bool is_double = (x == &a.high && a.is_exact) || (y == &b.high && b.is_exact);
      if (!is_double) corners.push_back(applied(operation, {*x, *y}));
    }
  }
  range.low = applied(Operation::minimum, corners);
  range.high = applied(Operation::maximum, corners);
}

/// |x|: 0 where x may have either sign.
void set_magnitude(Range& range, const Range& of) {
  const SqlFragment low = of.low, high = of.high;
  range.low = applied(Operation::maximum, {low, negative(high), {"0.0", {}}});
  range.high = applied(Operation::maximum, {negative(low), high});
}

/// base ^ exponent, where base has an error and the exponent is the number p.
void set_power(Range& range, const Range& base, const SqlFragment& exponent, double p) {
  Range x = base;
  const bool is_whole = p == std::round(p);
  if (is_whole && std::fmod(p, 2) == 0) set_magnitude(x, base);
  if (p < 0) {
    range.may_be_anything_where(spans(x.low, " <= 0", x.high, " >= 0"));
  } else if (!is_whole) {
    range.may_be_anything_where(spans(x.low, " < 0", x.high, " >= 0"));
  }
  if (p < 0) std::swap(x.low, x.high);
  range.low = applied(Operation::power, {x.low, exponent});
  range.high = applied(Operation::power, {x.high, exponent});
}

void set_power(Range& range, const Node& node, const std::vector<Range>& of) {
  const auto base = constant_of(*node.children[0]);
  const auto exponent = constant_of(*node.children[1]);
  if (exponent) {
    set_power(range, of[0], of[1].low, *exponent);
  } else if (base && *base > 0) {
    set_increasing(range, Operation::power, of);
    if (*base < 1) std::swap(range.low, range.high);
  } else {
    range.may_be_anything();
  }
}

/// The ends of an operation of whose operands some have errors.
void set_ends(Range& range, const Node& node, const std::vector<Range>& of) {
  const Operation operation = node.operation;
  switch (operation) {
    case Operation::negate:
      range.low = negative(of[0].high);
      range.high = negative(of[0].low);
      return;
    case Operation::subtract:
      range.low = applied(operation, {of[0].low, of[1].high});
      range.high = applied(operation, {of[0].high, of[1].low});
      return;
    case Operation::divide:
      if (!of[1].is_exact)
        range.may_be_anything_where(spans(of[1].low, " <= 0", of[1].high, " >= 0"));
      set_product(range, operation, of[0], of[1]);
      return;
    case Operation::multiply:
      set_product(range, operation, of[0], of[1]);
      return;
    case Operation::power:
      set_power(range, node, of);
      return;
    case Operation::absolute:
      set_magnitude(range, of[0]);
      return;
    case Operation::square_root:
      range.may_be_anything_where(spans(of[0].low, " < 0", of[0].high, " >= 0"));
      break;
    case Operation::log10:
      range.may_be_anything_where(spans(of[0].low, " <= 0", of[0].high, " > 0"));
      break;
    case Operation::tangent:
      range.may_be_anything_where(joined("abs(", of[0].low, ") > ",
                                         SqlFragment{"?", {kNearRightAngle}}, " OR abs(",
                                         of[0].high, ") > ", SqlFragment{"?", {kNearRightAngle}}));
      break;
    default:
      break;
  }
  set_increasing(range, operation, of);
}

class VerdictWriter {
 public:
  explicit VerdictWriter(const std::vector<Symbol>& symbols) : symbols_(symbols) {}

  VerdictSql verdict(const Node& root) const {
    VerdictSql found = condition(root);
    const bool is_deep = std::max(found.certain.depth, found.possible.depth) > kDeepestSql;
    return is_deep ? undivided(root) : found;
  }

 private:
  VerdictSql condition(const Node& node) const {
    switch (node.operation) {
      case Operation::literal:
      case Operation::name: {
        const Range flag = leaf(node);
        return unless_any(flag.any, {flag.low, flag.low});
      }
      case Operation::logical_not:
        return negation(condition(*node.children[0]));
      case Operation::logical_and:
      case Operation::logical_or: {
        const VerdictSql a = condition(*node.children[0]), b = condition(*node.children[1]);
        return {applied(node.operation, {a.certain, b.certain}),
                applied(node.operation, {a.possible, b.possible})};
      }
      default:
        return node.children[0]->type.kind == Kind::boolean ? equivalence(node) : comparison(node);
    }
  }

  Range leaf(const Node& node) const {
    Range range;
    if (node.operation == Operation::literal) {
      range.low = range.high = {"?", {node.literal}};
      return range;
    }
    const Symbol& symbol = symbols_[node.name];
    FAULTSIM_DEMAND(!symbol.sql.empty(), "no column for name ", node.name);
    range.low = range.high = {symbol.sql, {}};
    if (!symbol.unresolved.empty())
      range.may_be_anything_where(joined("(", SqlFragment{symbol.unresolved, {}}, ")"));
    if (symbol.error == 0 || symbol.type.kind != Kind::number) return range;
    range.is_exact = false;
    const SqlFragment error = {"?", {symbol.error}};
    range.low = applied(Operation::subtract, {range.low, error});
    range.high = applied(Operation::add, {range.high, error});
    return range;
  }

  Range range(const Node& node) const {
    if (node.children.empty()) return leaf(node);
    std::vector<Range> of;
    Range result;
    for (const auto& child : node.children) {
      of.push_back(range(*child));
      result.is_exact = result.is_exact && of.back().is_exact;
      for (const SqlFragment& condition : of.back().any) result.may_be_anything_where(condition);
    }
    if (result.is_exact) {
      set_increasing(result, node.operation, of);  // low and high are one
      return result;
    }
    set_ends(result, node, of);
    if (result.low.text.size() + result.high.text.size() > kLongest) result.may_be_anything();
    return result;
  }

  /// Numbers or texts beside each other.
  VerdictSql comparison(const Node& node) const {
    const Range a = range(*node.children[0]), b = range(*node.children[1]);
    Range side = a;
    for (const SqlFragment& condition : b.any) side.may_be_anything_where(condition);
    return unless_any(side.any, compared(node.operation, a, b));
  }

  static VerdictSql compared(Operation operation, const Range& a, const Range& b) {
    if (a.is_exact && b.is_exact) {
      const SqlFragment plain = applied(operation, {a.low, b.low});
      return {plain, plain};
    }
    if (operation == Operation::less || operation == Operation::less_equal)
      return {applied(operation, {a.high, b.low}), applied(operation, {a.low, b.high})};
    if (operation == Operation::greater || operation == Operation::greater_equal)
      return {applied(operation, {a.low, b.high}), applied(operation, {a.high, b.low})};
    const SqlFragment one_value = both(applied(Operation::equal, {a.low, b.high}),
                                       applied(Operation::equal, {a.high, b.low}));
    const SqlFragment meet = both(applied(Operation::less_equal, {a.low, b.high}),
                                  applied(Operation::less_equal, {b.low, a.high}));
    const VerdictSql equal = {one_value, meet};
    return operation == Operation::equal ? equal : negation(equal);
  }

  /// Conditions beside each other. a = b is (a and b) or (not a and not b), which is missing too
  /// where one of them is.
  VerdictSql equivalence(const Node& node) const {
    const VerdictSql a = condition(*node.children[0]), b = condition(*node.children[1]);
    const VerdictSql not_a = negation(a), not_b = negation(b);
    const VerdictSql same = {
        either(both(a.certain, b.certain), both(not_a.certain, not_b.certain)),
        either(both(a.possible, b.possible), both(not_a.possible, not_b.possible))};
    if (same.certain.text.size() > kLongest) return undivided(node);
    return node.operation == Operation::equal ? same : negation(same);
  }

  /// The condition as it stands, or either where some name is not resolved or has an error.
  VerdictSql undivided(const Node& node) const {
    Range names;
    add_doubts(node, names);
    const SqlFragment plain = sql_of(node, symbols_);
    return unless_any(names.any, {plain, plain});
  }
  void add_doubts(const Node& node, Range& names) const {
    for (const auto& child : node.children) add_doubts(*child, names);
    if (!node.children.empty()) return;
    const Range one = leaf(node);
    for (const SqlFragment& condition : one.any) names.may_be_anything_where(condition);
    if (!one.is_exact) names.may_be_anything_where({"1", {}});
  }

  const std::vector<Symbol>& symbols_;
};

}  // namespace

VerdictSql Expression::verdict_sql() const {
  FAULTSIM_DEMAND(type().kind == Kind::boolean, text_);
  return VerdictWriter(symbols_).verdict(*root_);
}

}  // namespace faultsweep
