#include "echopath/sim/synthesize.h"

namespace echopath {

Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job) {
  const Retrace retrace = settings.keyframes.retrace;
  if (retrace == Retrace::kNever) return CubePass(paths, radar, {PathGroups{}}, settings, job).cube(0, 0, job);
  Cube frame = Cube::zeros(radar);
  KeptGeometry kept;
  for (const Stretch& stretch : stretches_for(paths, radar, settings, job)) {
    const Paths record = record_of(paths, stretch, retrace, job, &kept);
    if (settings.probe) settings.probe->first_chirp = stretch.first_chirp;
    frame.insert_chirps(synthesize(record, stretch.radar, within_stretch(settings), job), stretch.first_chirp);
  }
  return frame;
}

}  // namespace echopath
