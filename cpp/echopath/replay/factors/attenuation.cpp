#include "echopath/replay/factors/attenuation.h"

#include <cmath>

namespace echopath {

void attenuate(const ChannelSpan& channels, size_t num_paths, size_t num_nodes, double attenuation) {
  for (const ChannelNodes& channel : channels.nodes) {
    const size_t num_echoes = channel.echo_of ? channel.echo_of[num_paths - 1] + 1 : num_paths;
    const double per_length = attenuation / channel.scale;  // of the lengths as they are written
    for (size_t node = 0; node < num_nodes; ++node) {
      const double* const length = channel.length + node * channel.stride;
      std::complex<double>* const amplitude = channel.amplitude + node * channel.stride;
      for (size_t echo = 0; echo < num_echoes; ++echo) amplitude[echo] *= std::exp(-per_length * length[echo]);
    }
  }
}

}  // namespace echopath
