#pragma once
// Tells which of several mirrors a wave meets where they lie on each other, as a puddle does on a road: one of them, so that
// an image over their plane counts once.
#include <optional>
#include <vector>

#include "echopath/trace/mirrors/mirrors.h"

namespace echopath {

// Sets `coplanar` of mirrors that lie on each other so near that no shadow query tells which of them is in front.
void find_coplanar(const EmbreeScene& geometry, std::vector<Mirror>& mirrors);

// Returns the hit of a wave from `from` that seems to meet the mirror `index` at a point (m) where others lie on it: on the
// mirror in front of all others or, in one plane, on the last one. Returns nothing where that is the mirror itself.
std::optional<Hit> hit_in_front(const std::vector<Mirror>& mirrors, int index, const Vec3& from, const Vec3& point);

}  // namespace echopath
