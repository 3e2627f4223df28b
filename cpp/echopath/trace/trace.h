#pragma once
// Traces a scene: rays that see scene and radar at mid-frame make the paths of the record.
#include "echopath/base/threads/job.h"
#include "echopath/scene/scene_snapshot.h"
#include "echopath/trace/launch/launch_focus.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

class KeptGeometry;  // trace/embree/kept_geometry.h
class FittedStrata;  // trace/strata/fitted_strata.h

inline constexpr int64_t kMostRays = 10000000000;

struct TraceSettings {
  int64_t num_rays = 1000000;    // 1 to kMostRays, and so few that the machine has memory for their record
  int64_t num_rays_to_come = 0;  // of a trace of the same scene that this one prepares; the memory must do for it too
  int max_bounces = 4;           // 1 to 64; hits on mirrors count
  uint64_t seed = 1;
  double start_time = 0.0;  // s, first sample of the frame
  PolarizationModel polarization = PolarizationModel::kScalar;
  Footprint footprint = Footprint::kSecondOrder;  // filter of the ray's footprint on coherent echoes, applied in replay
  // 1 to 64: independent lattices that share the rays; errors follow from their differences. Each is as fine as its share of
  // the rays.
  int batches = 1;
  Sampler sampler = Sampler::kLattice;  // of the launch directions
  LaunchGuide guide;                    // by default the rule of launch.h
  Scatterers scatterers = Scatterers::kRays;
  bool edges = false;        // also find the echoes of sharp edges (edges/edge_paths.h)
  double attenuation = 0.0;  // Np/m, of fields in the air between the surfaces

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// Shoots the rays from the mean transmitter position at mid-frame and connects hits to the mean receiver position.
// Deterministic: the same input gives the same bits for any number of threads. Raises invalid_argument for bad settings,
// a radar without antennas, a smooth mirror that is not flat, or a motion that does not cover the frame; raises
// DeviceError; raises Cancelled. With `kept`, the trace uses the geometry of the trace before where it can, and leaves
// its own for the next: the record is the same and comes sooner, but the memory stays in use. `fitted` does the same for
// the strata of surfaces that the trace before saw from the same place.
Paths trace(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job = nullptr,
            KeptGeometry* kept = nullptr, FittedStrata* fitted = nullptr);

}  // namespace echopath
