#include "echopath/trace/connect/antenna_legs.h"

#include <algorithm>

namespace echopath {
namespace {

int most_mirrors(const RayContext& context) { return std::min(kMaxLegMirrors, context.settings.max_bounces - 1); }

}  // namespace

AntennaLegs::AntennaLegs(const RayContext& context)
    : finder_(context.geometry, context.mirrors, context.settings.frequency, context.settings.polarization),
      transmitter_(finder_.view_of(context.settings.transmitter, most_mirrors(context))),
      receiver_(finder_.view_of(context.settings.receiver, most_mirrors(context))) {}

void AntennaLegs::find_receive(const SurfaceHit& surface, int max_mirrors, HitLegs& legs) const {
  const RayHit& point = surface.point;
  finder_.find({point.position, point.normal, max_mirrors, kOther, surface.receiver}, receiver_, legs.receive, legs.search);
  legs.has_receive = true;
}

void AntennaLegs::find_transmit(const SurfaceHit& surface, int max_mirrors, MirrorSequence skip, HitLegs& legs) const {
  legs.transmit.clear();
  if (skip == kNoMirrors && transmitter_.frusta.empty()) return;
  const RayHit& point = surface.point;
  finder_.find({point.position, point.normal, max_mirrors, skip, ShadowState::kUnknown}, transmitter_, legs.transmit,
               legs.search);
  std::erase_if(legs.transmit, [&](const Leg& leg) { return point.normal.dot(leg.to_antenna) < kGrazing; });
}

double density_over(const LaunchPlan& plan, uint32_t mesh_id, const Leg& leg) {
  const int stratum = plan.owners.owner(mesh_id, leg.sequence);
  return plan.density(stratum) * (plan.is_field_of_view(stratum) ? leg.specular_share : 1.0);
}

}  // namespace echopath
