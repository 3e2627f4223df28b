#pragma once
// Gives the positions of the meshes of a scene, all or some, and of the antennas of a radar at one time. All code that needs
// these positions takes them from here.
#include <array>
#include <vector>

#include "echopath/posed/mesh_places.h"
#include "echopath/posed/posed_antenna.h"
#include "echopath/scene/mesh/surface_patch.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Holds a scene and the antennas of a radar at one time. Nodes move by the rule of `moved` (motion/motion.h). To pose a
// rigid mesh costs one transform; to pose a deforming mesh takes time for each vertex that is posed. The scene must outlive
// it.
class PosedScene {
 public:
  // Poses all vertices and no antennas; the origin is that of the world. Raises invalid_argument when a motion is not
  // defined at `time` (s), or takes something out of the range of coordinates (base/range_of_coordinates.h).
  PosedScene(const Scene& scene, double time);
  // Poses also the antennas of `radar`, which must outlive it, but of the meshes these alone; no others may be asked for.
  // Relative coordinates count from `origin` (m, world). Raises as the constructor above.
  PosedScene(const Scene& scene, const Radar& radar, const MeshesToPose& meshes, const Vec3& origin, double time);
  // Poses the antennas as the constructor above, but no meshes: add() poses these.
  PosedScene(const Scene& scene, const Radar& radar, const Vec3& origin, double time);
  // Poses the meshes of `places` behind those that it has, which begin the list; only these may be asked for. `nodes` are
  // those that place the new ones.
  void add(const std::shared_ptr<const MeshPlaces>& places, const PlacingNodes& nodes,
           const std::vector<SurfacePatch>& patches);

  std::vector<PosedAntenna> transmitters, receivers;  // relative to the origin
  const std::vector<PosedAntenna>& antennas(bool of_receivers) const { return of_receivers ? receivers : transmitters; }

  double time() const { return time_; }
  uint32_t num_meshes() const { return static_cast<uint32_t>(scene_->meshes().size()); }
  size_t num_posed() const { return linear_.size(); }
  uint32_t mesh_at(size_t place) const { return places_ ? places_->meshes[place] : static_cast<uint32_t>(place); }
  // A point x of the mesh's frame lies at linear * x + translation, relative to the origin.
  const Mat3& linear(uint32_t mesh_id) const { return linear_[at(mesh_id)]; }
  Vec3 translation(uint32_t mesh_id) const { return world_translation(mesh_id) - origin_; }
  const Vec3& world_translation(uint32_t mesh_id) const { return world_translation_[at(mesh_id)]; }
  // Takes normals of the mesh's frame to the world; they are not normalised there. It is made of cofactors, so that normals
  // follow the winding of the triangles through reflections too.
  const Mat3& normal_matrix(uint32_t mesh_id) const { return normal_matrix_[at(mesh_id)]; }

  // Returns the vertices of a mesh in its own frame, m. For a deforming mesh of a scene posed with patches, these are the
  // vertices of its patch alone.
  const std::vector<Vec3>& local_vertices(uint32_t mesh_id) const;
  // Returns unit normals at the vertices of the patch of a smooth deforming mesh, in the frame of the mesh; none for other
  // meshes. They are exact at the corners of the triangles that the patch was made for (SurfacePatch), but not at the other
  // vertices, of which the patch lacks neighbouring triangles.
  const std::vector<Vec3>& deformed_normals(uint32_t mesh_id) const { return deformed_normals_[at(mesh_id)]; }

  // Returns all vertices of a mesh in the world, m. Raises invalid_argument where only a patch of it is posed.
  std::vector<Vec3> world_vertices(uint32_t mesh_id) const;
  // Returns unit normals [V] in world axes of the curved surface that the mesh stands for, by itself or as a part of a
  // larger surface (scene/smooth/smooth.h).
  std::vector<Vec3> world_normals(uint32_t mesh_id) const;
  // Returns the corners of a triangle in the world, m. Raises as world_vertices.
  std::array<Vec3, 3> world_triangle(uint32_t mesh_id, uint32_t triangle_id) const;

 private:
  size_t at(uint32_t mesh_id) const { return places_ ? places_->place[mesh_id] : mesh_id; }
  void place_meshes();
  void place(uint32_t mesh_id, const Transform& world_from_mesh);
  void deform(uint32_t mesh_id, const SurfacePatch& patch);
  void require_whole(uint32_t mesh_id) const;
  Vec3 in_world(uint32_t mesh_id, const Vec3& local) const { return linear(mesh_id) * local + world_translation(mesh_id); }

  const Scene* scene_;
  double time_;
  bool is_in_patches_ = false;  // of deforming meshes only patches are posed
  Vec3 origin_ = Vec3::Zero();
  std::shared_ptr<const MeshPlaces> places_;  // null: all meshes are posed, in their order
  // These are indexed by the place of a mesh (places_).
  std::vector<Mat3> linear_, normal_matrix_;
  std::vector<Vec3> world_translation_;
  std::vector<std::vector<Vec3>> deformed_, deformed_normals_;  // empty where rigid
};

}  // namespace echopath
