#include <algorithm>
#include <cctype>
#include <charconv>
#include <unordered_map>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/expression/node.h"

namespace faultsweep {
namespace {

constexpr std::size_t kMaximumLength = 10'000;
constexpr int kMaximumDepth = 200;
// SQLite takes trees of 1000 levels (those of a statement in another one count twice), of which a
// quotient has two, and functions of 127 values.
constexpr std::size_t kMostTerms = 200;
constexpr std::size_t kMostValues = 100;

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool is_keyword(std::string_view word) {
  return word == "and" || word == "or" || word == "not" || word == "true" || word == "false";
}

/// Whether an expression may have a name without quotes: letters, digits and dots before letters.
bool can_stand_alone(std::string_view name) {
  if (name.empty() || !is_letter(name.front()) || is_keyword(name)) return false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_dot = name[i] == '.' && i + 1 < name.size() && is_letter(name[i + 1]);
    if (!is_letter(name[i]) && !is_digit(name[i]) && !is_dot) return false;
  }
  return true;
}

/// A number with its unit in SI, or nothing when the unit is unknown.
struct Quantity {
  double value = 0;
  Type type;
};
std::optional<Quantity> read_quantity(const std::string& text) {
  for (const faultsim::DimensionInfo& one : faultsim::dimensions()) {
    if (one.dimension == Dimension::number) continue;
    const auto parsed = faultsim::parse_quantity(text, one.dimension);
    if (parsed.ok) return Quantity{parsed.value, number_type(one.dimension)};
  }
  return std::nullopt;
}

class Parser {
 public:
  Parser(const std::string& text, const std::vector<std::string>& known, const Scopes& scopes)
      : text_(text), known_(known), scopes_(scopes) {}

  ParsedText parse() {
    if (text_.size() > kMaximumLength) fail(0, "the expression is too long", "split it");
    skip_blanks();
    if (at_end()) fail(0, "the expression is empty", "write a condition such as offset > 100 m");
    auto root = parse_or();
    if (!at_end()) fail_unexpected();
    return {std::move(root), std::move(names_)};
  }

 private:
  using NodePointer = std::unique_ptr<Node>;

  [[noreturn]] void fail(std::size_t position, const std::string& what,
                         const std::string& cure) const {
    throw ExpressionError(text_, position, what, cure);
  }
  [[noreturn]] void fail_unexpected() const {
    if (at_end())
      fail(position_, "the expression ends too early", "add the value that is missing here");
    const char c = text_[position_];
    if (text_.compare(position_, 2, "&&") == 0) fail(position_, "\"&&\" is unknown", "write and");
    if (text_.compare(position_, 2, "||") == 0) fail(position_, "\"||\" is unknown", "write or");
    if (c == '!') fail(position_, "\"!\" is unknown", "write not");
    if (c == ')') fail(position_, "\")\" closes nothing", "remove it or add \"(\" before");
    if (is_letter(c) || is_digit(c) || c == '"' || c == '\'') {
      fail(position_, "an operator is missing before this",
           "write for example and, or, <, >, =, +, - or *");
    }
    fail(position_, "unexpected character", "remove it");
  }

  bool at_end() const { return position_ >= text_.size(); }
  void skip_blanks() {
    while (!at_end() && std::isspace(static_cast<unsigned char>(text_[position_])) != 0) {
      ++position_;
    }
  }
  bool accept(std::string_view symbol) {
    if (text_.compare(position_, symbol.size(), symbol) != 0) return false;
    position_ += symbol.size();
    skip_blanks();
    return true;
  }
  std::string_view peek_word() const {
    std::size_t end = position_;
    if (!is_letter(text_[end])) return {};
    while (is_letter(text_[end]) || is_digit(text_[end]) ||
           (text_[end] == '.' && is_letter(text_[end + 1]))) {
      ++end;
    }
    return std::string_view(text_).substr(position_, end - position_);
  }
  bool accept_word(std::string_view word) {
    if (peek_word() != word) return false;
    position_ += word.size();
    skip_blanks();
    return true;
  }

  static NodePointer make(Operation operation, std::size_t position, NodePointer left,
                          NodePointer right = nullptr) {
    auto node = std::make_unique<Node>();
    node->operation = operation;
    node->position = position;
    node->end = position + 1;
    node->children.push_back(std::move(left));
    if (right) node->children.push_back(std::move(right));
    return node;
  }

  /// Counts the nesting, so that "((((…" ends in a message and not in a stack overflow.
  struct Depth {
    int& depth;
    ~Depth() { --depth; }
  };
  Depth enter() {
    if (++depth_ > kMaximumDepth)
      fail(position_, "the expression is nested too deeply", "simplify it");
    return {depth_};
  }

  using Operators = std::initializer_list<std::pair<std::string_view, Operation>>;
  /// Takes the operator that stands here, the first that fits.
  std::optional<Operation> accept_one(const Operators& operators) {
    for (const auto& [symbol, operation] : operators) {
      if (is_letter(symbol.front()) ? accept_word(symbol) : accept(symbol)) return operation;
    }
    return std::nullopt;
  }
  /// operand (operator operand)*, from left to right.
  NodePointer parse_chain(NodePointer (Parser::*operand)(), const Operators& operators) {
    auto left = (this->*operand)();
    std::size_t n_terms = 1, start = position_;
    for (; const auto operation = accept_one(operators); start = position_) {
      if (++n_terms > kMostTerms) {
        fail(start, concat("there are more than ", kMostTerms, " terms here"),
             "put some of them in brackets");
      }
      left = make(*operation, start, std::move(left), (this->*operand)());
    }
    return left;
  }

  /// The same of `and` or of `or`, as a tree of few levels however many conditions there are: their
  /// value does not depend on how they are grouped.
  NodePointer parse_conditions(NodePointer (Parser::*operand)(), std::string_view word,
                               Operation operation) {
    std::vector<NodePointer> conditions;
    std::vector<std::size_t> places;  // of the words between them
    conditions.push_back((this->*operand)());
    for (std::size_t start = position_; accept_word(word); start = position_) {
      places.push_back(start);
      conditions.push_back((this->*operand)());
    }
    return balanced(operation, conditions, places, 0, conditions.size());
  }
  static NodePointer balanced(Operation operation, std::vector<NodePointer>& conditions,
                              const std::vector<std::size_t>& places, std::size_t begin,
                              std::size_t end) {
    if (end - begin == 1) return std::move(conditions[begin]);
    const std::size_t middle = begin + (end - begin + 1) / 2;
    return make(operation, places[middle - 1],
                balanced(operation, conditions, places, begin, middle),
                balanced(operation, conditions, places, middle, end));
  }

  NodePointer parse_or() {
    const Depth depth = enter();
    return parse_conditions(&Parser::parse_and, "or", Operation::logical_or);
  }
  NodePointer parse_and() {
    return parse_conditions(&Parser::parse_not, "and", Operation::logical_and);
  }
  NodePointer parse_not() {
    const Depth depth = enter();
    const std::size_t start = position_;
    if (accept_word("not")) return make(Operation::logical_not, start, parse_not());
    return parse_comparison();
  }

  std::optional<Operation> accept_comparison() {
    return accept_one({{"<=", Operation::less_equal},
                       {">=", Operation::greater_equal},
                       {"!=", Operation::not_equal},
                       {"<>", Operation::not_equal},
                       {"==", Operation::equal},
                       {"<", Operation::less},
                       {">", Operation::greater},
                       {"=", Operation::equal}});
  }
  NodePointer parse_comparison() {
    auto left = parse_sum();
    const std::size_t start = position_;
    const auto operation = accept_comparison();
    if (!operation) return left;
    auto node = make(*operation, start, std::move(left), parse_sum());
    const std::size_t second = position_;
    if (accept_comparison()) {
      fail(second, "comparisons cannot be chained", "write a < b and b < c");
    }
    return node;
  }
  NodePointer parse_sum() {
    return parse_chain(&Parser::parse_product, {{"+", Operation::add}, {"-", Operation::subtract}});
  }
  NodePointer parse_product() {
    return parse_chain(&Parser::parse_unary,
                       {{"*", Operation::multiply}, {"/", Operation::divide}});
  }
  NodePointer parse_unary() {
    const Depth depth = enter();
    const std::size_t start = position_;
    if (accept("-")) return make(Operation::negate, start, parse_unary());
    return parse_power();
  }
  NodePointer parse_power() {
    auto base = parse_primary();
    const std::size_t start = position_;
    if (text_.compare(start, 2, "**") == 0) {
      fail(start, "\"**\" is unknown", "write ^ for a power");
    }
    if (!accept("^")) return base;
    return make(Operation::power, start, std::move(base), parse_unary());
  }

  NodePointer parse_primary() {
    if (at_end()) fail_unexpected();
    const char c = text_[position_];
    if (c == '(') return parse_parentheses();
    if (c == '"' || c == '\'') {
      if (auto quoted_fault = parse_quoted_fault()) return quoted_fault;
      return parse_quoted();
    }
    if (is_digit(c) || (c == '.' && is_digit(text_[position_ + 1]))) return parse_number();
    if (is_letter(c)) return parse_word();
    fail_unexpected();
  }
  NodePointer parse_parentheses() {
    const std::size_t start = position_;
    accept("(");
    auto inside = parse_or();
    close_parenthesis(start);
    return inside;
  }

  void close_parenthesis(std::size_t open) {
    if (accept(")")) return;
    if (!at_end()) fail_unexpected();
    fail(open, "this \"(\" is not closed", "add \")\"");
  }

  NodePointer make_literal(std::size_t start, Value value, Type type) {
    auto node = std::make_unique<Node>();
    node->position = start;
    node->end = position_;
    node->literal = std::move(value);
    node->type = type;
    skip_blanks();
    return node;
  }

  /// `"Fault 2".slides`; nothing where the quotes are followed by something else.
  NodePointer parse_quoted_fault() {
    const std::size_t start = position_;
    const auto quoted = quoted_at(text_, start);
    if (!quoted || text_[quoted->end] != '.' || !is_letter(text_[quoted->end + 1])) return nullptr;
    position_ = quoted->end + 1;
    const std::string metric(peek_word());
    position_ += metric.size();
    skip_blanks();
    return make_name(start, quoted->inside + "." + metric);
  }
  /// What stands in the quotes at the position, which moves behind them.
  std::string take_quoted() {
    const auto quoted = quoted_at(text_, position_);
    if (!quoted) fail(position_, "this quote is not closed", "add the closing quote");
    position_ = quoted->end;
    return quoted->inside;
  }

  /// A known name that is not a word, else a number with its unit or text.
  NodePointer parse_quoted() {
    const std::size_t start = position_;
    const std::string inside = take_quoted();
    if (is_known(inside) && !can_stand_alone(inside)) {
      const std::size_t end = position_;
      skip_blanks();
      auto node = make_name(start, inside);
      node->end = end;
      node->quoted = inside;
      node->is_quoted = true;
      return node;
    }
    const bool may_be_number =
        is_digit(inside[0]) || std::string_view("-+.").find(inside[0]) != std::string_view::npos;
    const auto quantity = may_be_number ? read_quantity(inside) : std::nullopt;
    auto node = quantity ? make_literal(start, quantity->value, quantity->type)
                         : make_literal(start, inside, Type{Kind::text, {}});
    node->quoted = inside;
    node->is_quoted = true;
    return node;
  }

  /// End of the digits of a number that starts here: 12, 1.5, .5, 1e-3.
  std::size_t end_of_digits() const {
    double ignored = 0;
    const char* begin = text_.c_str();
    const char* end = std::from_chars(begin + position_, begin + text_.size(), ignored).ptr;
    return static_cast<std::size_t>(end - begin);
  }

  /// End of a unit at begin: words with optional exponents joined by "/", without blanks.
  std::size_t end_of_unit(std::size_t begin, bool with_slash) const {
    std::size_t end = begin;
    while (is_letter(text_[end])) ++end;
    while (is_digit(text_[end])) ++end;
    const bool goes_on =
        with_slash && end > begin && text_[end] == '/' && is_letter(text_[end + 1]);
    return goes_on ? end_of_unit(end + 1, true) : end;
  }

  NodePointer parse_number() {
    const std::size_t start = position_;
    const std::string digits = text_.substr(start, end_of_digits() - start);
    position_ += digits.size();
    skip_blanks();
    const std::string_view word = peek_word();
    if (word.empty() || is_keyword(word)) {
      const auto parsed = faultsim::parse_quantity(digits, Dimension::number);
      if (!parsed.ok) fail(start, parsed.what, parsed.cure);
      auto node = make_literal(start, parsed.value, Type{});
      node->end = start + digits.size();
      return node;
    }
    for (const bool with_slash : {true, false}) {
      const std::size_t end = end_of_unit(position_, with_slash);
      const auto quantity = read_quantity(digits + " " + text_.substr(position_, end - position_));
      if (!quantity) continue;
      position_ = end;
      return make_literal(start, quantity->value, quantity->type);
    }
    const std::string unit = text_.substr(position_, end_of_unit(position_, true) - position_);
    const bool is_name = is_known(std::string(word));
    fail(position_, "unknown unit \"" + unit + "\"",
         is_name ? "write " + digits + " * " + std::string(word)
                 : "some known units: m, km, m2, bar, MPa, GPa, deg, year");
  }

  NodePointer parse_word() {
    const std::size_t start = position_;
    const std::string word(peek_word());
    if (word == "true" || word == "false") {
      position_ += word.size();
      return make_literal(start, word == "true", Type{Kind::boolean, {}});
    }
    if (is_keyword(word)) fail(start, "a value is missing before \"" + word + "\"", "add it");
    position_ += word.size();
    skip_blanks();
    if (!at_end() && text_[position_] == '(') return parse_function(start, word);
    return make_name(start, word);
  }
  /// A name with what may follow it: in a stage.
  NodePointer make_name(std::size_t start, std::string word) {
    auto node = std::make_unique<Node>();
    node->operation = Operation::name;
    node->position = start;
    node->end = start + word.size();
    if (accept_word("in")) {
      const std::size_t place = position_;
      const std::string stage = parse_stage();
      if (!faultsim::contains(scopes_.stages, stage)) {
        fail(place, "there is no stage \"" + stage + "\" in the results",
             cure_of_name(stage, scopes_.stages));
      }
      word += " in " + stage;
      node->end = position_;
    }
    const auto [place, is_new] = name_places_.emplace(word, names_.size());
    node->name = place->second;
    if (is_new) {
      require_known(start, word);
      names_.push_back(word);
    }
    return node;
  }
  bool is_known(const std::string& word) const {
    return std::binary_search(known_.begin(), known_.end(), word);
  }
  std::string parse_stage() {
    const char first = at_end() ? ' ' : text_[position_];
    std::string stage;
    if (first == '"' || first == '\'') {
      stage = take_quoted();
    } else {
      stage = peek_word();
      if (stage.empty()) fail(position_, "a stage is missing after \"in\"", "name one");
      position_ += stage.size();
    }
    skip_blanks();
    return stage;
  }

  /// A name in quotes where it needs them; one of a fault or stage as it is known.
  static std::string as_written(const std::string& name) {
    const bool has_scope =
        name.find('.') != std::string::npos || name.find(" in ") != std::string::npos;
    return can_stand_alone(name) || has_scope ? name : spelled_name(name);
  }

  void require_known(std::size_t start, const std::string& word) const {
    if (is_known(word)) return;
    require_fault(start, word);
    std::string cure;
    if (const auto near = nearest(word, known_)) {
      cure = "did you mean " + as_written(*near) + "?";
    } else {
      cure = known_.empty() ? "no names are known here" : "known names:";
      for (std::size_t i = 0; i < std::min<std::size_t>(known_.size(), 12); ++i) {
        cure += (i == 0 ? " " : ", ") + as_written(known_[i]);
      }
      if (known_.size() > 12) cure += ", ...";
    }
    fail(start, "unknown name \"" + word + "\"", cure);
  }

  /// Where faults are known, what stands before a dot in an unknown name should be one.
  void require_fault(std::size_t start, const std::string& word) const {
    const std::vector<std::string>& faults = scopes_.faults;
    const std::size_t dot = word.rfind('.', word.find(" in "));
    if (faults.empty() || dot == std::string::npos) return;
    const std::string fault = word.substr(0, dot);
    if (faultsim::contains(faults, fault)) return;
    const auto near = nearest(word, known_);
    if (near && near->find('.') != std::string::npos && near->substr(0, near->rfind('.')) == fault)
      return;  // a parameter with a dot in its name, spelled wrong behind it
    fail(start, "there is no fault \"" + fault + "\" in the results", cure_of_name(fault, faults));
  }

  NodePointer parse_function(std::size_t start, const std::string& word) {
    const auto operation = function_named(word);
    if (!operation) {
      const auto near = nearest(word, functions());
      fail(
          start, "unknown function \"" + word + "\"",
          near ? "did you mean " + *near + "?" : "known functions: min max abs sqrt log10 exp tan");
    }
    const std::size_t open = position_;
    accept("(");
    auto node = std::make_unique<Node>();
    node->operation = *operation;
    node->position = start;
    node->end = start + word.size();
    do {
      if (node->children.size() == kMostValues)
        fail(position_, concat(word, " takes at most ", kMostValues, " values"), "nest " + word);
      node->children.push_back(parse_or());
    } while (accept(","));
    close_parenthesis(open);
    const bool many = *operation == Operation::minimum || *operation == Operation::maximum;
    if (many ? node->children.size() < 2 : node->children.size() != 1) {
      fail(start,
           word + " takes " + (many ? "two or more values" : "one value") + ", not " +
               std::to_string(node->children.size()),
           many ? "write " + word + "(a, b)" : "write " + word + "(a)");
    }
    return node;
  }

  const std::string& text_;
  const std::vector<std::string>& known_;
  const Scopes& scopes_;
  std::size_t position_ = 0;
  int depth_ = 0;
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> name_places_;  ///< in names_.
};

}  // namespace

ParsedText parse_expression(const std::string& text, const std::vector<std::string>& known_names,
                            const Scopes& scopes) {
  return Parser(text, known_names, scopes).parse();
}

std::string spelled_name(const std::string& name) {
  const bool is_word =
      !name.empty() && is_letter(name.front()) && !is_keyword(name) &&
      std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); });
  if (is_word) return name;
  const bool has_double = name.find('"') != std::string::npos;
  const char quote = has_double && name.find('\'') == std::string::npos ? '\'' : '"';
  std::string spelled(1, quote);
  for (const char c : name) spelled += c == quote ? std::string(2, quote) : std::string(1, c);
  return spelled + quote;
}

std::optional<QuotedText> quoted_at(std::string_view text, std::size_t start) {
  const char quote = text[start];
  QuotedText found;
  for (std::size_t i = start + 1; i < text.size(); ++i) {
    if (text[i] == quote && (i + 1 == text.size() || text[i + 1] != quote)) {
      found.end = i + 1;
      return found;
    }
    found.inside += text[i];
    i += text[i] == quote ? 1 : 0;  // doubled
  }
  return std::nullopt;
}

}  // namespace faultsweep
