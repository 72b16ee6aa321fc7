#pragma once

#include <string>
#include <vector>

namespace faultsim {

struct ChildOutput {
  int start_error = 0;  ///< errno, where it could not be started.
  int code = -1;        ///< exit code; 128 + n for signal n.
  std::string out;      ///< its stdout; stderr is ours.
};
/// Runs a program to its end; it is looked for as a shell does.
/// @param input  its stdin; "" = ours. Throws ResourceError where there is no pipe or file for it.
ChildOutput run_child(std::vector<std::string> command, const std::string& input = "");

}  // namespace faultsim
