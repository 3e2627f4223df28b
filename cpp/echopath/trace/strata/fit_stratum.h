#pragma once
// Finds the narrowest stratum that holds a surface.
#include <optional>
#include <string>
#include <vector>

#include "echopath/record/stratum.h"

namespace echopath {

// Returns the narrowest of the cones and strips tried that holds every triangle between the given vertices, seen from
// `apex`; it has no rays. Returns nothing where the surface surrounds the apex, that is where no cone of a half angle below
// 80 degrees holds it. The stratum is a little larger than needed, so that single precision loses no edge. Strips are tried
// along so many evenly turned directions, 0: none, and along the edges of hulls that have no more of them.
inline constexpr int kManyTurns = 48;
std::optional<Stratum> fit_stratum(const std::vector<Vec3>& vertices, const Vec3& apex, std::string name,
                                   int num_turns = kManyTurns);

}  // namespace echopath
