#pragma once
// Finds the objects of a scene and their images over mirrors, as targets of rays.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/trace/frusta/mirror_frusta.h"
#include "echopath/trace/strata/fitted_strata.h"

namespace echopath {

// A target is an object (scene_objects.h). Where no stratum holds it, because it surrounds the transmitter as a town does,
// or where it is a group of things that stand apart, the things that it consists of are targets: the largest of its parts,
// and of theirs in turn, that a stratum holds. Of more than 256 that stand still these are the ones in sight that have the
// strongest echoes by their size and distance, and of more than 256 images of them those over the fewest mirrors, and
// likewise of those that move; rays of the field of view meet the others. Where rays are steady, what stands still in an
// object is a target without what moves in it, such as the pole of a fan, and the highest nodes below which all moves are
// others; what moves then hides nothing that stands still.
struct RayTarget {
  Stratum stratum;  // holds the target; without rays
  int object = 0;   // index into the objects and parts, as RayTargets::object_of_mesh
  // Rays find it over these; planes at right angles have one image in both orders.
  std::vector<MirrorSequence> sequences;
  bool moves = false;  // it, or a part of it, or a mirror that shows it moves, or comes and goes (Scene::still_meshes)
  // The rays are shared out by these weights. The things of one object that stand still share the weight of that, those that
  // move another.
  double weight = 1.0;
};

// Returns the weight of an image over that many mirrors (0: of the object itself) in the sharing of the rays.
double weight_of_target(int num_mirrors);

struct RayTargetSettings {
  Vec3 transmitter;
  std::span<const MirrorFrustum> frusta;  // of the transmitter
  double largest_solid_angle = 0.0;       // sr: larger objects are left to the field of view
  bool may_use_strips = true;
  bool is_steady = false;                                      // LaunchSettings::is_steady
  int64_t most_objects = std::numeric_limits<int64_t>::max();  // nothing is aimed at where there are more
  FittedStrata* fitted = nullptr;                              // the strata of plans before; may be null
  const Job* job = nullptr;                                    // cancels the search; may be null
};

struct RayTargets {
  std::vector<RayTarget> targets;   // objects first, then images
  std::vector<int> object_of_mesh;  // by mesh ID, -1: a mirror
  int num_objects = 0;              // with the parts of those that surround the transmitter
  bool any_unaimed = false;         // some object has no stratum
  bool any_still_unaimed = false;   // likewise one that stands still, or one of which that is not known
  // Counts at least the things and images of one object beyond those that have rays of their own, and what is beyond the
  // strata that a record can tell apart; all objects where these are too many to aim at.
  int64_t num_left_out = 0;
};

// Raises Cancelled when the job is.
RayTargets find_ray_targets(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                            const RayTargetSettings& settings);

}  // namespace echopath
