#include "simulator/common/input_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"

namespace faultsim {
namespace {

/// Closes on the way out.
class Descriptor {
 public:
  /// O_NONBLOCK: to open a FIFO that nobody writes would wait for ever.
  explicit Descriptor(const std::string& path)
      : number_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

InputText refused(const std::string& what, const std::string& cure) { return {"", what, cure}; }

InputText unreadable(int error) {
  return refused(concat("the file cannot be read: ", std::strerror(error)),
                 "check name and permissions");
}

std::string kind_of(mode_t mode) {
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISCHR(mode) || S_ISBLK(mode) ? "a device" : "not a regular file";
}

/// The state of an open file that can be read as a whole, or why it cannot.
InputText look_at(const std::string& path, const Descriptor& file, struct stat& status) {
  if (path.find('\0') != std::string::npos) {
    return refused("the name of the file contains a NUL", "remove it");
  }
  if (file.number() < 0) return unreadable(errno);
  if (fstat(file.number(), &status) != 0) return unreadable(errno);
  if (S_ISDIR(status.st_mode)) return refused("this is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) {
    return refused("this is " + kind_of(status.st_mode), "write it to a file and name that");
  }
  return {};
}

/// Reads up to `size` bytes, and goes on where a signal came in between. @returns < 0: errno says.
ssize_t read_some(const Descriptor& file, char* to, std::size_t size) {
  while (true) {
    const ssize_t n = read(file.number(), to, size);
    if (n >= 0 || errno != EINTR) return n;
  }
}

}  // namespace

InputText read_input_file(const std::string& path, std::size_t most_bytes) {
  const Descriptor file(path);
  struct stat status {};
  if (InputText odd = look_at(path, file, status); !odd.what.empty()) return odd;
  const auto too_large = [&](std::size_t size) {
    return refused(concat("has ", size, " bytes"), concat("at most ", most_bytes, " are read"));
  };
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > most_bytes) return too_large(size);
  // Files of /proc say that they are empty: reading decides.
  InputText result;
  constexpr std::size_t kBlock = 65536;
  while (true) {
    const std::size_t have = result.text.size();
    result.text.resize(have + std::max(kBlock, have < size ? size - have : 0));
    const ssize_t n = read_some(file, result.text.data() + have, result.text.size() - have);
    const int error = errno;
    result.text.resize(have + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n < 0) return unreadable(error);
    if (n == 0) return result;
    if (result.text.size() > most_bytes) return too_large(result.text.size());
  }
}

InputText visit_input_file(const std::string& path,
                           const std::function<void(std::string_view)>& visit) {
  const Descriptor file(path);
  struct stat status {};
  if (InputText odd = look_at(path, file, status); !odd.what.empty()) return odd;
  std::string piece(std::size_t{1} << 20, '\0');
  while (true) {
    const ssize_t n = read_some(file, piece.data(), piece.size());
    if (n < 0) return unreadable(errno);
    if (n == 0) return {};
    visit(std::string_view(piece).substr(0, static_cast<std::size_t>(n)));
  }
}

std::string fingerprint_of_file(const std::string& path) {
  FingerprintOfPieces print;
  const InputText end = visit_input_file(path, [&](std::string_view piece) { print.add(piece); });
  if (!end.what.empty()) throw InputError(path, end.what, end.cure);
  return print.text();
}

MappedFile::MappedFile(const std::string& path) {
  const Descriptor file(path);
  struct stat status {};
  InputText odd = look_at(path, file, status);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (odd.what.empty() && size > 0) {
    void* const at = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (at == MAP_FAILED)
      odd = unreadable(errno);
    else
      text_ = {static_cast<const char*>(at), size};
  }
  if (!odd.what.empty()) throw InputError(path, odd.what, odd.cure);
}

MappedFile::~MappedFile() {
  if (!text_.empty()) munmap(const_cast<char*>(text_.data()), text_.size());
}

std::string read_input_or_throw(const std::string& path, std::size_t most_bytes) {
  InputText file = read_input_file(path, most_bytes);
  if (!file.what.empty()) throw InputError(path, file.what, file.cure);
  return std::move(file.text);
}

}  // namespace faultsim
