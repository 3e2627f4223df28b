#pragma once
// The image method over every sequence of rectangles, one by one, with shadows by a loop over all rectangles.
#include <set>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath::testing {

struct MirrorRectangle {
  Vec3 corner, a, b;  // m; the edges from the corner, at right angles
};

struct SlowPaths {
  std::set<std::vector<int>> found;
  // Those that a micrometre decides: over the rim of a mirror, or past the rim of what stands in the way.
  std::set<std::vector<int>> unsure;
};

// All sequences of 1 to `max_bounces` rectangles over which a mirror path leads from transmitter to receiver (m). Work grows
// as the number of rectangles to the power of `max_bounces`.
SlowPaths slow_mirror_paths(const Vec3& transmitter, const Vec3& receiver, const std::vector<MirrorRectangle>& rectangles,
                            int max_bounces);

// Walls and roofs of `num_boxes` houses that stand askew on a grid, and before them the ground: 5 num_boxes + 1 rectangles.
std::vector<MirrorRectangle> city_block(int num_boxes);

}  // namespace echopath::testing
