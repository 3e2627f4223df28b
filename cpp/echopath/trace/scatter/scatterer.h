#pragma once
// Sends rays on from their hits.
#include "echopath/trace/connect/diffuse_chain.h"
#include "echopath/trace/connect/mirror_orders.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {

template <class Weight>
class Scatterer {
 public:
  Scatterer(const RayContext& context, const AntennaLegs& legs)
      : context_(context), legs_(legs), orders_(context), chains_(context), weight_(context) {}
  // Draws whether and where a ray goes on.
  ScatterSample sample(const Ray& ray, const SurfaceHit& surface, int batch) const;
  // Returns how the ray goes on that the hit mirrors beside `scattered`, which is split.
  ScatterSample mirrored_beside(const Ray& ray, const SurfaceHit& surface, const ScatterSample& scattered) const;
  // Turns the ray into the one that leaves the hit; returns false where that does not count. It is called only where the ray
  // meets something behind, because most rays meet nothing. `legs` are those of the hit.
  bool leave(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const;

 private:
  std::array<double, 2> lobe_numbers(const Ray& ray, int batch) const;
  Vec3 lobe_direction(const Ray& ray, const SurfaceHit& surface, int batch) const;
  void reflect(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const;
  void leave_mirror(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const;
  void scatter(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const;
  void begin_chain(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const;

  const RayContext& context_;
  const AntennaLegs& legs_;
  MirrorOrders orders_;
  DiffuseChainOrders chains_;
  Weight weight_;
};

extern template class Scatterer<ScalarWeight>;
extern template class Scatterer<JonesWeight>;

}  // namespace echopath
