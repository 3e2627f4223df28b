#pragma once
// Follows one sequence of planes from transmitter to receiver by the image method.
#include <complex>
#include <optional>
#include <vector>

#include "echopath/em/surface/surface_response.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/mirrors/mirrors.h"
#include "echopath/trace/sbr/sbr_settings.h"

namespace echopath {

inline constexpr double kAtEdge = 1e-4;  // m: bounces this near to each other are at a common edge

// Finds where on a mirror a point of its plane lies, as a wave sees it that comes from `from`.
class PointLocator {
 public:
  virtual ~PointLocator() = default;
  virtual std::optional<Hit> locate(const Mirror& mirror, const Vec3& from, const Vec3& point) const = 0;
};

// Looks the point up in the triangles of the mirror.
class MeshLocator final : public PointLocator {
 public:
  std::optional<Hit> locate(const Mirror& mirror, const Vec3&, const Vec3& point) const override {
    return mirror.mesh.locate(point);
  }
};

// Describes a path over planes alone: its hits, the points where it meets the planes, and its weight.
struct ImagePath {
  std::vector<Hit> hits;
  std::vector<Vec3> points;     // m
  std::complex<double> weight;  // without the share, and without the coefficients where polarised
  double share = 0.0;  // of the field, that the sequence has: half of it for a path through an edge (mirror_paths.h)
  std::optional<JonesMatrix> jones;  // where polarised
};

// All must outlive it.
class ImageMethod {
 public:
  ImageMethod(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const PointLocator& locator,
              const SbrSettings& settings)
      : geometry_(geometry), mirrors_(mirrors), locator_(locator), settings_(settings) {}
  // Returns the path over the mirrors of these indices, in travel order; nothing where there is none.
  std::optional<ImagePath> path_over(const std::vector<int>& sequence);
  // Finds the specular points on the planes, wherever these end; returns false where there are none. Of a path through an
  // edge they are those toward a receiver a little beside the true one.
  bool find_points(const std::vector<int>& sequence, std::vector<Vec3>& points) const;
  int64_t num_queries() const { return num_queries_; }

 private:
  bool find_points_toward(const Vec3& receiver, const std::vector<int>& sequence, std::vector<Vec3>& points) const;
  bool follow(const Vec3& receiver, ImagePath& path);
  Vec3 lifted_toward(size_t k, const Vec3& target) const;
  bool sees_all(const Vec3& receiver);
  Vec3 departure() const;
  SurfaceModel model_of(const Mirror& mirror, const Vec3& direction) const;
  JonesMatrix jones_matrix() const;
  std::complex<double> field() const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const PointLocator& locator_;
  const SbrSettings& settings_;
  int64_t num_queries_ = 0;
  std::vector<int> sequence_;
  std::vector<Vec3> points_;
};

// Adds an image path with its share to a block.
void add_path(const ImagePath& path, PathBlock& block);

}  // namespace echopath
