#include "campaign/expression/expression.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/expression/node.h"
#include "simulator/common/near_miss.h"

namespace faultsweep {
namespace {

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// The text on its own line and a caret below; columns are counted in characters, not bytes. Of a
/// long text what stands around the place.
std::string caret_lines(const std::string& text, std::size_t position) {
  constexpr std::size_t kAround = 100;
  const auto continues = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  std::size_t begin = position > kAround ? position - kAround : 0;
  std::size_t end = std::min(text.size(), position + kAround);
  while (begin > 0 && continues(begin)) --begin;
  while (continues(end)) ++end;
  std::string shown = text.substr(begin, end - begin);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
  const std::string left = begin > 0 ? "..." : "";
  std::size_t column = left.size();
  for (std::size_t i = begin; i < std::min(position, text.size()); ++i) {
    if (!continues(i)) ++column;
  }
  return "\n    " + left + shown + (end < text.size() ? "..." : "") + "\n    " +
         std::string(column, ' ') + "^";
}

/// Refuses what SQLite's parser could not take, wherever the expression is used.
void require_flat(const Node& root, const std::string& text, std::size_t n_names) {
  const Symbol column = {"x", {}};
  const SqlFragment sql = sql_of(root, std::vector<Symbol>(n_names, column));
  if (sql.depth <= kDeepestSql) return;
  throw ExpressionError(text, root.position, "the expression is nested too deeply", "simplify it");
}

}  // namespace

Units units_of(Dimension dimension) { return {faultsim::info_of(dimension).powers}; }

std::string describe(const Units& units) {
  for (const faultsim::DimensionInfo& one : faultsim::dimensions()) {
    if (one.powers == units.exponents) return one.noun;
  }
  static constexpr std::array kBase = {"m", "kg", "s", "rad", "K"};
  std::string text = "in";
  for (std::size_t i = 0; i < kBase.size(); ++i) {
    if (units.exponents[i] == 0) continue;
    text += std::string(" ") + kBase[i];
    if (units.exponents[i] != 1) text += std::to_string(units.exponents[i]);
  }
  return text;
}

Type number_type(Dimension dimension) { return {Kind::number, units_of(dimension)}; }

ExpressionError::ExpressionError(const std::string& text, std::size_t position,
                                 const std::string& what, const std::string& cure)
    : InputError("expression", what, cure + caret_lines(text, position)),
      position_(position),
      message_(what + "; " + cure + caret_lines(text, position)) {}

Expression Expression::parse(const std::string& text, const Symbols& symbols,
                             const Scopes& scopes) {
  std::vector<std::string> known;
  for (const auto& [name, symbol] : symbols) known.push_back(name);
  ParsedText parsed = parse_expression(text, known, scopes);
  Expression expression;
  expression.text_ = text;
  expression.names_ = std::move(parsed.names);
  std::vector<Type> types;
  for (const std::string& name : expression.names_) {
    const Symbol& symbol = symbols.at(name);
    FAULTSIM_DEMAND(symbol.error >= 0 && std::isfinite(symbol.error), name, ' ', symbol.error);
    types.push_back(symbol.type);
    expression.symbols_.push_back(symbol);
  }
  check_types(*parsed.root, text, expression.names_, types);
  require_flat(*parsed.root, text, expression.names_.size());
  expression.root_ = std::shared_ptr<const Node>(std::move(parsed.root));
  return expression;
}

Type Expression::type() const { return root_->type; }

std::string cure_of_name(std::string_view word, const std::vector<std::string>& candidates) {
  std::string cure;
  if (const auto meant = nearest(word, candidates)) cure = "did you mean " + *meant + "? ";
  cure += candidates.empty() ? "there are none" : "there are: ";
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    cure += (i == 0 ? "" : ", ") + candidates[i];
  }
  return cure;
}

std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestWord = 100;  // nobody mistypes one; the distance takes its square
  if (word.size() > kLongestWord) return std::nullopt;
  const std::string wanted = lower(word);
  std::optional<std::string> best;
  std::size_t best_distance = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::string other = lower(candidate);
    const std::size_t shorter = std::min(wanted.size(), other.size());
    const std::size_t least = std::max(wanted.size(), other.size()) - shorter;
    std::size_t distance = least < best_distance ? faultsim::edit_distance(wanted, other) : least;
    // "salt.youngs_modulus" for "youngs_modulus": the right word without its owner.
    const std::size_t dot = other.find_last_of("./");
    if (dot != std::string::npos && other.substr(dot + 1) == wanted) {
      distance = std::min<std::size_t>(distance, 1);
    }
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace faultsweep
