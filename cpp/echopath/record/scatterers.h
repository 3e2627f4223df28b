#pragma once
// Says what the scatterers of rough surfaces are.

namespace echopath {

enum class Scatterers {
  // Scatterers are the points that the rays of a trace happen to meet.
  kRays,
  // For first hits straight from the transmitter, scatterers are points of the surfaces themselves
  // (trace/scatter/surface_points.h), which are the same in all traces of a scene with one seed: the speckle of a moving
  // body goes on from trace to trace. They are less even than a lattice of rays, so that mean powers of so many rays err
  // more.
  kSurface,
};

}  // namespace echopath
