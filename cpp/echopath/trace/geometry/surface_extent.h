#pragma once
// Measures how far a surface goes on around one of its points, whatever meshes and triangles it consists of.
#include "echopath/base/plane.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

struct SurfaceEnd {
  double distance = 0.0;     // m, along the surface
  bool is_wall = false;      // something rises from it there (the inside of a corner): it ends, but has no edge
  Vec3 wall = Vec3::Zero();  // unit normal of what rises there, toward the point
};

// Measures distances to the edges of a triangle.
class TriangleRim {
 public:
  TriangleRim(const EmbreeScene& geometry, const Hit& hit);
  // Returns the distance in m from a point of the triangle along the unit tangent to the rim.
  double distance(const Vec3& from, const Vec3& along) const;
  // Returns whether no point of the rim lies nearer to a point of the triangle than the root of `squared` (m^2).
  bool is_beyond(const Vec3& from, double squared) const;

 private:
  std::array<Vec3, 3> corners_, outward_;
};

// Tells over which triangles a surface goes on: those that turn by at most 30 degrees from the point's normal, or those
// that lie in the point's plane, which has an edge at each corner but those of 90, 60 and 45 degrees.
enum class Extent { kBent, kPlane };

// Finds how far the surface around a point extends. A surface extends over triangles that lie on each other's rims
// within `gap` (m); of a plane, all their corners lie so near to it. A hole may be overlooked: by is_at and reaches any,
// by find_end one that is no wider than the surface before it is long. `along` is a unit tangent. Its rays are added to
// num_queries; what stands on the surface may be a sheet, and the surface itself is one where the point lies on one.
// `next` is the plane, if any, that a wave meets next, whose corner with this one is no edge of this one: it counts
// there. Corners whose planes end within `crack` (m) of each other are closed.
// All arguments must outlive it.
class SurfaceAround {
 public:
  SurfaceAround(const EmbreeScene& geometry, const RayHit& point, double gap, int64_t& num_queries,
                Extent extent = Extent::kBent, const Plane* next = nullptr, double crack = 0.0)
      : geometry_(geometry), point_(point), rim_(geometry, point.hit), gap_(gap), crack_(crack), extent_(extent),
        next_(next), sees_(geometry.is_sheet(point.hit.mesh_id) ? Sees::kAll : Sees::kOpaque), num_queries_(num_queries) {}

  // Returns how far the point's own triangle goes on.
  double distance_to_rim(const Vec3& along) const { return rim_.distance(point_.position, along); }
  // Returns whether the point's own triangle holds a circle about it, by the square of the radius (m^2).
  bool holds_circle(double radius_squared) const { return rim_.is_beyond(point_.position, radius_squared); }
  // Returns whether it is there at `distance` (m); this costs a ray.
  bool is_at(const Vec3& along, double distance) const { return end_of_triangle_at(along, distance) >= 0; }
  // Returns the same, without a ray where the point's own triangle reaches as far.
  bool reaches(const Vec3& along, double distance) const {
    return distance_to_rim(along) >= distance || is_at(along, distance);
  }
  // Returns whether the wall whose foot stands at `distance` (m) rises to a height (m), straight up or in its plane, leaning
  // back by no more than 45 degrees; this costs a ray.
  bool wall_rises(const Vec3& along, double distance, double height) const;
  // Returns the distance in m at which a plane across stands on it that is no wall (SurfaceEnd::is_wall), whether the
  // surface goes on behind it or not; `reach` where none stands nearer. This costs up to two rays.
  double open_foot_of(const Plane& plane, const Vec3& along, double reach) const;
  // Finds its end where it does not reach as far as `reach` (m). An edge lies where the last triangle ends, so that the
  // distance does not depend on how the surface is cut into triangles and meshes. This costs some ten rays.
  SurfaceEnd find_end(const Vec3& along, double reach) const;

 private:
  SurfaceEnd nearest_wall(const Vec3& along, double reach) const;
  SurfaceEnd wall_at_height(double height, const Vec3& along, double reach) const;
  double end_before(double beyond, const Vec3& along) const;
  double end_of_triangle_at(const Vec3& along, double distance) const;
  bool is_in_plane(const Hit& hit) const;
  bool is_wall(const RayHit& met) const;
  // Returns the place from which one looks down on the surface.
  Vec3 above(const Vec3& along, double distance) const { return point_.position + distance * along + gap_ * point_.normal; }

  const EmbreeScene& geometry_;
  const RayHit& point_;
  TriangleRim rim_;
  double gap_, crack_;
  Extent extent_;
  const Plane* next_;
  Sees sees_;
  int64_t& num_queries_;
};

}  // namespace echopath
