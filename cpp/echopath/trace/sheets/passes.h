#pragma once
// Adds to a record the sheets through which its paths go (Paths::passes).
//
// Queries of rays go through sheets, so that the record has the paths behind them as if they were not there. Here each leg
// of each path is laid against the sheets alone. Their transmission is no part of the weight: replay computes it for each
// time and antenna (replay/factors/sheet_passages.h), of the polarisation of the first transmitter in that polarisation. In
// a polarised trace the matrix gets what both modes do to the components at either end of the path, over that; between hits,
// sheets are taken to leave the polarisation as it is. Replay follows the fields of edge paths itself (path_passages.h).
#include <memory>

#include "echopath/record/paths.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Passes of one leg from which on it is taken to end at the next sheet: its path has no weight then, and is counted.
inline constexpr int kMostPasses = 64;

// Finds the passes of any paths of one trace of a scene.
class SheetPasses {
 public:
  // `rounding` is that of the geometry that the rays of the trace have met, the whole scene: so what a path has of the
  // sheets on its way depends on other sheets only as its rays do (EmbreeScene::Upkeep). Raises DeviceError and Cancelled.
  SheetPasses(const Scene& scene, double trace_time, const RayRounding& rounding, Job* job);
  ~SheetPasses();
  // Does nothing where the scene has no sheets. The result is the same for any number of threads. Raises Cancelled.
  void add_to(Paths& paths, Job* job) const;

 private:
  class SheetScene;
  class PassFinder;
  std::unique_ptr<const SheetScene> sheets_;  // null where there are none
};

}  // namespace echopath
