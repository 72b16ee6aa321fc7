#include "simulator/common/printable.h"

#include <array>
#include <utility>

#include "simulator/common/text.h"

namespace faultsim {
Character character_at(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(i);
  if (first < 0x80) return {1, first, true};
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || i + size > text.size()) return {};
  std::uint32_t code = first & (0x7FU >> size);
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(i + k) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[size] || code > 0x10FFFF || surrogate) return {};
  return {size, code, true};
}

namespace {

bool is_control(std::uint32_t code) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 7> kRanges = {{
      {0x00, 0x1F},      // C0
      {0x7F, 0x9F},      // DEL, C1
      {0x061C, 0x061C},  // Arabic letter mark
      {0x200E, 0x200F},  // left-to-right and right-to-left marks
      {0x2028, 0x202E},  // line and paragraph separators, embeddings, overrides
      {0x2066, 0x2069},  // isolates
      {0xFEFF, 0xFEFF},  // byte order mark
  }};
  for (const auto& [first, last] : kRanges) {
    if (code >= first && code <= last) return true;
  }
  return false;
}

std::string spelled(std::string_view text, std::size_t i, const Character& one) {
  return one.valid ? formatted("\\u%04x", one.code)
                   : formatted("\\x%02x", static_cast<unsigned char>(text[i]));
}

}  // namespace

std::string printable(std::string_view text, Keep keep) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const Character one = character_at(text, i);
    const bool line_end = one.code == '\n' && keep == Keep::line_ends;
    if (one.valid && (line_end || !is_control(one.code))) {
      result += text.substr(i, one.size);
    } else {
      result += spelled(text, i, one);
    }
    i += one.size;
  }
  return result;
}

std::string first_unprintable(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] >= ' ' && text[i] <= '~') {  // nearly always
      ++i;
      continue;
    }
    const Character one = character_at(text, i);
    if (!one.valid || is_control(one.code)) return spelled(text, i, one);
    i += one.size;
  }
  return "";
}

std::string shortened(std::string_view text, std::size_t most) {
  std::size_t end = 0;
  for (std::size_t n = 0; n < most && end < text.size(); ++n) end += character_at(text, end).size;
  return std::string(text.substr(0, end)) + (end < text.size() ? "..." : "");
}

}  // namespace faultsim
