#pragma once
// Traces launch rays in packets to their first hits, and draws how they go on from there.
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/sbr/first_hits.h"

namespace echopath {

// A ray counts what its stratum owns (ray_owners.h): one that was aimed at an object goes over flagged mirrors as they
// reflect, without chance, and ends at whatever else it meets first. A ray that is aimed at a point of a rough surface ends
// where something else is in its way. Where there are such rays, they have the diffuse echo of the first hit and what it
// scatters diffusely, and rays of the lattices have its field and what it reflects.
class PacketFront {
 public:
  explicit PacketFront(const RayContext& context) : context_(context), directions_(context.plan.strata) {}
  // Traces the rays [begin, begin + count) of the plan.
  void trace(int64_t begin, int count, FirstHits& first, TraceStatistics& statistics) const;
  // Traces the rays that have met sheets on through these, as others beside those that are reflected there. Returns false
  // where none has, or none meets anything.
  bool trace_behind_sheets(FirstHits& first, TraceStatistics& statistics) const;
  // Makes the ray of a lane, and the hit where it arrives.
  void start(const FirstHits& first, int lane, Ray& ray, SurfaceHit& surface) const;

 private:
  void launch(FirstHits& first) const;
  void launch_at_points(FirstHits& first) const;
  void draw_samples(FirstHits& first) const;
  void find_hits(FirstHits& first, const LaneValues* begins, TraceStatistics& statistics) const;
  void arrive(FirstHits& first, TraceStatistics& statistics) const;
  bool counts(FirstHits& first, int lane) const;
  bool meets_point(const FirstHits& first, int lane) const;
  void share_out(FirstHits& first, int lane) const;
  void find_response(FirstHits& first, int lane) const;
  void see_receiver(FirstHits& first, TraceStatistics& statistics) const;
  void choose_front_mirrors(FirstHits& first) const;
  void leave_along_lobes(FirstHits& first) const;

  const RayContext& context_;
  LaunchDirections directions_;
};

}  // namespace echopath
