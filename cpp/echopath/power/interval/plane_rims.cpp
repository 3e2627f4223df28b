#include "echopath/power/interval/plane_rims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/solid_angle.h"
#include "echopath/scene/edges/planar_patches.h"

namespace echopath {
namespace {

constexpr double kMostOfEnd = 1.1705;  // of half the wave of a stationary point: the most that a part of it may have
constexpr double kSeenWhole = 0.97;    // of a plane: as much is found to be seen where nothing hides any of it
constexpr double kNoDirection = 1e-9;
constexpr double kShadowLines = 3.0;  // that cross a plane of which a part is hidden, in phase

// Computes the waves of the rim of one plane, for a wave from one antenna to the other. Both are on one side of it.
class RimOfPlane {
 public:
  RimOfPlane(const Plane& plane, const AntennaPair& antennas, double wavenumber)
      : normal_(plane.normal), antennas_(antennas), reflection_(plane.met_on_line(antennas.from, plane.image(antennas.to))),
        wavenumber_(wavenumber) {}

  // Returns whether the point that reflects the wave lies in the triangle.
  bool reflects_within(const std::array<Vec3, 3>& corners) const {
    const auto turns_left = [&](size_t side) {
      const Vec3& from = corners[side];
      return normal_.dot((corners[(side + 1) % 3] - from).cross(reflection_ - from)) >= 0.0;
    };
    return turns_left(0) == turns_left(1) && turns_left(1) == turns_left(2);
  }

  // Returns the sum of the sizes of the waves of a straight side of the rim, 1/m.
  double of_side(const Vec3& begin, const Vec3& end) const {
    const double length = (end - begin).norm();
    const Line line = line_through(begin, (end - begin) / length);
    const double inside = 0.0 < line.stationary && line.stationary < length ? at_stationary(line) : 0.0;
    return inside + at_end(line, 0.0) + at_end(line, length);
  }

  // Returns the most that upright lines of sight past a point of the plane have on it, 1/m. `corners`: of the plane.
  double of_upright(const Vec3& point, const std::vector<Vec3>& corners) const {
    return std::max(of_upright(antennas_.from, point, corners), of_upright(antennas_.to, point, corners));
  }

 private:
  // Where a line lies to an antenna: the place along it next to the antenna, and the distance of the antenna from it, m.
  struct Side {
    double next, distance;
  };
  struct Line {
    Vec3 begin, along;  // m; unit
    Side from, to;
    double stationary;  // m: where along it the length of the way is the least
  };
  struct Slopes {
    double first, second;  // rad/m, rad/m^2: of the phase along a line
  };

  Line line_through(const Vec3& begin, const Vec3& along) const {
    const auto seen_from = [&](const Vec3& antenna) -> Side {
      const double next = (antenna - begin).dot(along);
      return {next, (begin + next * along - antenna).norm()};
    };
    const Side from = seen_from(antennas_.from), to = seen_from(antennas_.to);
    return {begin, along, from, to, (from.next * to.distance + to.next * from.distance) / (from.distance + to.distance)};
  }

  Slopes slopes(const Line& line, double at) const {
    Slopes sum{0.0, 0.0};
    for (const Side& side : {line.from, line.to}) {
      const double ahead = at - side.next, distance = std::sqrt(ahead * ahead + side.distance * side.distance);
      sum.first += wavenumber_ * ahead / distance;
      sum.second += wavenumber_ * side.distance * side.distance / (distance * distance * distance);
    }
    return sum;
  }

  double at_end(const Line& line, double at) const {
    const Slopes phase = slopes(line, at);
    const double of_part = kMostOfEnd * std::sqrt(0.25 * kTwoPi / phase.second);
    return strength(line, at) * std::min(1.0 / std::abs(phase.first), of_part);
  }

  double at_stationary(const Line& line) const {
    return strength(line, line.stationary) * std::sqrt(kTwoPi / slopes(line, line.stationary).second);
  }

  // Returns what a metre of a line counts, 1/m^2: with the gradient g of the way along the plane, the part of g across the
  // line, over g^2, times the amplitude of the integral over the plane.
  double strength(const Line& line, double at) const {
    const Vec3 point = line.begin + at * line.along, in = point - antennas_.from, out = point - antennas_.to;
    const double length_in = in.norm(), length_out = out.norm();
    const Vec3 directions = in / length_in + out / length_out, gradient = directions - directions.dot(normal_) * normal_;
    const double across = std::abs(gradient.dot(line.along.cross(normal_)));
    const double cosine = std::max(std::abs(in.dot(normal_)) / length_in, std::abs(out.dot(normal_)) / length_out);
    return cosine * across / (kTwoPi * length_in * length_out * gradient.squaredNorm());
  }

  double of_upright(const Vec3& eye, const Vec3& point, const std::vector<Vec3>& corners) const {
    const Vec3 sight = point - eye, across = normal_.cross(sight.cross(Vec3::UnitZ()));
    if (across.norm() <= kNoDirection * sight.norm()) return 0.0;
    const Line line = line_through(point, across.normalized());
    double begin = 0.0, end = 0.0;
    for (const Vec3& corner : corners) {
      const double at = (corner - point).dot(line.along);
      begin = std::min(begin, at);
      end = std::max(end, at);
    }
    const bool is_inside = begin < line.stationary && line.stationary < end;
    return is_inside ? at_stationary(line) : at_end(line, line.stationary < begin ? begin : end);
  }

  Vec3 normal_;
  AntennaPair antennas_;
  Vec3 reflection_;  // the point of the plane that would reflect the wave
  double wavenumber_;
};

// Returns the volume that triangles enclose, m^3, negative where they wind the other way.
double volume_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  double sum = 0.0;
  for (const Triangle& of : triangles) sum += vertices[of[0]].dot(vertices[of[1]].cross(vertices[of[2]])) / 6.0;
  return sum;
}

}  // namespace

double rims_at_most(std::span<const RimWaves> planes, std::span<const double> seen) {
  double sum = 0.0;
  for (size_t i = 0; i < planes.size(); ++i) {
    const bool is_hidden = (i < seen.size() ? seen[i] : 0.0) < kSeenWhole * planes[i].solid_angle;
    sum += planes[i].own + (is_hidden ? kShadowLines * planes[i].of_shadow : 0.0);
  }
  return sum;
}

FacetedBody::FacetedBody(std::vector<Vec3> vertices, const std::vector<Triangle>& triangles, bool is_closed)
    : vertices_(std::move(vertices)), triangles_(triangles), neighbours_(edge_neighbours(vertices_, triangles)),
      patch_of_(triangles.size()) {
  patches_ = planar_patches(vertices_, triangles, flat_tolerance(box_about(vertices_).diagonal().norm()));
  for (size_t patch = 0; patch < patches_.size(); ++patch) {
    for (const uint32_t triangle : patches_[patch]) patch_of_[triangle] = static_cast<uint32_t>(patch);
    const std::vector<uint32_t>& of_plane = patches_[patch];
    planes_.push_back(plane_of_largest(of_plane.size(), [&](size_t i) { return corners(of_plane[i]); }));
  }
  if (is_closed) outside_ = volume_of(vertices_, triangles) < 0.0 ? -1.0 : 1.0;
}

std::vector<RimWaves> FacetedBody::waves(const AntennaPair& antennas, double wavenumber) const {
  std::vector<RimWaves> found;
  for (size_t index = 0; index < patches_.size(); ++index) {
    const double from = planes_[index].height(antennas.from), to = planes_[index].height(antennas.to);
    const bool is_met = from * to > 0.0 && outside_ * from >= 0.0;
    found.push_back(is_met ? waves_of(patches_[index], planes_[index], antennas, wavenumber) : RimWaves{});
  }
  return found;
}

RimWaves FacetedBody::waves_of(const std::vector<uint32_t>& patch, const Plane& plane, const AntennaPair& antennas,
                               double wavenumber) const {
  const RimOfPlane rim(plane, antennas, wavenumber);
  RimWaves sum;
  bool reflects = false;
  std::vector<Vec3> rim_corners;
  for (const uint32_t triangle : patch) {
    const std::array<Vec3, 3> at = corners(triangle);
    sum.solid_angle += std::abs(solid_angle(at, antennas.from));
    reflects = reflects || rim.reflects_within(at);
    for (size_t side = 0; side < 3; ++side) {
      if (!is_rim(triangle, side)) continue;
      const double wave = rim.of_side(at[side], at[(side + 1) % 3]);
      sum.own += wave;
      sum.of_shadow = std::max(sum.of_shadow, wave);
      rim_corners.push_back(at[side]);
    }
  }
  for (const Vec3& corner : rim_corners) sum.of_shadow = std::max(sum.of_shadow, rim.of_upright(corner, rim_corners));
  if (reflects || std::isnan(sum.own)) sum.own = std::numeric_limits<double>::infinity();
  return sum;
}

std::array<Vec3, 3> FacetedBody::corners(uint32_t triangle) const {
  const Triangle& of = triangles_[triangle];
  return {vertices_[of[0]], vertices_[of[1]], vertices_[of[2]]};
}

bool FacetedBody::is_rim(uint32_t triangle, size_t side) const {
  const uint32_t other = neighbours_[triangle][side];
  return other == kNoTriangle || patch_of_[other] != patch_of_[triangle];
}

}  // namespace echopath
