#pragma once
// The facade: paths -> IF cubes, whole or by parts, streaming blocks of paths through replay and signal.
#include <complex>
#include <vector>

#include "echopath/label/partition.h"
#include "echopath/replay/replay.h"
#include "echopath/sim/keyframes.h"
#include "echopath/signal/synthesizer.h"

namespace echopath {

struct CubeSettings {
  SynthesisOptions synthesis;  // the method is chosen from the whole set of paths, never per part
  ReplaySettings replay;
  KeyframeSettings keyframes;
};

// IF samples [tx, rx, chirp, sample] in sqrt(W), noise-free.
struct Cube {
  int num_tx = 0, num_rx = 0, num_chirps = 0, num_samples = 0;
  std::vector<std::complex<double>> values;
};

// The signal of all paths. Peak memory grows with neither paths x chirps nor paths x channels. The same bits for any number
// of threads. Raises invalid_argument for a bad radar or motion, Cancelled.
Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings = {}, Job* job = nullptr);

// One part of a decomposition.
struct PartCube {
  std::string name;
  Cube cube;
};

// The signals of the parts of several partitions from one pass; by partition, its parts in order with "other" last. The cubes
// of one partition add up to the whole to rounding.
std::vector<std::vector<PartCube>> decompose(const Paths& paths, const Radar& radar,
                                             const std::vector<std::vector<NamedSelection>>& partitions,
                                             const CubeSettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
