#include "campaign/app/child_output.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::ResourceError;

ChildOutput run_child(std::vector<std::string> command) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  std::array<int, 2> ends = {-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw ResourceError(concat("cannot open a pipe to ", command[0], ": ", std::strerror(errno)));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = -1;
  const int error = posix_spawn(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  ChildOutput result;
  std::array<char, 65536> block;
  for (ssize_t n = 0; error == 0 && (n = read(ends[0], block.data(), block.size())) != 0;) {
    if (n < 0 && errno != EINTR) break;
    if (n > 0) result.out.append(block.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  if (error != 0) {
    throw ResourceError(concat("cannot run ", command[0], ": ", std::strerror(error),
                               "; set FAULTSIM_BINARY to the faultsim binary"));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return result;
}

}  // namespace faultsweep
