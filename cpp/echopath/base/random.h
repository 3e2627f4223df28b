#pragma once
// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3",
// SC 2011). A number is a pure function of (seed, counter), so results depend on neither threads nor call order.
#include <array>
#include <cstdint>

namespace echopath {

// Independent uses of one seed.
enum class Stream : uint32_t {
  kLaunchShift = 1, kBounce = 2, kPhase = 3, kNoise = 4, kLaunchPoint = 5, kThinning = 6, kScatterShift = 7, kScatterPoint = 8,
  kProbe = 9, kTraining = 16
};

inline std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t p0 = uint64_t{0xD2511F53u} * counter[0];
    const uint64_t p1 = uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(p1),
               static_cast<uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(p0)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

// Two uniform numbers in [0, 1) with 53 bits for (seed, stream, index, dimension).
inline std::array<double, 2> uniform2(uint64_t seed, Stream stream, uint64_t index, uint32_t dimension) {
  const auto bits = philox4x32({static_cast<uint32_t>(index), static_cast<uint32_t>(index >> 32), dimension,
                                static_cast<uint32_t>(stream)},
                               {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)});
  const auto unit = [](uint32_t high, uint32_t low) {
    return static_cast<double>(((uint64_t{high} << 32) | low) >> 11) * 0x1.0p-53;
  };
  return {unit(bits[0], bits[1]), unit(bits[2], bits[3])};
}

}  // namespace echopath
