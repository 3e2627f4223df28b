#include "echopath/trace/scatter/scatter_points.h"

#include "echopath/base/random.h"

namespace echopath {
namespace {

// Returns the Sobol' digits of `index`, which is below kScatterNetSize, as integers below it.
constexpr ScatterCell net_point(uint32_t index) {
  ScatterCell point{0, 0};
  uint32_t mirrored = kScatterNetSize / 2, pascal = kScatterNetSize / 2;
  for (; index != 0; index >>= 1, mirrored >>= 1, pascal ^= pascal >> 1) {
    if (!(index & 1)) continue;
    point[0] ^= mirrored;
    point[1] ^= pascal;
  }
  return point;
}

constexpr auto kNet = [] {
  std::array<ScatterCell, kScatterNetSize> net{};
  for (uint32_t i = 0; i < kScatterNetSize; ++i) net[i] = net_point(i);
  return net;
}();

}  // namespace

ScatterCell scatter_shift(uint64_t seed, int batch, int64_t ray, int hit) {
  const auto group = static_cast<uint32_t>(batch) << 8 | static_cast<uint32_t>(hit);
  const auto shift = uniform2(seed, Stream::kScatterShift, static_cast<uint64_t>(ray) / kScatterNetSize, group);
  return {static_cast<uint32_t>(shift[0] * kScatterNetSize), static_cast<uint32_t>(shift[1] * kScatterNetSize)};
}

ScatterCell scatter_cell(const ScatterCell& shift, int64_t ray) {
  const ScatterCell& net = kNet[ray % kScatterNetSize];
  return {net[0] ^ shift[0], net[1] ^ shift[1]};
}

std::array<double, 2> scatter_point(uint64_t seed, int batch, int64_t ray, int hit) {
  const ScatterCell cell = scatter_cell(scatter_shift(seed, batch, ray, hit), ray);
  const auto fine = uniform2(seed, Stream::kScatterPoint, static_cast<uint64_t>(ray), static_cast<uint32_t>(hit));
  return {(cell[0] + fine[0]) / kScatterNetSize, (cell[1] + fine[1]) / kScatterNetSize};
}

}  // namespace echopath
