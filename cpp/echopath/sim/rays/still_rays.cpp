#include "echopath/sim/rays/still_rays.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace echopath {

StillRays::StillRays(LaunchGuide of_standing_scene) : guide(std::move(of_standing_scene)) {
  std::erase_if(guide.shares, [](const auto& share) { return share.second == 0.0; });
  std::erase_if(guide.foci, [&](const LaunchFocus& focus) { return !holds(focus.of); });
}

LaunchGuide StillRays::taken_from(LaunchGuide whole) const {
  for (const auto& [name, rays] : guide.shares) whole.shares[name] = 0.0;
  std::erase_if(whole.foci, [&](const LaunchFocus& focus) { return holds(focus.of); });
  return whole;
}

std::optional<Scene> standing_scene(const Scene& scene, const Radar& radar, const TraceSettings& settings) {
  if (!settings.guide.shares.empty() || !has_steady_rays(scene, radar, settings.scatterers)) return std::nullopt;
  const std::vector<bool> stands = scene.still_meshes();
  if (std::ranges::none_of(stands, std::identity())) return std::nullopt;
  Scene still(scene);
  still.keep_meshes(stands);
  return still;
}

std::shared_ptr<const StillRays> KeptStillRays::kept() {
  const std::lock_guard lock(mutex_);
  return rays_;
}

std::shared_ptr<const StillRays> KeptStillRays::get(const std::function<StillRays()>& find) {
  if (std::shared_ptr<const StillRays> before = kept()) return before;
  auto found = std::make_shared<const StillRays>(find());
  const std::lock_guard lock(mutex_);
  if (!rays_) rays_ = std::move(found);
  return rays_;
}

std::shared_ptr<const StillRays> still_rays(const Scene& scene, const Radar& radar, const TraceSettings& settings,
                                            KeptStillRays* kept,
                                            const std::function<StillRays(const SceneSnapshot&)>& find) {
  KeptStillRays own;
  return (kept ? *kept : own).get([&] {
    std::optional<Scene> standing = standing_scene(scene, radar, settings);
    return standing ? find(SceneSnapshot(*std::move(standing))) : StillRays{};
  });
}

}  // namespace echopath
