#pragma once
// Holds the state of a ray and of the hit where it is. At each hit a ray goes on with a probability q, that of
// ScatterSample::probability; what it carries on is divided by q, so that its mean is what the surface sends.
#include <array>
#include <complex>
#include <optional>

#include "echopath/em/polarization/jones.h"
#include "echopath/trace/mirrors/legs.h"
#include "echopath/trace/sbr/ray_differential.h"
#include "echopath/trace/scatter/hit_samples.h"
#include "echopath/trace/scatter/lobe_probabilities.h"

namespace echopath {

// Marks a ray that has left the transmitter over something else than the flagged mirrors of a leg.
inline constexpr MirrorSequence kOther = -1;

using RayHits = std::array<Hit, 64>;

// Describes one end of a coherent path over unflagged surfaces: a hit that is a mirror in one of the path's two orders and
// radiates in the other (mirror_orders.h).
struct PathEnd {
  double cover = 1.0;                      // share of the Fresnel zone that it covers as a mirror
  double spread = 1.0;                     // of the tube's area behind it, over that behind a flat mirror
  double to_antenna = 0.0, to_next = 0.0;  // m, unfolded
  bool is_smooth = false;
};

// Holds the hits of a ray from its first diffuse one on, which other rays meet in the opposite order (diffuse_chain.h).
struct DiffuseChain {
  int first = 0;            // index of its first hit: number of hits of the transmit leg
  std::optional<Leg> back;  // way from its first hit to the receiver as the ray came from the transmitter, if it is visible
  double density = 0.0;     // rays per m^2 that meet its first hit over the transmit leg and go on diffusely
  // This is the probability that a ray of the opposite order goes on from one end of the chain to the other, divided by that
  // of this ray; 0 where there is no such ray.
  double opposite_ratio = 1.0;
  // This is the survival probability in the opposite order at the hit that was left last. `opposite_ratio` takes it in one
  // hit later.
  double opposite_survival = 1.0;
  std::complex<double> coefficient = 1.0;  // of the hits left so far, for the opposite order
  FieldPair fields;                        // where polarised: fields of launches at the receiver that run the ray's way
};

// Tells the sign of the field that comes back to the radar.
//
// Fresnel's TM coefficient is that along p_i and p_r (em/surface/fresnel.h). These point opposite ways where a wave turns
// back, so the sign changes once: only then TE and TM are the same at normal incidence. Conductors count as TE at every
// angle: an odd number of them has made that change already.
struct ReturnSign {
  bool has_dielectric_tm = false, has_odd_conductors = false;

  void add(const SurfaceModel& surface, PolarizationMode mode) {
    has_dielectric_tm |= mode == PolarizationMode::kTm;
    has_odd_conductors ^= !surface.is_dielectric();
  }
  double value() const { return has_dielectric_tm && !has_odd_conductors ? -1.0 : 1.0; }
};

struct Ray {
  int64_t index = 0;
  int stratum = 0;
  int num_splits = 0;  // sheets behind which it has gone on while another ray was reflected
  Vec3 direction, launch_direction;
  RayHits hits;
  int depth = 0;                         // hits so far
  uint64_t diffuse = 0;                  // bit per hit
  bool coherent = true;                  // the ray carries a field, not a power (sbr.h)
  MirrorSequence sequence = kNoMirrors;  // the mirrors over which the ray left the transmitter
  double chain_share = 1.0;              // product of s_m^2 of these mirrors
  bool is_owned = false;                 // its stratum owns its first hit on a surface that is aimed at (ray_owners.h)
  double launch_density = 0.0;           // rays per sr of its stratum; in a focus, of the stratum that this is in
  double stands_for = 1.0;               // number of such rays that this one stands for (LaunchFoci)
  // These count from the last anchor (the transmitter or the last diffuse hit): the unfolded length in m, and the density of
  // rays per sr times the probabilities with which they went on.
  double leg_length = 0.0, leg_density = 0.0;
  std::complex<double> coefficient = 1.0;  // product of Gamma s and of what diffuse hits scatter, without q
  FieldPair fields;                        // the same for field vectors, where polarised
  ReturnSign return_sign;                  // of the unflagged hits so far (ScalarWeight)
  // Holds the factors of a coherent ray's field beside its coefficients: 1/q of every bounce and j of every caustic.
  std::complex<double> field_factor = 1.0;
  RayDifferential differential;      // of coherent rays, where the scene has smooth meshes
  bool is_curved = false;            // some bounce so far was on a curved surface
  int num_mirrors = 0;               // specular bounces off unflagged surfaces since the last anchor
  bool is_mirror_unweighed = false;  // the last bounce was one of these, and MirrorOrders has not weighed it yet
  bool holds_zones = true;           // each mirror that is weighed covers enough of its Fresnel zone (kHeldShare)
  RayHit mirror;                     // the last of these mirrors
  Vec3 mirror_arrival;               // unit, direction of the ray there
  double mirror_length = 0.0;        // m, `leg_length` there
  PathEnd first_mirror;              // the first of these mirrors
  double area = 1.0;                 // product of the material areas of the diffuse anchors
  DiffuseChain chain;                // of rays that have left a diffuse hit

  Ray() {}  // leaves members without defaults unset, to save time
};

// Describes the hit where a ray is.
struct SurfaceHit {
  RayHit point;
  const SurfaceModel* model = nullptr;  // of the side where the ray arrives
  const Material* material = nullptr;
  double cos_incidence = 0.0;
  PolarizationMode mode = PolarizationMode::kTe;
  SurfaceResponse response;
  double area = 0.0;                             // m^2: surface that this hit stands for, seen from the last anchor
  ShadowState receiver = ShadowState::kUnknown;  // as seen from this hit
  HitSamples samples;
  double tube_area = 0.0;  // m^2/sr: D of the ray tube behind curved bounces

  SurfaceHit() {}
};

// Says how a ray leaves a hit.
struct ScatterSample {
  Vec3 from, direction;
  bool is_specular = false;
  bool is_split = false;              // it is scattered, and another ray is mirrored beside it
  double lobe_probability = 1.0;      // of leaving mirrored, or scattered, as it does, given that it goes on
  double survival_probability = 1.0;  // of going on at all
  bool ends = false;

  // Returns q.
  double probability() const { return lobe_probability * survival_probability; }
};

// Returns the coefficient of the field that a diffuse hit scatters: S |Gamma|, with the Gamma of facets that face the radar.
inline double diffuse_coefficient(const SurfaceResponse& response) { return response.facet * response.diffuse; }

// Returns the density with which rays that arrive along `in` leave diffusely along `out`, over that of Lambert's lobe.
inline double density_over_lambert(const SurfaceHit& surface, const Vec3& in, const Vec3& out) {
  const DiffuseLobe& lobe = surface.model->lobe();
  return lobe.is_lambert() ? 1.0 : lobe.density_over_lambert({in, surface.point.normal, out});
}

// Returns the response of the surface to a wave that comes from where `direction` points, a unit vector.
inline SurfaceResponse response_toward(const SurfaceHit& surface, const Vec3& polarization, const Vec3& direction) {
  return respond_along(*surface.model, polarization, -direction, surface.point.normal);
}

}  // namespace echopath
