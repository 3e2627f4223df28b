#include "echopath/trace/live/path_difference.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "echopath/base/bit_sum.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/scene/scene_edges.h"

namespace echopath {
namespace {

constexpr int64_t kSumsTogether = 1 << 12;
constexpr uint64_t kUnlike = 0;  // of paths that are like no other

// Says how paths of one record are named in sums that hold for both: by the numbers of the record after.
struct CommonNames {
  const ChangedMeshes& changed;
  std::vector<uint32_t> mesh;  // by ID
  std::vector<int> stratum;    // by index; -1: it is like no other
};

CommonNames names_before(const CommonParts& common, size_t num_strata) {
  CommonNames names{common.meshes.of_before, common.meshes.id_after, std::vector<int>(num_strata, -1)};
  for (size_t k = 0; k < common.stratum_before.size(); ++k) {
    const int before = common.stratum_before[k];
    if (before >= 0) names.stratum[before] = static_cast<int>(k);
  }
  return names;
}

CommonNames names_after(const CommonParts& common) {
  CommonNames names{common.meshes.of_after, std::vector<uint32_t>(common.meshes.of_after.size()), {}};
  std::iota(names.mesh.begin(), names.mesh.end(), 0u);
  for (size_t k = 0; k < common.stratum_before.size(); ++k) {
    names.stratum.push_back(common.stratum_before[k] < 0 ? -1 : static_cast<int>(k));
  }
  return names;
}

class PathSums {
 public:
  PathSums(const Paths& paths, CommonNames names) : paths_(paths), names_(std::move(names)) {}

  std::vector<uint64_t> all(Job* job) const {
    std::vector<uint64_t> sums(paths_.num_paths());
    Job own(job);
    parallel_for_chunks(paths_.num_paths(), kSumsTogether, [&](int64_t begin, int64_t end) {
      for (int64_t path = begin; path < end; ++path) sums[path] = sum_of(path);
    }, &own);
    return sums;
  }

 private:
  uint64_t sum_of(size_t path) const {
    if (has_changed_edges_ && edge_hit(paths_.flags[path]) >= 0) return kUnlike;  // the wedge may be one with a changed mesh
    const uint16_t own = paths_.stratum[path];
    const int stratum = own == kNoStratum ? kNoStratum : names_.stratum[own];
    if (stratum < 0) return kUnlike;
    BitSum bits;
    const Hit* hits = paths_.hits_of(static_cast<int64_t>(path));
    for (int k = 0; k < paths_.num_bounces[path]; ++k) {
      if (names_.changed[hits[k].mesh_id]) return kUnlike;
      bits.add(named(hits[k]));
    }
    bits.add(paths_.diffuse[path]);
    bits.add(paths_.weight[path]);
    bits.add(uint64_t{paths_.flags[path]} << 32 | static_cast<uint64_t>(stratum) << 16 |
             uint64_t{paths_.num_bounces[path]} << 8 | paths_.batch[path]);
    if (!paths_.curved_cell.empty()) bits.add(paths_.curved_cell[path]);
    if (!paths_.jones.empty()) bits.add(paths_.jones[path]);
    for (const Pass& pass : paths_.passes_of(path)) {
      if (names_.changed[pass.hit.mesh_id]) return kUnlike;
      bits.add(named(pass.hit));
      bits.add(uint64_t{pass.leg});
    }
    return std::max(bits.value(), kUnlike + 1);
  }

  Hit named(const Hit& hit) const { return {names_.mesh[hit.mesh_id], hit.triangle_id, hit.u, hit.v}; }

  bool finds_changed_edges() const {
    for (uint32_t id = 0; paths_.frame.edges && id < paths_.scene->meshes().size(); ++id) {
      if (names_.changed[id] && has_echoing_edges(*paths_.scene, id)) return true;
    }
    return false;
  }

  const Paths& paths_;
  const CommonNames names_;
  const bool has_changed_edges_ = finds_changed_edges();
};

// Gives paths away by their sums; of equal ones the first comes first.
class PathsBySum {
 public:
  explicit PathsBySum(const std::vector<uint64_t>& sums)
      : sums_(sums), first_(std::bit_ceil(2 * sums.size() + 1), kNone), next_(sums.size(), kNone) {
    require(sums.size() < kNone, "live", "must change fewer than 2^32 - 1 paths at once", sums.size());
    for (auto i = static_cast<uint32_t>(sums.size()); i-- > 0;) {
      if (sums[i] == kUnlike) continue;
      uint32_t& first = first_[place_of(sums[i])];
      next_[i] = first;
      first = i;
    }
  }

  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  // Returns the index of a path with this sum that was not given away yet, else kNone.
  uint32_t take(uint64_t sum) {
    for (uint32_t* link = &first_[place_of(sum)]; *link != kNone; link = &next_[*link]) {
      if (sums_[*link] == sum) return std::exchange(*link, next_[*link]);
    }
    return kNone;
  }

 private:
  size_t place_of(uint64_t sum) const { return static_cast<size_t>(sum) & (first_.size() - 1); }

  const std::vector<uint64_t>& sums_;
  std::vector<uint32_t> first_;  // path of a chain, by the last bits of its sum
  std::vector<uint32_t> next_;   // in its chain, by path
};

}  // namespace

void leave_out_common(Paths& before, Paths& after, const CommonParts& common, Job* job) {
  const std::vector<uint64_t> old_sums = PathSums(before, names_before(common, before.frame.strata.size())).all(job),
                              new_sums = PathSums(after, names_after(common)).all(job);
  PathsBySum old_paths(old_sums);
  std::vector<uint8_t> keep_old(old_sums.size(), 1), keep_new(new_sums.size(), 1);
  for (size_t i = 0; i < new_sums.size(); ++i) {
    const uint32_t same_path = new_sums[i] == kUnlike ? PathsBySum::kNone : old_paths.take(new_sums[i]);
    if (same_path != PathsBySum::kNone) keep_old[same_path] = keep_new[i] = 0;
  }
  before = before.select(keep_old, job);
  after = after.select(keep_new, job);
}

Paths with_own_meshes(const Paths& paths, Job* job) {
  Paths out = paths.with_own_hits(job);
  std::vector<bool> is_met(paths.scene->meshes().size());
  for (const Hit& hit : *out.hits) is_met[hit.mesh_id] = true;
  for (const Pass& pass : out.passes) is_met[pass.hit.mesh_id] = true;
  for (uint32_t id = 0; paths.frame.edges && id < is_met.size(); ++id) {
    if (has_echoing_edges(*paths.scene, id)) is_met[id] = true;  // an edge may be one with those of its neighbours
  }
  std::vector<uint32_t> place(is_met.size());
  for (size_t id = 0, count = 0; id < is_met.size(); ++id) place[id] = static_cast<uint32_t>(is_met[id] ? count++ : count);
  auto hits = std::make_shared<std::vector<Hit>>(*out.hits);
  for (Hit& hit : *hits) hit.mesh_id = place[hit.mesh_id];
  for (Pass& pass : out.passes) pass.hit.mesh_id = place[pass.hit.mesh_id];
  out.hits = std::move(hits);
  auto scene = std::make_shared<Scene>(*paths.scene);
  scene->keep_meshes(is_met);
  out.scene = std::move(scene);
  return out;
}

}  // namespace echopath
