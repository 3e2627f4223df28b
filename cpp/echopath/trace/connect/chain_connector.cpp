#include "echopath/trace/connect/chain_connector.h"

#include <cmath>

namespace echopath {

template <class Weight>
void DiffuseChainConnector<Weight>::connect(Connection& at) const {
  const Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  const DiffuseChain& chain = ray.chain;
  const std::vector<Leg>&receive = at.legs.receive, &transmit = at.legs.transmit;
  if (receive.empty() && !chain.back) return;
  at.legs.transmit.clear();
  if (chain.back || chain.opposite_ratio > 0) {
    legs_.find_transmit(surface, context_.settings.max_bounces - ray.depth, kOther, at.legs);
  }
  const uint64_t bits = ray.diffuse | last_bit(ray);
  const std::complex<double> common = std::sqrt(ray.area * surface.area) * surface.samples.phase;
  const std::complex<double> natural = ray.coefficient * diffuse_coefficient(surface.response);
  for (const Leg& in : transmit) {
    const SurfaceResponse response = response_toward(surface, context_.settings.polarization, in.to_antenna);
    const double share = std::sqrt(orders_.share(ray, surface, response, in));
    const Leg* out = leg_over(receive, in.sequence);
    if (out) writer_.write(at, *out, bits, share * (common * weight_.held(natural * out->gain)), OrderShares{});
    if (!chain.back) continue;
    const std::complex<double> reversed = in.gain * diffuse_coefficient(response) * chain.coefficient * chain.back->gain;
    writer_.write_reversed(at, in, bits, share * (common * weight_.held(reversed)));
  }
  for (const Leg& out : receive) {
    if (leg_over(transmit, out.sequence)) continue;
    writer_.write(at, out, bits, common * weight_.held(natural * out.gain), OrderShares{});
  }
}

template class DiffuseChainConnector<ScalarWeight>;
template class DiffuseChainConnector<JonesWeight>;

}  // namespace echopath
