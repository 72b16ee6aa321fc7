#include "simulator/app/write_all.h"

#include <unistd.h>

#include <cerrno>

#include "simulator/common/errors.h"

namespace faultsim {

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw StorageError("nobody reads the replies any more");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace faultsim
