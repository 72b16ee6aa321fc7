#include "simulator/common/fingerprint.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "simulator/common/text.h"

namespace faultsim {

std::string fingerprint(const void* bytes, std::size_t n_bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes, n_bytes);
  return formatted("%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                   static_cast<unsigned long long>(hash.low64));
}

std::uint64_t hash64(const void* bytes, std::size_t n_bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes, n_bytes, seed);
}

std::string fingerprint(std::string_view bytes) { return fingerprint(bytes.data(), bytes.size()); }

}  // namespace faultsim
