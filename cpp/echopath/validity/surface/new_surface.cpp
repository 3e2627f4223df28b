#include "echopath/validity/surface/new_surface.h"

#include <algorithm>

#include "echopath/validity/frame/frame_probe.h"
#include "echopath/validity/renewal.h"

namespace echopath {
namespace {

// Returns a radar that is one instant long, between one transmitter and one receiver of the probe.
Radar instant_radar(const Paths& record, const Radar& radar, size_t antenna) {
  const Radar both = probe_radar(record, radar);
  Radar probe =
      one_channel(both, std::min(antenna, both.transmitters.size() - 1), std::min(antenna, both.receivers.size() - 1));
  probe.multiplexing = Multiplexing::kTdm;
  probe.code_phases.clear();
  probe.waveform.num_chirps = probe.waveform.num_samples = 1;
  return probe;
}

}  // namespace

TraceSettings settings_like(const TraceFrame& frame) {
  TraceSettings settings;
  static_cast<RecordSettings&>(settings) = frame;
  settings.num_rays = std::max<int64_t>(1, frame.statistics.num_rays);
  return settings;
}

SurfaceSearch trace_new_surface(const Paths& record, const Radar& radar, const SurfaceSearchSettings& settings, Job* job,
                                KeptGeometry* then, KeptGeometry* now) {
  TraceSettings rays = settings_like(record.frame);
  rays.num_rays = settings.num_rays;
  rays.seed = settings.seed;
  rays.start_time = settings.time;
  const Radar instant = instant_radar(record, radar, settings.antenna);
  SurfaceSearch look;
  look.paths = trace(record.scene, instant, rays, job, now, nullptr, &look.doubles);
  look.is_new = still_there(look.paths, instant, record.frame.trace_time, job, then);
  for (uint8_t& is_new : look.is_new) is_new = !is_new;
  return look;
}

}  // namespace echopath
