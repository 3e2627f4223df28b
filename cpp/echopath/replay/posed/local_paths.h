#pragma once
// Holds a block of a record's paths with all that does not depend on time: its hits stand in the frames of their meshes.
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "echopath/em/surface/diffuse_lobe.h"
#include "echopath/replay/posed/hit_patches.h"
#include "echopath/replay/posed/path_geometry.h"
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
  // The record must outlive it. `patches` are those of its deforming meshes (hit_patches.h), the same with which the scenes
  // are posed that pose its paths.
  PathPreparer(const Paths& paths, std::vector<SurfacePatch> patches);
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
  bool is_mirror(uint32_t mesh_id) const { return mesh_is_mirror_[mesh_id] != 0; }
  // Returns whether a specular hit on the mesh is replayed by images: that of a flagged mirror, or of a path of the image
  // method.
  bool is_image(uint32_t mesh_id, uint16_t stratum) const { return stratum == kNoStratum || is_mirror(mesh_id); }
  bool may_stretch(uint32_t mesh_id) const { return mesh_may_stretch_[mesh_id] != 0; }
  // Returns whether each triangle of the mesh stays a plane in the mesh's frame: the mesh is neither smooth nor deforming.
  bool is_plane(uint32_t mesh_id) const { return mesh_is_plane_[mesh_id] != 0; }
  // Returns the mean area in m^2 of the triangles of a mesh, with the scale that it has at the trace and the shape that it
  // has at rest; it is kNoFacets where the mesh is smooth or a plane.
  double facet_area(uint32_t mesh_id) const { return facet_area_[mesh_id]; }
  // Finds the normals at the corners of the hit's triangle; returns false where the mesh is not smooth or the crease guard
  // refuses this triangle.
  bool find_smooth_normals(const LocalHit& hit, std::array<Vec3, 3>& out) const;
  // Returns the normals of meshes as the rays saw them: at rest, or deformed as at the trace, and then normals outside of
  // the patch are zero.
  const NormalsOfMeshes& smooth_normals() const { return smooth_normals_; }
  const std::vector<SurfacePatch>& patches() const { return patches_; }
  const PosedScene& at_trace() const { return at_trace_; }
  // Returns the inverse of the matrix that the mesh had at the time of the trace.
  const Mat3& mesh_from_trace(uint32_t mesh_id) const { return mesh_from_trace_[mesh_id]; }
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
  Shape shape_at_trace(uint32_t mesh_id) const;
  NormalsOfMeshes::value_type normals_at_trace(uint32_t mesh_id) const;
  double facet_area_at_trace(uint32_t mesh_id) const;
  LocalPath local_path(int64_t index, LocalPaths& block) const;
  bool meets_lobe(int64_t path) const;

  const Paths& paths_;
  std::vector<SurfacePatch> patches_;                                       // by mesh ID
  std::vector<uint8_t> mesh_is_mirror_, mesh_may_stretch_, mesh_is_plane_;  // by mesh ID
  PosedScene at_trace_;
  std::vector<Shape> shapes_;          // by mesh ID
  std::vector<Mat3> mesh_from_trace_;  // by mesh ID
  NormalsOfMeshes smooth_normals_;
  std::vector<double> facet_area_;  // by mesh ID
  std::vector<DiffuseLobe> lobes_;
  std::optional<SceneEdges> edges_;  // where the trace looked for them
};

}  // namespace echopath
