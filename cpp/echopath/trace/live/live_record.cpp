#include "echopath/trace/live/live_record.h"

#include <algorithm>

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

bool asks_the_same(const TraceSettings& a, const TraceSettings& b) {
  return a.num_rays == b.num_rays && a.footprint == b.footprint && a.batches == b.batches && a.sampler == b.sampler &&
         a.scatterers == b.scatterers && a.attenuation == b.attenuation;
}

bool has_foci(const std::vector<Stratum>& strata) {
  return std::any_of(strata.begin(), strata.end(), [](const Stratum& one) { return one.is_focus(); });
}

}  // namespace

SharedByRays::SharedByRays(const Tracer& tracer, const TraceSettings& asked)
    : settings(asked), sbr(tracer.sbr()), origin(tracer.geometry().origin()), lift(tracer.geometry().lift()),
      reach(tracer.geometry().reach()), strata(tracer.plan().strata), first_ray(tracer.plan().first_ray),
      owners(tracer.plan().owners), first_point(tracer.plan().first_point),
      surface_scatterers(tracer.plan().surface_scatterers), sequences(sequences_of(tracer.frusta())) {}

// The field of view, the last stratum, is where all rays end that no other stratum owns.
bool SharedByRays::is_same(const SharedByRays& other) const {
  return asks_the_same(settings, other.settings) && sbr == other.sbr && origin == other.origin && lift == other.lift &&
         reach == other.reach && first_ray == other.first_ray && owners == other.owners &&
         first_point == other.first_point && sequences == other.sequences && strata.back() == other.strata.back() &&
         !has_foci(strata) && !has_foci(other.strata);
}

bool SharedByRays::launches_alike(const SharedByRays& other, int64_t begin, int64_t end) const {
  if (begin >= first_point && !surface_scatterers.empty()) {
    const auto first = static_cast<size_t>(begin - first_point), last = static_cast<size_t>(end - first_point);
    if (last > other.surface_scatterers.size()) return false;
    return std::equal(surface_scatterers.begin() + static_cast<int64_t>(first),
                      surface_scatterers.begin() + static_cast<int64_t>(last),
                      other.surface_scatterers.begin() + static_cast<int64_t>(first));
  }
  const auto after = std::upper_bound(first_ray.begin(), first_ray.end(), begin);
  for (auto k = static_cast<size_t>(after - first_ray.begin()) - 1; k < strata.size() && first_ray[k] < end; ++k) {
    if (!(strata[k] == other.strata[k])) return false;
  }
  return true;
}

LiveRecord::LiveRecord(const Tracer& tracer, const TraceSettings& settings)
    : empty(tracer.without_paths()), shared(tracer, settings),
      boxes(boxes_of(tracer.geometry(), static_cast<uint32_t>(empty.scene->meshes().size()))) {}

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
  add_passes(paths, job);
  return paths;
}

}  // namespace echopath
