#include "echopath/replay/factors/sheet_passages.h"

namespace echopath {

void SheetPassages::apply(std::span<const int64_t> indices, const PosedNodes& nodes, const ChannelSpan& channels,
                          bool with_amplitudes) const {
  for (size_t place = 0; place < indices.size(); ++place) {
    if (sheets_.preparer.paths().passes_of(indices[place]).empty()) continue;
    PathPassages path(sheets_, indices[place]);
    for (size_t node = 0; node < nodes.size(); ++node) {
      const size_t num_receivers = nodes.at(node).receivers.size();
      path.pose(nodes.at(node));
      for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
        const size_t of_all = channels.first + channel;
        const auto passed = path.at_channel(of_all / num_receivers, of_all % num_receivers);
        channels.nodes[channel].lengthen(node, place, passed.delay);
        if (with_amplitudes) channels.nodes[channel].scale_amplitude(node, place, passed.field);
      }
    }
  }
}

}  // namespace echopath
