#pragma once

#include <array>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// JSON text as nlohmann::json::dump() writes it: keys sorted, shortest numbers. Written in one go,
/// because a campaign has 10^5 texts.
namespace faultsim {

// Appends a value: a list of its elements, an enumeration as its number.
void append(std::string& text, double value);  ///< −0 as −0.0.
void append(std::string& text, int value);
void append(std::string& text, std::string_view value);  ///< in quotes.
inline void append(std::string& text, const char* value) { append(text, std::string_view(value)); }
inline void append(std::string& text, bool value) { text += value ? "true" : "false"; }
template <typename Enum>
requires std::is_enum_v<Enum>
void append(std::string& text, Enum value) { append(text, static_cast<int>(value)); }

/// @param write  appends an element to the text.
template <typename List, typename Write>
void append_list(std::string& text, const List& list, Write&& write) {
  text += '[';
  bool is_first = true;
  for (const auto& one : list) {
    if (!is_first) text += ',';
    is_first = false;
    write(text, one);
  }
  text += ']';
}
template <std::ranges::range List>
requires(!std::is_convertible_v<List, std::string_view>) void append(std::string& text,
                                                                     const List& list) {
  append_list(text, list, [](std::string& to, const auto& one) { append(to, one); });
}

/// An object at the end of a text, whose members are added in any order.
class ObjectText {
 public:
  explicit ObjectText(std::string& text) : text_(text), begin_(text.size()) {
    members_.reserve(20);
  }
  /// @param write  appends the value to the text.
  template <typename Write>
  requires std::is_invocable_v<Write, std::string&>
  void add(std::string_view key, Write&& write) {
    members_.push_back({key, text_.size(), 0});
    write(text_);
    members_.back().end = text_.size();
  }
  template <typename Value>
  requires(!std::is_invocable_v<Value, std::string&>) void add(std::string_view key,
                                                               const Value& value) {
    add(key, [&](std::string& text) { append(text, value); });
  }
  /// Puts the members in order and ends the object.
  void close();

 private:
  struct Member {
    std::string_view key;    ///< stays where it is.
    std::size_t begin, end;  ///< of its value.
  };
  std::string& text_;
  std::size_t begin_;
  std::vector<Member> members_;
};

}  // namespace faultsim
