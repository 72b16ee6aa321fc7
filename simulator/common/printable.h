#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace faultsim {

/// One code point of UTF-8, or a byte that begins none.
struct Character {
  std::size_t size = 1;  ///< bytes.
  std::uint32_t code = 0;
  bool valid = false;
};
/// @pre i < text.size().
Character character_at(std::string_view text, std::size_t i);

/// What printable() leaves as it is.
enum class Keep {
  nothing,
  line_ends,  ///< '\n' of texts that we made of several lines.
};

/// text with what a terminal would obey rather than show spelled out ("\u001b", "\u202e", "\xff"):
/// C0 and C1 control characters, DEL, marks that turn the direction of writing, line and paragraph
/// separators; and bytes that are not UTF-8. What remains is safe in a message or table.
std::string printable(std::string_view text, Keep keep = Keep::nothing);

/// The first such character of text as printable() spells it; "" if there is none.
std::string first_unprintable(std::string_view text);

/// At most `most` characters (code points, never cut within one) of text, "..." after them if there
/// are more.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace faultsim
