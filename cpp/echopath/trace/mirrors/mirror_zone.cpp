#include "echopath/trace/mirrors/mirror_zone.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kAmple = 1.0 / 0.7;  // widths of the zone from which on edges count as none

// Edges about the point of a flat mirror fade between these distances, in half zones.
constexpr double kFades = 8.0, kFaded = 16.0;

// A corner whose planes end so near to each other, in half zones, is closed: the strip that is missing in both orders takes
// 0.3 dB at most.
constexpr double kCrack = 0.02;

// Edges as near, in half zones, to the plane that a wave meets next are edges of both planes.
constexpr double kBesideNext = 0.25;

// Edges are looked for in so many directions, each in the middle of a cell.
constexpr int kDirections = 64;
constexpr double kHalfCell = kPi / kDirections;

const double kCosCell = std::cos(2.0 * kHalfCell), kSinCell = std::sin(2.0 * kHalfCell);

// The edges in three neighbouring directions are one where their closeness is off that of a straight one by no more than
// this share: circles about the point have half of it.
constexpr double kRound = 0.02;

// Returns the direction and distance by which the lit point of the target moves when the point of the mirror moves by 1 m
// along the axis.
Vec3 shift_on_target(const MirrorView& view, const Vec3& along, const ZoneTarget& target) {
  const Vec3& normal = target.point.normal;
  const Vec3 across = along - target.arrival * (along.dot(normal) / target.arrival.dot(normal));
  return (view.before + view.behind) / view.before * across;
}

// Returns the square of the distance in m from the point of a flat mirror at which an edge counts as none, whatever its
// direction, for edges that count as none from `half_zones` on: the zone is longest in the plane of incidence.
double ample_squared(const MirrorView& view, double wavelength, double half_zones) {
  const double cos_incidence = view.point.normal.dot(view.arrival);
  const double flat = cos_incidence * cos_incidence * (view.before + view.behind);
  return half_zones * half_zones * wavelength * view.before * view.behind / flat;
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

// Parts of a distance at which a surface is looked for: one beyond a gap, such as the next house in a row, is another.
constexpr std::array kParts = {0.125, 0.25, 0.5, 1.0};

// Returns whether the surface is there at all parts of the distance (m).
bool goes_on(const SurfaceAround& surface, const Vec3& along, double distance) {
  return std::ranges::all_of(kParts, [&](double part) { return surface.reaches(along, part * distance); });
}

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
    return width >= ample || goes_on(mirror_, ways[0], ample) || goes_on(mirror_, ways[1], ample);
  }

  // Returns whether the wall at an end rises to where the waves between the antennas, unfolded, and the zone beyond the wall
  // cross it.
  bool rises(const Vec3& way, const SurfaceEnd& end) const {
    const MirrorView& view = lit_.view;
    const Vec3 &normal = view.point.normal, foot = view.point.position + end.distance * way;
    const double beyond = (kAmple * axis_.half - end.distance) * std::abs(way.dot(end.wall));  // m, behind the wall
    const Vec3 departure = mirrored(view.arrival, normal);
    double height = 0.0;
    for (const Vec3& antenna : {Vec3(-view.before * view.arrival), Vec3(view.behind * departure)}) {
      const double apart = end.wall.dot(view.point.position + antenna - foot);
      if (apart > 0.0 && beyond > 0.0) height = std::max(height, normal.dot(antenna) * beyond / (apart + beyond));
    }
    return height == 0.0 || mirror_.wall_rises(way, end.distance, height);
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

// Returns one over the distance of the mirror's rim in half zones, in the direction of `half`, which reaches to the end of
// the half zone; 0: no edge is so near that it counts. One beside the plane that the wave meets next, if any, counts there.
double closeness_of_rim(const SurfaceAround& mirror, const Vec3& point, const Vec3& half, const Plane* next) {
  const double length = half.norm();
  const Vec3 along = half / length;
  for (const double part : kParts) {
    const double reach = part * kFaded * length;
    if (mirror.reaches(along, reach)) continue;
    const SurfaceEnd end = mirror.find_end(along, reach);
    if (end.is_wall || end.distance >= reach) return 0.0;
    if (next && std::abs(next->height(point + end.distance * along)) <= kBesideNext * length) return 0.0;
    return length / std::max(end.distance, 1e-6 * length);
  }
  return 0.0;
}

// Returns the same of all edges, also of those where planes that the wave has met stand on the mirror.
double closeness_of_edge(const SurfaceAround& mirror, const Vec3& point, const Vec3& half, std::span<const Plane> met,
                         const Plane* next) {
  const double length = half.norm(), reach = kFaded * length;
  double closeness = closeness_of_rim(mirror, point, half, next);
  for (const Plane& plane : met) {
    const double foot = mirror.open_foot_of(plane, half / length, reach);
    if (foot >= reach || (next && std::abs(next->height(point + foot / length * half)) <= kBesideNext * length)) continue;
    closeness = std::max(closeness, length / std::max(foot, 1e-6 * length));
  }
  return closeness;
}

// Returns by how much the way over a place that is `shift` (m) beside the point of reflection is longer, over what a square
// of the shift gives.
double excess_over_square(const MirrorView& view, const Vec3& shift) {
  const Vec3& normal = view.point.normal;
  const Vec3 departure = mirrored(view.arrival, normal);
  const auto longer = [&](double length, double tilt) {
    const double square = shift.squaredNorm() + 2.0 * length * tilt;
    return square / (std::sqrt(length * length + square) + length) - tilt;
  };
  const double slant = view.arrival.dot(shift);
  const double excess = longer(view.before, slant) + longer(view.behind, -departure.dot(shift));
  return excess / (0.5 * (shift.squaredNorm() - slant * slant) * (1.0 / view.before + 1.0 / view.behind));
}

// Returns the field with which the antennas light and hear a place that is `shift` (m) beside the point of reflection, over
// that of the point; at most 1 by either antenna.
std::complex<double> light_beside(const UnfoldedAntennas& antennas, const Vec3& shift) {
  std::complex<double> light = 1.0;
  for (const UnfoldedAntenna& antenna : antennas) {
    const AntennaGain here = antenna.toward(Vec3::Zero()), there = antenna.toward(shift);
    if (there.power < here.power) light *= std::sqrt(there.power / here.power);
    light *= std::polar(1.0, there.phase - here.phase);
  }
  return light;
}

// Holds the edges of a mirror about a point of it.
class EdgesAround {
 public:
  EdgesAround(const SurfaceAround& mirror, const MirrorView& view, double wavelength, const UnfoldedAntennas& antennas,
              std::span<const Plane> met, const Plane* next) {
    const std::array<ZoneAxis, 2> axes = zone_axes(view, wavelength);
    for (int k = 0; k < kDirections; ++k) {
      const double angle = kHalfCell * (2 * k + 1);
      const Vec3 half = std::cos(angle) * axes[0].half * axes[0].along + std::sin(angle) * axes[1].half * axes[1].along;
      closeness_[k] = closeness_of_edge(mirror, view.point.position, half, met, next);
      if (closeness_[k] == 0.0) continue;
      turn_[k] = kPi * excess_over_square(view, half / closeness_[k]);
      light_[k] = light_beside(antennas, half / closeness_[k]);
    }
  }

  // Returns the share of the field that the mirror loses at them.
  std::complex<double> lost_field() const {
    std::complex<double> sum = 0.0;
    for (int k = 0; k < kDirections; ++k) {
      if (closeness_[k] == 0.0) continue;
      for (const int side : {1, -1}) sum += light_[k] * field_of_half_cell(edge_beside(k, side), turn_[k]);
    }
    return sum / (2.0 * kDirections);
  }

 private:
  double at(int k) const { return closeness_[(k + kDirections) % kDirections]; }

  // Holds how close an edge is at an angle from a direction on: here cos + slope sin + round (1 - cos). It is straight
  // where `round` is zero, and an arc about the point where slope is zero and `round` is `here`.
  struct Edge {
    double here, slope, round;
  };

  // Returns by how much the closeness in the directions before and behind one is more than that of one straight edge.
  double roundness(int k) const { return at(k - 1) + at(k + 1) - 2.0 * kCosCell * at(k); }

  // Returns whether the edges in a direction and in both that neighbour it are one, straight or round.
  bool is_one_edge(int k) const {
    return at(k - 1) > 0.0 && at(k) > 0.0 && at(k + 1) > 0.0 && std::abs(roundness(k)) < kRound * at(k);
  }

  // Returns the edge from a direction on toward a side: that through both neighbours where all three are one, else that on
  // to the next direction where both are one, else, before a corner, that on the other side.
  Edge edge_beside(int k, int side) const {
    const double here = at(k), next = at(k + side), other = at(k - side);
    if (is_one_edge(k)) return {here, (next - other) / (2.0 * kSinCell), roundness(k) / (2.0 - 2.0 * kCosCell)};
    const auto toward = [&](double neighbour) { return (neighbour - here * kCosCell) / kSinCell; };
    if (next > 0.0 && (other == 0.0 || is_one_edge(k + side))) return {here, toward(next), 0.0};
    return {here, other > 0.0 ? -toward(other) : 0.0, 0.0};
  }

  // Returns the mean field of an edge over the angles from a direction to the end of its cell, of those that fade; `turn`:
  // rad, of the phase over the square of the distance.
  static std::complex<double> field_of_half_cell(const Edge& edge, double turn) {
    const auto distance = [&](double angle) {
      const double square = angle * angle;  // of which a half cell needs no more terms
      const double sunk = square / 2.0 * (1.0 - square / 12.0), sine = angle * (1.0 - square / 6.0);
      return 1.0 / std::max(edge.here * (1.0 - sunk) + edge.slope * sine + edge.round * sunk, 1.0 / kFaded);
    };
    // In each step the phase goes by a straight line from end to end, which its middle misses by an eighth of a radian at
    // most.
    const double first = distance(0.0), middle = distance(0.5 * kHalfCell), last = distance(kHalfCell);
    const double bend = turn * std::abs(first * first + last * last - 2.0 * middle * middle);
    const int steps = 1 + static_cast<int>(std::min(2.0 * std::sqrt(bend) + std::abs(last - first), kMostSteps));
    std::complex<double> sum = 0.0;
    double begin = first;
    for (int i = 0; i < steps; ++i) {
      const double at = distance(kHalfCell * (i + 0.5) / steps), end = distance(kHalfCell * (i + 1.0) / steps);
      const double half_turn = 0.5 * turn * (end * end - begin * begin);
      const double mean = half_turn * half_turn < 1e-8 ? 1.0 : std::sin(half_turn) / half_turn;
      const double faded = std::clamp((at - kFades) / (kFaded - kFades), 0.0, 1.0);
      const double kept = faded == 0.0 ? 1.0 : 0.5 + 0.5 * std::cos(kPi * faded);
      sum += std::polar(1.0, -turn * at * at) * (kept * mean);
      begin = end;
    }
    return sum / static_cast<double>(steps);
  }

  static constexpr double kMostSteps = 255.0;

  std::array<double, kDirections> closeness_, turn_;
  std::array<std::complex<double>, kDirections> light_;
};

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
  if (!view.point.is_smooth && mirror.holds_circle(ample_squared(view, wavelength, kAmple))) return cover;
  const LitSurface lit{geometry, view, target, gap, num_queries};
  for (const ZoneAxis& axis : zone_axes(view, wavelength)) {
    const ZoneCover along = AxisCover(mirror, axis, lit).look();
    cover.share *= along.share;
    cover.field *= along.field;
  }
  return cover;
}

double widest_crack(const MirrorView& view, double wavelength) {
  const std::array<ZoneAxis, 2> axes = zone_axes(view, wavelength);
  return kCrack * std::min(axes[0].half, axes[1].half);
}

std::complex<double> field_of_flat_mirror(const EmbreeScene& geometry, const MirrorView& view, double wavelength,
                                          const UnfoldedAntennas& antennas, int64_t& num_queries, std::span<const Plane> met,
                                          const Plane* next) {
  const double gap = geometry.plane_tolerance(wavelength);
  const SurfaceAround mirror(geometry, view.point, gap, num_queries, Extent::kPlane, next, widest_crack(view, wavelength));
  const double ample = ample_squared(view, wavelength, kFaded);
  const auto is_far = [&](const Plane& plane) {
    const double height = plane.height(view.point.position);
    return height * height >= ample * plane.normal.cross(view.point.normal).squaredNorm();
  };
  if (mirror.holds_circle(ample) && std::ranges::all_of(met, is_far)) return 1.0;
  return 1.0 - EdgesAround(mirror, view, wavelength, antennas, met, next).lost_field();
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
