#include "echopath/trace/scatter/surface_points.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/random.h"

namespace echopath {
namespace {

// Below this level a triangle is divided no further: its parts are 2^-20 of its size.
constexpr int kMostLevels = 20;
constexpr double kGoldenRatio = 0.6180339887498949;

// Holds the density that is asked for over one triangle's plane, 1/m^2: that of the rays times height/distance^3.
struct PlaneDensity {
  Vec3 viewer;
  double height = 0.0;       // m, of the viewer over the plane
  double ray_density = 0.0;  // 1/sr

  double at_distance(double distance) const { return ray_density * height / (distance * distance * distance); }
  double at(const Vec3& point) const { return at_distance((point - viewer).norm()); }
  double most_within(const Vec3& center, double radius) const {
    return at_distance(std::max(height, (center - viewer).norm() - radius));
  }
};

// Is a part of a triangle: one of the 4^level that halving all edges `level` times makes. The points in it are those whose
// number has the same `level` last digits to base 4 as its first one.
struct TrianglePart {
  std::array<Vec3, 3> corners;
  std::array<double, 3> first;  // barycentric coordinates of its first point
  uint64_t number = 0;          // of that point
  int level = 0;

  Vec3 point() const { return first[0] * corners[0] + first[1] * corners[1] + first[2] * corners[2]; }
};

// The parts of a triangle are those at its corners, 0 to 2, and the one in the middle, 3.
std::array<Vec3, 3> corners_of_part(const std::array<Vec3, 3>& of, size_t part) {
  const std::array<Vec3, 3> middles{0.5 * (of[1] + of[2]), 0.5 * (of[2] + of[0]), 0.5 * (of[0] + of[1])};
  if (part == 3) return middles;
  std::array<Vec3, 3> corners;
  for (size_t k = 0; k < 3; ++k) corners[k] = k == part ? of[k] : middles[3 - part - k];
  return corners;
}

size_t part_with(const std::array<double, 3>& point) {
  for (size_t k = 0; k < 3; ++k) {
    if (point[k] > 0.5) return k;
  }
  return 3;
}

std::array<double, 3> coordinates_in_part(const std::array<double, 3>& of, size_t part) {
  if (part == 3) return {1.0 - 2.0 * of[0], 1.0 - 2.0 * of[1], 1.0 - 2.0 * of[2]};
  std::array<double, 3> in;
  for (size_t k = 0; k < 3; ++k) in[k] = k == part ? 2.0 * of[k] - 1.0 : 2.0 * of[k];
  return in;
}

// Draws what belongs to the points of one triangle.
class PointNumbers {
 public:
  PointNumbers(uint64_t seed, const ScatteringTriangle& of)
      : key_(philox_key(seed)), mesh_(of.mesh_number), triangle_(of.name.triangle_id) {}

  // Returns barycentric coordinates, uniform over the area.
  std::array<double, 3> place(uint64_t number) const {
    const auto words = draw(number, kPlace);
    double a = unit_interval(words[0], words[1]), b = unit_interval(words[2], words[3]);
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    return {1.0 - a - b, a, b};
  }
  int64_t key(uint64_t number) const {
    const auto words = draw(number, kKey);
    return static_cast<int64_t>((uint64_t{words[0]} << 32 | words[1]) >> 1);
  }
  // Returns by how much the order of a part's other parts is turned.
  size_t turn(uint64_t number, int level) const { return draw(number, kTurn + static_cast<uint32_t>(level))[0] % 3; }
  // Returns the triangle's place in [0, 1) in the order of small triangles, which have a point or none. Neighbours in the
  // mesh lie far from each other there, so that those that have one are evenly spread.
  double shift() const {
    const auto words = philox4x32({mesh_, 0, kShift, static_cast<uint32_t>(Stream::kSurfacePoint)}, key_);
    const double place = unit_interval(words[0], words[1]) + kGoldenRatio * triangle_;
    return place - std::floor(place);
  }

 private:
  enum : uint32_t { kPlace, kKey, kShift, kTurn };
  std::array<uint32_t, 4> draw(uint64_t number, uint32_t use) const {
    // The numbers of a triangle's points have up to 40 bits, those of uses 5.
    const auto high = static_cast<uint32_t>(number >> 32) << 8 | use;
    const auto stream = static_cast<uint32_t>(Stream::kSurfacePoint);
    return philox4x32({static_cast<uint32_t>(number), high, triangle_, stream}, {key_[0] ^ mesh_, key_[1]});
  }

  std::array<uint32_t, 2> key_;
  uint32_t mesh_, triangle_;
};

// Takes the points of a triangle that the density asks for.
class PointTaker {
 public:
  PointTaker(const PointNumbers& numbers, const PlaneDensity& density, double area, std::vector<SurfacePoint>& out)
      : numbers_(numbers), density_(density), shift_(numbers.shift()), per_area_(1.0 / area), out_(out) {}

  // Returns whether not even the first point of all is asked for anywhere, as on most triangles of a fine mesh.
  bool has_none(const std::array<Vec3, 3>& corners) const { return rank(0) >= most_in(corners); }

  // Takes the first point of a part if the density there asks for it.
  void take(const TrianglePart& part) {
    const Vec3 point = part.point();
    if (rank(part.number) >= density_.at(point)) return;
    out_.push_back({point, {}, numbers_.key(part.number), 0});
  }

  // Takes all other points of a part.
  void take_others(const TrianglePart& part) {
    const uint64_t step = uint64_t{1} << (2 * part.level);
    if (part.level == kMostLevels || rank(part.number + step) >= most_in(part.corners)) return;
    const size_t own = part_with(part.first), turn = numbers_.turn(part.number, part.level);
    take_others({corners_of_part(part.corners, own), coordinates_in_part(part.first, own), part.number, part.level + 1});
    for (size_t i = 0; i < 3; ++i) {
      const size_t other = (own + 1 + (i + turn) % 3) % 4;
      const uint64_t number = part.number + (i + 1) * step;
      const TrianglePart inner{corners_of_part(part.corners, other), numbers_.place(number), number, part.level + 1};
      take(inner);
      take_others(inner);
    }
  }

 private:
  // Returns the density from which on there is a point of that number, 1/m^2.
  double rank(uint64_t number) const { return (static_cast<double>(number) + shift_) * per_area_; }
  double most_in(const std::array<Vec3, 3>& corners) const {
    const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3.0;
    double radius = 0.0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - center).norm());
    return density_.most_within(center, radius);
  }

  const PointNumbers& numbers_;
  const PlaneDensity& density_;
  double shift_, per_area_;
  std::vector<SurfacePoint>& out_;
};

}  // namespace

void add_surface_points(uint64_t seed, const ScatteringTriangle& triangle, const PointDensity& density,
                        std::vector<SurfacePoint>& out) {
  const auto& corners = triangle.corners;
  const Vec3 across = cross_of_sides(corners);
  const double twice_area = across.norm();
  if (!(twice_area > 0.0)) return;
  const double height = std::abs(across.dot(density.viewer - corners[0])) / twice_area;
  const PlaneDensity here{density.viewer, height, density.ray_density};
  const PointNumbers numbers(seed, triangle);
  const size_t before = out.size();
  PointTaker taker(numbers, here, 0.5 * twice_area, out);
  if (taker.has_none(corners)) return;
  const TrianglePart whole{corners, numbers.place(0), 0, 0};
  taker.take(whole);
  taker.take_others(whole);
  for (size_t i = before; i < out.size(); ++i) out[i].on = triangle.name;
}

}  // namespace echopath
