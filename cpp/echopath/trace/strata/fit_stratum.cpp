// Seen from a point, a triangle is the convex hull of its corners on the sphere of directions. Any convex region there that
// holds all vertices therefore holds the surface. A cone is convex, a strip is not, so that its height is found along the
// edges of the hull. The hull is that of the gnomonic projection, which shows great circles as straight lines.
#include "echopath/trace/strata/fit_stratum.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "echopath/base/constants.h"
#include "echopath/trace/geometry/convex_hull.h"

namespace echopath {
namespace {

constexpr double kWidestCosine = 0.17364817766693033;  // of 80 degrees
// Margins as a share of an extent itself, and of the larger extent: in single precision a surface ends a little beside its
// edges, and a stratum without margins would lose a part of it.
constexpr double kMargin = 1e-2, kMarginOfLarger = 1e-4;
// Elevations at which cells of a strip become half as wide as they are high are left to cones.
constexpr double kSteepestSine = 0.57;
constexpr size_t kSampledVertices = 4096;  // for the middle of directions
constexpr int kAxisSteps = 64;
constexpr int kOutwardDirections = 16;        // by which points inside the hull are sorted out
constexpr double kWithinCircle = 1.0 - 1e-6;  // of its radius: nearer to its rim rounding may tell otherwise

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

// Returns nearly the axis of the smallest cone (Badoiu and Clarkson 2003): it steps from one toward the farthest of some
// directions, again and again.
Vec3 middle_of(const std::vector<Vec3>& directions, Vec3 axis) {
  const size_t step = directions.size() / kSampledVertices + 1;
  for (int n = 0; n < kAxisSteps; ++n) {
    size_t farthest = 0;
    for (size_t i = 0; i < directions.size(); i += step) {
      if (directions[i].dot(axis) < directions[farthest].dot(axis)) farthest = i;
    }
    axis = (axis + (directions[farthest] - axis) / (n + 2.0)).normalized();
  }
  return axis;
}

bool all_within(const std::vector<Vec3>& directions, const Vec3& axis) {
  return std::ranges::all_of(directions, [&](const Vec3& direction) { return direction.dot(axis) >= kWidestCosine; });
}

// Points toward the middle of the box of the vertices, or where that is too far aside toward the middle of their directions.
// Neither depends on vertices within the hull of the others, as long as there are fewer than kSampledVertices.
std::optional<Vec3> axis_toward(const std::vector<Vec3>& vertices, const Vec3& apex, const std::vector<Vec3>& directions) {
  const Vec3 line = box_about(vertices).center() - apex;
  const Vec3 toward_box = line.norm() > 0 ? Vec3(line.normalized()) : directions.front();
  if (all_within(directions, toward_box)) return toward_box;
  const Vec3 middle = middle_of(directions, toward_box);
  return all_within(directions, middle) ? std::optional<Vec3>(middle) : std::nullopt;
}

struct GnomonicPlane {
  Vec3 axis, first, second;

  explicit GnomonicPlane(const Vec3& toward) : axis(toward), first(toward.unitOrthogonal()), second(toward.cross(first)) {}
  Eigen::Vector2d project(const Vec3& direction) const {
    return Eigen::Vector2d(direction.dot(first), direction.dot(second)) / direction.dot(axis);
  }
  Vec3 direction(const Eigen::Vector2d& point) const { return (axis + point[0] * first + point[1] * second).normalized(); }
};

Eigen::Vector2d outermost_point(const PlanePoints& points, int k) {
  const double angle = kTwoPi * k / kOutwardDirections;
  const Eigen::Vector2d outward(std::cos(angle), std::sin(angle));
  double farthest = outward.dot(points.front());
  size_t best = 0;
  for (size_t i = 1; i < points.size(); ++i) {
    const double distance = outward.dot(points[i]);
    if (distance <= farthest) continue;
    farthest = distance;
    best = i;
  }
  return points[best];
}

// Returns the points outside of a circle within the polygon of the outermost points in four directions: the others are
// neither outermost in any direction nor corners of the hull.
PlanePoints points_outside_of_circle(const PlanePoints& points) {
  std::array<Eigen::Vector2d, 4> corners;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (int k = 0; k < 4; ++k) {
    corners[k] = outermost_point(points, k * kOutwardDirections / 4);
    centre += 0.25 * corners[k];
  }
  double radius = std::numeric_limits<double>::max();
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d edge = corners[(k + 1) % 4] - corners[k];
    const double inward = edge.squaredNorm() > 0 ? cross(edge, centre - corners[k]) / edge.norm() : 0.0;
    radius = std::min(radius, std::max(0.0, inward));
  }
  const double limit = std::pow(kWithinCircle * radius, 2);
  PlanePoints outer;
  std::ranges::copy_if(points, std::back_inserter(outer),
                       [&](const Eigen::Vector2d& point) { return !((point - centre).squaredNorm() < limit); });
  return outer;
}

// Returns the points that may be corners of the convex hull: those outside of the polygon of the outermost ones in some
// directions.
PlanePoints outer_points(const PlanePoints& all) {
  const PlanePoints points = points_outside_of_circle(all);
  PlanePoints outermost;
  for (int k = 0; k < kOutwardDirections; ++k) outermost.push_back(outermost_point(points, k));
  outermost.erase(std::unique(outermost.begin(), outermost.end()), outermost.end());
  if (outermost.size() > 1 && outermost.front() == outermost.back()) outermost.pop_back();
  PlanePoints edges;
  for (size_t k = 0; k < outermost.size(); ++k) edges.emplace_back(outermost[(k + 1) % outermost.size()] - outermost[k]);
  const auto is_inside = [&](const Eigen::Vector2d& point) {
    for (size_t k = 0; k < edges.size(); ++k)
      if (cross(edges[k], point - outermost[k]) <= 0) return false;
    return true;
  };
  PlanePoints outer;
  std::ranges::copy_if(points, std::back_inserter(outer), [&](const auto& point) { return !is_inside(point); });
  return outer;
}

Stratum cone_around(const Vec3& axis, const std::vector<Vec3>& corners) {
  Stratum cone;
  cone.axis = axis;
  double widest = 0.0;
  for (const Vec3& corner : corners) widest = std::max(widest, 0.5 * (corner - axis).squaredNorm());
  cone.versine = widest * (1.0 + 2.0 * kMargin);
  return cone;
}

struct Range {
  double low, high;

  void extend(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void widen(double margin) {
    low -= margin;
    high += margin;
  }
  double size() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

// Extends the range by the sines of the elevation over the great circle around `up` that the arc between two directions
// takes.
void extend_along_arc(const Vec3& from, const Vec3& to, const Vec3& up, Range& heights) {
  heights.extend(from.dot(up));
  const Vec3 across = from.cross(to);
  const double size = across.norm();
  if (size < 1e-12) return;
  const Vec3 normal = across / size, peak = up - up.dot(normal) * normal;
  for (const double side : {1.0, -1.0}) {
    const Vec3 point = side * peak;
    if (from.cross(point).dot(normal) > 0 && point.cross(to).dot(normal) > 0) heights.extend(side * peak.norm());
  }
}

// Sets the extents of a strip, with their margins; it returns the middle of the azimuths.
double set_extents(Range azimuths, Range heights, Stratum& strip) {
  const double margin = kMarginOfLarger * std::max(azimuths.size(), heights.size());
  azimuths.widen(margin + 0.5 * kMargin * azimuths.size());
  heights.widen(margin + 0.5 * kMargin * heights.size());
  strip.half_azimuth = 0.5 * azimuths.size();
  strip.low = heights.low;
  strip.high = heights.high;
  return azimuths.middle();
}

// Returns the azimuths of directions around `up`, from `ahead` to `across`, in rad. Where all lie ahead, their tangents tell
// which are outermost.
Range azimuths_of(const std::vector<Vec3>& directions, const Vec3& ahead, const Vec3& across) {
  Range tangents{1e300, -1e300}, azimuths{1e9, -1e9};
  bool are_ahead = true;
  for (const Vec3& direction : directions) {
    const double forward = direction.dot(ahead);
    are_ahead = are_ahead && forward > 0.0;
    tangents.extend(direction.dot(across) / forward);
  }
  if (are_ahead) return {std::atan(tangents.low), std::atan(tangents.high)};
  for (const Vec3& direction : directions) azimuths.extend(std::atan2(direction.dot(across), direction.dot(ahead)));
  return azimuths;
}

// Returns the strip along the direction `along` of the plane that holds the hull between the corners, or nothing where it
// is no smaller than `largest` sr: the corners alone may tell so, without the arcs between them.
std::optional<Stratum> strip_along(const Eigen::Vector2d& along, const GnomonicPlane& plane, const PlanePoints& hull,
                                   const std::vector<Vec3>& corners, double largest) {
  const Eigen::Vector2d aside(-along[1], along[0]);
  Range offsets{aside.dot(hull.front()), aside.dot(hull.front())};
  for (const Eigen::Vector2d& corner : hull) offsets.extend(aside.dot(corner));
  const double middle = std::tan(0.5 * (std::atan(offsets.low) + std::atan(offsets.high)));
  const Vec3 up = (aside[0] * plane.first + aside[1] * plane.second - middle * plane.axis).normalized();
  const Vec3 ahead = (plane.axis - plane.axis.dot(up) * up).normalized(), across = up.cross(ahead);
  const Range azimuths = azimuths_of(corners, ahead, across);
  Range heights{1e9, -1e9};
  for (const Vec3& corner : corners) heights.extend(corner.dot(up));
  Stratum strip;
  set_extents(azimuths, heights, strip);
  if (!(strip.solid_angle() < largest)) return std::nullopt;
  for (size_t i = 0; i < corners.size(); ++i) extend_along_arc(corners[i], corners[(i + 1) % corners.size()], up, heights);
  const double turn = set_extents(azimuths, heights, strip);
  strip.axis = std::cos(turn) * ahead + std::sin(turn) * across;
  strip.across = std::cos(turn) * across - std::sin(turn) * ahead;
  return strip;
}

bool serves(const Stratum& strip) {
  return strip.half_azimuth > 0 && strip.high > strip.low && strip.half_azimuth < 0.5 * kPi &&
         std::max(std::abs(strip.low), std::abs(strip.high)) <= kSteepestSine;
}

// Returns unit vectors along which strips are tried: evenly turned, and along the edges of the hull where these are few.
PlanePoints turns_to_try(const PlanePoints& hull, int count) {
  PlanePoints turns;
  for (int k = 0; k < count; ++k) turns.emplace_back(std::cos(kPi * k / count), std::sin(kPi * k / count));
  if (std::ssize(hull) > count) return turns;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() > 0) turns.push_back(edge.normalized());
  }
  return turns;
}

}  // namespace

std::optional<Stratum> fit_stratum(const std::vector<Vec3>& vertices, const Vec3& apex, std::string name, int num_turns) {
  std::vector<Vec3> directions;
  directions.reserve(vertices.size());
  for (const Vec3& vertex : vertices) {
    const Vec3 line = vertex - apex;
    const double distance = line.norm();
    if (!(distance > 0)) return std::nullopt;
    directions.push_back(line / distance);
  }
  if (directions.empty()) return std::nullopt;
  const std::optional<Vec3> axis = axis_toward(vertices, apex, directions);
  if (!axis) return std::nullopt;
  const GnomonicPlane plane(*axis);
  PlanePoints points;
  points.reserve(directions.size());
  for (const Vec3& direction : directions) points.push_back(plane.project(direction));
  const PlanePoints hull = convex_hull(outer_points(points));
  std::vector<Vec3> corners;
  for (const Eigen::Vector2d& corner : hull) corners.push_back(plane.direction(corner));
  Stratum best = cone_around(plane.axis, corners);
  for (const Eigen::Vector2d& along : turns_to_try(hull, num_turns)) {
    const std::optional<Stratum> strip = strip_along(along, plane, hull, corners, best.solid_angle());
    if (strip && serves(*strip) && strip->solid_angle() < best.solid_angle()) best = *strip;
  }
  best.name = std::move(name);
  return best;
}

}  // namespace echopath
