#pragma once
// Unflagged surfaces as mirrors, and which of a path's two orders stands.
//
// A specular bounce off an unflagged surface is geometrical optics, which holds where the surface covers the Fresnel zone
// (mirror_zone.h). What counts is the surface around the point, over whatever meshes it is spread; the edges of one narrower
// than the zone take their part of the field. A diffuse echo behind a mirror that covers too little is dropped.
//
// Over unflagged surfaces the paths T a ... b R and T b ... a R between nearby antennas are each other's reversal, and rays find
// both: one order takes a for a mirror and integrates over b, the other b and a. Each family of paths can therefore be had in
// two ways, by its own rays or as the reversal of those of the opposite order. Its share of either is a function of what both
// kinds of rays know, the two ends, so that the shares add up to one and nothing counts twice. The better order stands: the one
// whose mirrors cover more of their zones, and whose rays lie denser.
#include "echopath/trace/mirrors/mirror_zone.h"
#include "echopath/trace/sbr/ray.h"
#include "echopath/trace/sbr/ray_context.h"

namespace echopath {

// The shares of a ray's echo, in its own order and in the opposite one.
struct OrderShares {
  double own = 1.0, opposite = 0.0;
};

class MirrorOrders {
 public:
  explicit MirrorOrders(const RayContext& context) : context_(context) {}
  // Weighs the last bounce, off an unflagged mirror, now that it is known which surface the ray meets behind it.
  // num_queries counts the rays that measure the mirror.
  void weigh_mirror(Ray& ray, const SurfaceHit& surface, int64_t& num_queries) const;
  // The shares of the coherent echo that the ray sends over `leg`: of the ray's own family in its own order and of the opposite
  // family in the opposite one.
  OrderShares shares(const Ray& ray, const SurfaceHit& surface, const Leg& leg, int64_t& num_queries) const;

 private:
  ZoneCover cover_of(const MirrorView& view, const ZoneTarget* target, int64_t& num_queries) const;
  PathEnd end_at(const MirrorView& view, const ZoneCover& cover) const;
  double resolution_of(const Ray& ray, const SurfaceHit& surface, const Leg& leg, const PathEnd& last) const;

  const RayContext& context_;
};

}  // namespace echopath
