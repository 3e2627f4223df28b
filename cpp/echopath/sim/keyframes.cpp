#include "echopath/sim/keyframes.h"

#include <algorithm>

#include "echopath/base/errors.h"
#include "echopath/replay/renewal.h"
#include "echopath/replay/validity.h"
#include "echopath/trace/trace.h"

namespace echopath {
namespace {

TraceSettings settings_of(const TraceFrame& frame, double start_time) {
  TraceSettings settings;
  settings.num_rays = std::max<int64_t>(1, frame.statistics.num_rays);
  settings.max_bounces = frame.max_bounces;
  settings.seed = frame.seed;
  settings.start_time = start_time;
  settings.polarization = frame.polarization;
  settings.footprint = frame.footprint;
  settings.batches = frame.num_batches;
  settings.sampler = frame.sampler;
  settings.shares = shares_of(frame.strata);
  return settings;
}

}  // namespace

std::vector<Stretch> stretches_of(const Radar& radar, double start_time, int count) {
  const int num_chirps = radar.waveform.num_chirps;
  require(count >= 1 && count <= num_chirps, "keyframes", "must lie in [1, num_chirps]", count);
  const double chirp_distance = radar.num_slots() * radar.waveform.chirp_interval;
  std::vector<Stretch> stretches;
  for (int i = 0; i < count; ++i) {
    const auto bound = [&](int64_t k) { return static_cast<int>(k * num_chirps / count); };
    Stretch stretch;
    stretch.first_chirp = bound(i);
    stretch.start_time = start_time + stretch.first_chirp * chirp_distance;
    stretch.radar = radar;
    stretch.radar.waveform.num_chirps = bound(i + 1) - bound(i);
    stretch.middle = stretch.start_time + 0.5 * stretch.radar.frame_duration();
    stretches.push_back(std::move(stretch));
  }
  return stretches;
}

int num_keyframes(const Paths& paths, const Radar& radar, const KeyframeSettings& settings, SpecularPoints specular,
                  Job* job) {
  require(settings.keyframes >= 0, "keyframes", "must not be negative", settings.keyframes);
  if (settings.keyframes > 0) return settings.keyframes;
  ValiditySettings asked;
  asked.specular = specular;
  const Validity found = validity(paths, radar, asked, job);
  const bool is_occluded = std::max({found.shares.blocked, found.shares.left, found.shares.new_surface}) > kValidityLimit;
  return std::clamp(std::max(found.keyframes(), is_occluded ? kOcclusionKeyframes : 1), 1, radar.waveform.num_chirps);
}

Paths record_of(const Paths& paths, const Stretch& stretch, Retrace retrace, Job* job, KeptGeometry* kept) {
  if (retrace == Retrace::kAlways) {
    // A new trace knows nothing of a selection.
    require(paths.num_paths() == paths.frame.statistics.num_paths, "retrace",
            "'always' takes all paths of a trace (decompose takes them apart), paths", paths.num_paths());
    return trace(*paths.scene, stretch.radar, settings_of(paths.frame, stretch.start_time), job, kept);
  }
  Paths record = retrace == Retrace::kInvalid ? renew(paths, stretch.radar, stretch.middle, job, kept).paths : paths;
  record.frame.start_time = stretch.start_time;
  return record;
}

}  // namespace echopath
