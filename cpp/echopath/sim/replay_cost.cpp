#include "echopath/sim/replay_cost.h"

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

// Seconds of one thread, measured with the street's pedestrian: for a hit or an end of a path in a chirp of a channel, by
// SpecularPoints, and for a path in a sample.
constexpr double kMaterialSeconds = 2.5e-8, kFermatSeconds = 4e-8, kSampleSeconds = 2e-9;

struct Moving {
  double paths = 0.0, places = 0.0;  // hits and ends
};

// Seconds of one thread for a ray query of a trace, and for a hit that is renewed, which asks for both its legs.
constexpr double kQuerySeconds = 5e-7, kRenewalSeconds = 1e-6;

// Counts the paths that touch what moves.
Moving count_moving(const Paths& paths, const Radar& radar) {
  std::vector<uint8_t> moves(paths.scene->meshes().size());
  for (uint32_t mesh = 0; mesh < moves.size(); ++mesh) moves[mesh] = radar.is_moving() || paths.scene->is_moving(mesh);
  Moving count;
  for (size_t i = 0; i < paths.offsets.size(); ++i) {
    const Hit* first = paths.hits->data() + paths.offsets[i];
    if (std::none_of(first, first + paths.num_bounces[i], [&](const Hit& hit) { return moves[hit.mesh_id]; })) continue;
    count.paths += 1.0;
    count.places += paths.num_bounces[i] + 1.0;
  }
  return count;
}

}  // namespace

double exact_seconds(const Paths& paths, const Radar& radar, const CubeSettings& settings) {
  if (!settings.synthesis.per_sample && !settings.replay.exact) return 0.0;
  const Moving moving = count_moving(paths, radar);
  const double of_place = settings.replay.specular == SpecularPoints::kMaterial ? kMaterialSeconds : kFermatSeconds;
  const double of_chirp = (settings.replay.exact ? of_place * moving.places : 0.0) +
                          (settings.synthesis.per_sample ? kSampleSeconds * moving.paths * radar.waveform.num_samples : 0.0);
  const double num_chirps = static_cast<double>(radar.waveform.num_chirps) * static_cast<double>(radar.transmitters.size());
  return of_chirp * num_chirps * static_cast<double>(radar.receivers.size()) / num_threads();
}

double keyframe_seconds(const Paths& paths, const KeyframeSettings& settings) {
  if (settings.retrace == Retrace::kNever) return 0.0;
  const double of_stretch = settings.retrace == Retrace::kAlways
                                ? kQuerySeconds * static_cast<double>(paths.frame.statistics.num_queries)
                                : kRenewalSeconds * static_cast<double>(paths.num_hits());
  return of_stretch * settings.keyframes / num_threads();
}

}  // namespace echopath
