#pragma once
// Holds a block of a record's paths with all that does not depend on time: its hits stand in the frames of their meshes.
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "echopath/em/surface/diffuse_lobe.h"
#include "echopath/replay/posed/path_geometry.h"
#include "echopath/replay/posed/touched_meshes.h"
#include "echopath/scene/scene_edges.h"

namespace echopath {

// Holds unit vertex normals by mesh ID; null where the mesh is not smooth, or deforms and has no patch.
using NormalsOfMeshes = std::vector<std::shared_ptr<const std::vector<Vec3>>>;

struct LocalPaths {
  std::vector<LocalPath> paths;
  int longest = 0;  // hits of a path at most

  // The paths point into these arrays.
  std::vector<LocalHit> hits;
  std::deque<std::array<Vec3, 3>> normals;
};

// Its functions are thread-safe.
class PathPreparer {
 public:
  // The record must outlive it. `meshes` hold at least those that its paths touch (touched_meshes.h), the same with which
  // the scenes are posed that pose its paths; no others may be asked for.
  PathPreparer(const Paths& paths, MeshesToPose meshes);
  PathPreparer(const PathPreparer&) = delete;
  PathPreparer& operator=(const PathPreparer&) = delete;
  // Returns the paths of these indices, with their hits in the order in which they were traced.
  LocalPaths operator()(std::span<const int64_t> indices) const;
  // Returns a hit in the frame of its mesh, without its normals.
  LocalHit hit(const Hit& hit) const;
  // Returns a hit with its normals, which are stored in `normals`.
  LocalHit hit(const Hit& hit, std::deque<std::array<Vec3, 3>>& normals) const;
  // Returns a hit on an edge.
  LocalHit edge_hit(const Hit& hit, int num_pieces) const;
  bool is_mirror(uint32_t mesh_id) const { return at(mesh_id).is_mirror; }
  // Returns whether a specular hit on the mesh is replayed by images: that of a flagged mirror, or of a path of the image
  // method.
  bool is_image(uint32_t mesh_id, uint16_t stratum) const { return stratum == kNoStratum || is_mirror(mesh_id); }
  bool may_stretch(uint32_t mesh_id) const { return at(mesh_id).may_stretch; }
  // Returns whether each triangle of the mesh stays a plane in the mesh's frame: the mesh is neither smooth nor deforming.
  bool is_plane(uint32_t mesh_id) const { return at(mesh_id).is_plane; }
  // Returns the mean area in m^2 of the triangles of a mesh, with the scale that it has at the trace and the shape that it
  // has at rest; it is kNoFacets where the mesh is smooth or a plane.
  double facet_area(uint32_t mesh_id) const { return at(mesh_id).facet_area; }
  // Finds the normals at the corners of the hit's triangle; returns false where the mesh is not smooth or the crease guard
  // refuses this triangle.
  bool find_smooth_normals(const LocalHit& hit, std::array<Vec3, 3>& out) const;
  // Returns the normals of meshes as the rays saw them: at rest, or deformed as at the trace, and then normals outside of
  // the patch are zero.
  const NormalsOfMeshes& smooth_normals() const { return smooth_normals_; }
  const MeshesToPose& meshes() const { return meshes_; }
  const PosedScene& at_trace() const { return at_trace_; }
  // Returns the inverse of the matrix that the mesh had at the time of the trace.
  const Mat3& mesh_from_trace(uint32_t mesh_id) const { return at(mesh_id).mesh_from_trace; }
  const Paths& paths() const { return paths_; }
  // Returns the lobes by mesh ID; empty where all are Lambert's.
  const std::vector<DiffuseLobe>& lobes() const { return lobes_; }
  // Returns whether a path scatters diffusely with another lobe than Lambert's.
  bool has_lobe(int64_t path) const { return !lobes_.empty() && meets_lobe(path); }

 private:
  // Holds the shape of a mesh as the rays saw it: vertices are those of the patch where it deforms.
  struct Shape {
    const Triangle* triangles;
    const Vec3* vertices;
    bool deforms;
  };
  // Holds what does not depend on time of one mesh.
  struct MeshAtTrace {
    Shape shape;
    bool is_mirror, may_stretch, is_plane;
    Mat3 mesh_from_trace;
    double facet_area;
  };
  const MeshAtTrace& at(uint32_t mesh_id) const { return of_meshes_[meshes_.places->place[mesh_id]]; }
  MeshAtTrace mesh_at_trace(uint32_t mesh_id) const;
  Shape shape_at_trace(uint32_t mesh_id) const;
  NormalsOfMeshes::value_type normals_at_trace(uint32_t mesh_id) const;
  double facet_area_at_trace(uint32_t mesh_id) const;
  LocalPath local_path(int64_t index, LocalPaths& block) const;
  bool meets_lobe(int64_t path) const;

  const Paths& paths_;
  MeshesToPose meshes_;
  PosedScene at_trace_;
  std::vector<MeshAtTrace> of_meshes_;  // by their places
  NormalsOfMeshes smooth_normals_;
  std::vector<DiffuseLobe> lobes_;
  std::optional<SceneEdges> edges_;  // where the trace looked for them
};

}  // namespace echopath
