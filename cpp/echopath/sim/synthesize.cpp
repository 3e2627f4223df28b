#include "echopath/sim/synthesize.h"

#include <utility>

namespace echopath {

Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job) {
  const Retrace retrace = settings.keyframes.retrace;
  if (retrace == Retrace::kNever) return CubePass(paths, radar, {PathGroups{}}, settings, job).cube(0, 0, job);
  Cube frame = Cube::zeros(radar);
  const std::vector<Stretch> stretches = stretches_for(paths, radar, settings, job);
  StretchRecords records(paths, radar, stretches, retrace, job);
  for (const Stretch& stretch : stretches) {
    StretchProbe probe(settings.probe, stretch);
    Cube sum;
    for (const Paths& record : records.of(stretch)) {
      Cube cube = synthesize(record, stretch.radar, within_stretch(settings, probe.next()), job);
      if (sum.values.empty()) sum = std::move(cube);
      else sum.add(cube);
    }
    frame.insert_chirps(sum, stretch.first_chirp);
  }
  return frame;
}

}  // namespace echopath
