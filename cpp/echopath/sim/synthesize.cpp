#include "echopath/sim/synthesize.h"

namespace echopath {

Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job) {
  const auto cube_of = [job](const Paths& record, const Radar& of, const CubeSettings& alone) {
    return CubePass(record, of, {PathGroups{}}, alone, job).cube(0, 0, job);
  };
  if (settings.keyframes.retrace == Retrace::kNever) return cube_of(paths, radar, settings);
  Cube frame = Cube::zeros(radar);
  const auto add = [&](const Paths& record, const Radar& of, const CubeSettings& alone, int first_chirp) {
    frame.add_chirps(cube_of(record, of, alone), first_chirp);
  };
  for_each_record(paths, radar, settings, job, add);
  return frame;
}

}  // namespace echopath
