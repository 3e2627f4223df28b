#pragma once
// Gives the probabilities with which a ray goes on from a hit.
#include <algorithm>

#include "echopath/em/surface/surface_response.h"
#include "echopath/trace/frusta/mirror_frusta.h"

namespace echopath {

// From this bounce on, rays end by Russian roulette. In a chain of diffuse hits its own bounces count, so that the
// probabilities of its orders do not depend on how they were reached.
inline constexpr int kRouletteBounce = 3;
static_assert(kMaxLegMirrors < kRouletteBounce, "the balance weight over legs knows of no roulette on mirrors");

// Holds the probabilities of leaving a hit specularly and diffusely, for a ray that goes on.
struct LobeProbabilities {
  double specular = 0.0, diffuse = 0.0;
};

// A ray that has not yet met its target always goes over flagged mirrors as they reflect.
inline constexpr LobeProbabilities kPassingOn{1.0, 0.0};

// Returns the probabilities of other rays: the shares of power of both lobes. `specular_probability` is that of SbrSettings.
inline LobeProbabilities lobe_probabilities(const SurfaceModel& model, const SurfaceResponse& response,
                                            double specular_probability) {
  const LobeProbabilities shares{response.coherent * response.coherent, response.diffuse * response.diffuse};
  const bool is_asked = specular_probability > 0 && shares.specular > 0 && shares.diffuse > 0;
  // The balance weight over the legs of mirrors (LegFinder) relies on the shares of mirrors.
  if (!is_asked || model.material().mirror) return shares;
  return {specular_probability, 1.0 - specular_probability};
}

// Returns whether a coherent ray is split at a surface that both mirrors and scatters: a mirrored ray then always goes on,
// and a scattered one with the probability of the diffuse lobe. The alternative is to choose one of the two at random. This
// leaves gaps among neighbouring mirrored rays, so that phases around a point of reflection do not cancel: between a
// person's limbs the coherent power is then wrong by 8 %, however many rays there are.
//
// A ray is not split, but chooses one way at random, where `specular_probability` is set, at flagged mirrors, where the
// mirrored share of the power is below kLeastMirrored, and behind hit kDeepest, so that one ray of the launch becomes at
// most four. `depth` counts the hits so far, this one among them.
inline bool goes_both_ways(const SurfaceModel& model, const LobeProbabilities& lobes, double specular_probability,
                           int depth) {
  constexpr int kDeepest = 3;
  constexpr double kLeastMirrored = 1e-3;  // of the power that goes on
  return depth <= kDeepest && specular_probability == 0.0 && lobes.specular > kLeastMirrored && lobes.diffuse > 0.0 &&
         !model.material().mirror;
}

// Returns the probability that a ray survives the roulette behind so many bounces: the larger reflectivity of both lobes, so
// that neither gains weight as it survives.
inline double survival_probability(const SurfaceResponse& response, int num_bounces) {
  if (num_bounces < kRouletteBounce) return 1.0;
  const double facet = response.diffuse > 0 ? response.facet * response.facet : 0.0;
  return std::min(1.0, std::max(std::norm(response.gamma), facet));
}

}  // namespace echopath
