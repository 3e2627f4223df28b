#pragma once
// Says what the scatterers of rough surfaces are.

namespace echopath {

enum class Scatterers {
  // The points that the rays of a trace happen to meet.
  kRays,
  // Points of the surfaces themselves (surface_points.h), the same in all traces of a scene with one seed, for the first
  // hits straight from the transmitter: the speckle of a moving body goes on from trace to trace. They are less even than a
  // lattice of rays, so that mean powers of so many rays err more.
  kSurface,
};

}  // namespace echopath
