#pragma once
// The narrowest stratum that holds a surface.
#include <optional>
#include <string>
#include <vector>

#include "echopath/trace/launch/stratum.h"

namespace echopath {

// The narrowest of the cones and strips tried that holds every triangle between the given vertices, seen from `apex`; without
// rays. None where the surface surrounds the apex: where no cone of a half angle below 80 degrees holds it.
// Holds a little more than asked for, so that single precision loses no edge.
std::optional<Stratum> fit_stratum(const std::vector<Vec3>& vertices, const Vec3& apex, std::string name,
                                   bool may_be_strip = true);

}  // namespace echopath
