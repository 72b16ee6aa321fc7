#include "campaign/expression/expression.h"

#include <algorithm>
#include <cctype>

#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;

struct NamedUnits {
  Dimension dimension;
  Units units;  // length, mass, time, angle
  const char* name;
};

const std::vector<NamedUnits>& named_units() {
  static const std::vector<NamedUnits> table = {
      {Dimension::number, {{0, 0, 0, 0}}, "a plain number"},
      {Dimension::length, {{1, 0, 0, 0}}, "a length"},
      {Dimension::area, {{2, 0, 0, 0}}, "an area"},
      {Dimension::pressure, {{-1, 1, -2, 0}}, "a pressure"},
      {Dimension::pressure_gradient, {{-2, 1, -2, 0}}, "a pressure gradient"},
      {Dimension::density, {{-3, 1, 0, 0}}, "a density"},
      {Dimension::angle, {{0, 0, 0, 1}}, "an angle"},
      {Dimension::time, {{0, 0, 1, 0}}, "a time"},
      {Dimension::viscosity, {{-1, 1, -1, 0}}, "a viscosity"},
      {Dimension::moment, {{2, 1, -2, 0}}, "a moment"},
      {Dimension::potency, {{3, 0, 0, 0}}, "a volume"},
  };
  return table;
}

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Edit distance in which swapping two neighbours counts one.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({change, previous[j] + 1, current[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before[j - 2] + 1);
      }
    }
    before = previous;
    previous = current;
  }
  return previous[b.size()];
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

}  // namespace

Units units_of(Dimension dimension) {
  for (const auto& row : named_units()) {
    if (row.dimension == dimension) return row.units;
  }
  faultsim::throw_internal("known dimension", "", __FILE__, __LINE__);
}

std::string describe(const Units& units) {
  for (const auto& row : named_units()) {
    if (row.units == units) return row.name;
  }
  static constexpr std::array kBase = {"m", "kg", "s", "rad"};
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
    : InputError("expression", {{"", 0, what, cure + caret_lines(text, position)}}),
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
    types.push_back(symbol.type);
    expression.columns_.push_back(symbol.sql);
  }
  check_types(*parsed.root, text, expression.names_, types);
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
    std::size_t distance = least < best_distance ? edit_distance(wanted, other) : least;
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
