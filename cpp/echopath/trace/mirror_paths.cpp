#include "echopath/trace/mirror_paths.h"

#include <cmath>
#include <optional>

namespace echopath {
namespace {

constexpr double kEdgeTolerance = 1e-6;    // m: how far outside its polygon a specular point may lie
constexpr int64_t kMaxSequences = 100000;  // mirror sequences tried; longer ones are left out beyond
constexpr int kImageStratum = 255;

// Barycentric hit of a point of the plane in a mirror's mesh.
std::optional<Hit> locate(const EmbreeScene& geometry, const Scene& scene, const Mirror& mirror, const Vec3& point) {
  const auto num_triangles = static_cast<uint32_t>(scene.node_of(mirror.mesh_id).mesh->triangles().size());
  for (uint32_t i = 0; i < num_triangles; ++i) {
    const auto [a, b, c] = geometry.corners(mirror.mesh_id, i);
    const Vec3 cross = (b - a).cross(c - a);
    const double twice_area = cross.norm();
    const Vec3 normal = cross / twice_area;
    const auto height = [&](const Vec3& from, const Vec3& to) {  // distance inside an edge, m
      return normal.dot((to - from).cross(point - from)) / (to - from).norm();
    };
    if (height(a, b) < -kEdgeTolerance || height(b, c) < -kEdgeTolerance || height(c, a) < -kEdgeTolerance) continue;
    const double u = normal.dot((a - c).cross(point - c)) / twice_area, v = normal.dot((b - a).cross(point - a)) / twice_area;
    return Hit{mirror.mesh_id, i, static_cast<float>(u), static_cast<float>(v)};
  }
  return std::nullopt;
}

class ImageSearch {
 public:
  ImageSearch(const EmbreeScene& geometry, const Scene& scene, const std::vector<Mirror>& mirrors, const SbrSettings& settings,
              PathBlock& block)
      : geometry_(geometry), scene_(scene), mirrors_(mirrors), settings_(settings), block_(block) {}

  void extend() {
    const int depth = static_cast<int>(sequence_.size());
    if (depth > 0) try_sequence();
    if (depth == settings_.max_bounces) return;
    for (int next = 0; next < static_cast<int>(mirrors_.size()); ++next) {
      if (depth > 0 && sequence_.back() == next) continue;
      if (++tried_ > kMaxSequences) return;
      sequence_.push_back(next);
      extend();
      sequence_.pop_back();
    }
  }

 private:
  const Mirror& mirror(size_t k) const { return mirrors_[static_cast<size_t>(sequence_[k])]; }

  void try_sequence() {
    if (!find_points() || !sees_all()) return;
    std::vector<Hit> hits;
    for (size_t k = 0; k < points_.size(); ++k) {
      const std::optional<Hit> hit = locate(geometry_, scene_, mirror(k), points_[k]);
      if (!hit) return;
      hits.push_back(*hit);
    }
    const std::complex<double> weight = (settings_.is_polarized ? 1.0 : field()) * corner_share();
    if (std::abs(weight) == 0) return;
    block_.add(hits.data(), static_cast<int>(hits.size()), 0, weight, kImageStratum);
    if (settings_.is_polarized) block_.set_jones(jones_matrix());
    block_.statistics.num_hits += static_cast<int64_t>(hits.size());
  }

  // Specular points from the receiver backwards through the images of the transmitter.
  bool find_points() {
    const size_t n = sequence_.size();
    std::vector<Vec3> images(n + 1);
    images[0] = settings_.transmitter;
    for (size_t k = 0; k < n; ++k) images[k + 1] = mirror(k).image(images[k]);
    points_.assign(n, Vec3::Zero());
    Vec3 target = settings_.receiver;
    for (size_t k = n; k-- > 0;) {
      const double behind = mirror(k).signed_distance(images[k + 1]), before = mirror(k).signed_distance(target);
      const bool at_edge = std::abs(before) < kEdgeTolerance;  // the next bounce lies on this plane too
      if (!at_edge && behind * before >= 0) return false;
      points_[k] = at_edge ? target : Vec3(target + before / (before - behind) * (images[k + 1] - target));
      target = points_[k];
    }
    return true;
  }

  // Off all the planes that meet in this point, toward the side of the target.
  Vec3 lifted_toward(size_t k, const Vec3& target) const {
    Vec3 point = points_[k];
    for (size_t other = 0; other < points_.size(); ++other) {
      if ((points_[other] - points_[k]).norm() > kEdgeTolerance) continue;
      const Mirror& plane = mirror(other);
      point = geometry_.lifted(point, plane.signed_distance(target) >= 0 ? plane.normal : Vec3(-plane.normal));
    }
    return point;
  }

  bool sees_all() {
    const size_t n = points_.size();
    for (size_t k = 0; k <= n; ++k) {
      const Vec3 from = k == 0 ? settings_.transmitter : lifted_toward(k - 1, k == n ? settings_.receiver : points_[k]);
      const Vec3 to = k == n ? settings_.receiver : lifted_toward(k, k == 0 ? settings_.transmitter : points_[k - 1]);
      if (k > 0 && k < n && (points_[k] - points_[k - 1]).norm() < kEdgeTolerance) continue;
      ++block_.statistics.num_queries;
      if (geometry_.occluded(from, to)) return false;
    }
    return true;
  }

  // Where bounces coincide the direction between them is that of the chain of reflections.
  Vec3 departure() const {
    Vec3 image = settings_.receiver;
    for (size_t k = points_.size(); k-- > 0;) image = mirror(k).image(image);
    return (image - settings_.transmitter).normalized();
  }

  JonesMatrix jones_matrix() const {
    Vec3 direction = departure();
    FieldPair fields = launched_fields(direction);
    for (size_t k = 0; k < points_.size(); ++k) {
      const Vec3 normal = direction.dot(mirror(k).normal) < 0 ? mirror(k).normal : Vec3(-mirror(k).normal);
      const double cos_incidence = -direction.dot(normal);
      const ModeCoefficients modes = mode_coefficients(*mirror(k).material, settings_.frequency, cos_incidence);
      const double coherent = respond(*mirror(k).material, settings_.frequency, cos_incidence, PolarizationMode::kTe).coherent;
      for (FieldVector& field : fields) field = coherent * reflected_field(field, direction, normal, modes);
      direction = mirror(k).reflect(direction);
    }
    return arriving_components(fields, direction);
  }

  std::complex<double> field() const {
    std::complex<double> product = 1.0;
    Vec3 direction = departure();
    for (size_t k = 0; k < points_.size(); ++k) {
      const Vec3& normal = mirror(k).normal;
      const SurfaceResponse response = respond(*mirror(k).material, settings_.frequency, std::abs(direction.dot(normal)),
                                               polarization_mode(settings_.polarization, direction, normal));
      product *= response.gamma * response.coherent;
      direction = mirror(k).reflect(direction);
    }
    return product;
  }

  double corner_share() const {
    double share = 1.0;
    int run = 1;
    for (size_t k = 1; k < points_.size(); ++k) {
      run = (points_[k] - points_[k - 1]).norm() < kEdgeTolerance ? run + 1 : 1;
      share /= run;
    }
    return share;
  }

  const EmbreeScene& geometry_;
  const Scene& scene_;
  const std::vector<Mirror>& mirrors_;
  const SbrSettings& settings_;
  PathBlock& block_;
  std::vector<int> sequence_;
  std::vector<Vec3> points_;
  int64_t tried_ = 0;
};

}  // namespace

void add_mirror_paths(const EmbreeScene& geometry, const Scene& scene, const std::vector<Mirror>& mirrors,
                      const SbrSettings& settings, PathBlock& block) {
  ImageSearch(geometry, scene, mirrors, settings, block).extend();
}

}  // namespace echopath
