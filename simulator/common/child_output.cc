#include "simulator/common/child_output.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using ScratchFile = std::unique_ptr<std::FILE, CloseFile>;

/// A file without a name that holds the text, to be read from its beginning.
ScratchFile scratch_file(const std::string& text) {
  ScratchFile file(std::tmpfile());
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0) {
    throw ResourceError(concat("cannot write a temporary file: ", std::strerror(errno)));
  }
  std::rewind(file.get());
  return file;
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 65536> block;
  for (ssize_t n = 0; (n = read(descriptor, block.data(), block.size())) != 0;) {
    if (n < 0 && errno != EINTR) break;
    if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
  }
  return text;
}

}  // namespace

ChildOutput run_child(std::vector<std::string> command, const std::string& input) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  const ScratchFile given = input.empty() ? nullptr : scratch_file(input);
  std::array<int, 2> ends = {-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw ResourceError(concat("cannot open a pipe to ", command[0], ": ", std::strerror(errno)));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (given) posix_spawn_file_actions_adddup2(&actions, fileno(given.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = -1;
  ChildOutput result;
  result.start_error = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (result.start_error == 0) result.out = read_all(ends[0]);
  close(ends[0]);
  if (result.start_error != 0) return result;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return result;
}

}  // namespace faultsim
