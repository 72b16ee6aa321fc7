#include "simulator/common/fingerprint.h"

#define XXH_INLINE_ALL
#ifndef NDEBUG  // with -Og not all is inlined that the library would force to be
#define XXH_NO_INLINE_HINTS 1
#endif
#include <xxhash.h>

#include "simulator/common/text.h"

namespace faultsim {

namespace {

std::string text_of_hash(const XXH128_hash_t& hash) {
  return formatted("%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                   static_cast<unsigned long long>(hash.low64));
}

}  // namespace

std::string fingerprint(const void* bytes, std::size_t n_bytes) {
  return text_of_hash(XXH3_128bits(bytes, n_bytes));
}

struct FingerprintOfPieces::State {
  XXH3_state_t hash;
};

FingerprintOfPieces::FingerprintOfPieces() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}
FingerprintOfPieces::~FingerprintOfPieces() = default;

void FingerprintOfPieces::add(std::string_view bytes) {
  XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
}

std::string FingerprintOfPieces::text() const {
  return text_of_hash(XXH3_128bits_digest(&state_->hash));
}

std::uint64_t hash64(const void* bytes, std::size_t n_bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes, n_bytes, seed);
}

std::string fingerprint(std::string_view bytes) { return fingerprint(bytes.data(), bytes.size()); }

}  // namespace faultsim
