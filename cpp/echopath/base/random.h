#pragma once
// Draws counter-based random numbers by Philox4x32-10 (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1,
// 2, 3", SC 2011). A number is a pure function of (seed, counter), so results depend on neither threads nor call order.
#include <array>
#include <cstddef>
#include <cstdint>

#include "echopath/base/lanes/simd.h"

namespace echopath {

// Names the independent uses of one seed.
enum class Stream : uint32_t {
  kLaunchShift = 1,
  kBounce = 2,
  kPhase = 3,
  kNoise = 4,
  kLaunchPoint = 5,
  kScatterShift = 7,
  kScatterPoint = 8,
  kProbe = 9,
  kSurfacePoint = 10,
  kFaintPath = 11,
  kTraining = 16
};

// Holds the four words of as many counters as there are lanes, or what has become of them.
template <size_t kLanes>
using PhiloxWords = std::array<std::array<uint32_t, kLanes>, 4>;

// Runs the rounds in loops over lanes that compilers vectorise.
template <size_t kLanes>
ECHOPATH_INLINE void philox4x32(PhiloxWords<kLanes>& words, std::array<uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    ECHOPATH_NO_UNROLL
    for (size_t i = 0; i < kLanes; ++i) {
      const uint64_t p0 = uint64_t{0xD2511F53u} * words[0][i];
      const uint64_t p1 = uint64_t{0xCD9E8D57u} * words[2][i];
      words[0][i] = static_cast<uint32_t>(p1 >> 32) ^ words[1][i] ^ key[0];
      words[1][i] = static_cast<uint32_t>(p1);
      words[2][i] = static_cast<uint32_t>(p0 >> 32) ^ words[3][i] ^ key[1];
      words[3][i] = static_cast<uint32_t>(p0);
    }
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
}

inline std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  PhiloxWords<1> words;
  for (size_t k = 0; k < 4; ++k) words[k][0] = counter[k];
  philox4x32(words, key);
  return {words[0][0], words[1][0], words[2][0], words[3][0]};
}

ECHOPATH_INLINE std::array<uint32_t, 2> philox_key(uint64_t seed) {
  return {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)};
}

// Returns a number that is uniform in [0, 1), with 53 bits.
ECHOPATH_INLINE double unit_interval(uint32_t high, uint32_t low) {
  return static_cast<double>(static_cast<int64_t>(((uint64_t{high} << 32) | low) >> 11)) * 0x1.0p-53;
}

// Returns two numbers that are uniform in [0, 1), with 53 bits, for (seed, stream, index, dimension).
inline std::array<double, 2> uniform2(uint64_t seed, Stream stream, uint64_t index, uint32_t dimension) {
  const auto bits = philox4x32(
      {static_cast<uint32_t>(index), static_cast<uint32_t>(index >> 32), dimension, static_cast<uint32_t>(stream)},
      philox_key(seed));
  return {unit_interval(bits[0], bits[1]), unit_interval(bits[2], bits[3])};
}

}  // namespace echopath
