#pragma once
// The facade: paths -> IF cubes of parts of the signal, several views of it from one pass.
#include <string>
#include <vector>

#include "echopath/label/grouping.h"
#include "echopath/sim/cube_pass.h"

namespace echopath {

// One part of a view.
struct PartCube {
  std::string name;
  Cube cube;
};

// The signals of the parts of several views, replayed once; by view, its parts in order, those that only later records of a
// frame with keyframes have before the last. The cubes of one view add up to the whole to rounding. The same bits for any
// number of threads. Raises what synthesize and the groupings do.
// Views are sorted into their combinations of parts, each path synthesised once for all, unless these are many: then each
// view for itself. Memory: a cube for each part of each view, and two to three for each combination while it runs.
std::vector<std::vector<PartCube>> decompose(const Paths& paths, const Radar& radar, const std::vector<Grouping>& views,
                                             const CubeSettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
