#include "echopath/trace/live/live_trace.h"

#include <algorithm>
#include <utility>

#include "echopath/base/threads/parallel.h"
#include "echopath/trace/live/live_record.h"
#include "echopath/trace/live/path_difference.h"

namespace echopath {
namespace {

// Share of the rays from which on it costs more to tell what differs, and to take it away and add it, than to begin anew.
constexpr double kMostRaysOfDifference = 0.4;

bool is_any_mirror(const Scene& scene, const ChangedMeshes& changed) {
  for (uint32_t id = 0; id < changed.size(); ++id) {
    if (changed[id] && scene.node_of(id).material->mirror) return true;
  }
  return false;
}

double surface_of(const FloatBox& box) {
  const Eigen::Vector3d sizes = box.sizes().cast<double>();
  return 2.0 * (sizes.x() * sizes.y() + sizes.y() * sizes.z() + sizes.z() * sizes.x());
}

// Adds the boxes of where a mesh was and is; where they lie together, one that holds both. A box is met by stretches about
// as often as its surface is large.
void add_boxes(const Eigen::AlignedBox3d& was, const Eigen::AlignedBox3d& is, std::vector<FloatBox>& boxes) {
  std::vector<FloatBox> own;
  for (const Eigen::AlignedBox3d* box : {&was, &is}) {
    if (!box->isEmpty()) own.push_back(box->cast<float>());
  }
  if (own.size() == 2) {
    const FloatBox both = own[0].merged(own[1]);
    if (surface_of(both) < surface_of(own[0]) + surface_of(own[1])) own = {both};
  }
  boxes.insert(boxes.end(), own.begin(), own.end());
}

// Returns where the changed meshes were and are.
std::vector<FloatBox> changed_boxes(const LiveRecord& before, const LiveRecord& after, const ChangedMeshes& changed) {
  std::vector<FloatBox> boxes;
  for (size_t id = 0; id < changed.size(); ++id) {
    if (changed[id]) add_boxes(before.boxes[id], after.boxes[id], boxes);
  }
  return boxes;
}

// Compares two records whose blocks are rays with the same indices.
class Comparison {
 public:
  // `before` may be null; then nothing is the same.
  Comparison(const LiveRecord* before, const LiveRecord& after) : before_(before), after_(after) {
    if (!before || !before->shared.is_same(after.shared) || !has_same_tree(*before->empty.scene, *after.empty.scene)) return;
    const bool time_moved = before->empty.frame.trace_time != after.empty.frame.trace_time;
    changed_ = changed_meshes(*before->empty.scene, *after.empty.scene, time_moved);
    shares_blocks_ = !is_any_mirror(*before->empty.scene, changed_) && !is_any_mirror(*after.empty.scene, changed_);
    if (shares_blocks_) boxes_ = changed_boxes(*before, after, changed_);
  }

  const ChangedMeshes& changed() const { return changed_; }
  bool shares_blocks() const { return shares_blocks_; }
  // Returns the block of the record before where its rays have the same paths now; else null.
  LiveBlockPtr kept(size_t index, int64_t begin, int64_t end) const {
    if (!shares_blocks_ || index >= before_->blocks.size()) return nullptr;
    const LiveBlockPtr& block = before_->blocks[index];
    const bool is_kept = block->begin == begin && block->end == end &&
                         after_.shared.launches_alike(before_->shared, begin, end) && !block->space.meets(boxes_);
    return is_kept ? block : nullptr;
  }

 private:
  const LiveRecord* before_;
  const LiveRecord& after_;
  bool shares_blocks_ = false;
  ChangedMeshes changed_;
  std::vector<FloatBox> boxes_;
};

// Returns the bounds of the blocks of all rays, and of those that are aimed at points of surfaces.
std::vector<std::pair<int64_t, int64_t>> block_bounds(const LaunchPlan& plan) {
  std::vector<std::pair<int64_t, int64_t>> bounds;
  const auto add = [&](int64_t begin, int64_t end) {
    for (; begin < end; begin += kRaysPerLiveBlock) bounds.emplace_back(begin, std::min(end, begin + kRaysPerLiveBlock));
  };
  add(0, plan.first_ray.back());
  add(plan.first_point, plan.first_point + std::ssize(plan.surface_scatterers));
  return bounds;
}

LiveBlockPtr shot(const Tracer& tracer, int64_t begin, int64_t end) {
  // The block of so few rays grows in memory that stays with the thread, and is copied when its sizes are known.
  thread_local LiveBlock scratch;
  scratch.begin = begin;
  scratch.end = end;
  scratch.space.clear();
  scratch.paths.clear();
  const QueryWatch::OfThread watching(scratch.space);
  tracer.shoot(begin, end, scratch.paths);
  return std::make_shared<const LiveBlock>(scratch);
}

// Fills the blocks, those that are kept and those that are shot; it returns the number of rays shot.
int64_t fill(Tracer& tracer, const Comparison& comparison, std::vector<LiveBlockPtr>& blocks, Job* job) {
  const auto bounds = block_bounds(tracer.plan());
  blocks.resize(bounds.size());
  std::vector<int64_t> rays(bounds.size(), 0);
  const QueryWatch watch(tracer.geometry());
  parallel_for(std::ssize(bounds), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    const auto [begin, end] = bounds[i];
    blocks[i] = comparison.kept(i, begin, end);
    if (blocks[i]) return;
    blocks[i] = shot(tracer, begin, end);
    rays[i] = end - begin;
  }, job);
  int64_t sum = 0;
  for (const int64_t one : rays) sum += one;
  return sum;
}

// Returns the blocks of `of` that are no blocks of `others`, which may have fewer.
std::vector<LiveBlockPtr> blocks_of_its_own(const LiveRecord& of, const LiveRecord& others) {
  std::vector<LiveBlockPtr> own;
  for (size_t i = 0; i < of.blocks.size(); ++i) {
    if (i >= others.blocks.size() || of.blocks[i] != others.blocks[i]) own.push_back(of.blocks[i]);
  }
  return own;
}

}  // namespace

LiveTrace::LiveTrace() = default;
LiveTrace::~LiveTrace() = default;

LiveTrace::Next LiveTrace::prepare(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job) {
  Tracer tracer(scene, radar, settings, job, &kept_, &fitted_);
  const auto next = std::make_shared<LiveRecord>(tracer, settings);
  const Comparison comparison(record_.get(), *next);
  Change change;
  if (job) job->start(std::ssize(block_bounds(tracer.plan())));
  change.num_rays_shot = fill(tracer, comparison, next->blocks, job);
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
  change.is_whole =
      !comparison.shares_blocks() || !(record_->doubles == next->doubles) ||
      static_cast<double>(change.num_rays_shot) > kMostRaysOfDifference * static_cast<double>(tracer.num_rays());
  if (change.is_whole) {
    change.added = next->paths_of(next->blocks, job);
    change.removed = next->empty;
  } else {
    change.removed = record_->paths_of(blocks_of_its_own(*record_, *next), job);
    change.added = next->paths_of(blocks_of_its_own(*next, *record_), job);
    leave_out_common(change.removed, change.added, comparison.changed(), job);
    change.removed = with_own_meshes(change.removed, job);
    change.added = with_own_meshes(change.added, job);
  }
  return {std::move(change), next};
}

LiveTrace::Change LiveTrace::accept(Next&& next) {
  record_ = std::move(next.record);
  return std::move(next.change);
}

Paths LiveTrace::paths(Job* job) const {
  require(record_ != nullptr, "live", "must have been updated before it has paths", 0);
  return record_->paths_of(record_->blocks, job);
}

}  // namespace echopath
