#pragma once
// What a hit makes of the ray that arrives there.
#include "echopath/trace/connect/mirror_orders.h"

namespace echopath {

class Arrivals {
 public:
  explicit Arrivals(const RayContext& context) : context_(context), orders_(context) {}
  // Carries a ray to the point of `surface`, and finds what the surface makes of it. False: not a hit that counts.
  bool arrive(Ray& ray, SurfaceHit& surface, TraceStatistics& statistics) const;
  // Takes a hit whose response is known into the ray.
  void record(Ray& ray, SurfaceHit& surface) const;

 private:
  void find_response(const Ray& ray, SurfaceHit& surface) const;
  bool finds_owner(Ray& ray, uint32_t mesh_id) const;

  const RayContext& context_;
  MirrorOrders orders_;
};

}  // namespace echopath
