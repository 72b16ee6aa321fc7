#pragma once

#include <cstddef>

namespace faultsim {

/// Asks the kernel to back [begin, begin + bytes) with pages of 2 MB instead of 4 kB (Linux:
/// transparent huge pages, madvise): what is touched for the first time is then mapped, and
/// cleared, 512 times less often, and a factor of 10 GB wants 5,000 entries of the TLB instead of
/// 2.5 million. To be called before the memory is touched. A wish: where the kernel does not know
/// or grant it (/sys/kernel/mm/transparent_hugepage/enabled says "never") nothing happens; values
/// and limits are the same in any case.
void ask_for_large_pages(void* begin, std::size_t bytes);

}  // namespace faultsim
