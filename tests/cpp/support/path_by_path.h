#pragma once
// Lengths and amplitudes of paths evaluated one by one, hit by hit, as plainly as the formula
// (replay/kernels/path_formula.h) is written: what Replayer, which shares what paths have in common and runs in lanes, is
// held against.
#include <complex>
#include <vector>

#include "echopath/replay/factors/radio_constants.h"
#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/specular_slide.h"

namespace echopath::testing {

struct PathValue {
  double length;                   // m
  std::complex<double> amplitude;  // sqrt(W)
  double largest;                  // sqrt(W), |amplitude| of antennas whose polarisations agree with the path best
};

class PathByPath {
 public:
  // All must outlive it.
  PathByPath(const Paths& paths, const Radar& radar, double time, SpecularPoints specular = SpecularPoints::kMaterial);
  // Of all channels [tx * num_rx + rx] at that time.
  std::vector<PathValue> operator()(int64_t path) const;

 private:
  struct Cell;
  class Walk;
  Cell cell_of(const LocalPath& path, size_t index) const;

  const Paths& paths_;
  PathPreparer preparer_;
  RadioConstants radio_;
  SpecularPoints specular_;
  PosedScene scene_;
};

}  // namespace echopath::testing
