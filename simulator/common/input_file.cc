#include "simulator/common/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "simulator/common/errors.h"

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

}  // namespace

InputText read_input_file(const std::string& path, std::size_t most_bytes) {
  if (path.find('\0') != std::string::npos) {
    return refused("the name of the file holds a NUL", "remove it");
  }
  const Descriptor file(path);
  if (file.number() < 0) return unreadable(errno);
  struct stat status {};
  if (fstat(file.number(), &status) != 0) return unreadable(errno);
  if (S_ISDIR(status.st_mode)) return refused("this is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) {
    return refused("this is " + kind_of(status.st_mode), "write it to a file and name that");
  }
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
    const ssize_t n = read(file.number(), result.text.data() + have, result.text.size() - have);
    const int error = errno;
    result.text.resize(have + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n < 0 && error == EINTR) continue;
    if (n < 0) return unreadable(error);
    if (n == 0) return result;
    if (result.text.size() > most_bytes) return too_large(result.text.size());
  }
}

std::string read_input_or_throw(const std::string& path, std::size_t most_bytes) {
  InputText file = read_input_file(path, most_bytes);
  if (!file.what.empty()) throw InputError(path, file.what, file.cure);
  return std::move(file.text);
}

}  // namespace faultsim
