# cmake -DINPUT=file -DOUTPUT=header -DSYMBOL=name -P embed.cmake: a text file as a string_view, and
# its SHA-256 in hexadecimal digits as NAME_sha256.
# The text is cut into pieces because compilers limit the length of one string literal.
file(READ ${INPUT} text)
string(SHA256 sha256 "${text}")
string(LENGTH "${text}" length)
set(pieces "")
set(position 0)
while(position LESS length)
  string(SUBSTRING "${text}" ${position} 8000 piece)
  string(APPEND pieces "R\"~~~(${piece})~~~\"\n")
  math(EXPR position "${position} + 8000")
endwhile()
file(WRITE ${OUTPUT} "#pragma once
#include <string_view>
namespace faultsim::embedded {
inline constexpr std::string_view ${SYMBOL} =
${pieces};
inline constexpr std::string_view ${SYMBOL}_sha256 = \"${sha256}\";
}  // namespace faultsim::embedded
")
