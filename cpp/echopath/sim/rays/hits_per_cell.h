#pragma once
// Tells how many more diffuse hits make the cells of a map what they are: sums over many.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Says how many hits the power in a cell, or that of the noise where it is more, is to be a sum of.
inline constexpr double kHitsPerCell = 4.0;

// Returns for each group how many times as many rays its diffuse hits need.
//
// The power of a wide surface, such as a ground, is known from what lies before the radar long before each cell of the map
// far away has a hit. There one hit stands for the whole ring about the radar: a point that stands out of the noise, where
// the ground itself would be below it. No hit should have more than (P + N) / kHitsPerCell, with the power P of its cell and
// the noise N of all channels in phase. A hit of the power p beside others that have P - p asks for
//   kHitsPerCell p / (N + P - p)
// times as many rays. Each cell counts for what p is in the mean over its power, up to `most`, and as far as it stands
// above the noise: with the weight P / (N + P). Cells are those of range and velocity between the first antennas, as far
// as the map reaches. A group that has no such cell gets 0. `group_of_path` [P] is below num_groups, `power_of_path` [P]
// in W. Raises Cancelled.
std::vector<double> growth_by_cells(const Paths& paths, std::span<const uint32_t> group_of_path, size_t num_groups,
                                    std::span<const double> power_of_path, double most, Job* job);

}  // namespace echopath
