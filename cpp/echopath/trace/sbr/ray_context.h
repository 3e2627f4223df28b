#pragma once
// Holds what all rays of a trace share. Internal to the module, as everything about single rays.
#include "echopath/base/constants.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/sbr/sbr_settings.h"
#include "echopath/trace/scatter/lobe_probabilities.h"
#include "echopath/trace/scatter/surface_table.h"

namespace echopath {

inline constexpr double kGrazing = 1e-3;  // cosine below which a hit is dropped

struct RayContext {
  const EmbreeScene& geometry;
  const std::vector<Mirror>& mirrors;
  const LaunchPlan& plan;
  SbrSettings settings;
  SurfaceTable surfaces;
  double wavelength = kSpeedOfLight / settings.frequency;  // m

  // Returns whether the rays of a stratum count the echoes of first hits on a mesh over these mirrors.
  bool is_owner(int stratum, uint32_t mesh_id, MirrorSequence sequence) const {
    return plan.owners.owner(mesh_id, sequence) == plan.foci.owner(stratum);
  }
  // Returns whether these rays pass over this mesh on their way to their target.
  bool is_passed(int stratum, uint32_t mesh_id) const {
    return surfaces.is_mirror(mesh_id) && !plan.is_field_of_view(stratum);
  }
  bool goes_both_ways(const SurfaceModel& model, const LobeProbabilities& lobes, int depth) const {
    return echopath::goes_both_ways(model, lobes, settings.specular_probability, depth);
  }
  // Returns whether anything is drawn at random at hit number `depth` of a ray: the roulette, or what diffuse hits need.
  bool draws_samples(int depth) const { return surfaces.may_scatter() || depth >= kRouletteBounce; }
  LobeProbabilities probabilities(const SurfaceModel& model, const SurfaceResponse& response) const {
    return lobe_probabilities(model, response, settings.specular_probability);
  }
};

}  // namespace echopath
