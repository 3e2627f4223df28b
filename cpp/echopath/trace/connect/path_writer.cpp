#include "echopath/trace/connect/path_writer.h"

#include <algorithm>

#include "echopath/trace/sbr/ray_tube.h"

namespace echopath {
namespace {

// Returns the hits of a ray and then those of a receive leg.
RayHits hits_over(const Ray& ray, const Leg& leg) {
  RayHits hits;
  std::copy_n(ray.hits.begin(), ray.depth, hits.begin());
  for (int k = 0; k < leg.num_bounces; ++k) {
    hits[ray.depth + k] = leg.bounces[k].hit;
  }
  return hits;
}

// Returns the same hits, with the way back of the ray's chain in place of its transmit leg.
RayHits hits_back_over(const Ray& ray, const Leg& leg) {
  const DiffuseChain& chain = ray.chain;
  RayHits hits = hits_over(ray, leg);
  for (int k = 0; k < chain.back->num_bounces; ++k) {
    hits[chain.first - 1 - k] = chain.back->bounces[k].hit;
  }
  return hits;
}

}  // namespace

template <class Weight>
void PathWriter<Weight>::write(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight,
                               const OrderShares& shares) const {
  const Ray& ray = at.ray;
  const int count = ray.depth + leg.num_bounces;
  if (count > context_.settings.max_bounces) return;
  if (shares.own > 0) {
    const std::complex<float> rounded(shares.own * weight);
    if (leg.num_bounces == 0) at.block.add_prefix(ray.depth, diffuse, rounded, ray.stratum);
    else at.block.add(hits_over(ray, leg).data(), count, diffuse, rounded, ray.stratum);
    set_columns(at, leg, diffuse);
  }
  if (shares.opposite == 0) return;
  const std::complex<float> rounded(shares.opposite * weight);
  at.block.add_reversal(hits_over(ray, leg).data(), count, diffuse, rounded, ray.stratum);
  set_columns(at, leg, diffuse);
  weight_.exchange_antennas(at, leg);
}

template <class Weight>
void PathWriter<Weight>::write_reversed(Connection& at, const Leg& leg, uint64_t diffuse,
                                        std::complex<double> weight) const {
  const Ray& ray = at.ray;
  at.block.add_reversal(hits_back_over(ray, leg).data(), ray.depth + leg.num_bounces, diffuse, std::complex<float>(weight),
                        ray.stratum);
  weight_.set_reversed_matrix(at, leg);
}

// Sets the columns that the last path needs beside its weight, if the scene asks for them.
template <class Weight>
void PathWriter<Weight>::set_columns(Connection& at, const Leg& leg, uint64_t diffuse) const {
  if (diffuse != 0) return weight_.set_diffuse_matrix(at, leg);
  if (at.ray.is_curved) {
    const Hit& hit = at.surface.point.hit;
    const std::array<Vec3, 3> corners = context_.geometry.corners(hit.mesh_id, hit.triangle_id);
    at.block.set_curved_cell(footprint_of_tube(at.ray, at.surface, corners, context_.plan.lattice_density(at.ray.stratum)));
  }
  weight_.set_coherent_matrix(at, leg);
}

template class PathWriter<ScalarWeight>;
template class PathWriter<JonesWeight>;

}  // namespace echopath
