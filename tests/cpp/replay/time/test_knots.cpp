// Frames longer than the knots of a keyframe motion are followed by polynomials between the knots.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/motion_knots.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_knots {
namespace {

using namespace testing;

// rad: the aim of 1e-5; tails are estimates, and leave a fifth of the margin to paths near the aim
constexpr double kPhaseTolerance = 2e-5;
constexpr double kKnot = 8e-3;  // s, between keyframes

// Sways as a limb does, sampled at 125 Hz.
std::shared_ptr<const Motion> swaying() {
  std::vector<double> times;
  std::vector<Vec3> translations;
  std::vector<Quaternion> rotations;
  for (int i = 0; i < 40; ++i) {
    const double t = i * kKnot;
    times.push_back(t);
    translations.emplace_back(-1.4 * t + 0.05 * std::sin(11 * t), 0.03 * std::cos(17 * t), 0.0);
    rotations.emplace_back(Eigen::AngleAxisd(0.6 * std::sin(9 * t), Vec3(0.2, 1, 0.1).normalized()));
  }
  return std::make_shared<KeyframeMotion>(times, translations, rotations);
}

Radar long_frame() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0));
  radar.waveform.num_chirps = 128;
  radar.waveform.chirp_interval = 720e-6;  // 12 transmitters of 60 us
  return radar;
}

void add_body(Scene& scene, const std::string& name, Surface surface, const Vec3& place,
              std::shared_ptr<const Motion> motion) {
  Node node;
  node.name = name;
  node.placement = Eigen::Translation3d(place) * Transform::Identity();
  node.mesh = std::make_shared<Mesh>(std::move(surface.vertices), std::move(surface.triangles));
  node.material = lambert(0.4);
  node.motion = std::move(motion);
  scene.add(node);
}

Scene swaying_limb() {
  Scene scene;
  add_body(scene, "limb", ellipsoid(Vec3(0, 0, -0.3), {.06, .06, .35}, 3), {8, 0.5, 0}, swaying());
  return scene;
}

Paths record(const Radar& radar, const Scene& scene = swaying_limb()) {
  TraceSettings settings;
  settings.num_rays = 2000;
  settings.max_bounces = 1;
  settings.start_time = 0.05;
  return trace(scene, radar, settings);
}

TEST(MotionKnots, AreTheTimesOfKeyframes) {
  const Paths paths = record(long_frame());
  const std::vector<double> knots = motion_knots(*paths.scene, paths.radar);
  ASSERT_EQ(knots.size(), 40u);
  EXPECT_DOUBLE_EQ(knots[3], 3 * kKnot);
  EXPECT_TRUE(motion_breakpoints(*paths.scene, paths.radar).empty());
}

TEST(MotionKnots, PolynomialsBetweenThemFollowLongFrames) {
  const Radar radar = long_frame();
  const Paths paths = record(radar);
  Replayer replayer(paths, radar);
  std::vector<int64_t> indices(static_cast<size_t>(paths.num_paths()));
  const PathGrids path_grids = replayer.path_grids();
  GridIndex polynomial = GridIndex::polynomial(0);
  for (size_t i = 0; i < indices.size(); ++i) {
    indices[i] = static_cast<int64_t>(i);
    polynomial = std::max(polynomial, path_grids.first(indices[i]));
  }
  ASSERT_TRUE(polynomial.is_polynomial());
  EXPECT_LT(replayer.grids().polynomial(polynomial).num_nodes, replayer.grids().num_sample_nodes() / 2);
  replayer.pose_polynomial(polynomial, indices);
  std::vector<UnfollowedPath> failed;
  const Echoes echoes = replayer.interpolated(indices, polynomial, failed).front();
  EXPECT_LT(failed.size(), indices.size() / 20);  // grazing ones, whose amplitudes have a kink
  for (const UnfollowedPath& one : failed) std::erase(indices, one.path);
  ASSERT_EQ(echoes.num_echoes, static_cast<int64_t>(indices.size()));
  EchoStates state;
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  double error = 0.0;
  for (const int chirp : {0, 31, 64, 127}) {
    replayer.evaluate(indices, paths.frame.start_time + radar.chirp_time(0, chirp), lengths, amplitudes);
    for (size_t p = 0; p < indices.size(); ++p) {
      evaluate_states(echoes, chirp, static_cast<int64_t>(p), 1, state);
      error = std::max(error, kTwoPi * 77e9 * std::abs(state.delay[0] - lengths[p] / kSpeedOfLight));
    }
  }
  EXPECT_LT(error, kPhaseTolerance);
}

// Goes straight on, but cannot tell how fast it turns when it is asked for the first time.
class ForgetfulMotion : public LinearMotion {
 public:
  ForgetfulMotion() : LinearMotion({1, 0, 0}) {}
  double turn_rate(const TimeSpan& during) const override {
    if (num_asked_++ == 0) throw std::runtime_error("what was the question?");
    return LinearMotion::turn_rate(during);
  }

 private:
  mutable int num_asked_ = 0;
};

// Pieces between knots have more nodes at the same order: both kinds stand among each other by their nodes.
TEST(MotionKnots, GridsOfBothKindsOfPiecesAreInOrder) {
  const Radar radar = long_frame();
  const Paths paths = record(radar);
  const TimeGrids grids(paths, radar, {});
  int num_analytic = 0;
  for (size_t k = 0; k < grids.num_polynomials(); ++k) {
    const PolynomialGrid& grid = grids.polynomial(GridIndex::polynomial(k));
    EXPECT_LE(grid.num_nodes, grids.num_sample_nodes());
    EXPECT_EQ(grid.num_nodes, grid.order * static_cast<int64_t>(grid.cuts.size() + 1));
    if (k > 0) {
      EXPECT_GE(grid.num_nodes, grids.polynomial(GridIndex::polynomial(k - 1)).num_nodes);
    }
    num_analytic += grid.pieces == PolynomialGrid::Pieces::kAnalytic;
  }
  ASSERT_GT(num_analytic, 0);
  const GridIndex next =
      grids.next_polynomial(GridIndex::polynomial(0), 1000.0);  // no order is so high: the first between knots
  ASSERT_TRUE(next.is_polynomial());
  EXPECT_EQ(grids.polynomial(next).pieces, PolynomialGrid::Pieces::kAnalytic);
}

TEST(PathGrids, AreThoseOfTheirMeshesAfterAnErrorToo) {
  const Radar radar = long_frame();
  Scene scene = swaying_limb();  // needs a higher polynomial than what goes straight on
  add_body(scene, "ball", ellipsoid(Vec3::Zero(), {.1, .1, .1}, 2), {12, -2, 0}, std::make_shared<ForgetfulMotion>());
  const Paths paths = record(radar, scene);
  Replayer asked_twice(paths, radar), asked_once(paths, radar);
  EXPECT_THROW(asked_twice.path_grids(), std::runtime_error);
  const PathGrids second = asked_twice.path_grids(), first = asked_once.path_grids();
  for (int64_t path = 0; path < paths.num_paths(); ++path) EXPECT_TRUE(second.first(path) == first.first(path)) << path;
}

}  // namespace
}  // namespace echopath::test_knots
