// MirrorFrusta of an antenna over mirrors against specular points found one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "echopath/base/random.h"
#include "echopath/trace/frusta/mirror_frusta.h"

namespace echopath::test_mirror_frusta {
namespace {

constexpr int kMaxMirrors = 3;
constexpr double kRim = 1e-6;  // m: a bounce this near to the rim of its mirror may count either way

std::vector<MirrorFrustum> find_frusta(const Vec3& antenna, const std::vector<Mirror>& mirrors, int max_mirrors) {
  return FrustumFinder(mirrors).find(antenna, {.max_mirrors = max_mirrors}).frusta;
}

struct Rectangle {
  Vec3 corner, a, b;
};

Vec3 random_vector(uint64_t index) {
  const auto first = uniform2(7, Stream::kNoise, index, 0), second = uniform2(7, Stream::kNoise, index, 1);
  return {2.0 * first[0] - 1.0, 2.0 * first[1] - 1.0, 2.0 * second[0] - 1.0};
}

Rectangle random_rectangle(uint64_t index) {
  const Vec3 a = random_vector(2 * index) * 4.0, towards = random_vector(2 * index + 1);
  const Vec3 b = (towards - towards.dot(a) / a.squaredNorm() * a).normalized() * 3.0;
  return {5.0 * random_vector(1000 + index), a, b};
}

Mirror mirror_of(const Rectangle& r) {
  Mirror mirror;
  mirror.point = r.corner;
  mirror.normal = r.a.cross(r.b).normalized();
  mirror.outline = {r.corner, r.corner + r.a, r.corner + r.a + r.b, r.corner + r.b};
  return mirror;
}

// A ray over a mirror and the leg that is searched from its other end take one coefficient.
TEST(Trace, ABounceIsOfOneModeBothWays) {
  const Vec3 slanted = Vec3(0, 1, 1).normalized();  // 45 degrees, as car radars have it
  for (uint64_t i = 0; i < 20000; ++i) {
    const Vec3 direction = random_vector(2 * i).normalized(), normal = random_vector(2 * i + 1).normalized();
    const Vec3 back = -(direction - 2.0 * direction.dot(normal) * normal);
    EXPECT_EQ(polarization_mode(slanted, direction, normal), polarization_mode(slanted, back, normal)) << i;
  }
}

// Distance inside its rectangle (negative: outside) of the least safe bounce between `point` and `antenna` over `sequence`,
// in m; bounces must lie between what they join, on one side of their mirror.
double margin_of(const Vec3& antenna, const std::vector<int>& sequence, const Vec3& point,
                 const std::vector<Rectangle>& rectangles, const std::vector<Mirror>& mirrors) {
  std::vector<Vec3> images = {antenna};
  for (const int k : sequence) images.push_back(mirrors[static_cast<size_t>(k)].image(images.back()));
  double margin = 1e9;
  Vec3 target = point;
  for (size_t i = sequence.size(); i-- > 0;) {
    const auto k = static_cast<size_t>(sequence[i]);
    const double here = mirrors[k].height(target), there = mirrors[k].height(images[i + 1]);
    if (here * there >= 0) return -1e9;
    target += here / (here - there) * (images[i + 1] - target);
    const double x = (target - rectangles[k].corner).dot(rectangles[k].a.normalized());
    const double y = (target - rectangles[k].corner).dot(rectangles[k].b.normalized());
    margin = std::min({margin, x, y, rectangles[k].a.norm() - x, rectangles[k].b.norm() - y});
  }
  return margin;
}

TEST(MirrorFrusta, LightWhatSpecularPointsReach) {
  std::vector<Rectangle> rectangles;
  std::vector<Mirror> mirrors;
  for (uint64_t i = 0; i < 6; ++i) {
    rectangles.push_back(random_rectangle(i));
    mirrors.push_back(mirror_of(rectangles.back()));
  }
  const Vec3 antenna(0.3, -0.2, 0.5);
  const std::vector<MirrorFrustum> frusta = find_frusta(antenna, mirrors, kMaxMirrors);
  int num_lit[kMaxMirrors + 1] = {};
  for (uint64_t i = 0; i < 3000; ++i) {
    const Vec3 point = 6.0 * random_vector(5000 + i);
    std::vector<std::vector<int>> sequences = {{}};
    for (size_t s = 0; s < sequences.size(); ++s) {
      const std::vector<int> sequence = sequences[s];
      if (sequence.size() < kMaxMirrors) {
        for (int k = 0; k < 6; ++k) {
          if (!sequence.empty() && sequence.back() == k) continue;
          sequences.push_back(sequence);
          sequences.back().push_back(k);
        }
      }
      if (sequence.empty()) continue;
      const double margin = margin_of(antenna, sequence, point, rectangles, mirrors);
      if (std::abs(margin) < kRim) continue;
      const auto frustum =
          std::find_if(frusta.begin(), frusta.end(), [&](const MirrorFrustum& b) { return b.mirrors == sequence; });
      EXPECT_EQ(frustum != frusta.end() && frustum->reaches(point, 0.0), margin > 0);
      num_lit[sequence.size()] += margin > 0 ? 1 : 0;
    }
  }
  for (int depth = 1; depth <= kMaxMirrors; ++depth) EXPECT_GT(num_lit[depth], 20) << depth;
}

TEST(MirrorFrusta, NumbersTellSequencesApart) {
  const size_t num_mirrors = 7;
  std::set<MirrorSequence> numbers = {kNoMirrors};
  for (int first = 0; first < 7; ++first) {
    numbers.insert(extended(kNoMirrors, first, num_mirrors));
    for (int second = 0; second < 7; ++second) {
      numbers.insert(extended(extended(kNoMirrors, first, num_mirrors), second, num_mirrors));
    }
  }
  EXPECT_EQ(numbers.size(), 1u + 7u + 49u);
  EXPECT_GE(*numbers.begin(), 0);
}

TEST(MirrorFrusta, AnAntennaOnAPlaneHasNoImageInIt) {
  const std::vector<Mirror> mirrors = {mirror_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})};
  EXPECT_TRUE(find_frusta({5, 5, 0}, mirrors, 2).empty());
  EXPECT_EQ(find_frusta({5, 5, 1}, mirrors, 2).size(), 1u);
  EXPECT_TRUE(find_frusta({5, 5, 1}, mirrors, 0).empty());
}

}  // namespace
}  // namespace echopath::test_mirror_frusta
