#include "echopath/power/plane_rims.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/plane.h"
#include "echopath/base/solid_angle.h"
#include "echopath/scene/edges/planar_patches.h"
#include "echopath/scene/mesh/adjacency.h"

namespace echopath {
namespace {

constexpr double kMostApart = 0.05;    // of the distance: the antennas may be so far from each other
constexpr double kMostOfEnd = 1.1705;  // of half the wave of a stationary point: the most that a part of it may have
constexpr double kSeenWhole = 0.97;    // of the rays of a plane: as many are counted where nothing hides any of it
constexpr double kNoDirection = 1e-9;
constexpr double kShadowLines = 3.0;  // that cross a plane of which a part is hidden, in phase

// Computes the waves of the rim of one plane, seen from the origin.
class RimOfPlane {
 public:
  RimOfPlane(const Plane& plane, double wavenumber)
      : normal_(plane.normal), foot_(0.5 * plane.image(Vec3::Zero())), wavenumber_(wavenumber) {}

  // Returns whether the triangle reflects the wave back to where it came from.
  bool reflects_within(const std::array<Vec3, 3>& corners) const {
    const auto turns_left = [&](size_t side) {
      const Vec3& from = corners[side];
      return normal_.dot((corners[(side + 1) % 3] - from).cross(foot_ - from)) >= 0.0;
    };
    return turns_left(0) == turns_left(1) && turns_left(1) == turns_left(2);
  }

  // Returns the sum of the sizes of the waves of a straight side of the rim, 1/m.
  double of_side(const Vec3& from, const Vec3& to) const {
    const double length = (to - from).norm();
    const Line line = line_through(from, (to - from) / length);
    const double inside = 0.0 < line.next && line.next < length ? at_nearest(line) : 0.0;
    return inside + at_end(line, 0.0) + at_end(line, length);
  }

  // Returns the most that an upright line of sight past a point of the plane has on it, 1/m. `corners`: of the plane.
  double of_upright(const Vec3& point, const std::vector<Vec3>& corners) const {
    const Vec3 across = normal_.cross(point.cross(Vec3::UnitZ()));
    if (across.norm() <= kNoDirection * point.norm()) return 0.0;
    const Line line = line_through(point, across.normalized());
    double begin = 0.0, end = 0.0;
    for (const Vec3& corner : corners) {
      const double at = (corner - point).dot(line.along);
      begin = std::min(begin, at);
      end = std::max(end, at);
    }
    return begin < line.next && line.next < end ? at_nearest(line) : at_end(line, line.next < begin ? begin : end);
  }

 private:
  struct Line {
    Vec3 from, along;      // m; unit
    double next, nearest;  // m: where along it the point next to the antennas lies, and how far from them
    double off;            // m, of the point of reflection
  };

  Line line_through(const Vec3& from, const Vec3& along) const {
    const double next = -from.dot(along);
    return {from, along, next, (from + next * along).norm(), std::abs(along.cross(normal_).dot(from - foot_))};
  }

  double at_end(const Line& line, double at) const {
    const Vec3 end = line.from + at * line.along;
    const double distance = end.norm();
    const double turn = 2.0 * wavenumber_ * std::abs(at - line.next) / distance;  // rad/m, of the phase along the line
    const double bend = 2.0 * wavenumber_ * line.nearest * line.nearest / (distance * distance * distance);  // rad/m^2
    return strength(end, line.off) * std::min(1.0 / turn, kMostOfEnd * std::sqrt(0.5 * kPi / bend));
  }

  double at_nearest(const Line& line) const {
    return strength(line.from + line.next * line.along, line.off) * std::sqrt(kPi * line.nearest / wavenumber_);
  }

  // Returns what a metre of a line counts that passes the point of reflection in the plane at `off` m, 1/m^2.
  double strength(const Vec3& at, double off) const {
    return foot_.norm() * off / (2.0 * kTwoPi * at.squaredNorm() * (at - foot_).squaredNorm());
  }

  Vec3 normal_, foot_;  // the point of the plane next to the origin: where it would reflect the wave
  double wavenumber_;
};

// Finds the waves of the planes of a mesh, with the antennas at the origin.
class PlaneSearch {
 public:
  PlaneSearch(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, double wavenumber)
      : vertices_(vertices), triangles_(triangles), neighbours_(edge_neighbours(vertices, triangles)),
        wavenumber_(wavenumber), patch_of_(triangles.size()) {
    Eigen::AlignedBox3d box;
    for (const Vec3& vertex : vertices) box.extend(vertex);
    patches_ = planar_patches(vertices, triangles, flat_tolerance(box.diagonal().norm()));
    for (size_t patch = 0; patch < patches_.size(); ++patch) {
      for (const uint32_t triangle : patches_[patch]) patch_of_[triangle] = static_cast<uint32_t>(patch);
    }
  }

  // `is_closed`: the mesh has a far side.
  PlaneWaves run(bool is_closed) const {
    PlaneWaves found;
    found.plane_of.assign(triangles_.size(), PlaneWaves::kFarSide);
    const double outside = volume() < 0.0 ? -1.0 : 1.0;  // by the winding
    for (const std::vector<uint32_t>& patch : patches_) {
      const Plane plane = plane_of(patch.front());
      if (is_closed && outside * plane.height(Vec3::Zero()) <= 0.0) continue;
      for (const uint32_t triangle : patch) found.plane_of[triangle] = static_cast<uint32_t>(found.planes.size());
      found.planes.push_back(waves_of(patch, plane));
    }
    return found;
  }

 private:
  RimWaves waves_of(const std::vector<uint32_t>& patch, const Plane& plane) const {
    const RimOfPlane rim(plane, wavenumber_);
    RimWaves sum;
    bool reflects = false;
    std::vector<Vec3> rim_corners;
    for (const uint32_t triangle : patch) {
      const std::array<Vec3, 3> at = corners(triangle);
      sum.solid_angle += std::abs(solid_angle(at, Vec3::Zero()));
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

  double volume() const {  // m^3, negative where the triangles wind the other way
    double sum = 0.0;
    for (uint32_t triangle = 0; triangle < triangles_.size(); ++triangle) {
      const auto [a, b, c] = corners(triangle);
      sum += a.dot(b.cross(c)) / 6.0;
    }
    return sum;
  }

  Plane plane_of(uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    return {a, (b - a).cross(c - a).normalized()};
  }

  std::array<Vec3, 3> corners(uint32_t triangle) const {
    const Triangle& of = triangles_[triangle];
    return {vertices_[of[0]], vertices_[of[1]], vertices_[of[2]]};
  }

  bool is_rim(uint32_t triangle, size_t side) const {
    const uint32_t other = neighbours_[triangle][side];
    return other == kNoTriangle || patch_of_[other] != patch_of_[triangle];
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const std::vector<std::array<uint32_t, 3>> neighbours_;
  const double wavenumber_;
  std::vector<std::vector<uint32_t>> patches_;
  std::vector<uint32_t> patch_of_;  // [F]
};

}  // namespace

double PlaneWaves::at_most(const std::vector<int64_t>& num_rays, double density) const {
  if (plane_of.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> seen(planes.size());
  for (size_t triangle = 0; triangle < plane_of.size(); ++triangle) {
    if (plane_of[triangle] != kFarSide) seen[plane_of[triangle]] += static_cast<double>(num_rays[triangle]);
  }
  double sum = 0.0;
  for (size_t i = 0; i < planes.size(); ++i) {
    const bool is_hidden = seen[i] < kSeenWhole * planes[i].solid_angle * density;
    sum += planes[i].own + (is_hidden ? kShadowLines * planes[i].of_shadow : 0.0);
  }
  return sum;
}

PlaneRims::PlaneRims(const Scene& scene, const Radar& radar, double time)
    : scene_(scene), wavenumber_(kTwoPi * radar.waveform.start_frequency / kSpeedOfLight), time_(time),
      found_(scene.meshes().size()) {
  const Transform world_from_radar = radar.world_from_radar(time);
  const Vec3 from = world_from_radar * radar.transmitters.front().position;
  const Vec3 to = world_from_radar * radar.receivers.front().position;
  middle_ = 0.5 * (from + to);
  apart_ = (to - from).norm();
}

const PlaneWaves& PlaneRims::of(uint32_t mesh_id) {
  std::optional<PlaneWaves>& found = found_[mesh_id];
  return found ? *found : found.emplace(this->found(mesh_id));
}

PlaneWaves PlaneRims::found(uint32_t mesh_id) {
  const Node& node = scene_.node_of(mesh_id);
  const bool is_curved = node.smooth && !node.mesh->is_flat();
  if (is_curved || node.mesh->triangles().size() > kMostTriangles) return {};
  if (!pose_) pose_.emplace(scene_, time_);
  std::vector<Vec3> vertices = pose_->world_vertices(mesh_id);
  double nearest = std::numeric_limits<double>::infinity();
  for (Vec3& vertex : vertices) {
    vertex -= middle_;
    nearest = std::min(nearest, vertex.norm());
  }
  if (apart_ > kMostApart * nearest) return {};
  return PlaneSearch(vertices, node.mesh->triangles(), wavenumber_).run(node.mesh->is_closed());
}

}  // namespace echopath
