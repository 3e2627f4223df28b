#include "echopath/trace/live/live_trace.h"

#include "echopath/base/threads/parallel.h"
#include "echopath/trace/live/live_record.h"
#include "echopath/trace/live/path_difference.h"
#include "echopath/trace/live/record_match.h"

namespace echopath {
namespace {

// Share of the rays from which on it costs more to tell what differs, and to take it away and add it, than to begin anew.
constexpr double kMostRaysOfDifference = 0.4;

LiveBlockPtr shot(const Tracer& tracer, int64_t begin, int64_t end) {
  // The block of so few rays grows in memory that stays with the thread, and is copied when its sizes are known.
  thread_local PathBlock paths;
  thread_local QueriedSpace space;
  space.clear();
  paths.clear();
  const QueryWatch::OfThread watching(space);
  tracer.shoot(begin, end, paths);
  return std::make_shared<const LiveBlock>(LiveBlock{end - begin, paths, std::make_shared<const QueriedSpace>(space)});
}

// Says where the blocks of a record come from.
struct Filled {
  std::vector<uint8_t> is_kept_before;  // by block of the record before
  std::vector<uint8_t> is_kept;         // by block of the record after
  int64_t num_rays_shot = 0;
};

// Fills the blocks, those that are kept and those that are shot.
Filled fill(Tracer& tracer, const RecordMatch& match, const LiveRecord* before, LiveRecord& after, Job* job) {
  const auto bounds = tracer.plan().pieces(kRaysPerLiveBlock);
  after.blocks.resize(bounds.size());
  Filled filled{std::vector<uint8_t>(before ? before->blocks.size() : 0), std::vector<uint8_t>(bounds.size())};
  const QueryWatch watch(tracer.geometry());
  if (job) job->start(std::ssize(bounds));
  parallel_for(std::ssize(bounds), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    const auto [begin, end] = bounds[i];
    const int64_t known = match.kept(i, begin, end);
    filled.is_kept[i] = known >= 0;
    if (known >= 0) filled.is_kept_before[known] = 1;
    after.blocks[i] = known >= 0 ? match.renumbered(before->blocks[known]) : shot(tracer, begin, end);
  }, job);
  for (size_t i = 0; i < bounds.size(); ++i) filled.num_rays_shot += filled.is_kept[i] ? 0 : after.blocks[i]->num_rays;
  return filled;
}

std::vector<LiveBlockPtr> without(const std::vector<LiveBlockPtr>& blocks, const std::vector<uint8_t>& left_out) {
  std::vector<LiveBlockPtr> others;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (!left_out[i]) others.push_back(blocks[i]);
  }
  return others;
}

}  // namespace

LiveTrace::LiveTrace(Scenes scenes, std::function<Paths(Paths, Job*)> finish)
    : scenes_(scenes), finish_(std::move(finish)) {}
LiveTrace::Next LiveTrace::prepare(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& asked, Job* job) {
  TraceSettings settings = asked;
  settings.for_edits = true;
  Tracer tracer(scene, radar, settings, job, &kept_, &fitted_);
  const auto next = std::make_shared<LiveRecord>(tracer, settings);
  const RecordMatch match(record_.get(), *next);
  const Filled filled = fill(tracer, match, record_.get(), *next, job);
  next->without_rays = tracer.find_paths_without_rays(job);
  PlaneImages images = tracer.plane_images();
  LitPlanes lit = tracer.lit_planes();
  for (const LiveBlockPtr& block : next->blocks) {
    images.add_chains(block->paths);
    lit.add_chains(block->paths);
  }
  next->over_planes = images.find(job);
  next->edges_over_planes = tracer.find_edges(lit, job);
  next->doubles = images.doubles();
  Change change;
  change.num_rays = tracer.num_rays() + std::ssize(tracer.plan().surface_scatterers);
  change.num_rays_shot = filled.num_rays_shot;
  change.is_whole = !match.shares_rays() || !record_->doubles.is_same(next->doubles, match.common().meshes.id_after) ||
                    static_cast<double>(change.num_rays_shot) > kMostRaysOfDifference * static_cast<double>(change.num_rays);
  if (change.is_whole) {
    change.added = finished(next->paths_of(next->blocks, job), job);
    change.removed = next->empty;
  } else {
    change.removed = finished(record_->paths_of(without(record_->blocks, filled.is_kept_before), job), job);
    change.added = finished(next->paths_of(without(next->blocks, filled.is_kept), job), job);
    leave_out_common(change.removed, change.added, match.common(), job);
    for (Paths* paths : {&change.removed, &change.added}) {
      *paths = scenes_ == Scenes::kWhole ? paths->with_own_hits(job) : with_own_meshes(*paths, job);
    }
  }
  return {std::move(change), next};
}

LiveTrace::Change LiveTrace::accept(Next&& next) {
  record_ = std::move(next.record);
  return std::move(next.change);
}

Paths LiveTrace::paths(Job* job) const {
  require(record_ != nullptr, "live", "must have been updated before it has paths", 0);
  return finished(record_->paths_of(record_->blocks, job), job);
}

}  // namespace echopath
