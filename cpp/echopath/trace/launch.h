#pragma once
// Where rays start: strata of directions and the low-discrepancy set inside each.
#include <array>
#include <vector>

#include "echopath/trace/mirror_beams.h"
#include "echopath/trace/packet.h"
#include "echopath/trace/sampler.h"

namespace echopath {

// One cone around each object as seen from `transmitter`, about the centre of its box, one around each of its images over
// mirrors, and a defensive stratum over the antenna's field of view, the last one. Objects are the children of the scene's
// root, without their mirrors, whose bounding sphere does not hold the antenna. The cones share 85 % of the rays: equal shares
// for objects and images over one mirror, a quarter of it for each mirror more. The defensive stratum has the rest (all, where
// there is no object). `boresight`: unit; `field_versine`: 1 - cosine of the field of view's half angle.
// At most 255 strata: images over the most mirrors are left out first, then the objects of the smallest solid angle.
struct LaunchPlan {
  // What belongs to each of a packet's rays.
  struct Places {
    std::array<int, kPacketSize> strata, batches;
    LaneValues x, y;  // of the unit disc
  };

  std::vector<Stratum> strata;
  // Of each stratum, in the equal-area (Lambert) projection of its cone to the unit disc.
  std::vector<std::unique_ptr<const DiscPoints>> points;
  std::vector<int64_t> first_ray;  // [strata + 1] running sum of num_rays
  uint64_t seed = 0;
  int batches = 1;

  int stratum_of(int64_t ray) const;
  int batch_of(int stratum, int64_t ray) const;
  // Rays per sr of one batch inside the cone.
  double lattice_density(int stratum) const { return strata[static_cast<size_t>(stratum)].ray_density / batches; }
  Eigen::Vector2d point_of(int stratum, int64_t ray) const;
  // Of `count` rays in a row.
  void place(int64_t begin, int count, Places& out) const;
  bool is_defensive(int stratum) const { return stratum + 1 == static_cast<int>(strata.size()); }
};

struct LaunchSettings {
  int64_t num_rays = 0;
  uint64_t seed = 0;
  Sampler sampler = Sampler::kLattice;
  int batches = 1;  // independent shifts of the set of each stratum, which share its rays
  int max_image_mirrors = kMaxLegMirrors;  // images over more get no cone
  Vec3 transmitter = Vec3::Zero();
  Vec3 boresight = Vec3::UnitX();
  double field_versine = 2.0;
};

LaunchPlan plan_launch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchSettings& settings);

}  // namespace echopath
