#include "echopath/trace/live/live_record.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"
#include "echopath/record/blocks/record_writer.h"
#include "echopath/trace/sheets/passes.h"

namespace echopath {
namespace {

std::vector<std::vector<int>> sequences_of(const AntennaFrusta& frusta) {
  std::vector<std::vector<int>> sequences;
  for (const MirrorFrusta* found : {&frusta.transmitter, &frusta.receiver}) {
    for (const MirrorFrustum& frustum : found->frusta) sequences.push_back(frustum.mirrors);
    sequences.emplace_back();  // the end of one antenna's
  }
  return sequences;
}

// The faint power is that of a later step (power/faint_paths.h): no ray knows it.
bool asks_the_same(const TraceSettings& a, const TraceSettings& b) {
  RecordSettings of_a = a;
  of_a.faint_power = b.faint_power;
  return a.num_rays == b.num_rays && of_a == static_cast<const RecordSettings&>(b);
}

bool has_foci(const std::vector<Stratum>& strata) {
  return std::ranges::any_of(strata, [](const Stratum& one) { return one.is_focus(); });
}

}  // namespace

bool is_launched_alike(const Stratum& a, const Stratum& b) {
  Stratum as_there = a;
  as_there.object = b.object;
  return as_there == b;
}

SharedByRays::SharedByRays(const Tracer& tracer, const TraceSettings& asked)
    : settings(asked), sbr(tracer.sbr()), rounding(tracer.geometry().rounding()), strata(tracer.plan().strata),
      owners(tracer.plan().owners), first_point(tracer.plan().first_point),
      surface_scatterers(tracer.plan().surface_scatterers), sequences(sequences_of(tracer.frusta())) {}

// The field of view, the last stratum, owns all that no other stratum does.
bool SharedByRays::is_same(const SharedByRays& other) const {
  return asks_the_same(settings, other.settings) && sbr == other.sbr && rounding == other.rounding &&
         surface_scatterers.empty() == other.surface_scatterers.empty() && sequences == other.sequences &&
         is_launched_alike(strata.back(), other.strata.back()) && !has_foci(strata) && !has_foci(other.strata);
}

LiveRecord::LiveRecord(const Tracer& tracer, const TraceSettings& settings)
    : empty(tracer.without_paths()), shared(tracer, settings),
      boxes(boxes_of(tracer.geometry(), static_cast<uint32_t>(empty.scene->meshes().size()))), first_block{0} {
  for (const Stratum& stratum : shared.strata) {
    const auto num_rays = static_cast<size_t>(stratum.num_rays), together = static_cast<size_t>(kRaysPerLiveBlock);
    first_block.push_back(first_block.back() + num_chunks(num_rays, together));
  }
}

Paths LiveRecord::paths_of(const std::vector<LiveBlockPtr>& some, Job* job) const {
  std::vector<const PathBlock*> parts;
  for (const PathBlock& block : without_rays) parts.push_back(&block);
  for (const LiveBlockPtr& block : some) parts.push_back(&block->paths);
  parts.push_back(&over_planes);
  for (const PathBlock& block : edges_over_planes) parts.push_back(&block);
  Paths paths = empty;
  RecordWriter writer(paths);
  writer.append(parts, job);
  writer.finish();
  doubles.leave_out(paths, job);
  SheetPasses(*paths.scene, paths.frame.trace_time, shared.rounding, job).add_to(paths, job);
  return paths;
}

}  // namespace echopath
