#pragma once
// Finds the meshes with coherent echoes.
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

// Returns the IDs of the meshes that are no flagged mirrors and reflect at least `least_share` of the power in phase at
// normal incidence (em/surface/coherent_share.h), ascending; `wavelength` is in m. `without_planes` leaves out those that
// are flat.
std::vector<uint32_t> coherent_meshes(const Scene& scene, double wavelength, double least_share,
                                      bool without_planes = false);

}  // namespace echopath
