#include "echopath/trace/scatter_points.h"

#include <cstddef>

#include "echopath/base/random.h"

namespace echopath {
namespace {

// Sobol' digits of `index` below kScatterNetSize, as integers below it.
std::array<uint32_t, 2> net_point(uint32_t index) {
  std::array<uint32_t, 2> point{0, 0};
  uint32_t mirrored = kScatterNetSize / 2, pascal = kScatterNetSize / 2;
  for (; index != 0; index >>= 1, mirrored >>= 1, pascal ^= pascal >> 1) {
    if (!(index & 1)) continue;
    point[0] ^= mirrored;
    point[1] ^= pascal;
  }
  return point;
}

}  // namespace

std::array<double, 2> scatter_point(uint64_t seed, int batch, int64_t ray, int hit) {
  constexpr double kSize = kScatterNetSize;
  const auto index = static_cast<uint64_t>(ray);
  const auto group = static_cast<uint32_t>(batch) << 8 | static_cast<uint32_t>(hit);
  const auto shift = uniform2(seed, Stream::kScatterShift, index / kScatterNetSize, group);
  const auto fine = uniform2(seed, Stream::kScatterPoint, index, static_cast<uint32_t>(hit));
  const auto net = net_point(static_cast<uint32_t>(index % kScatterNetSize));
  std::array<double, 2> point;
  for (std::size_t k = 0; k < 2; ++k) {
    point[k] = (static_cast<double>(net[k] ^ static_cast<uint32_t>(shift[k] * kSize)) + fine[k]) / kSize;
  }
  return point;
}

}  // namespace echopath
