// Slides of points of reflection: Newton's method over spheres, planes and mirrors ends at the law of reflection.
#include "echopath/replay/posed/specular_slide.h"

#include <gtest/gtest.h>

#include "cpp/support/scenes.h"

namespace echopath::test_specular_slide {
namespace {

using namespace testing;

constexpr double kLaw = 1e-9;  // of unit vectors, after Newton's method has ended
constexpr double kRounding = 1e-15;
constexpr double kFalls = 0.05;        // of the error before: a step of Newton squares it
constexpr double kSecondOrder = 0.01;  // relative: the next order of the slide

// Spheres (radius > 0: convex towards the path), planes (radius 0) and images, in order; the last hit is a material point.
struct Chain {
  struct Part {
    Vec3 point, normal;
    double radius = 0.0;
    bool image = false;
  };
  std::vector<Part> parts;
  std::vector<LocalHit> local;
  std::vector<PosedHit> hits;
  LocalPath path;
  Vec3 start = Vec3::Zero();

  void add(const Vec3& point, const Vec3& normal, double radius = 0.0, bool image = false) {
    parts.push_back({point, normal.normalized(), radius, image});
    PosedHit& hit = hits.emplace_back();
    hit.point = point;
    hit.normal = normal.normalized();
    hit.is_smooth = radius != 0;
    if (hit.is_smooth) hit.curvature = (Mat3::Identity() - hit.normal * hit.normal.transpose()) / radius;
  }
  void close() {
    local.resize(hits.size());
    path.hits = local.data();
    path.count = static_cast<int>(hits.size());
    path.last_material = path.count - 1;
    path.diffuse = uint64_t{1} << path.last_material;
    for (int k = 0; k < path.last_material; ++k) {
      (parts[static_cast<size_t>(k)].image ? path.image : path.sliding) |= uint64_t{1} << k;
      if (!parts[static_cast<size_t>(k)].image && path.first_material < 0) path.first_material = k;
    }
  }
  // The hit moves to the point of its surface next to `point`.
  void move(int k, const Vec3& point) {
    const Part& part = parts[static_cast<size_t>(k)];
    PosedHit& hit = hits[static_cast<size_t>(k)];
    if (part.radius == 0) {
      hit.point = point - part.normal.dot(point - part.point) * part.normal;
      return;
    }
    const Vec3 centre = part.point - part.radius * part.normal;
    hit.normal = (point - centre).normalized() * (part.radius > 0 ? 1.0 : -1.0);
    hit.point = centre + part.radius * hit.normal;
    hit.curvature = (Mat3::Identity() - hit.normal * hit.normal.transpose()) / part.radius;
  }
  double newton_step() {
    SpecularSlide slide;
    EXPECT_TRUE(slide.solve(path, hits.data(), start));
    for (size_t i = 0; i < slide.size(); ++i) {
      const int k = slide.hit(i);
      move(k, surface_point(hits[static_cast<size_t>(k)], slide.step(i)));
    }
    return slide.excess();
  }
  // Largest tangential part of arrival - departure at a sliding hit, by image points put together here.
  double break_of_law() const {
    double worst = 0.0;
    for (int k = 0; k < path.last_material; ++k) {
      if (!path.is_sliding(k)) continue;
      const PosedHit& hit = hits[static_cast<size_t>(k)];
      Vec3 before = k == 0 ? start : hits[static_cast<size_t>(k - 1)].point, behind = hits[static_cast<size_t>(k + 1)].point;
      int from = k - 1, to = k + 1;
      while (from >= 0 && path.is_image(from)) --from;
      before = from < 0 ? start : hits[static_cast<size_t>(from)].point;
      for (int m = from + 1; m < k; ++m) before = mirrored(before, m);
      while (path.is_image(to)) ++to;
      behind = hits[static_cast<size_t>(to)].point;
      for (int m = to - 1; m > k; --m) behind = mirrored(behind, m);
      const Vec3 sum = (before - hit.point).normalized() + (behind - hit.point).normalized();
      worst = std::max(worst, (sum - hit.normal.dot(sum) * hit.normal).norm());
    }
    return worst;
  }
  Vec3 mirrored(const Vec3& p, int m) const {
    const Part& plane = parts[static_cast<size_t>(m)];
    return p - 2.0 * plane.normal.dot(p - plane.point) * plane.normal;
  }
};

Vec3 bisector(const Vec3& at, const Vec3& before, const Vec3& behind) {
  return (before - at).normalized() + (behind - at).normalized();
}

// Over a floor that is an image, a column, the floor again, a hollow column and a plane, each nearly where it reflects.
Chain two_spheres_with_mirrors() {
  const Vec3 first(8, 3, 0.5), second(14, 3, 0.1), third(17, 0.5, 3.0), end(20, 0, 1);
  const auto in_floor = [](const Vec3& p) { return Vec3(p.x(), -4 - p.y(), p.z()); };
  Chain chain;
  chain.add({4, -2, 0}, {0, 1, 0}, 0.0, true);
  chain.add(first, bisector(first, in_floor(chain.start), in_floor(second)) + Vec3(0.003, 0, 0), 2.0);
  chain.add({11, -2, 0.2}, {0, 1, 0}, 0.0, true);
  chain.add(second, bisector(second, in_floor(first), third) + Vec3(0, 0, 0.002), -30.0);
  chain.add(third, bisector(third, second, end), 0.0, false);
  chain.add(end, {-1, 0, 0});
  chain.close();
  return chain;
}

TEST(SpecularSlide, NewtonsMethodEndsAtTheLawOfReflection) {
  Chain chain = two_spheres_with_mirrors();
  for (int i = 0; i < 12; ++i) chain.newton_step();
  EXPECT_LT(chain.break_of_law(), kLaw);
  EXPECT_LT(std::abs(chain.newton_step()), kRounding);
}

TEST(SpecularSlide, ConvergesQuadratically) {
  Chain chain = two_spheres_with_mirrors();
  for (int i = 0; i < 12; ++i) chain.newton_step();
  chain.move(1, chain.hits[1].point + Vec3(0.01, 0, 0.004));
  chain.move(3, chain.hits[3].point + Vec3(-0.008, 0, 0.01));
  const double first = chain.break_of_law();
  chain.newton_step();
  const double second = chain.break_of_law();
  chain.newton_step();
  EXPECT_LT(second, first * kFalls);
  EXPECT_LT(chain.break_of_law(), first * kFalls * kFalls);
}

// The length over the frozen points exceeds that over Fermat's by e.
TEST(SpecularSlide, ExcessIsTheDifferenceOfLengths) {
  Chain chain = two_spheres_with_mirrors();
  for (int i = 0; i < 12; ++i) chain.newton_step();
  SpecularSlide slide;
  ASSERT_TRUE(slide.solve(chain.path, chain.hits.data(), chain.start));
  const double shortest = slide.length();
  chain.move(1, chain.hits[1].point + Vec3(0.004, 0, 0.003));
  chain.move(3, chain.hits[3].point + Vec3(-0.003, 0, 0.004));
  chain.move(4, chain.hits[4].point + Vec3(0.005, -0.002, 0));
  ASSERT_TRUE(slide.solve(chain.path, chain.hits.data(), chain.start));
  const double excess = slide.length() - shortest;
  EXPECT_GT(std::abs(excess), 1e-6);
  EXPECT_NEAR(slide.excess() / excess, 1.0, kSecondOrder);
}

TEST(SpecularSlide, AMaterialPointBetweenParts) {
  Chain chain;
  chain.add({5, 2, 0}, {0, -1, 0});
  chain.add({9, 0, 0}, {-1, 0, 0});
  chain.add({12, 2, 0}, {0, -1, 0});
  chain.add({15, 0, 0}, {-1, 0, 0});
  chain.close();
  chain.path.sliding = 0b101;
  chain.path.diffuse = 0b1010;
  SpecularSlide slide;
  ASSERT_TRUE(slide.solve(chain.path, chain.hits.data(), chain.start));
  const double both = slide.excess();
  chain.move(0, {4.5, 2, 0});  // on the straight image line from 0 to the point behind: no excess left there
  ASSERT_TRUE(slide.solve(chain.path, chain.hits.data(), chain.start));
  EXPECT_NEAR(slide.step(0).norm(), 0.0, kRounding);
  EXPECT_NEAR(slide.step(1).norm(), 0.0, kRounding);
  const double slid = 0.5;  // in the plane of incidence, at equal legs r with cosine c: e = slid^2 c^2 / r, about
  EXPECT_NEAR(both, slid * slid * (2 / 4.924) * (2 / 4.924) / 4.924, 0.05 * both);
}

TEST(SpecularSlide, RefusesASingularPlace) {
  Chain chain;  // a hollow mirror of radius r images its centre onto itself: every path is equally long
  chain.add({2, 0, 0}, {-1, 0, 0}, -2.0);
  chain.add({0, 0, 0}, {1, 0, 0});
  chain.close();
  SpecularSlide slide;
  EXPECT_FALSE(slide.solve(chain.path, chain.hits.data(), chain.start));
  EXPECT_EQ(slide.size(), 0u);
}

TEST(SurfacePoint, LiesOnItsSphere) {
  Chain chain;
  chain.add({2, 0, 0}, {-1, 0, 0}, 0.1);
  chain.add({1, 0, 0}, {-1, 0, 0}, -0.5);
  for (const PosedHit& hit : chain.hits) {
    const double radius = hit.point.x() == 2 ? 0.1 : -0.5;
    for (const double step : {1e-3, 0.05, 0.4}) {
      const Vec3 moved = surface_point(hit, {0, 0.6 * step, 0.8 * step});
      EXPECT_NEAR((moved - (hit.point - radius * hit.normal)).norm(), std::abs(radius), kRounding);
    }
  }
}

}  // namespace
}  // namespace echopath::test_specular_slide
