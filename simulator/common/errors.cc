#include "simulator/common/errors.h"

#include <algorithm>

namespace faultsim {

Error::Error(std::string message) : text_(std::move(message)) {}

void Error::add_context(std::string doing) { text_ += " / while " + std::move(doing); }

InputError::InputError(std::string source, std::vector<Problem> problems)
    : Error(format_problems(source, problems)),
      source_(std::move(source)),
      problems_(std::move(problems)) {}

std::string format_problems(const std::string& source, const std::vector<Problem>& problems) {
  std::vector<Problem> sorted = problems;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  std::string text;
  for (const Problem& problem : sorted) {
    if (!text.empty()) text += '\n';
    text += source;
    if (problem.line > 0) text += ":" + std::to_string(problem.line);
    text += ": ";
    if (!problem.pointer.empty()) text += problem.pointer + ": ";
    text += problem.what;
    if (!problem.cure.empty()) text += "; " + problem.cure;
  }
  return text;
}

void throw_internal(const char* condition, const std::string& values, const char* file, int line) {
  throw InternalError(
      concat("internal error: ", condition, " does not hold (", values, ") at ", file, ":", line));
}

}  // namespace faultsim
