// Meshes that deform: what replay poses of them, and what stretching does to their echoes.
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "cpp/support/scenes.h"
#include "echopath/motion/skin.h"

namespace echopath::test_deforming {
namespace {

using namespace testing;

constexpr double kSizeTolerance = 0.02;  // dB: both traces sample the same plate with footprints below a wavelength
constexpr double kDistance = 400.0;      // m: plates lie within 0.04 rad of a plane wave
constexpr double kSide = 0.1;            // m

// A flat sheet of n x n squares with corner vertices at the origin and (0, 1, 1).
Surface grid(uint32_t n) {
  Surface surface;
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t j = 0; j <= n; ++j) surface.vertices.push_back(Vec3(0, i, j) / n);
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t a = i * (n + 1) + j, b = a + n + 1;
      surface.triangles.push_back({a, b + 1, b});
      surface.triangles.push_back({a, a + 1, b + 1});
    }
  }
  return surface;
}

// Stretches a unit sheet from `from` to `to` (both edge lengths, m) within one second; counts what it poses.
class Stretch : public Deformation {
 public:
  Stretch(const Surface& sheet, const Vec3& from, const Vec3& to) : sheet_(sheet.vertices), from_(from), to_(to) {}
  int64_t num_vertices() const override { return static_cast<int64_t>(sheet_.size()); }
  std::vector<Vec3> at(double time) const override {
    std::vector<uint32_t> all(sheet_.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<Vec3> out;
    at(time, all, out);
    return out;
  }
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override {
    num_posed += static_cast<int64_t>(indices.size());
    out.clear();
    const Vec3 size = from_ + time * (to_ - from_);
    for (const uint32_t v : indices) out.push_back(Vec3(kDistance, 0, 0) + size.cwiseProduct(sheet_[v] - Vec3(0, 0.5, 0.5)));
  }
  std::vector<double> breakpoints(const TimeSpan&) const override { return {}; }
  TimeSpan span() const override { return {-1.0, 2.0}; }
  double turn_rate(const TimeSpan&) const override { return 0.0; }
  mutable std::atomic<int64_t> num_posed = 0;

 private:
  std::vector<Vec3> sheet_;
  Vec3 from_, to_;
};

struct Case {
  std::shared_ptr<Stretch> stretch;
  Scene scene;
};

Case stretching(uint32_t n, const Vec3& from, const Vec3& to, const MaterialPtr& material, bool smooth = false) {
  const Surface sheet = grid(n);
  Case made{std::make_shared<Stretch>(sheet, from, to), {}};
  Node node = node_with("sheet", sheet, material, smooth);
  node.deformation = made.stretch;
  made.scene.add(node);
  return made;
}

Radar boresight_radar() { return plain_radar(Vec3::Zero(), Vec3::Zero()); }

Paths traced(const Scene& scene, double start_time, int64_t num_rays) {
  TraceSettings settings = with_rays(num_rays, 1);
  settings.start_time = start_time;
  return trace(scene, boresight_radar(), settings);
}

Replayed replayed_at(const Paths& paths, double time) {
  std::vector<int64_t> all(static_cast<size_t>(paths.num_paths()));
  std::iota(all.begin(), all.end(), 0);
  Replayed out;
  Replayer(paths, paths.radar).evaluate(all, time, out.lengths, out.amplitudes);
  return out;
}

double cross_section_db(const Replayed& echoes) {
  const double wavenumber = kTwoPi * plain_radar(Vec3::Zero(), Vec3::Zero()).waveform.start_frequency / kSpeedOfLight;
  std::complex<double> sum = 0.0;
  for (size_t p = 0; p < echoes.lengths.size(); ++p) {
    sum += echoes.amplitudes[p] * std::polar(1.0, -wavenumber * echoes.lengths[p]);
  }
  return decibel(rcs_of(std::norm(sum), kDistance, wavenumber / kTwoPi * kSpeedOfLight));
}

double total_power(const Replayed& echoes) {
  double sum = 0.0;
  for (const std::complex<double>& amplitude : echoes.amplitudes) sum += std::norm(amplitude);
  return sum;
}

TEST(Deforming, OnlyVerticesOfTrianglesThatWereHitArePosed) {
  for (const bool smooth : {false, true}) {
    const Case sheet = stretching(200, Vec3::Constant(kSide), Vec3::Constant(2 * kSide), lambert(0.5), smooth);
    const Paths paths = traced(sheet.scene, 0.0, 200);
    ASSERT_GT(paths.num_paths(), 50);
    sheet.stretch->num_posed = 0;
    const Replayed echoes = replayed_at(paths, 0.5);
    // The trace time and the time asked for; three corners to a hit, and at most 18 neighbours of a triangle.
    EXPECT_LE(sheet.stretch->num_posed, 2 * paths.num_hits() * (smooth ? 18 : 3));
    EXPECT_LT(sheet.stretch->num_posed, sheet.stretch->num_vertices());
    EXPECT_GT(total_power(echoes), 0.0);
  }
}

TEST(Deforming, APlateThatStretchesHasTheCrossSectionOfItsNewSize) {
  const Case plate = stretching(4, Vec3::Constant(kSide), {1.0, 1.5 * kSide, 1.2 * kSide}, share(Material::metal()));
  const Paths paths = traced(plate.scene, 0.0, 1 << 15);
  const double wavelength = kSpeedOfLight / paths.radar.waveform.start_frequency;
  for (const double time : {paths.frame.trace_time, 0.5, 1.0}) {
    const double area = kSide * kSide * (1.0 + 0.5 * time) * (1.0 + 0.2 * time);
    const double closed_form = decibel(4.0 * kPi * area * area / (wavelength * wavelength));
    EXPECT_NEAR(cross_section_db(replayed_at(paths, time)), closed_form, kSizeTolerance) << time;
  }
  const Paths fresh = traced(plate.scene, 1.0, 1 << 15);
  EXPECT_NEAR(cross_section_db(replayed_at(paths, 1.0)), cross_section_db(replayed_at(fresh, fresh.frame.trace_time)),
              kSizeTolerance);
}

TEST(Deforming, UnevenStretchingIsWeighedTriangleByTriangle) {
  // One column of squares grows, the others stay: only its echoes do.
  class OneColumn : public Stretch {
   public:
    explicit OneColumn(const Surface& sheet) : Stretch(sheet, Vec3::Constant(kSide), Vec3::Constant(kSide)) {}
    void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override {
      Stretch::at(time, indices, out);
      for (Vec3& v : out) v.y() += v.y() > 0.2 * kSide ? time * kSide : 0.0;
    }
  };
  const Surface sheet = grid(4);
  Scene scene;
  Node node = node_with("sheet", sheet, lambert(1.0));
  node.deformation = std::make_shared<OneColumn>(sheet);
  scene.add(node);
  const Paths paths = traced(scene, 0.0, 4000);
  const double start = paths.frame.trace_time;
  const Replayed before = replayed_at(paths, start), after = replayed_at(paths, 1.0);
  // The column is a quarter of the side and becomes five quarters, that is 5 times as wide (less by the start).
  const double widening = (0.25 + 1.0) / (0.25 + start);
  for (size_t p = 0; p < before.amplitudes.size(); ++p) {
    const uint32_t triangle = paths.hits_of(static_cast<int64_t>(p))->triangle_id;
    const bool grows = triangle / 2 / 4 == 2;  // squares [i, j] with i = 2: from y = 0 to 0.25 of the side
    const double ratio = std::norm(after.amplitudes[p]) / std::norm(before.amplitudes[p]);
    EXPECT_NEAR(ratio, grows ? widening : 1.0, 2e-2) << triangle;  // distances and angles change a little
  }
}

TEST(Deforming, ARoughPlateThatStretchesScattersByItsArea) {
  // Small against its distance, so that area alone counts: 1 mm to 2 mm by 3 mm.
  const Case plate = stretching(2, Vec3::Constant(1e-3), {1.0, 2e-3, 3e-3}, lambert(0.5));
  const Paths paths = traced(plate.scene, 0.0, 2000);
  const double start = paths.frame.trace_time;
  const double before = total_power(replayed_at(paths, start)), after = total_power(replayed_at(paths, 1.0));
  EXPECT_NEAR(after / before, 6.0 / ((1.0 + start) * (1.0 + 2.0 * start)), 1e-8);  // of (size / distance)^2
}

TEST(Deforming, APlateThatTurnsBelowAnUnevenPlacementStretches) {
  // Turned by x about z below diag(1, 2, 1) a unit area has the area vector (2 cos x, sin x, 0), and a rough plate seen
  // along the x axis scatters by the square of its first component over its length.
  constexpr double kRate = kPi / 4;  // rad/s
  Scene scene;
  Node squeeze;
  squeeze.name = "squeeze";
  squeeze.placement.linear() = Vec3(1.0, 2.0, 1.0).asDiagonal();
  squeeze.placement.translation() = Vec3(kDistance, 0, 0);
  scene.add(squeeze);
  Node plate;
  plate.name = "plate";
  plate.parent = 0;
  const double half = 5e-4;
  plate.mesh =
      std::make_shared<Mesh>(std::vector<Vec3>{{0, -half, -half}, {0, -half, half}, {0, half, half}, {0, half, -half}},
                             std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  plate.material = lambert(0.5);
  plate.motion = std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, kRate));
  scene.add(plate);
  const auto scattered = [](double angle) {
    const double across = 2.0 * std::cos(angle);
    return across * across / std::hypot(across, std::sin(angle));
  };
  const Paths paths = traced(scene, 0.0, 2000);
  const double start = paths.frame.trace_time;
  const double ratio = total_power(replayed_at(paths, 1.0)) / total_power(replayed_at(paths, start));
  EXPECT_NEAR(ratio, scattered(kRate) / scattered(kRate * start), 1e-4);  // of size / distance
}

TEST(Deforming, RigidMotionKeepsTheWeightOfEveryHit) {
  // Through the skin's way of posing and through the node's: the same amplitudes.
  const auto motion = std::make_shared<const LinearMotion>(Vec3(-1, 0.5, 0), Vec3(0, 0, 0.3));
  const Surface ball = ellipsoid(Vec3(10, 0, 0), Vec3(0.3, 0.2, 0.4), 3);
  Scene rigid, skinned;
  Node node = node_with("ball", ball, share(Material::metal()), true);
  Node skin = node;
  node.motion = motion;
  rigid.add(node);
  const SkinWeights weights{1, std::vector<uint32_t>(ball.vertices.size(), 0),
                            std::vector<double>(ball.vertices.size(), 1.0)};
  skin.deformation = std::make_shared<Skin>(
      ball.vertices, std::vector<Joint>{Joint{"root", -1, Transform::Identity(), motion, {}}}, weights);
  skinned.add(skin);
  const Paths one = traced(rigid, 0.0, 2000), other = traced(skinned, 0.0, 2000);
  ASSERT_EQ(one.num_paths(), other.num_paths());
  for (const double time : {0.0, 0.2}) {
    const Replayed a = replayed_at(one, time), b = replayed_at(other, time);
    const double scale = std::sqrt(total_power(a) / static_cast<double>(a.lengths.size()));
    for (size_t p = 0; p < a.lengths.size(); ++p) {
      EXPECT_NEAR(a.lengths[p], b.lengths[p], 1e-13 * a.lengths[p]);
      EXPECT_LT(std::abs(a.amplitudes[p] - b.amplitudes[p]), 1e-6 * scale);  // launch cells come from a quotient in float
    }
  }
}

}  // namespace
}  // namespace echopath::test_deforming
