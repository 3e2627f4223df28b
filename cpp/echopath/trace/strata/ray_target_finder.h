#pragma once
// Fits the strata of one object and of its images over mirrors.
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "echopath/trace/strata/ray_targets.h"
#include "echopath/trace/strata/scene_objects.h"

namespace echopath {

// Holds the meshes of an object, or of a part of one, with what its strata depend on.
class TargetMeshes {
 public:
  // `index`: of the target (RayTarget::object); `of_what_moves`: RayTarget::moves. The geometry must outlive it.
  TargetMeshes(const Scene& scene, const EmbreeScene& geometry, const SceneObject& of, int index, bool of_what_moves);

  // Returns the vertices of all its meshes, which are put together when they are first asked for.
  const std::vector<Vec3>& vertices();
  // Returns those that its outline may depend on, from wherever it is seen. They are found when they are first asked for.
  const std::vector<Vec3>& outer_vertices();
  // Gives their memory back; they are put together again when they are asked for.
  void forget_vertices();

  int object, node;
  std::string name;
  Sphere sphere;
  bool moves;
  uint64_t bits = 0;  // sum of those of the vertices

 private:
  const EmbreeScene* geometry_;
  std::vector<uint32_t> mesh_ids_;
  std::vector<Vec3> vertices_;  // of the first meshes
  size_t num_together_ = 0;
  std::vector<Vec3> outer_vertices_;
};

// All arguments must outlive it.
class RayTargetFinder {
 public:
  RayTargetFinder(const Scene& scene, const std::vector<Mirror>& mirrors, const RayTargetSettings& settings)
      : scene_(scene), mirrors_(mirrors), settings_(settings) {}

  // Returns the object itself as a target; nothing where no stratum holds it.
  std::optional<RayTarget> at_object(TargetMeshes& target) const;
  // Returns the most mirrors of any frustum.
  int most_mirrors() const {
    return settings_.frusta.empty() ? 0 : static_cast<int>(settings_.frusta.back().mirrors.size());
  }
  // Returns how many images frusta over so many mirrors may show, where those over the same mirrors in all orders are one.
  size_t least_images(const TargetMeshes& target, int num_mirrors) const;
  // Appends targets at each image that a frustum over so many mirrors may show to those over fewer.
  void add_images(TargetMeshes& target, int num_mirrors, std::vector<RayTarget>& images) const;

 private:
  std::span<const MirrorFrustum> frusta_over(int num_mirrors) const;
  using Vertices = std::function<const std::vector<Vec3>&()>;
  uint64_t input_of(const TargetMeshes& target, const std::vector<int>& sequence) const;
  std::optional<RayTarget> target_at(const TargetMeshes& target, uint64_t input, std::string name, int num_mirrors,
                                     const Vertices& vertices) const;
  std::string name_over(const TargetMeshes& target, const MirrorFrustum& frustum) const;

  const Scene& scene_;
  const std::vector<Mirror>& mirrors_;
  const RayTargetSettings& settings_;
};

}  // namespace echopath
