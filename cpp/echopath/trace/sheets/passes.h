#pragma once
// Adds to a record the sheets through which its paths go (Paths::passes).
//
// Queries of rays go through sheets, so that the record has the paths behind them as if they were not there. Here each leg
// of each path is laid against the sheets alone. Their transmission is no part of the weight: replay computes it for each
// time and antenna (replay/factors/sheet_passages.h), of the polarisation of the first transmitter in that polarisation. In
// a polarised trace the matrix gets what both modes do to the components at either end of the path, over that; between hits,
// sheets are taken to leave the polarisation as it is. Replay follows the fields of edge paths itself (path_passages.h).
#include "echopath/record/paths.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Passes of one leg from which on it is taken to end at the next sheet: its path has no weight then, and is counted.
inline constexpr int kMostPasses = 64;

// Does nothing where the scene has no sheets. `rounding` is that of the geometry that the rays of the record have met, the
// whole scene: so what a path has of the sheets on its way depends on other sheets only as its rays do
// (EmbreeScene::Upkeep). The result is the same for any number of threads. Raises DeviceError and Cancelled.
void add_passes(Paths& paths, const RayRounding& rounding, Job* job);

}  // namespace echopath
