#include <CLI/CLI.hpp>

#include "simulator/common/errors.h"
#include "simulator/common/version.h"
#include "simulator/linalg/blas_start.h"
#include "tests/verification/closed_forms/verify.h"

namespace faultsim {
namespace {

/// Reads the command line and runs the problems.
ExitCode verify_main(int argc, char** argv) {
  start_blas(argv);
  CLI::App app{"faultsim-verify: runs the simulator against closed forms", "faultsim-verify"};
  std::vector<std::string> names;
  bool list = false, json = false, slow = false, markdown = false;
  app.add_option("names", names, "V1 V2 … (default: all)");
  app.add_flag("--list", list, "list the problems");
  app.add_flag("--json", json, "machine-readable output on stdout");
  app.add_flag("--slow", slow, "also the members that take minutes");
  app.add_flag("--markdown", markdown, "tables as in results/verification/figures.md");
  app.footer(
      "Examples:\n"
      "  faultsim-verify                  all, under a minute\n"
      "  faultsim-verify V4 V5 --json     these two, with expected and computed values\n"
      "Exit codes: 0 all met, 2 an unknown name, 5 a miss, 70 bug, 75 interrupted.");
  app.set_version_flag("--version", version_text("faultsim-verify"));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::input;
  }
  return verify_command(names, list, json, slow, markdown);
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("faultsim-verify", faultsim::verify_main, argc, argv));
}
