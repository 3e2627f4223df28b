#pragma once
// Computes IF cubes of parts of the signal from paths, several views of it in one pass.
#include <string>
#include <vector>

#include "echopath/label/grouping.h"
#include "echopath/sim/stream/cube_pass.h"

namespace echopath {

// Holds one part of a view.
struct PartCube {
  std::string name;
  Cube cube;
};

// Computes the signals of the parts of several views, replaying the paths once. Returns by view its parts in order; those
// that only later records of a frame with keyframes have stand before the last. The cubes of one view add up to the whole to
// rounding, with the same bits for any number of threads. Raises as synthesize and the groupings.
// Views are sorted into their combinations of parts, so that each path is synthesised once for all; where combinations are
// many, each view is synthesised by itself. Memory: a cube for each part of each view, and two to three for each combination
// while it runs.
std::vector<std::vector<PartCube>> decompose(const Paths& paths, const Radar& radar, const std::vector<Grouping>& views,
                                             const CubeSettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
