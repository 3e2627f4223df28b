#pragma once
// Defines cubes, and the pass of replay and synthesis that fills them.
#include <complex>
#include <cstdint>
#include <functional>
#include <vector>

#include "echopath/replay/replay.h"
#include "echopath/signal/synthesizer.h"
#include "echopath/sim/stream/keyframes.h"
#include "echopath/sim/stream/signal_probe.h"

namespace echopath {

struct CubeSettings {
  SynthesisOptions synthesis;  // the method is chosen from the whole set of paths, never per part
  ReplaySettings replay;
  KeyframeSettings keyframes;
  SignalProbe* probe = nullptr;  // filled by each pass
};

// Holds IF samples [tx, rx, chirp, sample] in sqrt(W), noise-free.
struct Cube {
  int num_tx = 0, num_rx = 0, num_chirps = 0, num_samples = 0;
  std::vector<std::complex<double>> values;

  static Cube zeros(const Radar& radar);
  void add(const Cube& other);
  // Adds a stretch of the frame to the chirps from `first_chirp` on.
  void add_chirps(const Cube& stretch, int first_chirp);
};

// Describes one way to sort paths into groups.
struct PathGroups {
  const std::vector<uint32_t>* group = nullptr;  // [P] below num_groups; null: all in group 0
  int num_groups = 1;
};

// Computes the signals of all groups of several ways to sort the paths, replaying these once. It takes no notice of
// keyframes.
class CubePass {
 public:
  // Runs the pass. Raises as Replayer and Synthesizer, and Cancelled.
  CubePass(const Paths& paths, const Radar& radar, const std::vector<PathGroups>& ways, CubeSettings settings, Job* job);

  Cube cube(size_t way, int group, Job* job) const;
  size_t cube_bytes() const;

 private:
  const Radar& radar_;
  std::vector<Synthesizer> synthesizers_;  // by way
};

// Visits the records of a frame that needs several (settings.keyframes), stretch by stretch. `visit` gets each with the
// radar of its stretch and the settings of a pass over it alone, whose signal belongs to the chirps from first_chirp on.
using RecordVisitor =
    std::function<void(const Paths& record, const Radar& radar, const CubeSettings& settings, int first_chirp)>;
void for_each_record(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job,
                     const RecordVisitor& visit);

}  // namespace echopath
