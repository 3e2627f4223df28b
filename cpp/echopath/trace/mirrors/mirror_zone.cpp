#include "echopath/trace/mirrors/mirror_zone.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kAmple = 1.0 / 0.7;  // widths of the zone from which on edges count as none

// Edges about the point of a flat mirror fade between these distances, in half zones.
constexpr double kFades = 0.5, kFaded = kAmple;

// Edges are looked for in so many directions. A corner takes some of them whole, so that it is known to 1 dB at its tip.
constexpr int kDirections = 64;

// Returns the direction and distance by which the lit point of the target moves when the point of the mirror moves by 1 m
// along the axis.
Vec3 shift_on_target(const MirrorView& view, const Vec3& along, const ZoneTarget& target) {
  const Vec3& normal = target.point.normal;
  const Vec3 across = along - target.arrival * (along.dot(normal) / target.arrival.dot(normal));
  return (view.before + view.behind) / view.before * across;
}

// Returns the square of the distance in m from the point of a flat mirror at which an edge counts as none, whatever its
// direction: the zone is longest in the plane of incidence.
double ample_squared(const MirrorView& view, double wavelength) {
  const double cos_incidence = view.point.normal.dot(view.arrival);
  const double flat = cos_incidence * cos_incidence * (view.before + view.behind);
  return kAmple * kAmple * wavelength * view.before * view.behind / flat;
}

// Holds the surface that the wave lights, if fields are followed.
struct LitSurface {
  const EmbreeScene& geometry;
  const MirrorView& view;
  const ZoneTarget* target;
  double gap;
  int64_t& num_queries;

  // Returns whether it reaches as far as the lit point moves when the mirror's point moves by `distance`.
  bool goes_on(const Vec3& way, double distance) const {
    if (target->point.is_smooth) return false;
    const Vec3 shift = shift_on_target(view, way, *target);
    const double length = shift.norm();
    return length == 0 ||
           SurfaceAround(geometry, target->point, gap, num_queries).reaches(shift / length, distance * length);
  }
};

class AxisCover {
 public:
  // All must outlive it.
  AxisCover(const SurfaceAround& mirror, const ZoneAxis& axis, const LitSurface& lit)
      : mirror_(mirror), axis_(axis), lit_(lit) {}

  ZoneCover look() {
    ZoneCover cover;
    const double ample = 2.0 * axis_.half * kAmple;
    const std::array<Vec3, 2> ways = {axis_.along, -axis_.along};
    std::array<SurfaceEnd, 2> ends;
    if (is_ample(ample, ways)) return cover;
    double width = 0.0;
    for (size_t k = 0; k < 2; ++k) {
      ends[k] = mirror_.find_end(ways[k], ample);
      width += ends[k].distance;
    }
    if (width >= ample) return cover;
    // Between two walls the images in them go on only as far as the walls rise.
    const bool is_trough = ends[0].is_wall && ends[1].is_wall;
    double covered = 0.0;
    for (size_t k = 0; k < 2; ++k)
      covered += is_trough && !rises(ways[k], ends[k]) ? ends[k].distance : half_covered(ends[k]);
    cover.share = std::min(1.0, 0.5 * covered / axis_.half);
    if (!lit_.target) return cover;
    const double narrowness = std::min(1.0, (2.0 * axis_.half / width - 1.0 / kAmple) / (1.0 - 1.0 / kAmple));
    const std::complex<double> left = field_at(ends[0], ways[0]) + field_at(ends[1], ways[1]) - 1.0;
    cover.field = 1.0 - narrowness * (1.0 - left);
    return cover;
  }

 private:
  // Returns whether the surface is wider than `ample`, as far as a few rays can tell.
  bool is_ample(double ample, const std::array<Vec3, 2>& ways) {
    double width = 0.0;
    for (const Vec3& way : ways) width += mirror_.distance_to_rim(way);
    return width >= ample || mirror_.is_at(ways[0], ample) || mirror_.is_at(ways[1], ample);
  }

  // Returns whether the wall at an end is as high as the farther antenna, unfolded, stands above the surface: no ray between
  // the antennas and the surface beyond the wall is higher where it meets the wall.
  bool rises(const Vec3& way, const SurfaceEnd& end) const {
    const MirrorView& view = lit_.view;
    const double height = -view.point.normal.dot(view.arrival) * std::max(view.before, view.behind);
    return mirror_.wall_rises(way, end.distance, height);
  }

  double half_covered(const SurfaceEnd& end) const {
    return end.is_wall ? std::max(end.distance, axis_.half) : end.distance;
  }

  std::complex<double> field_at(const SurfaceEnd& end, const Vec3& way) {
    if (end.is_wall || lit_.goes_on(way, 2.0 * end.distance)) return 1.0;
    return field_beside_edge(end.distance / axis_.half);
  }

  const SurfaceAround& mirror_;
  const ZoneAxis& axis_;
  const LitSurface& lit_;
};

// Returns the share of the field that a flat mirror loses at its edge in the direction of `half`, which reaches to the end
// of the half zone.
std::complex<double> field_of_edge(const SurfaceAround& mirror, const Vec3& half) {
  const double length = half.norm(), reach = kFaded * length;
  const Vec3 along = half / length;
  if (mirror.reaches(along, reach)) return 0.0;
  const SurfaceEnd end = mirror.find_end(along, reach);
  if (end.is_wall || end.distance >= reach) return 0.0;
  const double distance = end.distance / length;
  const double faded = std::clamp((distance - kFades) / (kFaded - kFades), 0.0, 1.0);
  return std::polar(0.5 + 0.5 * std::cos(kPi * faded), -kPi * distance * distance);
}

}  // namespace

std::array<ZoneAxis, 2> zone_axes(const MirrorView& view, double wavelength) {
  const Vec3& normal = view.point.normal;
  const double cos_incidence = -normal.dot(view.arrival);
  const Vec3 slant = view.arrival + cos_incidence * normal;
  const double sine = slant.norm();
  std::array<ZoneAxis, 2> axes;
  axes[0].along = sine > 1e-6 ? Vec3(slant / sine) : normal.unitOrthogonal();
  axes[1].along = normal.cross(axes[0].along);
  for (ZoneAxis& axis : axes) {
    const double tilt = axis.along.dot(view.arrival);
    const double flat = (1.0 - tilt * tilt) * (1.0 / view.before + 1.0 / view.behind);
    const double curved = view.point.is_smooth ? axis.along.dot(view.point.curvature * axis.along) : 0.0;
    const double bend = std::max(std::abs(flat + 2.0 * cos_incidence * curved), 1e-12);
    axis.half = std::sqrt(wavelength / bend);
    axis.spread = bend / flat;
  }
  return axes;
}

ZoneCover cover_of_zone(const EmbreeScene& geometry, const MirrorView& view, const ZoneTarget* target, double wavelength,
                        int64_t& num_queries) {
  const double gap = geometry.plane_tolerance(wavelength);
  const SurfaceAround mirror(geometry, view.point, gap, num_queries);
  ZoneCover cover;
  if (!view.point.is_smooth && mirror.holds_circle(ample_squared(view, wavelength))) return cover;
  const LitSurface lit{geometry, view, target, gap, num_queries};
  for (const ZoneAxis& axis : zone_axes(view, wavelength)) {
    const ZoneCover along = AxisCover(mirror, axis, lit).look();
    cover.share *= along.share;
    cover.field *= along.field;
  }
  return cover;
}

FlatMirrorField field_of_flat_mirror(const EmbreeScene& geometry, const MirrorView& view, double wavelength,
                                     int64_t& num_queries) {
  const SurfaceAround mirror(geometry, view.point, geometry.plane_tolerance(wavelength), num_queries);
  if (mirror.holds_circle(ample_squared(view, wavelength))) return {};
  const std::array<ZoneAxis, 2> axes = zone_axes(view, wavelength);
  std::complex<double> of_edges = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * kPi * (k + 0.5) / kDirections;
    const Vec3 half = std::cos(angle) * axes[0].half * axes[0].along + std::sin(angle) * axes[1].half * axes[1].along;
    of_edges += field_of_edge(mirror, half);
  }
  return {1.0 - of_edges / static_cast<double>(kDirections), of_edges != 0.0};
}

// Uses the auxiliary functions of Fresnel's integrals to 2e-3: Abramowitz and Stegun (1964), 7.3.32 and 7.3.33.
std::complex<double> field_beside_edge(double within) {
  const double x = std::sqrt(2.0) * within;
  const double f = (1.0 + 0.926 * x) / (2.0 + x * (1.792 + x * 3.104));
  const double g = 1.0 / (2.0 + x * (4.142 + x * (3.492 + x * 6.670)));
  const double angle = -kPi * within * within;
  return 1.0 + 0.5 * std::complex<double>(1.0, 1.0) * std::complex<double>(-g, f) *
                   std::complex<double>(std::cos(angle), std::sin(angle));
}

}  // namespace echopath
