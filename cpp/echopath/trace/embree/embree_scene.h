#pragma once
// Holds the posed triangles of a scene and finds what rays meet of them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"
#include "echopath/scene/scene.h"
#include "echopath/trace/embree/embree_meshes.h"
#include "echopath/trace/embree/packet.h"
#include "echopath/trace/embree/query_formula.h"

namespace echopath {

struct RayHit {
  Hit hit;
  Vec3 position;          // rebuilt in double from (u, v), relative to the origin; on the curved surface where it is smooth
  Vec3 normal;            // unit, flipped against the ray
  double distance = 0.0;  // m, along the ray
  double reported = 0.0;  // m, likewise, as Embree has it in single precision: farther off, the more the ray grazes
  bool is_smooth = false;
  // This is the area of the curved surface for which a ray stands, over the area that its tube covers at the angle of
  // `normal`; 1 where the facet is meant.
  double stretch = 1.0;
  Mat3 curvature;  // 1/m on the side of `normal`: positive where convex (scene/smooth/smooth.h); only where smooth
};

struct PacketFacets;  // embree_packets.cpp, as the next one
struct RayLanes;
struct ValidLanes;

struct Segment {
  Vec3 from, to;  // m, relative to the origin
};

// Says where and how coarsely points and rays of a scene are rounded to single precision.
struct RayRounding {
  Vec3 origin;   // m, world: EmbreeScene::origin
  double lift;   // m: EmbreeScene::lift
  double reach;  // m: EmbreeScene::reach

  bool operator==(const RayRounding&) const = default;
};

// Answers queries of rays in a posed scene. Coordinates are relative to `origin` (world), so that single precision resolves
// the space around it. A ray that starts far outside the scene is first moved up to it in double precision. Queries are
// thread-safe, and pass sheets unless `sees` says otherwise.
class EmbreeScene {
 public:
  // Raises DeviceError when Embree fails, Cancelled when the job is cancelled during the build, and invalid_argument where
  // coordinates relative to the origin are out of their range (base/range_of_coordinates.h).
  EmbreeScene(const Scene& scene, const PosedScene& pose, const Vec3& origin, Job* job = nullptr);
  // Makes a scene without meshes, until update() adds them.
  EmbreeScene();
  ~EmbreeScene();
  // Makes the scene as if anew, with the same answers, but does only what differs from before. Where meshes overlap little,
  // and something moves, edits come (Upkeep) or there are hundreds of small ones, each has a tree of its own, or shares one
  // with small neighbours: then a mesh that has moved costs a fit of its tree (6 ns a triangle) and the tree over all
  // trees, and one that shares a tree that tree (0.2 us a triangle). Elsewhere everything is built, unless nothing differs.
  // Raises as the constructor does and holds nothing after that.
  void update(const Scene& scene, const PosedScene& pose, const Vec3& origin, Job* job = nullptr);
  // Updates a part of a scene, which is rounded as all of it is.
  void update(const Scene& part, const PosedScene& pose, const RayRounding& of_all, Job* job);
  // Says what may differ at the next update: the time alone; or `near` moves, too; or the scene is edited. Edits may touch
  // any object: the origin is then rounded even where nothing moves, as are lift and reach (up to powers of two), so that
  // they seldom depend on any one of them, and meshes that overlap little have trees of their own.
  enum class Upkeep { kTimes, kMovingRadar, kEdits };
  static Upkeep upkeep_near(bool near_moves) { return near_moves ? Upkeep::kMovingRadar : Upkeep::kTimes; }
  // Updates the scene likewise, with the origin that origin_near gives for `near` (m, world).
  void update(const Scene& scene, const PosedScene& pose, const Vec3& near, Upkeep upkeep, Job* job);

  enum class Verdict { kMiss, kHit, kFalseHit };
  // Finds the closest hit from `from` along the unit vector `direction`. kFalseHit means that Embree reported a point that
  // double precision does not find on the ray (slivers near grazing); the ray counts as lost.
  Verdict intersect(const Vec3& from, const Vec3& direction, RayHit& out) const;
  // Finds the closest hit from a point of the scene itself, on a surface or lifted off it, or from anywhere outside, among
  // the surfaces that the ray sees and no nearer than `begin` (m).
  Verdict intersect_from_surface(const Vec3& from, const Vec3& direction, RayHit& out, Sees sees = Sees::kOpaque,
                                 double begin = 0.0) const;
  // Finds the closest hit from a point on a surface within `reach` (m). Short rays are quicker, because they miss most of
  // the scene. A hit may lie a little farther than `reach`.
  Verdict intersect_near(const Vec3& from, const Vec3& direction, double reach, RayHit& out, Sees sees) const;
  // Returns the distance along a ray, m, at which to continue it behind a hit, so that it does not meet the same surface
  // again: for Embree that lies at `reported` (m), not at `distance`. Embree rounds only the way within reach of the scene.
  double behind(double distance, double reported) const {
    const double farther = std::max(distance, reported);
    return farther + 0x1.0p-20 * std::min(farther, 2.0 * reach_) + 2.0 * lift_;
  }
  bool has_sheets() const { return has_sheets_; }
  bool is_sheet(uint32_t mesh_id) const { return meshes_.is_sheet(mesh_id); }
  // Holds what the rays of a packet meet, lane by lane.
  struct PacketHits {
    std::array<Verdict, kPacketSize> verdicts;
    std::array<Hit, kPacketSize> met;
    LaneVectors position, normal;
    LaneValues distance, stretch;
    LaneValues reported{};  // m, where the scene has sheets
    LaneFlags is_smooth{};
    std::array<Mat3, kPacketSize> curvature;

    RayHit operator[](int lane) const;
    void set(int lane, const RayHit& hit);
  };
  // Finds the closest hits of the first `count` rays of a packet, from one point; it is 4 times as fast where they are
  // nearly parallel. The lanes behind them must hold finite numbers too, and meet nothing.
  // With `begins` (m), they are the closest no nearer than there, and rays with negative ones meet nothing.
  void intersect(const Vec3& from, const LaneVectors& directions, int count, PacketHits& out, Sees sees = Sees::kOpaque,
                 const LaneValues* begins = nullptr) const;
  // Finds what the rays of a packet from one point meet first in their stretches, in single precision and without the hits
  // themselves. Of all meshes, those that share a bit with `mask` are looked at: bits of Sees, or those of mask_of.
  struct Stretches {
    LaneValues begin, end;  // m, along the rays; a ray whose stretch is empty is not asked about
  };
  struct MeshHits {
    std::array<uint32_t, kPacketSize> mesh_id;  // kNoMesh where there is none
    LaneValues distance;                        // m
  };
  void intersect_meshes(const Vec3& from, const LaneVectors& directions, const Stretches& stretches, uint32_t mask,
                        MeshHits& out) const;
  uint32_t mask_of(uint32_t mesh_id) const { return meshes_.mask_of(mesh_id); }  // its bit: EmbreeMeshes::mask_of
  // Returns whether something lies on the open segment between the two points. Points on surfaces must be lifted first.
  bool occluded(const Vec3& from, const Vec3& to) const;
  // Answers this for `count` segments; it is 4 times as fast, in whatever order they come.
  void occluded(const Segment* segments, size_t count, uint8_t* blocked) const;
  // Answers this between the points of a packet and one other point, in the lanes where `asked` is set; elsewhere nothing is
  // blocked.
  void occluded(const LaneVectors& from, const Vec3& to, const LaneFlags& asked, LaneFlags& blocked) const;
  // All queries go through this interface to Embree, in single precision. Another one can take its place, for example one
  // that looks at the queries and hands them on. It must outlive its use, and no query may be under way.
  class Queries;  // embree_device.h
  const Queries& queries() const { return *queries_; }
  void ask_through(const Queries& queries) { queries_ = &queries; }
  // Returns the point moved off its surface by a few units of single precision, so that a ray from there does not meet the
  // surface again.
  Vec3 lifted(const Vec3& point, const Vec3& normal) const { return point + lift_ * normal; }
  double lift() const { return lift_; }  // m
  // Returns how far apart surfaces may be, in m, to count as one plane or as abutting at this wavelength (m): so far that an
  // echo turns by an eighth of a turn, and no less than vertices and rays are rounded in single precision.
  double plane_tolerance(double wavelength) const { return std::max(wavelength / 16.0, 4.0 * lift_); }
  double reach() const { return reach_; }  // m, farther than from any point of the scene to any other

  // Returns the point of the scene's bounding box next to `near` (world), the best origin for rays from there. Where
  // something or `near` moves, it is rounded to a grid, by no more than 1/16 of the scene's length in each axis: then it is
  // the same at most times, and meshes at rest need not be built again.
  static Vec3 origin_near(const Scene& scene, const PosedScene& pose, const Vec3& near, bool near_moves = false);
  const Vec3& origin() const { return meshes_.origin(); }
  RayRounding rounding() const { return {origin(), lift_, reach_}; }

  std::array<Vec3, 3> corners(uint32_t mesh_id, uint32_t triangle_id) const {
    const Surface& surface = surfaces_[mesh_id];
    const Triangle& triangle = surface.triangles[triangle_id];
    return {surface.vertices[triangle[0]], surface.vertices[triangle[1]], surface.vertices[triangle[2]]};
  }
  size_t num_triangles(uint32_t mesh_id) const { return meshes_.triangles(mesh_id).size(); }
  // Returns vertices relative to the origin.
  const std::vector<Vec3>& vertices(uint32_t mesh_id) const { return meshes_.vertices(mesh_id); }
  Box box(uint32_t mesh_id) const { return meshes_.box(mesh_id); }
  // Returns the width in m that `measure` gives for the mesh, or gave since its vertices were last computed.
  double width(uint32_t mesh_id, const std::function<double()>& measure) const { return meshes_.width(mesh_id, measure); }

 private:
  struct Device;    // embree_device.h
  class Trees;      // embree_trees.h
  struct Surface {  // of one mesh: where its arrays begin
    const Triangle* triangles;
    const Vec3* vertices;
    const Vec3* normals;  // null where facets are meant
  };
  void bring_to(const Scene& scene, const PosedScene& pose, const EmbreeMeshes::OriginRule& origin, Upkeep upkeep, Job* job);
  void forget();
  Hit named(uint32_t geometry_id, uint32_t triangle_id, float u, float v) const;
  Vec3 moved_up(const Vec3& from, const Vec3& direction) const {
    return from + way_up(unpacked(from), unpacked(direction), reach_) * direction;
  }
  SegmentRay ray_between(const Vec3& from, const Vec3& to) const {
    return segment_ray(unpacked(from), unpacked(to), 2.0 * lift_, reach_);
  }
  // These serve packets (embree_packets.cpp).
  void name_hits(std::array<Hit, kPacketSize>& met) const;
  void fetch(const PacketHits& hits, PacketFacets& facets) const;
  void ask_segments(const RayLanes& rays, ValidLanes& blocked) const;
  // Embree has the ray begin at `start`.
  struct RayStart {
    Vec3 at;
    double begin, end = std::numeric_limits<double>::infinity();  // m, from there
  };
  Verdict intersect(const Vec3& from, const RayStart& start, const Vec3& direction, Sees sees, RayHit& out) const;
  Verdict confirm(const Vec3& from, const Vec3& direction, RayHit& hit) const;
  void curve(const std::array<Vec3, 3>& corners, const Vec3& direction, RayHit& hit) const;

  std::unique_ptr<Device> device_;
  std::unique_ptr<Trees> trees_;
  const Queries* queries_;
  bool has_sheets_ = false;
  double lift_ = 0.0;   // m
  double reach_ = 0.0;  // m: rays from farther away are moved up to there
  EmbreeMeshes meshes_;
  std::vector<Surface> surfaces_;  // by mesh ID
};

}  // namespace echopath
