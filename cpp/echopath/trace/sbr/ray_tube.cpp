#include "echopath/trace/sbr/ray_tube.h"

#include <algorithm>
#include <cmath>

#include "echopath/scene/smooth/smooth.h"

namespace echopath {

void carry_tube(Ray& ray, SurfaceHit& surface, double wavelength) {
  const double distance = surface.point.distance;
  if (ray.is_curved) {
    const int num_caustics = ray.differential.num_caustics(ray.direction, distance);
    for (int n = num_caustics; n > 0; --n) ray.field_factor *= std::complex<double>(0.0, 1.0);
    // Geometrical optics is singular at a caustic: no tube is narrower than the wave allows.
    surface.tube_area = std::max(std::abs(ray.differential.area(ray.direction, distance)), wavelength * ray.leg_length);
  }
  ray.differential.transfer(ray.direction, distance, surface.point.normal);
}

void reflect_tube(Ray& ray, const SurfaceHit& surface) {
  const RayHit& point = surface.point;
  const Mat3 flat = Mat3::Zero();
  ray.differential.reflect(ray.direction, point.normal, point.is_smooth ? point.curvature : flat);
  ray.is_curved = ray.is_curved || point.is_smooth;
}

std::array<float, 7> footprint_of_tube(const Ray& ray, const SurfaceHit& surface, const std::array<Vec3, 3>& corners,
                                       double lattice_density) {
  const auto& [a, b, c] = corners;
  const RayDifferential& tube = ray.differential;
  const double side = 1.0 / std::sqrt(lattice_density);
  // A tube that the caustic limit widened keeps its proportions.
  const double widened = std::sqrt(surface.tube_area / std::max(std::abs(tube.area(ray.direction, 0.0)), 1e-30));
  const double scale = side * std::min(widened, 1e6);
  std::array<float, 7> cell{};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d at = edge_coordinates(b - a, c - a, surface.point.normal, tube.point[axis] * scale);
    cell[2 * axis] = static_cast<float>(at[0]);
    cell[2 * axis + 1] = static_cast<float>(at[1]);
  }
  const auto turn = [&](int i, int j) { return side * scale * tube.point[i].dot(tube.turn[j]); };
  cell[4] = static_cast<float>(turn(0, 0));
  cell[5] = static_cast<float>(0.5 * (turn(0, 1) + turn(1, 0)));
  cell[6] = static_cast<float>(turn(1, 1));
  return cell;
}

}  // namespace echopath
