#include "simulator/documents/canonical_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace faultsim {

void append(std::string& text, double value) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  // That of dump(), without a document around it: a tenth of the time.
  std::array<char, 64> digits{};
  text.append(digits.data(), nlohmann::detail::to_chars(digits.data(), digits.data() + 64, value));
}

void append(std::string& text, int value) { text += std::to_string(value); }

void append(std::string& text, std::string_view value) {
  const bool is_plain = std::ranges::all_of(
      value, [](char c) { return c >= ' ' && c < '\x7f' && c != '"' && c != '\\'; });
  if (is_plain) {
    text.append("\"").append(value).append("\"");
  } else {
    text += nlohmann::json(value).dump();
  }
}

void ObjectText::close() {
  std::ranges::sort(members_, {}, &Member::key);
  std::string object;
  object.reserve(text_.size() - begin_ + 32 * members_.size() + 2);
  object += '{';
  for (const Member& member : members_) {
    if (object.size() > 1) object += ',';
    append(object, member.key);
    object += ':';
    object.append(text_, member.begin, member.end - member.begin);
  }
  object += '}';
  text_.replace(begin_, std::string::npos, object);
}

}  // namespace faultsim
