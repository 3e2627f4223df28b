#include "echopath/trace/mirror_paths.h"

#include <cmath>
#include <optional>

#include "echopath/trace/mirror_beams.h"

namespace echopath {
namespace {

constexpr double kAtEdge = 1e-4;      // m: bounces this near to each other are at a common edge
constexpr size_t kMaxBeams = 20000;   // sequences of mirrors tried; the longest are left out beyond
// A path through an edge belongs to the sequences of mirrors on both sides of it: those of a receiver a little beside the true
// one, and of one as far on the other side. In no direction that a scene is likely to be built along.
constexpr double kAside = 1e-5;  // m
const Vec3 kAsideDirection = Vec3(0.6180339887, 0.7320508076, -0.2915026221).normalized();

class ImageSearch {
 public:
  ImageSearch(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings, PathBlock& block)
      : geometry_(geometry), mirrors_(mirrors), settings_(settings), block_(block) {}

  void run() {
    for (const Beam& beam : find_beams(settings_.transmitter, mirrors_, settings_.max_bounces, kMaxBeams)) {
      if (!beam.reaches(settings_.receiver, kAtEdge)) continue;
      sequence_ = beam.mirrors;
      try_sequence();
    }
  }

 private:
  const Mirror& mirror(size_t k) const { return mirrors_[static_cast<size_t>(sequence_[k])]; }

  void try_sequence() {
    int num_found = 0;
    for (const double side : {1.0, -1.0}) num_found += follow(settings_.receiver + side * kAside * kAsideDirection) ? 1 : 0;
    if (num_found == 0) return;
    const std::complex<double> weight = (settings_.is_polarized ? 1.0 : field()) * (0.5 * num_found);
    if (std::abs(weight) == 0) return;
    block_.add(hits_.data(), static_cast<int>(hits_.size()), 0, std::complex<float>(weight), kNoStratum);
    if (settings_.is_polarized) block_.set_jones(jones_matrix());
    block_.statistics.num_hits += static_cast<int64_t>(hits_.size());
  }

  // To a receiver there; sets hits_ where it gets through.
  bool follow(const Vec3& receiver) {
    if (!find_points(receiver) || !sees_all(receiver)) return false;
    std::vector<Hit> hits;
    for (size_t k = 0; k < points_.size(); ++k) {
      const std::optional<Hit> hit = mirror(k).mesh.locate(points_[k]);
      if (!hit) return false;
      hits.push_back(*hit);
    }
    hits_ = std::move(hits);
    return true;
  }

  // Specular points from the receiver backwards through the images of the transmitter.
  bool find_points(const Vec3& receiver) {
    const size_t n = sequence_.size();
    std::vector<Vec3> images(n + 1);
    images[0] = settings_.transmitter;
    for (size_t k = 0; k < n; ++k) images[k + 1] = mirror(k).image(images[k]);
    points_.assign(n, Vec3::Zero());
    Vec3 target = receiver;
    for (size_t k = n; k-- > 0;) {
      const double behind = mirror(k).signed_distance(images[k + 1]), before = mirror(k).signed_distance(target);
      if (behind * before >= 0) return false;
      points_[k] = target + before / (before - behind) * (images[k + 1] - target);
      target = points_[k];
    }
    return true;
  }

  // Off all the planes that meet in this point, toward the side of the target.
  Vec3 lifted_toward(size_t k, const Vec3& target) const {
    Vec3 point = points_[k];
    for (size_t other = 0; other < points_.size(); ++other) {
      if ((points_[other] - points_[k]).norm() > kAtEdge) continue;
      const Mirror& plane = mirror(other);
      point = geometry_.lifted(point, plane.signed_distance(target) >= 0 ? plane.normal : Vec3(-plane.normal));
    }
    return point;
  }

  bool sees_all(const Vec3& receiver) {
    const size_t n = points_.size();
    for (size_t k = 0; k <= n; ++k) {
      const Vec3 from = k == 0 ? settings_.transmitter : lifted_toward(k - 1, k == n ? receiver : points_[k]);
      const Vec3 to = k == n ? receiver : lifted_toward(k, k == 0 ? settings_.transmitter : points_[k - 1]);
      if (k > 0 && k < n && (points_[k] - points_[k - 1]).norm() < kAtEdge) continue;
      ++block_.statistics.num_queries;
      if (geometry_.occluded(from, to)) return false;
    }
    return true;
  }

  // Of the path to the true receiver.
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
      const PolarizationMode mode = polarization_mode(settings_.polarization, direction, normal);
      const SurfaceResponse response = respond(*mirror(k).material, settings_.frequency, std::abs(direction.dot(normal)), mode);
      product *= response.gamma * response.coherent *
                 mirror_sign(*mirror(k).material, mode, settings_.polarization, direction, normal);
      direction = mirror(k).reflect(direction);
    }
    return product;
  }

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const SbrSettings& settings_;
  PathBlock& block_;
  std::vector<int> sequence_;
  std::vector<Vec3> points_;
  std::vector<Hit> hits_;
};

}  // namespace

void add_mirror_paths(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings,
                      PathBlock& block) {
  ImageSearch(geometry, mirrors, settings, block).run();
}

}  // namespace echopath
