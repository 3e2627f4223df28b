#pragma once
// Poses the hits of paths: points, normals and the legs between them, with images for flagged mirrors.
#include <span>

#include "echopath/base/plane.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/record/paths.h"

namespace echopath {

// Describes a hit in the frame of its mesh.
struct LocalHit {
  uint32_t mesh_id = 0, triangle_id = 0;
  bool deformed = false;  // the corners are those of the scene, `triangle` counts places in the mesh's patch
  Triangle triangle{};
  double u = 0.0, v = 0.0;
  Vec3 corner, edge_u, edge_v;  // of its triangle at rest; of a deforming mesh, as at the trace
  Vec3 point, normal;           // on the facet, at the same time; unit
  double trace_area = 0.0;      // m^2, |edge_u x edge_v| in the world at the trace; 0: its area never changes
  // These are the unit vertex normals at rest where the triangle is taken as smooth, else null. On deforming meshes only
  // this difference counts: their normals are those of the posed scene.
  const std::array<Vec3, 3>* normals = nullptr;
  // These are the edge and the number of its pieces where the hit stands for a piece of an edge. It is then posed with the
  // normal outward_of the edge.
  const SharpEdge* edge = nullptr;
  int num_pieces = 0;
};

// Describes a hit in the world. Its point is relative to the origin, on the curved surface where it is smooth; its normal is
// that of the triangle's winding.
struct PosedHit : Plane {
  Vec3 edge_u, edge_v;  // only where they are asked for or the triangle bends
  Vec3 facet;           // the point on the flat triangle; only where is_smooth
  Mat3 curvature;       // 1/m, about `normal` (scene/smooth/smooth.h); only where is_smooth
  bool is_smooth = false;
  double area_ratio = 1.0;  // of its triangle, over that at the trace
  bool is_edge = false;     // LocalHit::edge
};

// Holds the part of a path that does not depend on time.
struct LocalPath {
  const LocalHit* hits = nullptr;
  const Hit* recorded = nullptr;  // these hits in the order of the record
  int count = 0;
  bool is_reversed = false;  // hits and bits stand as traced, from the receiver's end: antennas change their roles
  uint64_t diffuse = 0;
  uint64_t image = 0;    // bit per hit: specular on a flagged mirror, replayed by images
  uint64_t sliding = 0;  // bit per hit: other specular hits, whose point of reflection slides over the surface

  uint32_t flags = 0;  // of the record
  int edge = -1;       // the first hit on an edge
  int num_edges = 0;   // how many there are in a row: the material points of the path

  bool is_image(int hit) const { return image >> hit & 1; }
  bool is_diffuse(int hit) const { return diffuse >> hit & 1; }
  bool is_edge(int hit) const { return edge >= 0 && hit >= edge && hit < edge + num_edges; }
  bool is_sliding(int hit) const { return sliding >> hit & 1; }
  // These are the first and the last hit that are not images; they are -1 where the path has mirrors only. The last one is a
  // material point.
  int first_material = -1, last_material = -1;
};

// Finds point, edges and normal of a hit on its flat triangle.
void pose_facet(const LocalHit& hit, const PosedScene& scene, PosedHit& out);
// `with_triangle` says that the edges are needed too.
void pose_hit(const LocalHit& hit, const PosedScene& scene, bool with_triangle, PosedHit& out);
void pose_hits(const LocalPath& path, const PosedScene& scene, PosedHit* out);

// An unfolded leg runs from one point to another over the mirrors `first` to `last` - 1 of a path.
struct UnfoldedLeg {
  double length;            // m
  Vec3 departure, arrival;  // unit directions of travel at both ends
};
UnfoldedLeg unfolded_leg(const PosedHit* hits, const Vec3& from, int first, int last, const Vec3& to);
// Returns these mirrors as a chain (base/plane.h).
inline std::span<const PosedHit> chain_of(const PosedHit* hits, int first, int last) { return {hits + first, hits + last}; }

// Returns the leg between the hits `from` < `to` of a path, which are not images, over the mirrors between them.
UnfoldedLeg inner_leg(const PosedHit* hits, int from, int to);

// Calls visit(k, arrival, departure) for the hits of a path in turn, with the unit directions of travel of a wave from
// `start` to `end`. Images mirror what arrives; between other hits it runs straight over the images.
template <class Visit>
void for_each_hit(const LocalPath& path, const PosedHit* hits, const Vec3& start, const Vec3& end, const Visit& visit) {
  Vec3 from = start, arrival;
  for (int material = -1; material < path.count;) {
    int next = material + 1;
    while (next < path.count && path.is_image(next)) ++next;
    const Vec3 to = next < path.count ? hits[next].point : end;
    const UnfoldedLeg leg = unfolded_leg(hits, from, material + 1, next, to);
    if (material >= 0) visit(material, arrival, leg.departure);
    Vec3 way = leg.departure;
    for (int k = material + 1; k < next; ++k) {
      const Vec3 behind = hits[k].mirrored(way);
      visit(k, way, behind);
      way = behind;
    }
    arrival = leg.arrival;
    from = to;
    material = next;
  }
}

}  // namespace echopath
