#pragma once
// Finds the points of rough surfaces at which rays are aimed, where these points are to be the same in every trace.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/scatter/surface_points.h"

namespace echopath {

struct SurfaceScattererSettings {
  uint64_t seed = 0;
  double frequency = 77e9;          // Hz
  Vec3 transmitter = Vec3::Zero();  // relative to the origin of the geometry
};

// Returns the points of all rough surfaces that face the transmitter and lie in the field of view, hidden ones too. They are
// as dense in direction as the rays of the plan by the rule of shares (LaunchPlan::default_density): the number of points on
// an object follows its share of the rays, whatever its distance. Points come by mesh, so that neighbours in the list are
// near each other.
std::vector<SurfacePoint> find_surface_scatterers(const Scene& scene, const EmbreeScene& geometry, const LaunchPlan& plan,
                                                  const SurfaceScattererSettings& settings, Job* job);

}  // namespace echopath
