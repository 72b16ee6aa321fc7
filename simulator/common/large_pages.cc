#include "simulator/common/large_pages.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstdint>

namespace faultsim {

void ask_for_large_pages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kPage = 1 << 21;
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) / kPage * kPage;
  const std::uintptr_t to = (first + bytes) / kPage * kPage;
  if (to <= from) return;
  const int error = errno;  // not the caller's concern
  madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
  errno = error;
}

}  // namespace faultsim
