#pragma once
// Treats unflagged surfaces as mirrors, and decides which of a path's two orders counts: an order says which of its two ends
// is met first, `T a ... b R` or `T b ... a R`.
//
// A specular bounce off an unflagged surface is geometrical optics, which holds where the surface covers the Fresnel zone
// (mirror_zone.h). The surface around the point counts, whatever meshes it consists of; the edges of a surface narrower than
// the zone take away a part of the field. A diffuse echo behind a mirror that covers too little is dropped.
//
// Over unflagged surfaces the paths T a ... b R and T b ... a R between nearby antennas are each other's reversal, and rays
// find both: one order takes a for a mirror and integrates over b, the other takes b for a mirror and integrates over a.
// The echo over a ... b can therefore come from rays that meet a first, or be taken from those that meet b first, turned
// round. Each of these counts with a share. The shares depend only on the two ends, a and b, which both kinds of rays know,
// so that they add up to one and nothing counts twice.
// The better order counts: the one whose mirrors cover more of their zones, and whose rays lie denser.
#include "echopath/trace/mirrors/mirror_zone.h"
#include "echopath/trace/sbr/ray.h"
#include "echopath/trace/sbr/ray_context.h"

namespace echopath {

// Holds the shares of a ray's echo in its own order and in the opposite one.
struct OrderShares {
  double own = 1.0, opposite = 0.0;
};

// Returns both shares where `cover` is the share of the Fresnel zone that the own order's first mirror covers, and
// `opposite_cover` that of the opposite one's, for orders that rays resolve alike.
OrderShares order_shares(double cover, double opposite_cover);

class MirrorOrders {
 public:
  explicit MirrorOrders(const RayContext& context) : context_(context) {}
  // Weighs the last bounce of a ray, where that was off an unflagged mirror, at the surface that the ray meets behind it.
  // This costs rays, which `num_queries` counts: it is asked for late, because most hits behind mirrors see no receiver.
  void weigh_mirror(Ray& ray, const SurfaceHit& surface, int64_t& num_queries) const {
    if (ray.is_mirror_unweighed) weigh(ray, surface, num_queries);
  }
  // Returns the shares of the coherent echo that the ray sends over `leg`: the share of its own family in its own order, and
  // that of the opposite family in the opposite order.
  OrderShares shares(const Ray& ray, const SurfaceHit& surface, const Leg& leg, int64_t& num_queries) const;

 private:
  // Finds what the last mirror covers of its Fresnel zone, and notes it in the ray.
  void weigh(Ray& ray, const SurfaceHit& surface, int64_t& num_queries) const;
  ZoneCover cover_of(const MirrorView& view, const ZoneTarget* target, int64_t& num_queries) const;
  PathEnd end_at(const MirrorView& view, const ZoneCover& cover) const;
  double resolution_of(const Ray& ray, const SurfaceHit& surface, const Leg& leg, const PathEnd& last) const;

  const RayContext& context_;
};

}  // namespace echopath
