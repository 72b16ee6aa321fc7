#include "simulator/case_figures/picture_file.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"

extern char** environ;

namespace faultsim {
namespace {

constexpr const char* kConverter = "rsvg-convert";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using ScratchFile = std::unique_ptr<std::FILE, CloseFile>;

/// A file without a name.
ScratchFile scratch_file() {
  ScratchFile file(std::tmpfile());
  if (!file) throw StorageError(concat("no temporary file: ", std::strerror(errno)));
  return file;
}

/// Runs the converter between two open files; its exit status. Throws InputError where there is no
/// such program.
int convert(std::FILE* from, std::FILE* to) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(from), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(to), STDOUT_FILENO);
  const std::string words[] = {kConverter, "--zoom=2", "--format=png"};
  char* arguments[] = {const_cast<char*>(words[0].c_str()), const_cast<char*>(words[1].c_str()),
                       const_cast<char*>(words[2].c_str()), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, kConverter, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw InputError("-o", {{"", 0,
                             concat("a PNG is made by ", kConverter, ", which does not run (",
                                    std::strerror(error), ")"),
                             "install librsvg (Debian: librsvg2-bin), or write a .svg"}});
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string png_of(const std::string& svg) {
  const ScratchFile from = scratch_file(), to = scratch_file();
  if (std::fwrite(svg.data(), 1, svg.size(), from.get()) != svg.size() ||
      std::fflush(from.get()) != 0) {
    throw StorageError(concat("writing a temporary file: ", std::strerror(errno)));
  }
  std::rewind(from.get());
  const int status = convert(from.get(), to.get());
  std::string png;
  char bytes[65536];
  std::rewind(to.get());
  for (std::size_t n = 0; (n = std::fread(bytes, 1, sizeof bytes, to.get())) > 0;) {
    png.append(bytes, n);
  }
  if (status != 0 || png.rfind("\x89PNG", 0) != 0) {
    throw StorageError(concat(kConverter, " made no PNG (status ", status, ")"));
  }
  return png;
}

}  // namespace

void require_picture_file(const std::filesystem::path& target,
                          const std::vector<std::string>& endings,
                          const std::vector<std::filesystem::path>& inputs) {
  const std::string ending = target.extension().string();
  if (std::find(endings.begin(), endings.end(), ending) == endings.end()) {
    std::string wanted;
    for (const std::string& one : endings) wanted += (wanted.empty() ? "" : " or ") + one;
    throw InputError("-o", {{"", 0, concat("\"", target.string(), "\" does not say what to write"),
                             "let the name end in " + wanted}});
  }
  require_writable_file("-o", target, FileKind::text, inputs);
}

void write_picture(const std::filesystem::path& target, const std::string& svg) {
  write_text(target, target.extension() == ".png" ? png_of(svg) : svg);
}

}  // namespace faultsim
