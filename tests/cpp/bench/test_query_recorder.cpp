// What is written down is what Embree was asked, by whatever thread, and is asked again as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cpp/support/scenes.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/bench/query_recorder.h"
#include "echopath/trace/tracer.h"

namespace echopath::test_query_recorder {
namespace {

using namespace testing;

Scene rough_ball() {
  Scene scene;
  Surface ball = ellipsoid({5, 0, 0}, {1, 1, 1}, 2);
  add_mesh(scene, "ball", ball.vertices, ball.triangles, lambert(0.5));
  add_rectangle(scene, "wall", {8, -5, -5}, {0, 10, 0}, {0, 0, 10}, lambert(0.5));
  return scene;
}

auto numbers_of(const QueryLog::Ray& ray) {
  return std::tuple(ray.from.x, ray.from.y, ray.from.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.far);
}

void expect_same(const QueryLog& a, const QueryLog& b) {
  const auto same_call = [](const QueryLog::Call& x, const QueryLog::Call& y) {
    return x.kind == y.kind && x.num_rays == y.num_rays;
  };
  EXPECT_TRUE(std::equal(a.calls.begin(), a.calls.end(), b.calls.begin(), b.calls.end(), same_call));
  const auto same_ray = [](const QueryLog::Ray& x, const QueryLog::Ray& y) { return numbers_of(x) == numbers_of(y); };
  EXPECT_TRUE(std::equal(a.rays.begin(), a.rays.end(), b.rays.begin(), b.rays.end(), same_ray));
}

int64_t count_of(const QueryLog& log, QueryLog::Kind kind) {
  return std::count_if(log.calls.begin(), log.calls.end(), [&](const QueryLog::Call& call) { return call.kind == kind; });
}

// The queries of one block of rays.
void write_block_down(Tracer& tracer, QueryLog& log) {
  PathBlock block;
  const QueryRecorder recorder(tracer.geometry(), log);
  log.mark();
  tracer.shoot_block(0, block);
  log.mark();
}

TraceSettings few_rays() {
  TraceSettings settings = with_rays(256);
  return settings;
}

TEST(QueryRecorder, TakesTheQueriesOfAllThreads) {
  constexpr int64_t kNumQueries = 20000;
  const Scene scene = rough_ball();
  EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  QueryLog log;
  {
    const QueryRecorder recorder(geometry, log);
    parallel_for(kNumQueries, [&](int64_t i) {
      const double number = static_cast<double>(i);
      geometry.occluded(Vec3(-2.0 - number, 0.0, 0.0), Vec3(-3.0 - number, 0.0, 0.0));
    });
  }
  ASSERT_EQ(log.calls.size(), static_cast<size_t>(kNumQueries));
  ASSERT_EQ(log.rays.size(), static_cast<size_t>(kNumQueries));
  std::vector<int> times_asked(kNumQueries);
  for (const QueryLog::Ray& ray : log.rays) ++times_asked[static_cast<size_t>(std::lround(-2.0f - ray.from.x))];
  EXPECT_TRUE(std::all_of(times_asked.begin(), times_asked.end(), [](int times) { return times == 1; }));
}

TEST(QueryRecorder, AskingAgainAsksTheSame) {
  Tracer tracer(rough_ball(), plain_radar({0, 0, 0}, {0, 0.1, 0}), few_rays(), nullptr);
  QueryLog first, again;
  write_block_down(tracer, first);
  for (const auto kind : {QueryLog::Kind::kClosest, QueryLog::Kind::kClosestPacket, QueryLog::Kind::kShadowPacket}) {
    EXPECT_GT(count_of(first, kind), 0);
  }
  {
    const QueryRecorder recorder(tracer.geometry(), again);
    ask_again(tracer.geometry(), first, first.marks.front(), first.marks.back(), false);
  }
  expect_same(first, again);
}

TEST(QueryRecorder, OneByOneAsksEveryRayInUse) {
  Tracer tracer(rough_ball(), plain_radar({0, 0, 0}, {0, 0.1, 0}), few_rays(), nullptr);
  QueryLog packed, single;
  write_block_down(tracer, packed);
  {
    const QueryRecorder recorder(tracer.geometry(), single);
    ask_again(tracer.geometry(), packed, packed.marks.front(), packed.marks.back(), true);
  }
  EXPECT_EQ(count_of(single, QueryLog::Kind::kClosestPacket) + count_of(single, QueryLog::Kind::kShadowPacket), 0);
  EXPECT_EQ(std::ssize(single.rays),
            std::count_if(packed.rays.begin(), packed.rays.end(), [](const QueryLog::Ray& ray) { return ray.far > 0; }));
}

TEST(QueryRecorder, WritesNothingOnceItHasEnded) {
  Tracer tracer(rough_ball(), plain_radar({0, 0, 0}, {0, 0.1, 0}), few_rays(), nullptr);
  QueryLog log;
  write_block_down(tracer, log);
  const size_t num_calls = log.calls.size();
  PathBlock block;
  tracer.shoot_block(0, block);
  EXPECT_EQ(log.calls.size(), num_calls);
}

}  // namespace
}  // namespace echopath::test_query_recorder
