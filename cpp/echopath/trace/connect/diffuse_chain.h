#pragma once
// Joins chains of several diffuse hits in both orders, which rays find from either end.
//
// A ray goes from the transmitter over a leg c (direct or over mirrors) to its first diffuse hit and on to its last one.
// Over every leg c' of the last hit it gives the paths (c, chain, c') and (c', opposite chain, c), with one random phase but
// coefficients of their own. Rays that come over c' and end at c meet the same two paths, so the material area counts both
// kinds of rays. Geometry drops out of the ratio between the kinds: from x to y rays have the density cos_x cos_y/(pi r^2)
// per m^2 both ways. What remains is how they start, with which probabilities they go on, and the densities of their
// directions over those of Lambert's lobe. Over a transmit leg that no LegFinder finds (many bounces, unflagged surfaces) no
// ray comes the opposite way.
#include "echopath/trace/connect/antenna_legs.h"

namespace echopath {

// Keeps Ray::chain except its fields, which belong to the weight.
class DiffuseChainOrders {
 public:
  explicit DiffuseChainOrders(const RayContext& context) : context_(context) {}
  // Begins a chain before a coherent ray leaves a surface diffusely. `receive` are the receive legs of the hit.
  void begin(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, const std::vector<Leg>& receive) const;
  // Takes a hit into the chain before the ray leaves it diffusely.
  void scatter(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const;
  // Takes a hit into the chain as the ray leaves it specularly.
  void reflect(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const;
  // Returns the share of the rays of this order in all rays that meet the chain and the transmit leg behind its last hit.
  // `response` is that of the last hit to a wave that comes over the leg.
  double share(const Ray& ray, const SurfaceHit& surface, const SurfaceResponse& response, const Leg& leg) const;

 private:
  const RayContext& context_;
};

}  // namespace echopath
