#pragma once
// Gives numbers for the directions in which neighbouring rays scatter, spread more evenly than chance.
#include <array>
#include <cstdint>

namespace echopath {

inline constexpr int kScatterNetSize = 256;  // rays

// Names one of kScatterNetSize x kScatterNetSize equal cells of the unit square.
using ScatterCell = std::array<uint32_t, 2>;

// Returns the shift of the cells of kScatterNetSize rays in a row (aligned), of which `ray` is one.
ScatterCell scatter_shift(uint64_t seed, int batch, int64_t ray, int hit);

// Returns the cell of a ray.
ScatterCell scatter_cell(const ScatterCell& shift, int64_t ray);

// Returns two numbers in [0, 1) for the direction in which ray `ray` (>= 0) of a batch leaves its first diffuse hit, which
// has index `hit` among its hits. Each is uniform. Of kScatterNetSize rays in a row (aligned) that share batch and hit, one
// falls into every interval of area 1/kScatterNetSize with binary sides: neighbours meet much the same surface and share its
// directions among them. Other rays are independent. Two rough plates in a corner err by half of what chance leaves. Source:
// the first two dimensions of Sobol' 1967, digitally shifted at random. A single sequence over all rays would make patterns
// with the rows of the launch lattice: four times the error of chance for some numbers of rays.
std::array<double, 2> scatter_point(uint64_t seed, int batch, int64_t ray, int hit);

}  // namespace echopath
