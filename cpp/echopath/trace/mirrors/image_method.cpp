#include "echopath/trace/mirrors/image_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "echopath/em/polarization/mirrored_fields.h"
#include "echopath/record/near_antenna.h"
#include "echopath/trace/mirrors/coplanar_mirrors.h"

namespace echopath {
namespace {

// A path through an edge belongs to the sequences of mirrors on both sides of it: those of a receiver a little beside the
// true one, and of one as far on the other side. No scene is likely to be built along the direction of the shift.
constexpr double kAside = 1e-5;  // m
const Vec3 kAsideDirection = Vec3(0.6180339887, 0.7320508076, -0.2915026221).normalized();

}  // namespace

std::optional<ImagePath> ImageMethod::path_over(const std::vector<int>& sequence) {
  sequence_ = sequence;
  ImagePath path;
  for (const double side : {1.0, -1.0}) {
    if (follow(settings_.receiver + side * kAside * kAsideDirection, path)) path.share += 0.5;
  }
  if (path.share == 0.0) return std::nullopt;
  path.weight = settings_.is_polarized ? 1.0 : field();
  if (settings_.is_polarized) path.jones = jones_matrix();
  if (std::abs(path.weight) == 0) return std::nullopt;
  return path;
}

// Follows the sequence to a receiver; sets hits and points of the path and returns true where it gets through.
bool ImageMethod::follow(const Vec3& receiver, ImagePath& path) {
  if (!find_points_toward(receiver, sequence_, points_)) return false;
  if (!reaches_antenna((points_.front() - settings_.transmitter).norm()) ||
      !reaches_antenna((points_.back() - settings_.receiver).norm()))
    return false;
  std::vector<Hit> hits;
  Vec3 from = settings_.transmitter;
  for (size_t k = 0; k < points_.size(); ++k) {
    // Of bounces at a common edge one looks at all from where the wave comes.
    if (k > 0 && (points_[k] - points_[k - 1]).norm() >= kAtEdge) from = lifted_toward(k - 1, points_[k]);
    const std::optional<Hit> hit = locator_.locate(chain_of(mirrors_, sequence_)[k], from, points_[k]);
    if (!hit || hit_in_front(mirrors_, sequence_[k], from, points_[k])) return false;
    hits.push_back(*hit);
  }
  if (!sees_all(receiver)) return false;
  path.hits = std::move(hits);
  path.points = points_;
  return true;
}

bool ImageMethod::find_points(const std::vector<int>& sequence, std::vector<Vec3>& points) const {
  return std::ranges::any_of(std::array{0.0, 1.0, -1.0}, [&](double side) {
    return find_points_toward(settings_.receiver + side * kAside * kAsideDirection, sequence, points);
  });
}

bool ImageMethod::find_points_toward(const Vec3& receiver, const std::vector<int>& sequence,
                                     std::vector<Vec3>& points) const {
  points.resize(sequence.size());
  return !find_reflections(chain_of(mirrors_, sequence), settings_.transmitter, receiver, points.data());
}

Vec3 ImageMethod::lifted_toward(size_t k, const Vec3& target) const {
  return lifted_off_mirrors(chain_of(mirrors_, sequence_), points_.data(), k, target, kAtEdge, geometry_.lift());
}

bool ImageMethod::sees_all(const Vec3& receiver) {
  const size_t n = points_.size();
  for (size_t k = 0; k <= n; ++k) {
    const Vec3 from = k == 0 ? settings_.transmitter : lifted_toward(k - 1, k == n ? receiver : points_[k]);
    const Vec3 to = k == n ? receiver : lifted_toward(k, k == 0 ? settings_.transmitter : points_[k - 1]);
    if (k > 0 && k < n && (points_[k] - points_[k - 1]).norm() < kAtEdge) continue;
    ++num_queries_;
    if (geometry_.occluded(from, to)) return false;
  }
  return true;
}

// Returns the departure of the path to the true receiver.
Vec3 ImageMethod::departure() const {
  const Vec3 image = image_over_reversed(chain_of(mirrors_, sequence_), settings_.receiver);
  return (image - settings_.transmitter).normalized();
}

// Returns the model of a mirror, from the side that a wave along `direction` meets.
SurfaceModel ImageMethod::model_of(const Mirror& mirror, const Vec3& direction) const {
  const SheetSide side = direction.dot(mirror.normal) < 0 ? SheetSide::kFront : SheetSide::kBack;
  return {*mirror.material, settings_.frequency, side};
}

JonesMatrix ImageMethod::jones_matrix() const {
  Vec3 direction = departure();
  FieldPair fields = launched_fields(direction);
  for (const int index : sequence_)
    carry_over_mirror(fields, direction, mirrors_[index].normal, model_of(mirrors_[index], direction));
  return arriving_components(fields, direction);
}

std::complex<double> ImageMethod::field() const {
  std::complex<double> product = 1.0;
  Vec3 direction = departure();
  for (const int index : sequence_) {
    const Mirror& mirror = mirrors_[index];
    const SurfaceModel model = model_of(mirror, direction);
    const SurfaceResponse response = respond_as_mirror(model, settings_.polarization, direction, mirror.normal);
    product *= response.gamma * response.coherent;
    direction = mirror.mirrored(direction);
  }
  return product;
}

void add_path(const ImagePath& path, PathBlock& block) {
  const int count = static_cast<int>(path.hits.size());
  block.add(path.hits.data(), count, 0, std::complex<float>(path.weight * path.share), kNoStratum);
  if (path.jones) block.set_jones(*path.jones);
  block.statistics.num_hits += count;
}

}  // namespace echopath
