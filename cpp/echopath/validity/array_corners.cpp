#include "echopath/validity/array_corners.h"

#include <Eigen/Eigenvalues>
#include <set>

namespace echopath {
namespace {

constexpr double kNoExtent = 1e-9;  // m: an axis along which no antenna is farther from another
constexpr double kTie = 1e-9;       // of the extents: nearer than this, the antenna of lower index counts

// Returns positions along their principal axes, each scaled to -1 to 1; axes without extent are 0.
std::vector<Vec3> normalised(const std::vector<Antenna>& antennas) {
  Vec3 mean = Vec3::Zero();
  for (const Antenna& antenna : antennas) mean += antenna.position / static_cast<double>(antennas.size());
  Mat3 covariance = Mat3::Zero();
  for (const Antenna& antenna : antennas) covariance += (antenna.position - mean) * (antenna.position - mean).transpose();
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors();
  Eigen::AlignedBox3d box;
  for (const Antenna& antenna : antennas) box.extend(Vec3(axes.transpose() * (antenna.position - mean)));
  std::vector<Vec3> positions;
  for (const Antenna& antenna : antennas) {
    Vec3 at = axes.transpose() * (antenna.position - mean) - box.center();
    for (int axis = 0; axis < 3; ++axis) at[axis] = box.sizes()[axis] > kNoExtent ? 2.0 * at[axis] / box.sizes()[axis] : 0.0;
    positions.push_back(at);
  }
  return positions;
}

int farthest_along(const std::vector<Vec3>& positions, const Vec3& direction) {
  int best = 0;
  for (int i = 1; i < static_cast<int>(positions.size()); ++i) {
    if (direction.dot(positions[i] - positions[best]) > kTie) best = i;
  }
  return best;
}

}  // namespace

std::vector<int> array_corners(const std::vector<Antenna>& antennas) {
  const std::vector<Vec3> positions = normalised(antennas);
  std::set<int> corners;
  // The eigenvalues ascend: the axes of a plane array are the last two.
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 1), Vec3(0, 1, -1)}) {
    for (const double sign : {1.0, -1.0}) {
      if (farthest_along(positions, direction) == farthest_along(positions, -direction)) continue;
      corners.insert(farthest_along(positions, sign * direction));
    }
  }
  return {corners.begin(), corners.end()};
}

}  // namespace echopath
