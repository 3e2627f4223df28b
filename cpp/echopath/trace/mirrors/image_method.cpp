#include "echopath/trace/mirrors/image_method.h"

#include <cmath>
#include <utility>

namespace echopath {
namespace {

// A path through an edge belongs to the sequences of mirrors on both sides of it: those of a receiver a little beside the
// true one, and of one as far on the other side. No scene is likely to be built along the direction of the shift.
constexpr double kAside = 1e-5;  // m
const Vec3 kAsideDirection = Vec3(0.6180339887, 0.7320508076, -0.2915026221).normalized();

}  // namespace

std::optional<ImagePath> ImageMethod::path_over(const std::vector<int>& sequence) {
  sequence_ = sequence;
  int num_found = 0;
  for (const double side : {1.0, -1.0}) num_found += follow(settings_.receiver + side * kAside * kAsideDirection) ? 1 : 0;
  if (num_found == 0) return std::nullopt;
  ImagePath path{hits_, points_, 0.5 * num_found, {}};
  if (settings_.is_polarized) path.jones = jones_matrix();
  else path.weight = field() * (0.5 * num_found);
  if (std::abs(path.weight) == 0) return std::nullopt;
  return path;
}

// Follows the sequence to a receiver; sets hits_ and returns true where the path gets through.
bool ImageMethod::follow(const Vec3& receiver) {
  if (!find_points(sequence_, receiver, points_)) return false;
  std::vector<Hit> hits;
  for (size_t k = 0; k < points_.size(); ++k) {
    const Vec3 from = k == 0 ? settings_.transmitter : lifted_toward(k - 1, points_[k]);
    const std::optional<Hit> hit = locator_.locate(mirror(k), from, points_[k]);
    if (!hit) return false;
    hits.push_back(*hit);
  }
  if (!sees_all(receiver)) return false;
  hits_ = std::move(hits);
  return true;
}

// Goes from the receiver backwards through the images of the transmitter.
bool ImageMethod::find_points(const std::vector<int>& sequence, const Vec3& receiver, std::vector<Vec3>& points) const {
  const size_t n = sequence.size();
  const auto plane = [&](size_t k) -> const Mirror& { return mirrors_[static_cast<size_t>(sequence[k])]; };
  std::vector<Vec3> images(n + 1);
  images[0] = settings_.transmitter;
  for (size_t k = 0; k < n; ++k) images[k + 1] = plane(k).image(images[k]);
  points.assign(n, Vec3::Zero());
  Vec3 target = receiver;
  for (size_t k = n; k-- > 0;) {
    const double behind = plane(k).height(images[k + 1]), before = plane(k).height(target);
    if (behind * before >= 0) return false;
    points[k] = target + before / (before - behind) * (images[k + 1] - target);
    target = points[k];
  }
  return true;
}

// Lifts the point off all the planes that meet in it, toward the side of the target.
Vec3 ImageMethod::lifted_toward(size_t k, const Vec3& target) const {
  Vec3 point = points_[k];
  for (size_t other = 0; other < points_.size(); ++other) {
    if ((points_[other] - points_[k]).norm() > kAtEdge) continue;
    const Mirror& plane = mirror(other);
    point = geometry_.lifted(point, plane.height(target) >= 0 ? plane.normal : Vec3(-plane.normal));
  }
  return point;
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
  Vec3 image = settings_.receiver;
  for (size_t k = points_.size(); k-- > 0;) image = mirror(k).image(image);
  return (image - settings_.transmitter).normalized();
}

SheetSide ImageMethod::side_met(size_t k, const Vec3& direction) const {
  return direction.dot(mirror(k).normal) < 0 ? SheetSide::kFront : SheetSide::kBack;
}

JonesMatrix ImageMethod::jones_matrix() const {
  Vec3 direction = departure();
  FieldPair fields = launched_fields(direction);
  for (size_t k = 0; k < points_.size(); ++k) {
    const Vec3 normal = direction.dot(mirror(k).normal) < 0 ? mirror(k).normal : Vec3(-mirror(k).normal);
    const double cos_incidence = -direction.dot(normal);
    const SurfaceModel model(*mirror(k).material, settings_.frequency, side_met(k, direction));
    const ModeCoefficients modes = model.modes(cos_incidence);
    const double coherent = model.respond(cos_incidence, PolarizationMode::kTe).coherent;
    for (FieldVector& field : fields) field = coherent * reflected_field(field, direction, normal, modes);
    direction = mirror(k).mirrored(direction);
  }
  return arriving_components(fields, direction);
}

std::complex<double> ImageMethod::field() const {
  std::complex<double> product = 1.0;
  Vec3 direction = departure();
  for (size_t k = 0; k < points_.size(); ++k) {
    const Vec3& normal = mirror(k).normal;
    const PolarizationMode mode = polarization_mode(settings_.polarization, direction, normal);
    const SurfaceModel model(*mirror(k).material, settings_.frequency, side_met(k, direction));
    const SurfaceResponse response = model.respond(std::abs(direction.dot(normal)), mode);
    product *= response.gamma * response.coherent *
               mirror_sign(*mirror(k).material, mode, settings_.polarization, direction, normal);
    direction = mirror(k).mirrored(direction);
  }
  return product;
}

void add_path(const ImagePath& path, PathBlock& block) {
  const int count = static_cast<int>(path.hits.size());
  block.add(path.hits.data(), count, 0, std::complex<float>(path.weight), kNoStratum);
  if (path.jones) block.set_jones(*path.jones);
  block.statistics.num_hits += count;
}

}  // namespace echopath
