#include "echopath/trace/bare_queries.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "echopath/base/parallel.h"
#include "echopath/trace/tracer.h"

namespace echopath {
namespace {

template <class Work>
double seconds_of(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Work>
void measure(BareQueries::Seconds& seconds, const Work& work) {
  const std::clock_t begin = std::clock();
  seconds.elapsed.push_back(seconds_of(work));
  seconds.processor.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
}

void write_down(Tracer& tracer, QueryLog& log, Job* job) {
  PathBlock block;
  tracer.geometry().record_queries(&log);
  for (int64_t i = 0; i < tracer.num_blocks(); ++i) {
    if (job) job->throw_if_cancelled();
    log.mark();
    block.clear();
    tracer.shoot_block(i, block);
  }
  log.mark();
  tracer.geometry().record_queries(nullptr);
}

void ask_all(const EmbreeScene& geometry, const QueryLog& log, bool one_by_one) {
  parallel_for(std::ssize(log.marks) - 1, [&](int64_t i) {
    const auto block = static_cast<size_t>(i);
    geometry.ask_again(log, log.marks[block], log.marks[block + 1], one_by_one);
  });
}

void count_queries(const QueryLog& log, BareQueries& out) {
  const QueryLog::Ray* ray = log.rays.data();
  for (const auto [kind, num_lanes] : log.calls) {
    const auto count = std::count_if(ray, ray + num_lanes, [](const QueryLog::Ray& one) { return one.far > 0; });
    ray += num_lanes;
    out.num_queries += count;
    if (kind == QueryLog::Kind::kClosestPacket || kind == QueryLog::Kind::kShadowPacket) out.num_in_packets += count;
    if (kind == QueryLog::Kind::kShadow || kind == QueryLog::Kind::kShadowPacket) out.num_shadow += count;
  }
}

}  // namespace

BareQueries measure_bare_queries(const Scene& scene, const Radar& radar, const TraceSettings& settings, int repetitions,
                                 Job* job) {
  require(repetitions >= 1, "repetitions", "must be >= 1", repetitions);
  BareQueries out;
  std::unique_ptr<Tracer> tracer;
  out.build_seconds = seconds_of([&] { tracer = std::make_unique<Tracer>(scene, radar, settings, job); });
  QueryLog log;
  write_down(*tracer, log, job);
  count_queries(log, out);
  out.num_rays = tracer->num_rays();
  for (int i = 0; i < repetitions; ++i) {
    measure(out.trace, [&] { out.num_paths = tracer->run(job).num_paths(); });
    measure(out.bare, [&] { ask_all(tracer->geometry(), log, false); });
    measure(out.single, [&] { ask_all(tracer->geometry(), log, true); });
  }
  return out;
}

}  // namespace echopath
