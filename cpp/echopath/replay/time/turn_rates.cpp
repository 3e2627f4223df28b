#include "echopath/replay/time/turn_rates.h"

namespace echopath {

double turn_rate(const Scene& scene, uint32_t mesh_id, const TimeSpan& during) {
  const Node& node = scene.node_of(mesh_id);
  double rate = node.deformation ? node.deformation->turn_rate(during) : 0.0;
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[i].parent) {
    const Motion* motion = scene.nodes()[i].motion.get();
    if (motion) rate += motion->turn_rate(during);
  }
  return rate;
}

double turn_rate(const Radar& radar, const TimeSpan& during) { return radar.motion ? radar.motion->turn_rate(during) : 0.0; }

}  // namespace echopath
