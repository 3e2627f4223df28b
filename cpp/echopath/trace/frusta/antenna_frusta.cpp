#include "echopath/trace/frusta/antenna_frusta.h"

#include <algorithm>

#include "echopath/trace/mirrors/image_method.h"

namespace echopath {
namespace {

// Returns whether hits on surfaces of this material have echoes of their own (connector.h).
bool radiates(const Material& material, double frequency) {
  return !material.mirror || SurfaceModel(material, frequency).respond(1.0, PolarizationMode::kTe).diffuse > 0;
}

bool any_radiates(const Scene& scene, double frequency) {
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    if (radiates(*scene.node_of(mesh_id).material, frequency)) return true;
  }
  return false;
}

}  // namespace

int most_leg_mirrors(const SbrSettings& settings) { return std::min(kMaxLegMirrors, settings.max_bounces - 1); }

AntennaFrusta find_antenna_frusta(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                                  const SbrSettings& settings, const ShadowCasters& casters, const Job* job) {
  AntennaFrusta found;
  found.serve_legs = !mirrors.empty() && any_radiates(scene, settings.frequency);
  if (mirrors.empty()) return found;
  const int of_legs = found.serve_legs ? most_leg_mirrors(settings) : 0, half = settings.max_bounces / 2;
  const FrustumFinder finder(mirrors, &geometry, casters);
  FrustumSearch search{.max_mirrors = std::max(half, of_legs), .slack = kAtEdge};
  found.transmitter = finder.find(settings.transmitter, search, job);
  found.receiver = finder.find(settings.receiver, search, job);
  const bool is_one_over = settings.max_bounces > 2 * half && search.max_mirrors == half;
  if (!is_one_over) return found;
  search.max_mirrors = half + 1;
  search.keeps_hidden = true;
  found.receiver_is_longer = found.receiver.frusta.size() < found.transmitter.frusta.size();
  if (found.receiver_is_longer) finder.lengthen(settings.receiver, search, found.receiver, job);
  else finder.lengthen(settings.transmitter, search, found.transmitter, job);
  return found;
}

std::span<const MirrorFrustum> with_at_most(const MirrorFrusta& found, int max_mirrors) {
  const auto is_no_longer = [&](const MirrorFrustum& one) { return static_cast<int>(one.mirrors.size()) <= max_mirrors; };
  const auto end = std::partition_point(found.frusta.begin(), found.frusta.end(), is_no_longer);
  return {found.frusta.begin(), end};
}

}  // namespace echopath
