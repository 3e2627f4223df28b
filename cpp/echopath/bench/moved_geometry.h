#pragma once
// Times what it costs to bring the geometry of a scene to another time, beside Embree's own share of it.
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

struct MovedGeometry {
  double first = 0.0;         // s of the processor: the geometry at the first time, from nothing
  std::vector<double> again;  // s of the processor, at each other time
  std::vector<double> bare;  // likewise, of Embree alone: a geometry for each mesh, those that move fitted and all committed
};

// Raises invalid_argument where there are no times (s), or motions are not defined there.
MovedGeometry measure_moved_geometry(const Scene& scene, const std::vector<double>& times);

}  // namespace echopath
