#include "echopath/bench/bare_queries.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"
#include "echopath/bench/query_recorder.h"
#include "echopath/bench/stopwatch.h"
#include "echopath/trace/tracer.h"

namespace echopath {
namespace {

template <class Work>
void measure(BareQueries::Seconds& seconds, const Work& work) {
  const Stopwatch watch;
  work();
  seconds.elapsed.push_back(watch.elapsed());
  seconds.processor.push_back(watch.processor());
}

void write_down(Tracer& tracer, QueryLog& log, Job* job) {
  PathBlock block;
  const QueryRecorder recorder(tracer.geometry(), log);
  for (int64_t i = 0; i < tracer.num_blocks(); ++i) {
    if (job) job->throw_if_cancelled();
    log.mark();
    block.clear();
    tracer.shoot_block(i, block);
  }
  log.mark();
}

void ask_all(const EmbreeScene& geometry, const QueryLog& log, bool one_by_one) {
  parallel_for(std::ssize(log.marks) - 1, [&](int64_t i) {
    const auto block = static_cast<size_t>(i);
    ask_again(geometry, log, log.marks[block], log.marks[block + 1], one_by_one);
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
  const Stopwatch watch;
  Tracer tracer(scene, radar, settings, job);
  out.build_seconds = watch.elapsed();
  QueryLog log;
  write_down(tracer, log, job);
  count_queries(log, out);
  out.num_rays = tracer.num_rays();
  for (int i = 0; i < repetitions; ++i) {
    measure(out.trace, [&] { out.num_paths = tracer.run(job).num_paths(); });
    measure(out.bare, [&] { ask_all(tracer.geometry(), log, false); });
    measure(out.single, [&] { ask_all(tracer.geometry(), log, true); });
  }
  return out;
}

}  // namespace echopath
