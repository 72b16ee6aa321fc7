#pragma once

namespace faultsim {

/// How a program of ours ends; printed in --help, documented in docs/commands.md.
enum class ExitCode : int {
  done = 0,            ///< All that was asked.
  incomplete = 1,      ///< A campaign finished, some cases without a full result.
  input = 2,           ///< The input is wrong; nothing was started.
  no_convergence = 3,  ///< A single run did not reach its end (unconverged or unstable).
  world = 4,           ///< Disk, memory, lock.
  regress = 5,         ///< A comparison failed, or compared or ran nothing.
  bug = 70,            ///< Our fault.
  interrupted = 75,    ///< Stopped by a signal or a time limit; can be resumed.
};

/// Runs body (which returns an ExitCode) and turns what it throws into text on stderr and a code:
/// the one place where exceptions become text. Standard output that could not be written whole ends
/// with `world`, whatever body returned. @param program  printed before each message.
ExitCode run_program(const char* program, ExitCode (*body)(int, char**), int argc, char** argv);

}  // namespace faultsim
