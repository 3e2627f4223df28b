#pragma once
// Where rays go that scatter: numbers for the directions of neighbouring rays, evener than chance.
#include <array>
#include <cstdint>

namespace echopath {

inline constexpr int kScatterNetSize = 256;  // rays

// One of kScatterNetSize x kScatterNetSize equal cells of the unit square.
using ScatterCell = std::array<uint32_t, 2>;

// What shifts the cells of kScatterNetSize rays in a row (aligned), of which `ray` is one.
ScatterCell scatter_shift(uint64_t seed, int batch, int64_t ray, int hit);

// The cell of a ray.
ScatterCell scatter_cell(const ScatterCell& shift, int64_t ray);

// Two numbers in [0, 1) for the direction in which ray `ray` (>= 0) of a batch leaves its first diffuse hit, the one at
// index `hit` of its hits. Each is uniform. Of kScatterNetSize rays in a row (aligned) that share batch and hit, one falls
// into every interval of area 1/kScatterNetSize with binary sides: neighbours meet much the same surface and share its
// directions among them. Other rays are independent. Two rough plates in a corner err by half of what chance leaves.
// Source: the first two dimensions of Sobol' 1967, digitally shifted at random. One sequence over all rays instead makes
// patterns with the rows of the launch lattice: four times the error of chance for some numbers of rays.
std::array<double, 2> scatter_point(uint64_t seed, int batch, int64_t ray, int hit);

}  // namespace echopath
