#pragma once
// Finds the legs between the hit of a ray and both antennas.
#include "echopath/trace/frusta/antenna_frusta.h"
#include "echopath/trace/sbr/ray.h"
#include "echopath/trace/sbr/ray_context.h"

namespace echopath {

// Holds the legs of one hit; it is kept from hit to hit for its memory.
struct HitLegs {
  std::vector<Leg> transmit, receive;
  bool has_receive = false;  // `receive` is that of the hit where the ray is
  LegSearch search;
};

class AntennaLegs {
 public:
  // Both must outlive it.
  AntennaLegs(const RayContext& context, const AntennaFrusta& frusta);
  // Returns whether no flagged mirror gives either antenna an image: then all legs are straight.
  bool are_straight() const { return are_straight_; }
  // Finds the visible receive legs of a hit.
  void find_receive(const SurfaceHit& surface, int max_mirrors, HitLegs& legs) const;
  // Finds the visible transmit legs of a hit over which rays can come, except the one over `skip`.
  void find_transmit(const SurfaceHit& surface, int max_mirrors, MirrorSequence skip, HitLegs& legs) const;

 private:
  LegFinder finder_;
  AntennaView transmitter_, receiver_;
  bool are_straight_;
};

// Returns the view of an antenna in which its legs are searched. `found` has its frusta; the view has none of them unless
// they serve legs.
AntennaView view_for_legs(const Vec3& antenna, const MirrorFrusta& found, bool serve_legs, const SbrSettings& settings);

// Returns the leg over a sequence of mirrors, or null where there is none.
inline const Leg* leg_over(const std::vector<Leg>& legs, MirrorSequence sequence) {
  for (const Leg& leg : legs) {
    if (leg.sequence == sequence) return &leg;
  }
  return nullptr;
}

// Returns the rays per sr at the antenna's end of a transmit leg that come over it to a first hit on a mesh. Rays that aim
// there go on at all mirrors of the leg.
double density_over(const LaunchPlan& plan, uint32_t mesh_id, const Leg& leg);

}  // namespace echopath
