#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace faultsim {

/// Bumped by hand when a change may alter a result; part of every identity.
inline constexpr int kNumericsVersion = 9;

/// The 128-bit XXH3 hash of the bytes as 32 hexadecimal digits. Not cryptographic: it tells inputs
/// of one user apart and finds damaged files; it does not defend against forgery.
std::string fingerprint(std::string_view bytes);
std::string fingerprint(const void* bytes, std::size_t n_bytes);

/// The same of bytes that come in pieces: of a file that need not fit into memory.
class FingerprintOfPieces {
 public:
  FingerprintOfPieces();
  ~FingerprintOfPieces();
  FingerprintOfPieces(const FingerprintOfPieces&) = delete;
  FingerprintOfPieces& operator=(const FingerprintOfPieces&) = delete;
  void add(std::string_view bytes);
  /// Of all bytes so far.
  std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The 64-bit XXH3 hash of the bytes with a seed: for sums over many small things.
std::uint64_t hash64(const void* bytes, std::size_t n_bytes, std::uint64_t seed = 0);

}  // namespace faultsim
