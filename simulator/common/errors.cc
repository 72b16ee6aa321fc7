#include "simulator/common/errors.h"

#include <algorithm>
#include <string_view>

#include "simulator/common/printable.h"

namespace faultsim {
namespace {

/// "simulator/mesh/split.cc" of any path to it: where the program was built is nobody's business.
std::string_view in_repository(std::string_view file) {
  std::size_t begin = 0;
  for (const std::string_view root : {"/simulator/", "/campaign/", "/tests/"}) {
    const std::size_t at = file.rfind(root);
    if (at != std::string_view::npos) begin = std::max(begin, at + 1);
  }
  return file.substr(begin);
}

}  // namespace

// Escaped once more where text of a user came in by another way than format_problems: what() ends
// at a NUL, and a terminal obeys the others.
Error::Error(std::string message) : text_(std::move(message)) {
  text_ = printable(text_, Keep::line_ends);
}

void Error::add_context(std::string doing) {
  doing = printable(doing, Keep::line_ends);
  text_ += " / while " + doing;
}

InputError::InputError(std::string source, std::vector<Problem> problems)
    : Error(format_problems(source, problems)),
      source_(std::move(source)),
      problems_(std::move(problems)) {}

std::string format_problems(const std::string& source, const std::vector<Problem>& problems) {
  std::vector<Problem> sorted = problems;
  std::ranges::stable_sort(sorted, {}, &Problem::line);
  constexpr std::size_t kMostSpelledOut = 2000;
  std::string text;
  for (const Problem& problem : sorted) {
    if (!text.empty()) text += '\n';
    if (&problem - sorted.data() == kMostSpelledOut)
      return text + concat(printable(source), ": and ", sorted.size() - kMostSpelledOut, " more");
    text += printable(source);
    if (problem.line > 0) text += ":" + std::to_string(problem.line);
    text += ": ";
    if (!problem.pointer.empty()) text += printable(problem.pointer) + ": ";
    text += printable(problem.what, Keep::line_ends);
    if (!problem.cure.empty()) text += "; " + printable(problem.cure, Keep::line_ends);
  }
  return text;
}

void throw_internal(const char* condition, const std::string& values, const char* file, int line) {
  throw InternalError(concat("internal error: ", condition, " does not hold (", values, ") at ",
                             in_repository(file), ":", line));
}

}  // namespace faultsim
