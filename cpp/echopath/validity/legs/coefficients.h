#pragma once
// Tells what the hits of a coherent path make of a wave at another time than that of the trace.
#include <complex>

#include "echopath/em/polarization/jones.h"
#include "echopath/replay/posed/local_paths.h"
#include "echopath/trace/scatter/surface_models.h"

namespace echopath {

// Holds a path at one time: its hits as they are posed, in the order of the trace, and its antennas.
struct PathAtTime {
  const LocalPath& path;
  const PosedHit* hits;
  Vec3 start, end;

  bool is_as(const PathAtTime& other) const;
};

// Follows waves over coherent paths without edges, as the trace did. Its functions are thread-safe.
class Coefficients {
 public:
  // The record must outlive it. frequency: Hz.
  Coefficients(const Paths& paths, double frequency);
  // Returns whether the path has coefficients that follow its angles.
  bool follow_angles(const LocalPath& path) const;
  // Returns the product of the coefficients that the weight of a scalar path holds.
  std::complex<double> product(const PathAtTime& at) const;
  // Returns the matrix of a polarised path (Paths::jones).
  JonesMatrix matrix(const PathAtTime& at) const;

 private:
  const SurfaceModel& model(const PathAtTime& at, int k, const Vec3& direction) const;

  SurfaceModels models_;
  bool is_polarized_;
  Vec3 polarization_;  // by which the scalar model tells modes apart
};

}  // namespace echopath
