#include "cpp/support/slow_images.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace echopath::testing {
namespace {

constexpr double kUnsure = 1e-6;    // m
constexpr double kOwnPlane = 1e-9;  // m: a leg begins and ends on rectangles that do not block it

struct Plane {
  Vec3 corner, normal, along_a, along_b;  // unit vectors
  double length_a, length_b;

  explicit Plane(const MirrorRectangle& r)
      : corner(r.corner), normal(r.a.cross(r.b).normalized()), along_a(r.a.normalized()), along_b(r.b.normalized()),
        length_a(r.a.norm()), length_b(r.b.norm()) {}
  double height(const Vec3& p) const { return normal.dot(p - corner); }
  // How far inside the rim, m; negative outside.
  double margin(const Vec3& p) const {
    const double x = along_a.dot(p - corner), y = along_b.dot(p - corner);
    return std::min({x, y, length_a - x, length_b - y});
  }
};

class Search {
 public:
  Search(const Vec3& transmitter, const Vec3& receiver, const std::vector<MirrorRectangle>& rectangles)
      : transmitter_(transmitter), receiver_(receiver), planes_(rectangles.begin(), rectangles.end()) {}

  void extend(const Vec3 image, size_t more) {
    for (int k = 0; k < static_cast<int>(planes_.size()); ++k) {
      if (!sequence_.empty() && sequence_.back() == k) continue;
      const Plane& plane = planes_[static_cast<size_t>(k)];
      sequence_.push_back(k);
      images_.push_back(image - 2.0 * plane.height(image) * plane.normal);
      try_sequence();
      if (more > 1) extend(images_.back(), more - 1);
      sequence_.pop_back();
      images_.pop_back();
    }
  }

  SlowPaths out;

 private:
  void try_sequence() {
    double margin = 1e9;
    Vec3 from = receiver_;
    points_.assign(1, from);
    for (size_t i = sequence_.size(); i-- > 0;) {
      const Plane& plane = planes_[static_cast<size_t>(sequence_[i])];
      const double here = plane.height(from), there = plane.height(images_[i]);
      if (here * there >= 0) return;
      from += here / (here - there) * (images_[i] - from);
      margin = std::min(margin, plane.margin(from));
      if (margin < -kUnsure) return;
      points_.push_back(from);
    }
    points_.push_back(transmitter_);
    for (size_t i = 0; i + 1 < points_.size(); ++i) {
      for (const Plane& plane : planes_) margin = std::min(margin, clearance(plane, points_[i], points_[i + 1]));
      if (margin < -kUnsure) return;
    }
    (margin > kUnsure ? out.found : out.unsure).insert(sequence_);
  }

  // By how much the leg passes the rectangle, m; negative where it goes through.
  static double clearance(const Plane& plane, const Vec3& from, const Vec3& to) {
    const double here = plane.height(from), there = plane.height(to);
    if (std::abs(here) < kOwnPlane || std::abs(there) < kOwnPlane || here * there > 0) return 1e9;
    return -plane.margin(from + here / (here - there) * (to - from));
  }

  const Vec3 transmitter_, receiver_;
  const std::vector<Plane> planes_;
  std::vector<int> sequence_;
  std::vector<Vec3> images_, points_;
};

}  // namespace

SlowPaths slow_mirror_paths(const Vec3& transmitter, const Vec3& receiver, const std::vector<MirrorRectangle>& rectangles,
                            int max_bounces) {
  Search search(transmitter, receiver, rectangles);
  search.extend(transmitter, static_cast<size_t>(max_bounces));
  return std::move(search.out);
}

std::vector<MirrorRectangle> city_block(int num_boxes) {
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<MirrorRectangle> mirrors = {{{-200.0, -200.0, 0.0}, {400.0, 0.0, 0.0}, {0.0, 400.0, 0.0}}};
  const int side = static_cast<int>(std::ceil(std::sqrt(num_boxes)));
  for (int i = 0; i < num_boxes; ++i) {
    const double turn = 0.4 * uniform(draw), length = 8.0 + 3.0 * uniform(draw), width = 8.0 + 3.0 * uniform(draw);
    const double y = 20.0 * (i / side - side / 2) + 3.0 * uniform(draw),
                 x = 20.0 * (i % side - side / 2) + 3.0 * uniform(draw);
    const Vec3 middle(x, y, 0.0);
    const Vec3 along = length * Vec3(std::cos(turn), std::sin(turn), 0.0);
    const Vec3 across = width * Vec3(-std::sin(turn), std::cos(turn), 0.0);
    const Vec3 up(0.0, 0.0, 6.0 + 6.0 * uniform(draw)), corner = middle - 0.5 * along - 0.5 * across;
    mirrors.push_back({corner, along, up});
    mirrors.push_back({corner + across, along, up});
    mirrors.push_back({corner, across, up});
    mirrors.push_back({corner + along, across, up});
    mirrors.push_back({corner + up, along, across});
  }
  return mirrors;
}

}  // namespace echopath::testing
