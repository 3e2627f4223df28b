#pragma once
// Holds the first hits of neighbouring rays. Each array has one value per ray, the values of a packet side by side.
#include "echopath/trace/sbr/ray.h"
#include "echopath/trace/sbr/ray_context.h"

namespace echopath {

// Separates the random numbers of a ray from those of the rays that are split off it at sheets: behind n sheets, ray i takes
// the random numbers of index i + n kBranch.
inline constexpr int64_t kBranch = int64_t{1} << 44;

struct FirstHits {
  int64_t begin = 0, number = 0;         // index of the first ray in the plan, and in the random numbers
  int num_sheets = 0;                    // through which the rays have gone
  const SurfacePoint* points = nullptr;  // [count] at which the rays are aimed; null for rays of a lattice
  int count = 0;
  LaunchPlan::Places places;
  LaneVectors directions;
  // These are the densities, in rays per sr, that the weights of rays are made of: the density of the stratum that owns the
  // echoes of a ray, divided by the number of that stratum's rays that this ray stands for (LaunchFoci::rays_of_owner), or
  // for rays that are aimed at points LaunchPlan::default_density. The density is infinite where foci own all echoes of a
  // direction.
  LaneValues densities;
  PacketSamples samples;
  EmbreeScene::PacketHits hits;
  LaneVectors lifted;  // the hits, off their surfaces
  LaneValues cos_incidence;
  LaneValues cos_receiver;  // positive where the receiver is on the lit side; not divided by its distance
  LaneValues near_squared;  // m^2: to the nearest antenna
  LaneFlags arrives;        // whether the ray is at a hit that its stratum owns, or passes over a mirror
  LaneFlags is_owned;       // whether its stratum owns the hit
  std::array<ShadowState, kPacketSize> receiver;  // as seen from the hit
  std::array<const SurfaceModel*, kPacketSize> models;
  std::array<PolarizationMode, kPacketSize> modes;
  LaneValues gamma_re, gamma_im, coherent, diffuse, facet;  // the responses
  LaneValues sign;                                          // of the field that comes back (connector.cpp)
  LaneValues specular_probability, diffuse_probability;     // of going on that way, if it does
  LaneValues receiver_reach;  // m^2: positive where the reflected ray meets the sphere around the receiver (plane_images.h)
  LaneVectors out;            // the direction in which it goes on
  LaneVectors mirrored;       // the direction in which the surface mirrors it
  LaneFlags goes_both_ways;   // mirrored always, scattered by chance
  LaneFlags goes_on;          // whether the ray goes on at all

  // Returns the index of the lane's ray in the random numbers, and that of its hits: behind each sheet these are others,
  // unless they belong to the point at which the ray is aimed.
  int64_t ray(int lane) const { return points ? points[lane].key : number + lane; }
  int64_t index(int lane) const { return points ? points[lane].key : number + lane + num_sheets * kBranch; }
  void set_response(int lane, const SurfaceResponse& response, const LobeProbabilities& lobes) {
    gamma_re[lane] = response.gamma.real();
    gamma_im[lane] = response.gamma.imag();
    coherent[lane] = response.coherent;
    diffuse[lane] = response.diffuse;
    facet[lane] = response.facet;
    specular_probability[lane] = lobes.specular;
    diffuse_probability[lane] = lobes.diffuse;
    sign[lane] = modes[lane] == PolarizationMode::kTm ? -1.0 : 1.0;
  }
  SurfaceResponse response(int lane) const {
    return {{gamma_re[lane], gamma_im[lane]}, coherent[lane], diffuse[lane], facet[lane]};
  }
  // Returns whether the ray of a lane is both scattered, which is what `sample` tells, and mirrored.
  bool is_split(int lane) const { return goes_on[lane] && goes_both_ways[lane] && !sample(lane).is_specular; }
  ScatterSample mirrored_sample(int lane) const {
    ScatterSample sample;
    sample.from = lifted[lane];
    sample.direction = mirrored[lane];
    sample.is_specular = true;
    return sample;
  }
  // Returns how the ray of a lane goes on.
  ScatterSample sample(int lane) const {
    static_assert(kRouletteBounce > 1, "first hits know of no roulette");
    ScatterSample sample;
    sample.from = lifted[lane];
    sample.direction = out[lane];
    sample.is_specular = samples.lobe_sample[lane] < specular_probability[lane];
    sample.lobe_probability = sample.is_specular ? specular_probability[lane] : diffuse_probability[lane];
    if (sample.is_specular && goes_both_ways[lane]) sample.lobe_probability = 1.0;
    return sample;
  }
};

}  // namespace echopath
