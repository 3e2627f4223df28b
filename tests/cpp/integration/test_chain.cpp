// The whole chain in C++ alone: mesh files and a scene built in code -> trace -> replay -> signal -> decomposed map.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cpp/support/any_threads.h"
#include "cpp/support/scenes.h"
#include "echopath/scene/readers/readers.h"
#include "echopath/sim/decompose.h"
#include "echopath/sim/synthesize.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath::test_chain {
namespace {

using namespace testing;

constexpr double kAdditivity = 1e-12;  // relative to the largest sample
constexpr double kCell = 0.15;         // m and m/s: of the nearest cell

// A box of two groups, "front" facing -x and "back", around the origin.
const char* const kTwoPlates = R"(
v -0.1 -0.2 -0.2
v -0.1 0.2 -0.2
v -0.1 0.2 0.2
v -0.1 -0.2 0.2
v 0.1 -0.6 -0.2
v 0.1 -0.3 -0.2
v 0.1 -0.3 0.2
v 0.1 -0.6 0.2
g front
f 1 2 3 4
g back
f 5 6 7 8
)";

// The file's groups below a node "car" at 15 m that recedes with 4 m/s, beside a mirror wall.
Scene scene_from_file() {
  const std::string path = ::testing::TempDir() + "echopath_two_plates.obj";
  std::ofstream(path) << kTwoPlates;
  Scene scene;
  Node car;
  car.name = "car";
  car.placement = Transform(Eigen::Translation3d(15.0, 0.0, 1.0));
  car.motion = std::make_shared<LinearMotion>(Vec3(4.0, 0.0, 0.0));
  const int parent = scene.add(car);
  for (const NamedMesh& group : load_meshes(path)) {
    Node node;
    node.name = group.name;
    node.parent = parent;
    node.mesh = group.mesh;
    node.material = lambert(0.5);
    scene.add(node);
  }
  std::remove(path.c_str());
  add_rectangle(scene, "wall", {-5, 3, -5}, {50, 0, 0}, {0, 0, 15}, share(Material::metal(true)));
  return scene;
}

Radar frame_radar() {
  Radar radar = plain_radar({0, 0, 1}, {0, 0.01, 1});
  radar.waveform.num_chirps = 128;
  return radar;
}

struct Peak {
  double range, velocity;  // m, m/s
};

Peak strongest(const Cube& cube, const Radar& radar) {
  const RangeDoppler map = range_doppler(cube.values, radar, Window::named("hann"), 2);
  const auto norm_less = [](const std::complex<double>& a, const std::complex<double>& b) {
    return std::norm(a) < std::norm(b);
  };
  const auto at =
      static_cast<size_t>(std::max_element(map.values.begin(), map.values.end(), norm_less) - map.values.begin());
  return {map.range[at % map.range.size()], map.velocity[at / map.range.size()]};
}

TEST(Chain, MeshFileBecomesADecomposedMap) {
  const Scene scene = scene_from_file();
  ASSERT_EQ(scene.mesh_names(), (std::vector<std::string>{"car/front", "car/back", "wall"}));
  const Radar radar = frame_radar();
  const Paths paths = trace(scene, radar, with_rays(20000));
  const Selection ghosts = Selection::touches("wall") & Selection::touches("car/front") & Selection::num_bounces(2, 2);
  const Grouping route =
      by_selections({{"front", "T 'car/front' R"}, {"back", "T 'car/back' R"}, {"wall", "T .* 'wall' .* R"}});
  const Grouping bounces = by_selections({{"one", Selection::num_bounces(1, 1)}, {"ghosts", ghosts}});
  const auto views = decompose(paths, radar, {route, bounces});
  ASSERT_EQ(views.size(), 2u);
  ASSERT_EQ(views[0].size(), 4u);
  EXPECT_EQ(views[0][3].name, "other");

  // Closed form: a receding target of this mixer lies f_c v / slope farther.
  const double coupling = radar.waveform.centre_frequency() * 4.0 / radar.waveform.slope();
  const double mid_frame = 4.0 * 0.5 * radar.frame_duration();
  const Peak front = strongest(views[0][0].cube, radar);
  EXPECT_NEAR(front.range, 14.9 + mid_frame + coupling, kCell);
  EXPECT_NEAR(front.velocity, 4.0, kCell);
  const Peak back = strongest(views[0][1].cube, radar);
  EXPECT_NEAR(back.range, std::hypot(15.1, 0.45) + mid_frame + coupling, kCell);
  const Peak ghost = strongest(views[1][1].cube, radar);
  const double over_wall = std::hypot(14.9, 6.0);
  EXPECT_NEAR(ghost.range, 0.5 * (14.9 + over_wall) + mid_frame + coupling, kCell);
  EXPECT_NEAR(ghost.velocity, 4.0 * 0.5 * (1.0 + 14.9 / over_wall), kCell);

  const Cube whole = synthesize(paths, radar);
  double scale = 0.0;
  for (const std::complex<double>& sample : whole.values) scale = std::max(scale, std::abs(sample));
  for (const std::vector<PartCube>& parts : views) {
    double residual = 0.0;
    for (size_t i = 0; i < whole.values.size(); ++i) {
      std::complex<double> sum = 0.0;
      for (const PartCube& part : parts) sum += part.cube.values[i];
      residual = std::max(residual, std::abs(sum - whole.values[i]));
    }
    EXPECT_LT(residual, kAdditivity * scale);
  }
}

TEST(Chain, BitsDoNotDependOnThreads) {
  const Scene scene = scene_from_file();
  Radar radar = frame_radar();
  radar.waveform.num_chirps = 8;
  TraceSettings settings = with_rays(3000);
  test::same_on_any_threads([&] { return synthesize(trace(scene, radar, settings), radar).values; }, {2, 7});
}

TEST(Chain, EmptySceneGivesZeros) {
  const Radar radar = frame_radar();
  const Cube cube = synthesize(trace(Scene(), radar, {}), radar);
  ASSERT_EQ(cube.values.size(), size_t{128} * 512);
  EXPECT_TRUE(
      std::all_of(cube.values.begin(), cube.values.end(), [](const auto& s) { return s == std::complex<double>(0.0); }));
}

TEST(Chain, CancellingStopsSynthesis) {
  const Radar radar = frame_radar();
  const Paths paths = trace(scene_from_file(), radar, with_rays(3000));
  Job job;
  job.cancel();
  EXPECT_THROW(synthesize(paths, radar, {}, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_chain
