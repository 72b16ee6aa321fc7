#pragma once

#include <string>
#include <vector>

namespace faultsweep {

struct ChildOutput {
  int code = -1;    ///< exit code; 128 + n for signal n.
  std::string out;  ///< its stdout; stderr is ours.
};
/// Runs a program to its end. Throws ResourceError when it cannot be started.
ChildOutput run_child(std::vector<std::string> command);

}  // namespace faultsweep
