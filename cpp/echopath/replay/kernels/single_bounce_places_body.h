#pragma once
// Holds the loops of single_bounce_kernels.h that prepare what is evaluated: where the hits of a triangle lie and how large
// their launch cells are, and where the antennas are seen from them. Part of single_bounce_kernels_body.h.
#include "echopath/replay/kernels/shared_leg_kernels_body.h"
#include "echopath/replay/kernels/single_bounce_kernels.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

using Rows3 = const SingleBounceSlots::Row*;

ECHOPATH_INLINE VectorOf<Vec> vector_at(Rows3 rows, size_t slot) {
  return {load(rows[0] + slot), load(rows[1] + slot), load(rows[2] + slot)};
}
ECHOPATH_INLINE void set_vector(SingleBounceSlots::Row* rows, size_t slot, const VectorOf<Vec>& v) {
  store(rows[0] + slot, v.x);
  store(rows[1] + slot, v.y);
  store(rows[2] + slot, v.z);
}
ECHOPATH_INLINE VectorOf<Vec> times(const double* matrix, const VectorOf<Vec>& v) {
  const auto along = [&](int axis) {
    return matrix[3 * axis] * v.x + matrix[3 * axis + 1] * v.y + matrix[3 * axis + 2] * v.z;
  };
  return {along(0), along(1), along(2)};
}
ECHOPATH_INLINE VectorOf<Vec> choose(Mask first, const VectorOf<Vec>& a, const VectorOf<Vec>& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

// Returns any unit vector across a unit vector.
ECHOPATH_INLINE VectorOf<Vec> orthogonal(const VectorOf<Vec>& v) {
  const Vec least = 1e-12 * LaneMath::magnitude(v.z);
  const Mask is_upright = (LaneMath::magnitude(v.x) <= least) & (LaneMath::magnitude(v.y) <= least);
  const Vec of_xy = 1.0 / LaneMath::root(v.x * v.x + v.y * v.y), of_yz = 1.0 / LaneMath::root(v.y * v.y + v.z * v.z);
  return choose(is_upright, {Vec{}, -v.z * of_yz, v.y * of_yz}, {-v.y * of_xy, v.x * of_xy, Vec{}});
}

ECHOPATH_INLINE Mask is_finite(const VectorOf<Vec>& v) {
  return (v.x - v.x == 0.0) & (v.y - v.y == 0.0) & (v.z - v.z == 0.0);
}

// Finds the point and the launch cell of the path's own stratum on the plane of its triangle (launch_cell.h).
void prepare(const SingleBounceTrace& trace, SingleBounceSlots& slots) {
  for (size_t slot = 0; slot < SingleBounceSlots::kSlots; slot += kLanes) {
    const VectorOf<Vec> edge_u = vector_at(slots.edge[0], slot), edge_v = vector_at(slots.edge[1], slot);
    const Vec u = load(slots.along_edge[0] + slot), v = load(slots.along_edge[1] + slot);
    const VectorOf<Vec> point = vector_at(slots.corner, slot) + u * edge_u + v * edge_v;
    const VectorOf<Vec> across = times(trace.normal, cross(edge_u, edge_v));
    const VectorOf<Vec> normal = (1.0 / LaneMath::root(dot(across, across))) * across;
    const VectorOf<Vec> moved{all(trace.translation[0]), all(trace.translation[1]), all(trace.translation[2])};
    const VectorOf<Vec> at = times(trace.linear, point) + moved;
    const Vec length = LaneMath::root(dot(at, at));
    const VectorOf<Vec> arrival = (1.0 / length) * at;
    const Vec cos_in = dot(normal, arrival);
    const TubeOnPlane<Vec> tube = tube_on_plane<LaneMath>(length, load(slots.density + slot), cos_in);
    const VectorOf<Vec> slope = arrival - cos_in * normal;
    const Vec sine = LaneMath::root(dot(slope, slope));
    const VectorOf<Vec> along = choose(has_plane_of_incidence(sine), (1.0 / sine) * slope, orthogonal(normal));
    const VectorOf<Vec> first = tube.along * along, second = tube.across * cross(normal, along), none{};
    const Mask has_cell = is_finite(first) & is_finite(second);
    const VectorOf<Vec> tangent[2] = {choose(has_cell, first, none), choose(has_cell, second, none)};
    set_vector(slots.point, slot, at);
    set_vector(slots.normal, slot, normal);
    for (int a = 0; a < 2; ++a) set_vector(slots.tangent[a], slot, tangent[a]);
    store(slots.product[0] + slot, dot(tangent[0], tangent[0]));
    store(slots.product[1] + slot, dot(tangent[0], tangent[1]));
    store(slots.product[2] + slot, dot(tangent[1], tangent[1]));
    store(slots.has_cell + slot, has_cell ? all(1.0) : Vec{});
  }
}

// Multiplies v by the transposed matrix.
template <class Real>
ECHOPATH_INLINE VectorOf<Real> times_transposed(const double* matrix, const VectorOf<Real>& v) {
  const auto along = [&](int axis) { return matrix[axis] * v.x + matrix[3 + axis] * v.y + matrix[6 + axis] * v.z; };
  return {along(0), along(1), along(2)};
}

// The motion since the trace is a rotation, linear * mesh_from_trace, and a shift; the transposed matrix undoes the
// rotation.
template <class Math>
void see(const SingleBounceTrace& trace, const AntennaToSee& antenna, size_t stride) {
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto turned_back = [&](const auto& v) {
      const auto along = [&](int axis) {
        const auto entry = [&](int row) { return at.value(antenna.mesh, PointToPose::kLinear + 3 * row + axis); };
        return entry(0) * v.x + entry(1) * v.y + entry(2) * v.z;
      };
      return times_transposed(trace.mesh_from_trace, VectorOf<typename Math::Real>{along(0), along(1), along(2)});
    };
    const auto moved = at.vector(antenna.mesh, PointToPose::kTranslation);
    const auto position = turned_back(at.vector(antenna.antenna, LegToMeasure::kImagePosition) - moved);
    const double* origin = trace.translation;
    at.set(antenna.out, LegToMeasure::kImagePosition,
           {position.x + origin[0], position.y + origin[1], position.z + origin[2]});
    at.set(antenna.out, LegToMeasure::kBoresight, turned_back(at.vector(antenna.antenna, LegToMeasure::kBoresight)));
  }
}

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS
