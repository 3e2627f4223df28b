#include "echopath/trace/connect/antenna_legs.h"

namespace echopath {

AntennaView view_for_legs(const Vec3& antenna, const MirrorFrusta& found, bool serve_legs, const SbrSettings& settings) {
  if (!serve_legs) return {antenna, {}, {}};
  return view_of(antenna, with_at_most(found, most_leg_mirrors(settings)));
}

AntennaLegs::AntennaLegs(const RayContext& context, const AntennaFrusta& frusta)
    : finder_(context.geometry, context.mirrors, context.settings.frequency, context.settings.polarization),
      transmitter_(view_for_legs(context.settings.transmitter, frusta.transmitter, frusta.serve_legs, context.settings)),
      receiver_(view_for_legs(context.settings.receiver, frusta.receiver, frusta.serve_legs, context.settings)),
      are_straight_(with_at_most(frusta.transmitter, most_leg_mirrors(context.settings)).empty() &&
                    with_at_most(frusta.receiver, most_leg_mirrors(context.settings)).empty()) {}

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
  if (leg.sequence == kNoMirrors && plan.has_surface_scatterers()) return plan.default_density[stratum];
  return plan.density(stratum) * (plan.is_field_of_view(stratum) ? leg.specular_share : 1.0);
}

}  // namespace echopath
