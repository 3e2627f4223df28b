// At how many times of a frame what moves is checked.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "cpp/support/scenes.h"
#include "echopath/motion/motion.h"
#include "echopath/validity/frame/check_times.h"

namespace echopath::test_check_times {
namespace {

using namespace testing;

constexpr int kKinks = 3;

// Goes straight on, and suddenly faster at kKinks times within the frame of the radar.
std::shared_ptr<const Motion> jerky(const Radar& radar) {
  std::vector<double> times;
  std::vector<Vec3> places;
  for (int k = 0; k <= kKinks + 1; ++k) {
    times.push_back(radar.frame_duration() * k / (kKinks + 1));
    places.emplace_back(0.0, 0.01 * k * k, 0.0);
  }
  return std::make_shared<KeyframeMotion>(times, places, std::vector<Quaternion>(), Interpolation::kLinear);
}

// A ball below two nodes; of the three, counted from above, `mover` moves.
Scene ball_below_two(int mover, const std::shared_ptr<const Motion>& motion) {
  Scene scene;
  for (int level = 0; level < 3; ++level) {
    Node node;
    if (level == 2) node = node_with("", ellipsoid({8, 0, 0}, {1, 1, 1}, 0), lambert(0.5));
    node.name = "level " + std::to_string(level);
    node.parent = level - 1;
    if (level == mover) node.motion = motion;
    scene.add(node);
  }
  return scene;
}

TEST(CheckTimes, AreTwoMoreForEachKinkOfWhateverMovesAMesh) {
  Radar radar = plain_radar({0, 0, 0}, {0, 0, 0});
  radar.waveform.num_chirps = 64;
  for (int mover = 0; mover < 3; ++mover) {
    const CheckTimes found = check_times(ball_below_two(mover, jerky(radar)), radar, 0.0);
    EXPECT_EQ(found.of_mesh, std::vector<int>{kBaseCheckTimes + 2 * kKinks}) << mover;
    EXPECT_EQ(found.times.size(), static_cast<size_t>(kBaseCheckTimes + 2 * kKinks)) << mover;
  }
}

}  // namespace
}  // namespace echopath::test_check_times
