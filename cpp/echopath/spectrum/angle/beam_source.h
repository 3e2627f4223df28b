#pragma once
// Forms beams from the cells of a map.
#include <Eigen/Core>
#include <vector>

#include "echopath/spectrum/angle/beam_kernel.h"
#include "echopath/spectrum/angle/beamform.h"

namespace echopath {

// Computes the power that beams of one array receive from a set of snapshots, in any direction.
class CellBeam {
 public:
  // Sets up Bartlett beams from weights [elements] and the snapshots `own` [elements, snapshots].
  CellBeam(const Eigen::VectorXd& weights, const Eigen::MatrixXcd& own);
  // Sets up Capon beams. `covariance` [elements, elements] is Hermitian and is loaded here; 0 means that there is no power.
  CellBeam(const Eigen::MatrixXcd& covariance, const Eigen::MatrixXcd& own, double loading);

  // Returns the power [directions] of the beams, combined over the snapshots. Raises Cancelled.
  Eigen::VectorXd power(const BeamKernel& beams, Combine combine = Combine::kSum, const Job* job = nullptr) const;

 private:
  // Bartlett keeps the weighted snapshots x. Capon keeps R^-1 x and a square root W of R^-1 = W W^H; its power is |a^H R^-1
  // x|^2 / (a^H R^-1 a)^2.
  Eigen::MatrixXcd snapshots_, root_;
};

// Reads snapshots from a map, to which it keeps a reference.
class BeamSource {
 public:
  BeamSource(const RangeDoppler& map, const Radar& radar, const BeamformOptions& options);
  BeamSource(const BeamSource&) = delete;

  const VirtualArray& array() const { return array_; }

  // Returns the beam of one cell toward the directions of an echo.
  CellBeam cell(int64_t velocity, int64_t range, const EchoPlace& echo = {}) const;
  // Returns the beam of one range over its velocities [begin, end).
  CellBeam velocities(int64_t begin, int64_t end, int64_t range) const;
  // Returns for Bartlett the snapshots of ranges [first, first + count) of one velocity times the weights, [elements,
  // count].
  Eigen::MatrixXcd weighted(int64_t velocity, int64_t first, int64_t count) const;

 private:
  Eigen::MatrixXcd covariance(const Eigen::MatrixXcd& snapshots) const;
  // [elements, snapshots]
  Eigen::MatrixXcd neighbourhood(int64_t velocity, int64_t range, const EchoPlace& echo) const;

  const BeamformOptions options_;
  const VirtualArray array_;
  const ElementReader reader_;
  Eigen::VectorXd weights_;    // kBartlett
  std::vector<int> mirrored_;  // element at the opposite point, for forward_backward
};

}  // namespace echopath
