#include "echopath/base/principal_box.h"

#include <Eigen/Eigenvalues>

namespace echopath {

PrincipalBox principal_box(const std::vector<Vec3>& points) {
  PrincipalBox found;
  found.mean = Vec3::Zero();
  for (const Vec3& point : points) found.mean += point / static_cast<double>(points.size());
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& point : points) covariance += (point - found.mean) * (point - found.mean).transpose();
  found.axes = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors();
  for (const Vec3& point : points) found.box.extend(found.coordinates(point));
  return found;
}

}  // namespace echopath
