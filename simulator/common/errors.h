#pragma once

#include <exception>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Errors of faultsim and faultsweep: what kind of thing went wrong decides the type, and the type
/// decides the exit code (exit_code.h). An answer that we do not like (no convergence) is a value.
namespace faultsim {

/// Joins the arguments with operator<<, floating point at 17 digits.
template <typename... Args>
std::string concat(const Args&... args) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  (out << ... << args);
  return out.str();
}

/// "1 case", "2 cases".
template <typename Count>
std::string counted(const Count& count, const char* one, const char* many) {
  return concat(count, ' ', count == 1 ? one : many);
}

/// Base of the errors that are not bugs: a message and context lines, innermost first.
class Error : public std::exception {
 public:
  explicit Error(std::string message);
  /// Adds "while <doing>".
  void add_context(std::string doing);
  /// Message and contexts, joined by " / while ".
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// One thing wrong with an input file.
struct Problem {
  std::string pointer;  ///< JSON Pointer to the value ("" = the whole document).
  int line = 0;         ///< Line in the file, from 1; 0 when it has none (a --set value, say).
  std::string what;     ///< What is wrong: "\"25\" has no unit".
  std::string cure;     ///< What would be right: "write \"25 deg\"".
};

/// The input is wrong. Carries *all* problems found; exit code 2.
class InputError : public Error {
 public:
  /// @param source  file name or other place, printed before each line number.
  InputError(std::string source, std::vector<Problem> problems);
  /// One problem, of no place within the source.
  InputError(std::string source, std::string what, std::string cure)
      : InputError(std::move(source), {{"", 0, std::move(what), std::move(cure)}}) {}
  const std::vector<Problem>& problems() const { return problems_; }
  const std::string& source() const { return source_; }

 private:
  std::string source_;
  std::vector<Problem> problems_;
};

/// The text of an InputError: per problem "SOURCE:LINE: POINTER: WHAT; CURE", sorted by line; of
/// more than 2000 the rest is counted.
std::string format_problems(const std::string& source, const std::vector<Problem>& problems);

/// The world failed: disk full, file locked or corrupt. Exit code 4.
class StorageError : public Error {
  using Error::Error;
};
/// Not enough memory, no such program, ... Exit code 4.
class ResourceError : public Error {
  using Error::Error;
};
/// The user (or a time limit) asked to stop; what was done is kept. Exit code 75.
class Interrupted : public Error {
  using Error::Error;
};
/// We are wrong. Not an Error, so that nobody catches it on the way. Exit code 70.
class InternalError : public std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] void throw_internal(const char* condition, const std::string& values, const char* file,
                                 int line);

/// Runs body; an Error that leaves it gets doing() as a context line and keeps its type.
template <typename Doing, typename Body>
decltype(auto) with_context(const Doing& doing, Body&& body) {
  try {
    return std::forward<Body>(body)();
  } catch (Error& error) {
    error.add_context(doing());
    throw;
  }
}

}  // namespace faultsim

/// Always-on check of our own reasoning; the values are printed.
#define FAULTSIM_DEMAND(condition, ...)                                                            \
  do {                                                                                             \
    if (!(condition)) [[unlikely]]                                                                 \
      ::faultsim::throw_internal(#condition, ::faultsim::concat(__VA_ARGS__), __FILE__, __LINE__); \
  } while (false)
