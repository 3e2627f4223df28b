// Paths over the same hits have the same length and may make one echo; no others do.
#include <gtest/gtest.h>

#include <numeric>

#include "cpp/replay/small_arrays.h"
#include "cpp/support/scenes.h"
#include "echopath/replay/posed/touched_meshes.h"

namespace echopath::test_joined_echoes {
namespace {

using namespace testing;

constexpr double kRounding = 1e-14;  // relative, of sums of a few lengths and amplitudes

// A rough body that turns before a rough wall: each hit of a ray sends two paths back.
Paths record(bool wall_is_mirror = false) {
  Material rough;
  rough.reflectivity = 0.6;
  rough.scattering = 0.7;
  Scene scene;
  Surface surface = ellipsoid(Vec3(6, 0.5, 0), {.3, .2, .4}, 2);
  add_mesh(scene, "body", std::move(surface.vertices), std::move(surface.triangles), share(rough),
           std::make_shared<LinearMotion>(Vec3(-10, 0, 0), Vec3(0, 0, 20)));
  rough.mirror = wall_is_mirror;
  add_rectangle(scene, "wall", {-20, 3, -3}, {60, 0, 0}, {0, 0, 6}, share(rough));
  Radar radar = plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0));
  radar.waveform.num_chirps = 32;
  return trace(scene, radar, with_rays(1500, 2));
}

std::vector<uint8_t> joined(const Paths& paths, const std::vector<int64_t>& indices,
                            const std::vector<uint32_t>* label = nullptr,
                            SpecularPoints specular = SpecularPoints::kMaterial) {
  const PathPreparer preparer(paths, touched_meshes(paths));
  std::vector<const std::vector<uint32_t>*> labels;
  if (label) labels.push_back(label);
  return JoinRule(paths, preparer, specular, labels)(indices);
}

int64_t num_joined(const std::vector<uint8_t>& joined) { return std::accumulate(joined.begin(), joined.end(), int64_t{0}); }

TEST(JoinedEchoes, HaveOneLengthAtAllTimes) {
  const Paths paths = record();
  const std::vector<int64_t> indices = all_of(paths);
  const std::vector<uint8_t> found = joined(paths, indices);
  EXPECT_GT(num_joined(found), paths.num_paths() / 5);
  const Replayer replayer(paths, paths.radar);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  for (const double time : {0.0, 1e-3, 0.1}) {
    replayer.evaluate(indices, time, lengths, amplitudes);
    for (size_t i = 1; i < found.size(); ++i) {
      if (found[i]) {
        EXPECT_NEAR(lengths[i], lengths[i - 1], kRounding * lengths[i]);
      }
    }
  }
}

// Of one ray over the wall, as from a mirror and scattered there.
TEST(JoinedEchoes, ImagesAndPointsOfOneMirrorStayApart) {
  Paths paths = record(true);
  const auto over_wall = [&](int64_t path) {
    return paths.num_bounces[static_cast<size_t>(path)] == 2 && paths.hits_of(path)[0].mesh_id == 1;
  };
  const std::vector<int64_t> indices = all_of(paths);
  const auto found = std::find_if(indices.begin(), indices.end(), over_wall);
  ASSERT_NE(found, indices.end());
  const auto path = static_cast<size_t>(*found);
  const auto is_joined = [&](uint64_t diffuse, uint64_t other) {
    Paths two = paths.select([&] {
      std::vector<uint8_t> keep(indices.size());
      keep[path] = keep[path == 0 ? 1 : path - 1] = 1;
      return keep;
    }());
    for (size_t i = 0; i < 2; ++i) {
      two.offsets[i] = paths.offsets[path];
      two.num_bounces[i] = paths.num_bounces[path];
      two.flags[i] = paths.flags[path];
      two.batch[i] = paths.batch[path];
      two.diffuse[i] = i == 0 ? diffuse : other;
    }
    return joined(two, {0, 1})[1] != 0;
  };
  EXPECT_TRUE(is_joined(0b00, 0b10));
  EXPECT_TRUE(is_joined(0b11, 0b01));
  EXPECT_FALSE(is_joined(0b00, 0b01));
  EXPECT_FALSE(is_joined(0b01, 0b10));
}

TEST(JoinedEchoes, StayApartWhereAnythingElseDiffers) {
  const Paths paths = record();
  const std::vector<int64_t> indices = all_of(paths);
  const std::vector<uint8_t> found = joined(paths, indices);
  const auto last = static_cast<size_t>(std::find(found.begin(), found.end(), 1) - found.begin());
  ASSERT_LT(last, found.size());
  const auto is_joined = [&](auto change) {
    Paths other = paths;
    change(other);
    return joined(other, indices)[last] != 0;
  };
  EXPECT_FALSE(is_joined([&](Paths& other) { other.flags[last] ^= kReversedPath; }));
  EXPECT_FALSE(is_joined([&](Paths& other) { other.flags[last] ^= kSecondHalf; }));
  EXPECT_FALSE(is_joined([&](Paths& other) { other.batch[last] = kNoBatch; }));
  EXPECT_FALSE(is_joined([&](Paths& other) { ++other.offsets[last]; }));
  std::vector<uint32_t> label(found.size(), 3);
  EXPECT_EQ(joined(paths, indices, &label), found);
  label[last] = 2;
  EXPECT_FALSE(joined(paths, indices, &label)[last]);
  EXPECT_EQ(num_joined(joined(paths, indices, nullptr, SpecularPoints::kFermat)), 0);
}

// Against a loop over nodes and paths; runs of one, two and three.
TEST(JoinedEchoes, AreTheSumsOfTheirAmplitudes) {
  const std::vector<uint8_t> joined = {0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 1, 1, 0};
  Echoes all;
  all.num_echoes = static_cast<int64_t>(joined.size());
  all.sampling.num_rows = 3;
  for (size_t i = 0; i < 3 * joined.size(); ++i) {
    all.delay.push_back(1e-8 * static_cast<double>(i));
    all.amplitude.emplace_back(std::cos(static_cast<double>(i)), std::sin(2.0 * static_cast<double>(i)));
  }
  Echoes sums;
  const std::vector<uint32_t> echo_of = echoes_of(joined);
  sums.num_echoes = echo_of.back() + 1;
  sums.delay.assign(3 * static_cast<size_t>(sums.num_echoes), -1.0);
  sums.amplitude.assign(sums.delay.size(), 99.0);
  join(all, joined, sums);
  EXPECT_EQ(sums.num_echoes, std::count(joined.begin(), joined.end(), 0));
  for (size_t node = 0; node < 3; ++node) {
    for (size_t echo = 0; echo < static_cast<size_t>(sums.num_echoes); ++echo) {
      std::complex<double> sum;
      for (size_t i = joined.size(); i-- > 0;) {
        if (echo_of[i] != echo) continue;
        sum += all.amplitude[node * joined.size() + i];
        if (joined[i]) continue;
        EXPECT_EQ(sums.delay[node * static_cast<size_t>(sums.num_echoes) + echo], all.delay[node * joined.size() + i]);
      }
      EXPECT_LE(std::abs(sums.amplitude[node * static_cast<size_t>(sums.num_echoes) + echo] - sum), kRounding);
    }
  }
}

// Evaluated as one echo or joined afterwards, to the bit.
TEST(JoinedEchoes, OfTheChirpsAreThoseOfTheirPaths) {
  const Paths paths = record();
  const std::vector<int64_t> indices = all_of(paths);
  const std::vector<uint8_t> found = joined(paths, indices);
  Replayer replayer(paths, paths.radar);
  const GridIndex polynomial = GridIndex::polynomial(0);
  replayer.pose_polynomial(polynomial, indices);
  EXPECT_GT(num_joined(found), 0);
  PartlyPosedGrid partly = replayer.pose_partly(ChirpGrid{0});
  const PosedGrid& chirps = partly.with(replayer.meshes_of(indices));
  const std::vector<Echoes> at_once = replayer.by_chirp(indices, polynomial, chirps, found);
  const std::vector<Echoes> after = replayer.joined(replayer.by_chirp(indices, polynomial, chirps), found);
  ASSERT_EQ(at_once.front().num_echoes, paths.num_paths() - num_joined(found));
  ASSERT_EQ(at_once.front().num_echoes, after.front().num_echoes);
  EXPECT_EQ(at_once.front().sampling.num_rows, after.front().sampling.num_rows);
  EXPECT_EQ(at_once.front().amplitude, after.front().amplitude);
  EXPECT_EQ(at_once.front().delay, after.front().delay);
}

}  // namespace
}  // namespace echopath::test_joined_echoes
