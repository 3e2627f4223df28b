#include "echopath/trace/strata/ray_target_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/bit_sum.h"
#include "echopath/trace/geometry/outer_points.h"
#include "echopath/trace/strata/fit_stratum.h"

namespace echopath {
namespace {

// Strata are the same within this difference of axes and solid angles, relative to the latter.
constexpr double kSameStratum = 1e-6;

bool is_same(const Stratum& a, const Stratum& b) {
  const double size = a.solid_angle();
  return (a.axis - b.axis).squaredNorm() < kSameStratum * size && std::abs(size - b.solid_angle()) < kSameStratum * size &&
         (a.across - b.across).norm() < kSameStratum;
}

}  // namespace

TargetMeshes::TargetMeshes(const Scene& scene, const EmbreeScene& geometry, const SceneObject& of, int index,
                           bool of_what_moves)
    : object(index), node(of.node), name(scene.nodes()[of.node].name), moves(of_what_moves), geometry_(&geometry),
      mesh_ids_(of.mesh_ids) {
  sphere = bounding_sphere([&](uint32_t id) -> const std::vector<Vec3>& { return geometry.vertices(id); }, mesh_ids_);
  BitSum sum;
  for (const uint32_t id : mesh_ids_) {
    const std::vector<Vec3>& own = geometry.vertices(id);
    sum.add(own.size());
    sum.add_bytes(own.data(), own.size() * sizeof(Vec3));
  }
  bits = sum.value();
}

const std::vector<Vec3>& TargetMeshes::vertices() {
  for (; num_together_ < mesh_ids_.size(); ++num_together_) {
    const std::vector<Vec3>& own = geometry_->vertices(mesh_ids_[num_together_]);
    vertices_.insert(vertices_.end(), own.begin(), own.end());
  }
  return vertices_;
}

const std::vector<Vec3>& TargetMeshes::outer_vertices() {
  if (outer_vertices_.empty()) outer_vertices_ = outer_points_of_hull(vertices());
  return outer_vertices_;
}

void TargetMeshes::forget_vertices() {
  vertices_ = std::vector<Vec3>();  // {} would keep its memory
  outer_vertices_ = std::vector<Vec3>();
  num_together_ = 0;
}

std::optional<RayTarget> RayTargetFinder::at_object(TargetMeshes& target) const {
  return target_at(target, input_of(target, {}), target.name, 0,
                   [&]() -> const std::vector<Vec3>& { return target.vertices(); });
}

std::span<const MirrorFrustum> RayTargetFinder::frusta_over(int num_mirrors) const {
  const auto found = std::ranges::equal_range(settings_.frusta, num_mirrors, {}, [](const MirrorFrustum& frustum) {
    return static_cast<int>(frustum.mirrors.size());
  });
  return {found.begin(), found.end()};
}

size_t RayTargetFinder::least_images(const TargetMeshes& target, int num_mirrors) const {
  const auto found = std::ranges::count_if(frusta_over(num_mirrors), [&](const MirrorFrustum& frustum) {
    return frustum.reaches(target.sphere.centre, target.sphere.radius);
  });
  return static_cast<size_t>(std::ceil(static_cast<double>(found) / std::tgamma(num_mirrors + 1.0)));
}

void RayTargetFinder::add_images(TargetMeshes& target, int num_mirrors, std::vector<RayTarget>& images) const {
  std::vector<Vec3> vertices;
  for (const MirrorFrustum& frustum : frusta_over(num_mirrors)) {
    if (!frustum.reaches(target.sphere.centre, target.sphere.radius)) continue;
    const auto images_of_vertices = [&]() -> const std::vector<Vec3>& {
      vertices.clear();
      const auto chain = chain_of(mirrors_, frustum.mirrors);
      for (const Vec3& vertex : target.outer_vertices()) vertices.push_back(image_over_reversed(chain, vertex));
      return vertices;
    };
    std::optional<RayTarget> made =
        target_at(target, input_of(target, frustum.mirrors), name_over(target, frustum), num_mirrors, images_of_vertices);
    if (!made) continue;
    made->moves = made->moves || std::ranges::any_of(frustum.mirrors, [&](int mirror) {
      return !scene_.stands_still(mirrors_[mirror].mesh_id);
    });
    const auto same =
        std::ranges::find_if(images, [&](const RayTarget& other) { return is_same(made->stratum, other.stratum); });
    RayTarget& image = same == images.end() ? images.emplace_back(std::move(*made)) : *same;
    image.sequences.push_back(frustum.sequence);
  }
}

// Returns the sum of the bits of all that a stratum depends on.
uint64_t RayTargetFinder::input_of(const TargetMeshes& target, const std::vector<int>& sequence) const {
  if (!settings_.fitted) return 0;
  BitSum bits;
  bits.add(target.bits);
  bits.add_bytes(target.name.data(), target.name.size());
  bits.add_bytes(settings_.transmitter.data(), sizeof(Vec3));
  bits.add(settings_.may_use_strips);
  for (const int index : sequence) {
    const Mirror& mirror = mirrors_[index];
    bits.add_bytes(mirror.point.data(), sizeof(Vec3));
    bits.add_bytes(mirror.normal.data(), sizeof(Vec3));
    const std::string own_name = name_of(mirror, scene_);  // an ID depends on what else is in the scene
    bits.add_bytes(own_name.data(), own_name.size());
  }
  return bits.value();
}

std::optional<RayTarget> RayTargetFinder::target_at(const TargetMeshes& target, uint64_t input, std::string name,
                                                    int num_mirrors, const Vertices& vertices) const {
  const auto fit = [&] {
    return fit_stratum(vertices(), settings_.transmitter, std::move(name), settings_.may_use_strips ? kManyTurns : 0);
  };
  std::optional<Stratum> stratum = settings_.fitted ? settings_.fitted->find(input, fit) : fit();
  if (!stratum || stratum->solid_angle() > settings_.largest_solid_angle) return std::nullopt;
  stratum->object = target.node;
  stratum->num_mirrors = num_mirrors;
  RayTarget made{std::move(*stratum), target.object, {}, target.moves, weight_of_target(num_mirrors)};
  if (num_mirrors == 0) made.sequences.push_back(kNoMirrors);
  return made;
}

std::string RayTargetFinder::name_over(const TargetMeshes& target, const MirrorFrustum& frustum) const {
  std::string name = target.name;
  for (size_t k = frustum.mirrors.size(); k-- > 0;) {
    name += " over " + name_of(mirrors_[frustum.mirrors[k]], scene_);
  }
  return name;
}

}  // namespace echopath
