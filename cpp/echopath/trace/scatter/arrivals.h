#pragma once
// Takes the hit where a ray arrives into the ray, and finds the response of its surface.
#include "echopath/trace/connect/mirror_orders.h"

namespace echopath {

class Arrivals {
 public:
  explicit Arrivals(const RayContext& context) : context_(context), orders_(context) {}
  // Carries a ray to the point of `surface` and finds the response there. Returns false where the hit does not count.
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
