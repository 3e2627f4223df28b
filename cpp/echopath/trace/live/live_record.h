#pragma once
// Holds the record of a live trace in blocks of rays, each with the space that its queries went through. Internal to the
// module.
#include <memory>
#include <vector>

#include "echopath/trace/live/queried_space.h"
#include "echopath/trace/live/scene_changes.h"
#include "echopath/trace/mirrors/plane_images.h"
#include "echopath/trace/tracer.h"

namespace echopath {

inline constexpr int64_t kRaysPerLiveBlock = 16;  // few, so that a change touches few others beside the rays that it must
static_assert(kRaysPerLiveBlock % kPacketSize == 0, "a packet has rays of one kind (LaunchPlan::first_point)");

// Holds the paths of some rays in a row.
struct LiveBlock {
  int64_t num_rays = 0;
  PathBlock paths;
  std::shared_ptr<const QueriedSpace> space;
};
using LiveBlockPtr = std::shared_ptr<const LiveBlock>;

// Returns whether both strata launch the same rays, whichever nodes of their scenes they aim at.
bool is_launched_alike(const Stratum& a, const Stratum& b);

// Holds what all rays of a trace share, beside the scene.
struct SharedByRays {
  explicit SharedByRays(const Tracer& tracer, const TraceSettings& settings);

  // Returns whether rays of both traces can have the same paths.
  bool is_same(const SharedByRays& other) const;

  TraceSettings settings;
  SbrSettings sbr;
  RayRounding rounding;
  std::vector<Stratum> strata;
  RayOwners owners;
  int64_t first_point;
  std::vector<SurfacePoint> surface_scatterers;
  std::vector<std::vector<int>> sequences;  // of mirrors, over which the antennas' frusta go
};

class LiveRecord {
 public:
  LiveRecord(const Tracer& tracer, const TraceSettings& settings);

  Paths empty;  // scene, radar and frame of the record
  SharedByRays shared;
  std::vector<Box> boxes;  // of the meshes
  std::vector<LiveBlockPtr> blocks;
  std::vector<size_t> first_block;  // [strata + 1] index of the first one of each, and of the points that are aimed at
  std::vector<PathBlock> without_rays;
  PathBlock over_planes;
  std::vector<PathBlock> edges_over_planes;
  PlaneDoubles doubles;

  // Returns the record of the paths that need no rays, of these blocks and of the paths over planes.
  Paths paths_of(const std::vector<LiveBlockPtr>& some, Job* job) const;
};

}  // namespace echopath
