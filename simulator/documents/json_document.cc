#include "simulator/documents/json_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "simulator/common/input_file.h"
#include "simulator/common/printable.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxDepth = 64;  // Ours nest to 8; more is an attack or a mistake.
// The place of every value is kept, so places are short and values not without number: 1 GB at
// most.
constexpr std::size_t kMaxPointer = 500;       // bytes; ours have 100
constexpr std::size_t kMaxValues = 2'000'000;  // 10^5 cases of 10 values are 10^6

/// Reads characters and tells through `position` how many the parser has taken.
class CountingIterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator() = default;
  CountingIterator(const char* at, const char** position) : at_(at), position_(position) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    if (position_ != nullptr) *position_ = at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_ = nullptr;
  const char** position_ = nullptr;
};

/// Builds the document from the parser's events; finds duplicate keys and too much depth.
class Builder final : public json::json_sax_t {
 public:
  Builder(std::string_view text, JsonDocument& document)
      : document_(document), counted_(text.data()), position_(text.data()) {}

  const char** position() { return &position_; }
  const std::vector<Problem>& problems() const { return problems_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override {
    // 10.0 and 1e1 are whole numbers too (draft-07 says so); -0.0 stays a float.
    constexpr double kExact = 9007199254740992.0;  // 2^53
    const bool whole = std::nearbyint(value) == value && std::abs(value) < kExact;
    if (whole && value != 0) return add(static_cast<std::int64_t>(value));
    return add(value);
  }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(json::object(), false); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(json::array(), true); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    Frame& frame = stack_.back();
    frame.key = name;
    const std::string pointer = frame.pointer + "/" + pointer_token(name);
    if (pointer.size() > kMaxPointer) {
      problems_.push_back({frame.pointer, line_at(-2),
                           concat("the key \"", shortened(name, 40), "\" and those above it have ",
                                  pointer.size(), " bytes, more than ", kMaxPointer),
                           "use shorter names"});
      return false;
    }
    if (frame.node->contains(name)) {
      problems_.push_back(
          {pointer, line_at(-2),
           concat("key \"", name, "\" is given twice, first in line ", document_.line_of(pointer)),
           "remove one of the two"});
    }
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
    constexpr int kOverflow = 406;
    if (error.id == kOverflow) {
      const std::string text = error.what();
      const auto quote = text.find('\'');
      problems_.push_back({next_pointer(), line_at(-2),
                           "number " +
                               shortened(text.substr(quote + 1, text.rfind('\'') - quote - 1), 40) +
                               " overflows",
                           "write a finite number"});
    } else {
      problems_.push_back(syntax_problem(error.what()));
    }
    return false;
  }

 private:
  struct Frame {
    json* node;
    bool is_array;
    std::string pointer;
    std::string key;  ///< the member being read.
  };

  /// Line of the character at the parser's position plus offset. The parser has taken one character
  /// past a number, none past anything else; so -2 is right for scalars and -1 for brackets.
  int line_at(std::ptrdiff_t offset) {
    const char* until = std::max(position_ + offset, counted_);
    line_ += static_cast<int>(std::count(counted_, until, '\n'));
    counted_ = until;
    return line_;
  }
  std::string next_pointer() const {
    if (stack_.empty()) return "";
    const Frame& frame = stack_.back();
    if (frame.is_array) return frame.pointer + "/" + std::to_string(frame.node->size());
    return frame.pointer + "/" + pointer_token(frame.key);
  }
  json* place(json value, std::ptrdiff_t offset) {
    const std::string pointer = next_pointer();
    document_.lines[pointer] = line_at(offset);
    if (stack_.empty()) {
      document_.value = std::move(value);
      return &document_.value;
    }
    Frame& frame = stack_.back();
    if (frame.is_array) {
      frame.node->push_back(std::move(value));
      return &frame.node->back();
    }
    return &((*frame.node)[frame.key] = std::move(value));
  }
  bool add(json value) {
    place(std::move(value), -2);
    return has_room();
  }
  bool has_room() {
    if (document_.lines.size() <= kMaxValues) return true;
    problems_.push_back({"", line_at(-2), concat("there are more than ", kMaxValues, " values"),
                         "this is not a file for this program"});
    return false;
  }
  bool open(json value, bool is_array) {
    if (stack_.size() >= kMaxDepth) {
      problems_.push_back({"", line_at(-1), concat("values are nested deeper than ", kMaxDepth),
                           "this is not a file for this program"});
      return false;
    }
    const std::string pointer = next_pointer();
    json* node = place(std::move(value), -1);
    stack_.push_back({node, is_array, pointer, ""});
    return true;
  }
  bool close() {
    stack_.pop_back();
    return true;
  }
  /// From "[...] parse error at line L, column C: syntax error while parsing X - DETAIL".
  static Problem syntax_problem(const std::string& text) {
    Problem problem;
    std::string detail = text;
    if (const auto at = text.find("at line "); at != std::string::npos) {
      problem.line = std::stoi(text.substr(at + 8));
      const auto colon = text.find(": ", at);
      const auto column = text.find("column ", at);
      detail = text.substr(column, colon - column) + ": " + text.substr(colon + 2);
    }
    const std::string noise = "syntax error ";
    if (const auto at = detail.find(noise); at != std::string::npos) detail.erase(at, noise.size());
    constexpr std::size_t kLongest = 200;  // the parser repeats what it read last, be it megabytes
    problem.what = "not valid JSON, " + shortened(detail, kLongest);
    problem.cure = "look here and just before for a missing or superfluous comma, quote or bracket";
    return problem;
  }

  JsonDocument& document_;
  const char* counted_;  ///< newlines before this place are counted in line_.
  const char* position_;
  int line_ = 1;
  std::vector<Frame> stack_;
  std::vector<Problem> problems_;
};

/// Takes the first token off a pointer.
std::string_view next_token(std::string_view& pointer) {
  const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
  const std::string_view token = pointer.substr(1, end - 1);
  pointer.remove_prefix(end);
  return token;
}

std::string unescaped(std::string_view token) {
  std::string key;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const bool escape = token[i] == '~' && i + 1 < token.size();
    if (escape) ++i;
    key += escape ? (token[i] == '1' ? '/' : '~') : token[i];
  }
  return key;
}

[[noreturn]] void refuse(const JsonDocument& document, const std::string& pointer,
                         const std::string& what, const std::string& cure) {
  throw InputError(document.source, {{pointer, 0, what, cure}});
}

/// Says why put_value could not.
[[noreturn]] void refuse_place(const JsonDocument& document, const std::string& pointer) {
  const json* node = &document.value;
  std::string_view rest = pointer;
  std::string_view token = next_token(rest);
  std::size_t end = 0;  // of the pointer to node
  while (const json* child = child_at(*node, token)) {
    node = child;
    end = pointer.size() - rest.size();
    token = next_token(rest);
  }
  const std::string parent = end == 0 ? "the document" : pointer.substr(0, end);
  if (!node->is_array()) {
    refuse(document, pointer, parent + " is neither an object nor a list",
           "see `faultsim parameters` for what can be set");
  }
  refuse(document, pointer,
         concat(parent, " has ", node->size(), " elements and no \"", token, "\""),
         node->empty() ? "write the element into the file"
                       : concat("use an index from 0 to ", node->size() - 1));
}

}  // namespace

int JsonDocument::line_of(const std::string& pointer) const {
  std::string at = pointer;
  while (true) {
    if (const auto found = lines.find(at); found != lines.end()) return found->second;
    if (at.empty()) return 0;
    at.resize(at.rfind('/') == std::string::npos ? 0 : at.rfind('/'));
  }
}

JsonDocument parse_json(std::string_view text, const std::string& source) {
  JsonDocument document;
  document.source = source;
  if (text.size() > kMostJsonBytes) {
    throw InputError(source, concat("has ", text.size(), " bytes"),
                     concat("at most ", kMostJsonBytes, " are read"));
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw InputError(source, {{"", 1, "the file is empty", "start from `faultsim init`"}});
  }
  Builder builder(text, document);
  const bool complete =
      json::sax_parse(CountingIterator(text.data(), builder.position()),
                      CountingIterator(text.data() + text.size(), nullptr), &builder);
  FAULTSIM_DEMAND(complete || !builder.problems().empty(), "source ", source);
  if (!builder.problems().empty()) throw InputError(source, builder.problems());
  return document;
}

std::string pointer_token(const std::string& key) {
  return (json::json_pointer() / key).to_string().substr(1);
}

const json* child_at(const json& parent, std::string_view token) {
  if (parent.is_object()) {
    const bool escaped = token.find('~') != std::string_view::npos;
    const auto found = escaped ? parent.find(unescaped(token)) : parent.find(token);
    return found == parent.end() ? nullptr : &*found;
  }
  std::size_t index = 0;
  const auto [rest, error] = std::from_chars(token.data(), token.data() + token.size(), index);
  const bool is_index = error == std::errc() && rest == token.data() + token.size() &&
                        (token.size() == 1 || token[0] != '0');
  return parent.is_array() && is_index && index < parent.size() ? &parent[index] : nullptr;
}

const json* value_at(const json& document, std::string_view pointer) {
  const json* value = &document;
  while (value != nullptr && !pointer.empty()) value = child_at(*value, next_token(pointer));
  return value;
}

bool put_value(json& document, std::string_view pointer, json value) {
  json* place = &document;
  while (!pointer.empty()) {
    const std::string_view token = next_token(pointer);
    if (place->is_null()) *place = json::object();
    if (place->is_object()) {
      place = &(*place)[unescaped(token)];
    } else if (const json* element = child_at(*place, token)) {
      place = const_cast<json*>(element);
    } else {
      return false;
    }
  }
  *place = std::move(value);
  return true;
}

namespace {

/// Behind as many empty lines as stand before it.
std::string scene_of_page(const std::string& html, const std::string& source) {
  const std::size_t at = html.find(kSceneElement);
  const std::size_t end = at == std::string::npos ? at : html.find("</script>", at);
  if (end == std::string::npos) {
    throw InputError(source, "the page contains no scene",
                     "name a page that faultsim report wrote, or a scene file");
  }
  const std::size_t begin = at + kSceneElement.size();
  const auto n_lines =
      std::count(html.begin(), html.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  return std::string(static_cast<std::size_t>(n_lines), '\n') + html.substr(begin, end - begin);
}

}  // namespace

JsonDocument read_json_file(const std::string& path) {
  const std::string text = read_input_or_throw(path, kMostJsonBytes);
  return parse_json(path.ends_with(".html") ? scene_of_page(text, path) : text, path);
}

json value_of_text(const std::string& text, const std::string& source, const std::string& pointer) {
  try {
    if (json::accept(text)) return parse_json(text, "").value;
  } catch (const InputError&) {  // JSON, but none that a file may hold: taken as text
  }
  const std::string bad = first_unprintable(text);  // a plain text such as 25 deg
  if (bad.empty()) return text;
  throw InputError(
      source,
      {{pointer, 0, "the value contains the control character or stray byte " + bad, "remove it"}});
}

void set_value(JsonDocument& document, const std::string& pointer, const std::string& value) {
  if (pointer.size() < 2 || pointer[0] != '/') {
    refuse(document, pointer, "\"" + pointer + "\" is not a JSON Pointer to a value",
           "write for example /friction/friction_angle");
  }
  json new_value = value_of_text(value, document.source, pointer);
  if (!put_value(document.value, pointer, std::move(new_value))) refuse_place(document, pointer);
  for (auto slash = pointer.find('/', 1); slash != std::string::npos;
       slash = pointer.find('/', slash + 1)) {
    document.lines.emplace(pointer.substr(0, slash), 0);  // made on the way
  }
  std::erase_if(document.lines,
                [&](const auto& entry) { return entry.first.rfind(pointer + "/", 0) == 0; });
  document.lines[pointer] = 0;
}

}  // namespace faultsim
