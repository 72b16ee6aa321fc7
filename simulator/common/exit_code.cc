#include "simulator/common/exit_code.h"

#include <cstdio>
#include <iostream>
#include <new>
#include <system_error>

#include "simulator/common/errors.h"
#include "simulator/common/interrupt.h"

namespace faultsim {
namespace {

constexpr const char* kNoMemory =
    "not enough memory, or no further thread is allowed; raise the limits of this process (ulimit "
    "-v, -d, -u), close other programs, or choose a coarser mesh";

ExitCode say(const char* program, const char* text, ExitCode code) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s: %s\n", program, text);
  return code;
}

/// Output that was lost is not a success: what was buffered is written now, or it is said.
bool all_is_written() {
  const bool flushed = std::fflush(stdout) == 0;
  return flushed && std::ferror(stdout) == 0 && !std::cout.flush().fail();
}

}  // namespace

ExitCode run_program(const char* program, ExitCode (*body)(int, char**), int argc, char** argv) {
  end_on_signals();
  try {
    const ExitCode code = body(argc, argv);
    if (all_is_written()) return code;
    return say(program, "the output could not be written completely (disk full?)", ExitCode::world);
  } catch (const InputError& error) {
    const std::string count =
        concat("the input has ", counted(error.problems().size(), "problem", "problems"),
               "; nothing was started\n", error.what());
    return say(program, count.c_str(), ExitCode::input);
  } catch (const Interrupted& error) {
    return say(program, error.what(), ExitCode::interrupted);
  } catch (const Error& error) {
    return say(program, error.what(), ExitCode::world);
  } catch (const std::bad_alloc&) {
    return say(program, kNoMemory, ExitCode::world);
  } catch (const std::system_error& error) {
    // No room for the stack of another thread, or no further thread allowed.
    if (error.code() == std::errc::resource_unavailable_try_again ||
        error.code() == std::errc::not_enough_memory)
      return say(program, kNoMemory, ExitCode::world);
    return say(program, error.what(), ExitCode::bug);
  } catch (const std::exception& error) {
    return say(program, error.what(), ExitCode::bug);
  }
}

}  // namespace faultsim
