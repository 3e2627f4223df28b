#pragma once
// What the sbr_*.cpp share: the state of a ray. Internal to the module.
#include <array>
#include <cmath>
#include <optional>

#include "echopath/em/hit_modes.h"
#include "echopath/em/jones.h"
#include "echopath/trace/near_antenna.h"
#include "echopath/trace/ray_differential.h"
#include "echopath/trace/sbr.h"

namespace echopath {

inline constexpr double kGrazing = 1e-3;  // cosine below which a hit is dropped
// Rays leave this bounce and later ones by Russian roulette. Of a chain of diffuse hits its own bounces count, so that the
// odds of its orders do not depend on how they were reached.
inline constexpr int kRouletteBounce = 3;
// Of the Fresnel zone: an unflagged surface that covers less is no mirror for diffuse echoes.
inline constexpr double kHeldShare = 0.5;
inline constexpr MirrorSequence kOther = -1;  // the transmitter was left over something else than a sequence of a leg

// One end of a coherent path over unflagged surfaces: a hit that is a mirror in one of the path's two orders and radiates in the
// other (sbr_orders.cpp).
struct RayShooter::PathEnd {
  double cover = 1.0;       // share of the Fresnel zone that it covers as a mirror
  double spread = 1.0;      // of the tube's area behind it, over that behind a flat mirror
  double to_antenna = 0.0, to_next = 0.0;  // m, unfolded
  bool is_smooth = false;
};

struct RayShooter::Ray {
  int64_t index = 0;
  int stratum = 0;
  Vec3 direction, launch_direction;
  RayHits hits;
  int depth = 0;              // hits so far
  uint64_t diffuse = 0;       // bit per hit
  bool coherent = true;       // regime C
  MirrorSequence sequence = kDirect;  // how the transmitter was left
  double chain_share = 1.0;           // product of s_m^2 of these mirrors
  bool is_owned = false;              // its stratum owns its first hit on a surface that is aimed at (ray_owners.h)
  double launch_density = 0.0;        // rays per sr of its stratum; in a focus, of the stratum that this is in
  double stands_for = 1.0;            // so many of these rays (LaunchFoci)
  // Since the last anchor (the transmitter or the last diffuse hit): unfolded length in m and rays per sr, continuation
  // probabilities included.
  double leg_length = 0.0, leg_density = 0.0;
  std::complex<double> coefficient = 1.0;  // product of Gamma s and of what diffuse hits scatter, without q
  FieldPair polarized;                     // likewise of vectors, where polarised
  // Of the unflagged bounces so far; tells the sign of what comes back (sbr_connect.cpp).
  bool has_dielectric_tm = false, has_odd_conductors = false;
  // What a field has beside its coefficients: 1/q of every bounce, j of every caustic; regime C.
  std::complex<double> field_factor = 1.0;
  RayDifferential rays;       // regime C, where the scene has smooth meshes
  bool is_curved = false;     // some bounce so far was on a curved surface
  int num_mirrors = 0;            // specular bounces off unflagged surfaces since the last anchor
  bool last_was_mirror = false;   // and it was the last bounce
  bool holds_zones = true;        // each of them covers at least kHeldShare of its Fresnel zone
  PathEnd first_mirror;           // the first of them
  double area = 1.0;                       // product of the material areas of the diffuse anchors
};

struct RayShooter::Surface {
  RayHit point;
  const SurfaceModel* model = nullptr;
  const Material* material = nullptr;
  double cos_incidence = 0.0;
  PolarizationMode mode = PolarizationMode::kTe;
  SurfaceResponse response;
  double area = 0.0;  // m^2: surface that this hit stands for, seen from the last anchor
  ShadowState receiver = ShadowState::kUnknown;  // as seen from here
  HitSamples chance;
  double tube_area = 0.0;  // m^2/sr: D of the ray tube behind curved bounces
};

struct RayShooter::RayAtHit {
  Ray ray;
  Surface surface;

  RayAtHit() {}  // does not clear what its members leave as it is
};

// Neighbouring rays and their first hits, lane by lane.
struct RayShooter::Packet {
  int64_t begin = 0;  // index of the first ray
  int count = 0;
  LaunchPlan::Places places;
  LaneVectors directions;
  LaneValues densities;  // rays per sr, if each counted in full: of the owner over what a ray stands for; infinite where foci have all
  PacketChance chance;
  EmbreeScene::PacketHits hits;
  LaneVectors lifted;        // the hits, off their surfaces
  LaneValues cos_incidence;
  LaneValues cos_receiver;   // positive where the receiver is on the lit side; not divided by its distance
  LaneValues near_squared;   // m^2: to the nearest antenna
  EmbreeScene::Lanes arrives;              // whether the ray is at a hit that its stratum owns, or passes over a mirror
  std::array<bool, kPacketSize> is_owned;  // the former
  std::array<ShadowState, kPacketSize> receiver;  // as seen from there
  std::array<const SurfaceModel*, kPacketSize> models;
  std::array<PolarizationMode, kPacketSize> modes;
  LaneValues gamma_re, gamma_im, coherent, diffuse, facet;  // the responses
  LaneValues sign;                                   // of the field that comes back (sbr_connect.cpp)
  LaneValues specular_odds, diffuse_odds;            // of going on that way, if it does
  LaneVectors out;                                   // the direction in which it goes on
  std::array<bool, kPacketSize> goes_on;             // whether anything does
  std::array<bool, kPacketSize> is_plain;            // no legs but straight ones
  LanesOf<float> field_re, field_im, power_re, power_im;  // weights of the coherent and the diffuse echo to the receiver
  // Where polarised: the same without coefficients, which are in the matrices of both echoes.
  LaneValues te_re, te_im, tm_re, tm_im;     // of reflection
  LaneValues cross_share, axis_cosine, axis_sine;  // of diffuse hits
  LanesOf<float> field_jones[4][2], power_jones[4][2];  // [entry][re, im]

  void set_response(int lane, const SurfaceResponse& response, const LobeProbabilities& odds) {
    gamma_re[lane] = response.gamma.real();
    gamma_im[lane] = response.gamma.imag();
    coherent[lane] = response.coherent;
    diffuse[lane] = response.diffuse;
    facet[lane] = response.facet;
    specular_odds[lane] = odds.specular;
    diffuse_odds[lane] = odds.diffuse;
    sign[lane] = modes[static_cast<size_t>(lane)] == PolarizationMode::kTm ? -1.0 : 1.0;
  }
  SurfaceResponse response(int lane) const {
    return {{gamma_re[lane], gamma_im[lane]}, coherent[lane], diffuse[lane], facet[lane]};
  }
};

// How a ray leaves a hit.
struct RayShooter::ScatterSample {
  Vec3 from, direction;
  bool is_specular = false;
  double odds = 1.0;      // of that, where the ray goes on
  double survival = 1.0;  // probability that it does
  bool ends = false;

  double probability() const { return odds * survival; }
};

// The hits of a ray from its first diffuse one on, which other rays meet in the opposite order (sbr_diffuse.cpp).
struct RayShooter::Chain {
  int first = 0;             // index of its first hit: number of hits of the transmit leg
  std::optional<Leg> back;   // way from its first hit to the receiver as the ray came from the transmitter, if it is visible
  double density = 0.0;      // rays per m^2 that meet its first hit over the transmit leg and go on diffusely
  // Odds of a ray that comes the opposite way to go on between both ends, over those of this ray. 0: none comes.
  double odds = 1.0;
  double held = 1.0;         // survival in the opposite order at the hit that was left last: it joins `odds` one hit later
  std::complex<double> coefficient = 1.0;  // of the hits left so far, for the opposite order
  FieldPair fields;          // likewise, where polarised: of launches at the receiver that run the ray's way

  void begin(int first_hit) {
    first = first_hit;
    back.reset();
    density = 0.0;
    odds = held = 1.0;
    coefficient = 1.0;
  }
};

// The modes of launches that arrive at a diffuse hit, as far as it keeps them.
struct RayShooter::ModesIn {
  VectorOf<double> direction;
  ModeAxes axes;
  std::complex<double> te[2], tm[2];  // [launch]
};

// Along which fields that leave a hit a receiver sees its two components, in parts across the way out.
struct RayShooter::AxesOut {
  VectorOf<double> direction;
  BasisAcross across;
  std::complex<double> horizontal[2], vertical[2];  // [component]
};

struct RayShooter::Scratch {
  std::vector<Leg> transmit, receive;
  std::vector<FieldPair> axes;   // of `receive`, where polarised (sbr_polarization.cpp)
  std::vector<ModesIn> modes_in;  // of pairs, likewise
  std::vector<AxesOut> axes_out;
  bool has_receive = false;                     // `receive` is that of the ray's hit
  LegSearch search;
  RayHit mirror;        // the last specular bounce off an unflagged surface
  Vec3 mirror_arrival;  // unit, of the ray there
  Chain chain;  // of rays that have left a diffuse hit
  RayAtHit first;  // the ray of a packet that is followed now
};

// Replay multiplies the matrix of a coherent path by cos_i; a conductor's TM part goes with the cosine of radiation instead, so the
// quotient is bounded where cos_i is small beside that.
ECHOPATH_INLINE double polarized_scale(double cos_incidence, double cos_radiation) {
  constexpr double kPolarizedGrazing = 0.05;
  return 1.0 / ScalarMath::larger(cos_incidence, kPolarizedGrazing * cos_radiation);
}

// Of the field that a diffuse hit scatters.
inline double diffuse_coefficient(const SurfaceResponse& response) { return response.facet * response.diffuse; }

}  // namespace echopath
