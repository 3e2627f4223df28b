#pragma once
// Shares out rays so that an object that comes, goes or changes leaves most other objects the rays that they have.
#include <cstdint>
#include <string_view>
#include <vector>

#include "echopath/scene/scene.h"
#include "echopath/trace/strata/ray_targets.h"

namespace echopath {

// Returns the number of rays of each target, and last that of the field of view, which gets `field_share` of num_rays where
// it owns anything. The other rays go to the targets by their weights, whether they move or not. What comes to an object is
// rounded to a power of sqrt(2) times a number that depends on the object's name alone, so that an object has the rays of
// before unless the sum of all weights passes a step of its own: where the sum grows by a twentieth, one object in seven has
// others. A target that would get too few rays to have any leaves them to the field of view, where they are rounded
// likewise. The sum differs from num_rays by 19 % at most.
std::vector<int64_t> rays_by_object(const Scene& scene, const std::vector<RayTarget>& targets, bool field_owns_any,
                                    double field_share, int64_t num_rays);

// Returns where the random numbers of a stratum's rays begin: a multiple of kScatterNetSize below 2^62 that depends on the
// name alone. So few of all numbers are in use that two strata almost never share any.
int64_t first_number_of(std::string_view stratum);

}  // namespace echopath
