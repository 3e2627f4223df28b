// Frames longer than the knots of a keyframe motion are followed by polynomials between the knots.
#include <gtest/gtest.h>

#include <set>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/motion_cuts.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_motion_cuts {
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
              std::shared_ptr<const Motion> motion, std::shared_ptr<const Deformation> deformation = nullptr) {
  Node node = node_with(name, std::move(surface), lambert(0.4));
  node.placement = Eigen::Translation3d(place) * Transform::Identity();
  node.motion = std::move(motion);
  node.deformation = std::move(deformation);
  scene.add(node);
}

Scene swaying_limb() {
  Scene scene;
  add_body(scene, "limb", ellipsoid(Vec3(0, 0, -0.3), {.06, .06, .35}, 3), {8, 0.5, 0}, swaying());
  return scene;
}

Paths record(const Radar& radar, const Scene& scene = swaying_limb()) {
  TraceSettings settings = with_rays(2000, 1);
  settings.start_time = 0.05;
  return trace(scene, radar, settings);
}

TEST(MotionCuts, AreTheTimesOfKeyframesWithinTheFrame) {
  const Scene scene = swaying_limb();
  const MotionCuts cuts(scene, long_frame(), {2 * kKnot, 5 * kKnot});
  EXPECT_EQ(cuts[cuts.of_mesh(0)].knots, (std::vector<double>{3 * kKnot, 4 * kKnot}));
  EXPECT_TRUE(cuts[cuts.of_mesh(0)].breakpoints.empty());
}

// The radar's are in all sets, and those of a mesh do not depend on other meshes.
TEST(MotionCuts, OfMeshesAreThoseOfTheirMotionsAndOfTheRadar) {
  const std::vector<Vec3> places = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitX()};
  const auto stops_at = [&](double time) {
    return std::make_shared<KeyframeMotion>(std::vector<double>{0, time, 1}, places, std::vector<Quaternion>(),
                                            Interpolation::kLinear);
  };
  Radar radar = long_frame();
  radar.motion = stops_at(0.5);
  Scene scene = swaying_limb();
  add_body(scene, "house", ellipsoid(Vec3::Zero(), {.1, .1, .1}, 1), {12, -2, 0}, nullptr);
  add_body(scene, "car", ellipsoid(Vec3::Zero(), {.1, .1, .1}, 1), {12, 2, 0}, stops_at(0.25));
  MotionCuts cuts(scene, radar, {0.27, 0.6});
  EXPECT_EQ(cuts.of_mesh(1), MotionCuts::kOfRadar);
  EXPECT_EQ(cuts.of_mesh(2), MotionCuts::kOfRadar);  // it stopped before the frame
  EXPECT_EQ(cuts[MotionCuts::kOfRadar].knots, std::vector<double>{0.5});
  EXPECT_EQ(cuts[MotionCuts::kOfRadar].breakpoints, std::vector<double>{0.5});
  EXPECT_EQ(cuts[cuts.of_mesh(0)].knots,
            (std::vector<double>{34 * kKnot, 35 * kKnot, 36 * kKnot, 37 * kKnot, 38 * kKnot, 39 * kKnot, 0.5}));
  EXPECT_EQ(cuts[cuts.of_mesh(0)].breakpoints, std::vector<double>{0.5});
}

TEST(MotionCuts, JoinedOnesAreUnionsWhateverTheOrder) {
  Scene scene = swaying_limb();
  const std::vector<double> times = {0, 0.0123, 0.02, 1};
  const std::vector<Vec3> flaps = {Vec3::Zero(), Vec3::UnitZ(), Vec3::Zero(), Vec3::UnitZ()};
  add_body(scene, "bird", ellipsoid(Vec3::Zero(), {.1, .1, .1}, 1), {12, -2, 0},
           std::make_shared<KeyframeMotion>(times, flaps, std::vector<Quaternion>()));
  MotionCuts cuts(scene, long_frame(), {0.01, 0.03});
  const uint32_t both = cuts.join(cuts.of_mesh(0), cuts.of_mesh(1));
  EXPECT_EQ(cuts[both].knots, (std::vector<double>{0.0123, 2 * kKnot, 0.02, 3 * kKnot}));
  EXPECT_EQ(cuts.join(cuts.of_mesh(1), cuts.of_mesh(0)), both);
  EXPECT_EQ(cuts.joined(cuts.of_mesh(1), cuts.of_mesh(0)), both);
  EXPECT_EQ(cuts.joined(both, MotionCuts::kOfRadar), both);
  EXPECT_EQ(cuts.join(both, cuts.of_mesh(0)), both);  // they are among them
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
  const uint32_t cuts = grids.cuts().of_mesh(0);
  int num_analytic = 0;
  for (size_t k = 0; k < grids.num_polynomials(cuts); ++k) {
    const PolynomialGrid& grid = grids.polynomial(GridIndex::polynomial(k, cuts));
    EXPECT_LE(grid.num_nodes, grids.num_sample_nodes());
    EXPECT_EQ(grid.num_nodes, grid.order * static_cast<int64_t>(grid.cuts.size() + 1));
    if (k > 0) {
      EXPECT_GE(grid.num_nodes, grids.polynomial(GridIndex::polynomial(k - 1, cuts)).num_nodes);
    }
    num_analytic += grid.pieces == PolynomialGrid::Pieces::kAnalytic;
  }
  ASSERT_GT(num_analytic, 0);
  const GridIndex next =
      grids.next_polynomial(GridIndex::polynomial(0, cuts), 1000.0);  // no order is so high: the first between knots
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

TEST(PathGrids, OfPathsOverSeveralMeshesHaveTheCutsOfAll) {
  const auto slides_until = [](double time) {
    return std::make_shared<KeyframeMotion>(std::vector<double>{0, time, 1},
                                            std::vector<Vec3>{Vec3::Zero(), Vec3(1e-3, 0, 0), Vec3(1e-3, 0, 0)},
                                            std::vector<Quaternion>(), Interpolation::kLinear);
  };
  Scene scene;  // a corner that opens toward the radar
  add_rectangle(scene, "left", {8, 0, -0.5}, {-0.5, 0.5, 0}, {0, 0, 1}, share(Material::metal()), slides_until(0.11));
  add_rectangle(scene, "right", {8, 0, -0.5}, {-0.5, -0.5, 0}, {0, 0, 1}, share(Material::metal()), slides_until(0.08));
  TraceSettings settings = with_rays(500, 2);
  settings.start_time = 0.05;
  const Radar radar = long_frame();
  const Paths paths = trace(scene, radar, settings);
  Replayer replayer(paths, radar);
  const PathGrids grids = replayer.path_grids();
  std::set<std::vector<double>> found;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    std::set<double> cuts;
    for (int k = 0; k < paths.num_bounces[path]; ++k) cuts.insert(paths.hits_of(path)[k].mesh_id == 0 ? 0.11 : 0.08);
    found.emplace(cuts.begin(), cuts.end());
    ASSERT_TRUE(grids.first(path).is_polynomial());
    EXPECT_EQ(replayer.grids().polynomial(grids.first(path)).cuts, std::vector<double>(cuts.begin(), cuts.end()));
  }
  EXPECT_EQ(found.size(), 3u);
}

// Eight chirps are 24 nodes: enough for four to six in each of a wall's four pieces, but not in each of the seven of both.
TEST(PathGrids, OfMoreCutsTogetherThanPolynomialsHaveNodesForAreNone) {
  const auto shakes_from = [](double first) {
    const std::vector<double> times = {0, first, first + 1e-3, first + 2e-3, 1};
    std::vector<Vec3> places;
    for (size_t k = 0; k < times.size(); ++k) places.emplace_back(k % 2 ? 1e-5 : 0.0, 0, 0);
    return std::make_shared<KeyframeMotion>(times, places, std::vector<Quaternion>(), Interpolation::kLinear);
  };
  Scene scene;  // a corner that opens toward the radar
  add_rectangle(scene, "left", {8, 0, -0.5}, {-0.5, 0.5, 0}, {0, 0, 1}, share(Material::metal()), shakes_from(1e-3));
  add_rectangle(scene, "right", {8, 0, -0.5}, {-0.5, -0.5, 0}, {0, 0, 1}, share(Material::metal()), shakes_from(1.5e-3));
  Radar radar = long_frame();
  radar.waveform.num_chirps = 8;
  const Paths paths = trace(scene, radar, with_rays(500, 2));
  Replayer replayer(paths, radar);
  const PathGrids grids = replayer.path_grids();
  int num_over_both = 0;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const bool is_over_both = paths.num_bounces[path] == 2;
    num_over_both += is_over_both;
    EXPECT_EQ(grids.first(path) == GridIndex::none(), is_over_both) << path;
  }
  EXPECT_GT(num_over_both, 0);
  EXPECT_LT(num_over_both, paths.num_paths());
}

// A wing that beats at its tip alone: paths at its root have the same grid beside those at the tip and without these, which
// leave the tip out of what is posed of the mesh.
TEST(PathGrids, OfDeformingMeshesDoNotHangOnWhichTrianglesAreHit) {
  Scene scene;
  const Surface wing = ellipsoid(Vec3::Zero(), {.06, 1.0, .35}, 3);
  std::vector<double> times;
  std::vector<std::vector<Vec3>> frames;
  for (int i = 0; i < 40; ++i) {
    times.push_back(i * kKnot);
    frames.push_back(wing.vertices);
    for (Vec3& vertex : frames.back()) vertex.x() += std::max(0.0, vertex.y()) * 0.3 * std::sin(60 * times.back());
  }
  add_body(scene, "wing", wing, {8, 0, 0}, nullptr, std::make_shared<VertexSequence>(times, frames));
  const Radar radar = long_frame();
  const Paths all = record(radar, scene);
  std::vector<uint8_t> at_root;
  for (int64_t path = 0; path < all.num_paths(); ++path) {
    const Triangle& triangle = scene.node_of(0).mesh->triangles()[all.hits_of(path)->triangle_id];
    at_root.push_back(
        std::all_of(triangle.begin(), triangle.end(), [&](uint32_t v) { return wing.vertices[v].y() < -0.1; }));
  }
  const Paths root = all.select(at_root);
  ASSERT_GT(root.num_paths(), 0);
  ASSERT_LT(root.num_paths(), all.num_paths());
  Replayer of_all(all, radar), of_root(root, radar);
  EXPECT_TRUE(of_all.path_grids().first(0) == of_root.path_grids().first(0));
}

}  // namespace
}  // namespace echopath::test_motion_cuts
