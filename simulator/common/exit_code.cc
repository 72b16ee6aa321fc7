#include "simulator/common/exit_code.h"

#include <cstdio>
#include <new>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

ExitCode say(const char* program, const char* text, ExitCode code) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s: %s\n", program, text);
  return code;
}

}  // namespace

ExitCode run_program(const char* program, ExitCode (*body)(int, char**), int argc, char** argv) {
  try {
    return body(argc, argv);
  } catch (const InputError& error) {
    const std::string count =
        concat("the input has ", error.problems().size(), " problem",
               error.problems().size() == 1 ? "" : "s", "; nothing was started\n", error.what());
    return say(program, count.c_str(), ExitCode::input);
  } catch (const Interrupted& error) {
    return say(program, error.what(), ExitCode::interrupted);
  } catch (const Error& error) {
    return say(program, error.what(), ExitCode::world);
  } catch (const std::bad_alloc&) {
    return say(program, "out of memory", ExitCode::world);
  } catch (const std::exception& error) {
    return say(program, error.what(), ExitCode::bug);
  }
}

}  // namespace faultsim
