#include "echopath/validity/array_corners.h"

#include <set>

#include "echopath/base/principal_box.h"

namespace echopath {
namespace {

constexpr double kNoExtent = 1e-9;  // m: an axis along which no antenna is farther from another
constexpr double kTie = 1e-9;       // of the extents: nearer than this, the antenna of lower index counts

// Returns positions along their principal axes, each scaled to an extent of 1; axes without extent are 0.
std::vector<Vec3> normalised(const std::vector<Antenna>& antennas) {
  std::vector<Vec3> positions;
  for (const Antenna& antenna : antennas) positions.push_back(antenna.position);
  const PrincipalBox found = principal_box(positions);
  const Vec3 sizes = found.box.sizes();
  for (Vec3& at : positions) {
    at = found.coordinates(at);
    for (int axis = 0; axis < 3; ++axis) at[axis] = sizes[axis] > kNoExtent ? at[axis] / sizes[axis] : 0.0;
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
