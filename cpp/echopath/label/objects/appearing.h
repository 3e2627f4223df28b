#pragma once
// Tells cheaply which of the objects that are hidden at one time of a frame may be in sight at others.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/label/objects/visibility.h"

namespace echopath {

struct AppearingSettings {
  double time = 0.0;           // s, when they are hidden
  std::vector<double> others;  // s
  double hidden_share = 0.0;   // visible shares above this are in sight
  int num_directions = 1024;   // on each object
};

// Returns those of `objects` (indices, ascending) of which more may be visible at one of the other times, by the end that
// sees less of it; what it leaves out stays hidden.
//
// The points of an object that directions meet at the one time move with it, and so do the meshes that hide any of them: as
// long as no more points than the share come out from behind those meshes alone, the object is hidden. No geometry is built:
// a segment is looked at where the mesh that may cut it was. It takes the silhouette of the object for that of the points,
// which holds while the object turns little. Objects that deform, that deforming meshes hide or that no direction meets are
// returned too. `kept` and errors are those of `visibility`.
std::vector<uint32_t> may_appear(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                 std::span<const uint32_t> objects, const AppearingSettings& settings, Job* job = nullptr,
                                 KeptGeometry* kept = nullptr);

}  // namespace echopath
