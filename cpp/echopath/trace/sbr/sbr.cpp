#include "echopath/trace/sbr/sbr.h"

#include "echopath/trace/sbr/ray_walk.h"

namespace echopath {

struct RayShooter::Parts {
  RayContext context;
  const AntennaFrusta& frusta;
  AntennaLegs legs{context, frusta};
  PacketFront front{context};
  RayWalk<ScalarWeight> scalar{context, legs, front};
  RayWalk<JonesWeight> jones{context, legs, front};
};

RayShooter::RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchPlan& plan, const SbrSettings& settings, const AntennaFrusta& frusta)
    : parts_(new Parts{{geometry, mirrors, plan, settings, SurfaceTable(scene, geometry, mirrors, settings.frequency)},
                       frusta}) {}

RayShooter::~RayShooter() = default;

void RayShooter::shoot(int64_t begin, int64_t end, PathBlock& block) const {
  if (parts_->context.settings.is_polarized) return parts_->jones.shoot(begin, end, block);
  parts_->scalar.shoot(begin, end, block);
}

}  // namespace echopath
