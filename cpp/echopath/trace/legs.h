#pragma once
// Legs between a surface point and an antenna: direct and over flagged mirrors.
#include <array>
#include <complex>

#include "echopath/em/surface_response.h"
#include "echopath/trace/embree_scene.h"
#include "echopath/trace/mirror_beams.h"

namespace echopath {

// A bounce of a leg, seen by a wave that travels from the surface point to the antenna.
struct LegBounce {
  int mirror = 0;      // index into the mirrors
  Hit hit{};
  Vec3 direction;      // unit, of travel toward the mirror
  Vec3 normal;         // unit, on the lit side
  double specular_share = 1.0;  // s_m^2
};

struct Leg {
  MirrorSequence sequence = kDirect;
  int num_bounces = 0;
  std::array<LegBounce, kMaxLegMirrors> bounces;  // from the point toward the antenna
  double length = 0.0;        // m, unfolded
  Vec3 to_antenna;            // unit, from the point toward the antenna or its image
  Vec3 at_antenna;            // unit, from the antenna toward the point or its image
  std::complex<double> gain = 1.0;  // field factor: product of Gamma_m s_m of the mirrors
  double specular_share = 1.0;      // product of s_m^2: the probability with which a ray goes on specularly over all of them
};

struct AntennaView {
  Vec3 position;             // relative to the trace origin
  std::vector<Beam> beams;
};

class LegFinder {
 public:
  LegFinder(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency, const Vec3& polarization)
      : geometry_(geometry), mirrors_(mirrors), frequency_(frequency), polarization_(polarization) {}

  AntennaView view_of(const Vec3& antenna) const;
  // All visible legs between `point` (unit normal on the lit side) and `antenna` over at most `max_mirrors` mirrors, direct
  // first, then in the order of the beams. `skip`: a sequence that is left out, negative for none. Queries made are added to
  // `num_queries`.
  void find(const Vec3& point, const Vec3& normal, const AntennaView& antenna, int max_mirrors, MirrorSequence skip,
            std::vector<Leg>& legs, int64_t& num_queries) const;

 private:
  bool over_mirrors(const Vec3& point, const Vec3& normal, const AntennaView& antenna, const Beam& beam, Leg& leg,
                    int64_t& num_queries) const;
  bool bounce(int mirror, const Vec3& from, const Vec3& direction, Leg& leg, RayHit& met) const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  double frequency_;
  Vec3 polarization_;
};

}  // namespace echopath
