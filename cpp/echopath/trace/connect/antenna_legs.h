#pragma once
// The legs between the hit of a ray and both antennas.
#include "echopath/trace/sbr/ray.h"
#include "echopath/trace/sbr/ray_context.h"

namespace echopath {

// The legs of one hit, kept from one to the next for their memory.
struct HitLegs {
  std::vector<Leg> transmit, receive;
  bool has_receive = false;  // `receive` is that of the hit where the ray is
  LegSearch search;
};

class AntennaLegs {
 public:
  explicit AntennaLegs(const RayContext& context);
  // Whether no flagged mirror gives either antenna an image: all legs are straight then.
  bool are_straight() const { return transmitter_.frusta.empty() && receiver_.frusta.empty(); }
  // The number of the antennas' frusta over mirrors whose further mirrors were not looked for (kMostFrusta).
  int64_t num_unfollowed_beams() const { return transmitter_.num_unfollowed + receiver_.num_unfollowed; }
  // Finds the visible receive legs of a hit.
  void find_receive(const SurfaceHit& surface, int max_mirrors, HitLegs& legs) const;
  // Finds the visible transmit legs of a hit that rays can come over, but for the one over `skip`.
  void find_transmit(const SurfaceHit& surface, int max_mirrors, MirrorSequence skip, HitLegs& legs) const;

 private:
  LegFinder finder_;
  AntennaView transmitter_, receiver_;
};

// The leg over a sequence of mirrors, null where there is none.
inline const Leg* leg_over(const std::vector<Leg>& legs, MirrorSequence sequence) {
  for (const Leg& leg : legs) {
    if (leg.sequence == sequence) return &leg;
  }
  return nullptr;
}

// Rays per sr at the antenna's end of a transmit leg that come over it to a first hit on a mesh, and go on at all its mirrors:
// those that aim there do.
double density_over(const LaunchPlan& plan, uint32_t mesh_id, const Leg& leg);

}  // namespace echopath
