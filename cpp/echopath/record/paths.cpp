#include "echopath/record/paths.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/posed/posed_antenna.h"
#include "echopath/scene/scene_edges.h"

namespace echopath {
namespace {

constexpr size_t kHitsPerWord = 64;
constexpr float kBarycentricRounding = 1e-3f;  // by which u + v may exceed 1 at hits that are moved to an edge
constexpr float kBelowZero = 1e-6f;  // by which u or v may be below 0 at hits of rays on the border of two triangles

template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<uint8_t>& keep, size_t count, Job* job) {
  if (job) job->throw_if_cancelled();
  std::vector<T> out;
  out.reserve(count);
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) out.push_back(values[i]);
  }
  return out;
}

// Holds a set of hits and tells quickly how many of its members come before one.
class HitSet {
 public:
  explicit HitSet(size_t num_hits) : words_((num_hits + kHitsPerWord - 1) / kHitsPerWord), before_(words_.size()) {}
  void insert(size_t hit) { words_[hit / kHitsPerWord] |= uint64_t{1} << (hit % kHitsPerWord); }
  bool has(size_t hit) const { return (words_[hit / kHitsPerWord] >> (hit % kHitsPerWord)) & 1u; }
  // Prepares `rank`; returns the number of members.
  int64_t count() {
    int64_t sum = 0;
    for (size_t i = 0; i < words_.size(); ++i) {
      before_[i] = sum;
      sum += std::popcount(words_[i]);
    }
    return sum;
  }
  int64_t rank(size_t hit) const {
    const uint64_t lower = words_[hit / kHitsPerWord] & ((uint64_t{1} << (hit % kHitsPerWord)) - 1);
    return before_[hit / kHitsPerWord] + std::popcount(lower);
  }

 private:
  std::vector<uint64_t> words_;
  std::vector<int64_t> before_;
};

bool is_finite(std::complex<float> value) { return std::isfinite(value.real()) && std::isfinite(value.imag()); }

void validate_hit(const Hit& hit, const Scene& scene) {
  require(hit.mesh_id < scene.meshes().size(), "mesh_id", "must be a mesh of the scene", hit.mesh_id);
  const size_t num_triangles = scene.node_of(hit.mesh_id).mesh->triangles().size();
  require(hit.triangle_id < num_triangles, "triangle_id", "must be a triangle of its mesh", hit.triangle_id);
  require(std::min(hit.u, hit.v) >= -kBelowZero && hit.u + hit.v <= 1.0f + kBarycentricRounding, "u and v",
          "must not be negative, their sum at most 1", hit.u + hit.v);
}

void validate_edges(const Paths& paths, size_t path, const SceneEdges* edges) {
  const int at = edge_hit(paths.flags[path]), end = at + num_edge_hits(paths.flags[path]);
  if (at < 0) return;
  require(edges != nullptr, "flags", "must name no edges in a frame without edges, path", path);
  require(end <= paths.num_bounces[path] && paths.diffuse[path] == 0, "flags",
          "must name a hit of a coherent path as its edge, hit", at);
  const bool is_past = (paths.flags[path] & kPastEdge) != 0, is_reversed = paths.is_reversed(path);
  const bool has_mirror_behind = is_reversed ? at > 0 : end < paths.num_bounces[path];
  require(!is_past || (end == at + 1 && has_mirror_behind), "flags", "must name an edge before a mirror, path", path);
  require(paths.stratum[path] == kNoStratum, "stratum", "must be 65535 where a path has an edge", int{paths.stratum[path]});
  require(num_edge_pieces(paths.flags[path]) > 0, "flags", "must hold how many pieces an edge has", 0);
  for (int k = at; k < end; ++k) {
    const Hit& hit = paths.hits_of(static_cast<int64_t>(path))[k];
    validate_hit(hit, *paths.scene);
    require(sharp_edge_at(edges->of(hit.mesh_id), hit.triangle_id, double{hit.u}, double{hit.v}) != nullptr, "flags",
            "must name hits on sharp edges, path", path);
  }
}

void validate_passes(const Paths& paths) {
  const std::vector<int64_t>& offsets = paths.pass_offsets;
  const size_t size = paths.offsets.size();
  require(offsets.empty() || offsets.size() == size + 1, "pass_offsets", "must be empty or have one entry more than paths",
          offsets.size());
  const auto end = std::ssize(paths.passes);
  require((offsets.empty() ? 0 : offsets.back()) == end, "pass_offsets", "must end with the number of passes", end);
  require(offsets.empty() || (offsets.front() == 0 && std::ranges::is_sorted(offsets)), "pass_offsets",
          "must begin with 0 and ascend, entries", offsets.size());
  for (size_t path = 0; path < size; ++path) {
    uint32_t leg = 0;
    for (const Pass& pass : paths.passes_of(path)) {
      require(pass.leg >= leg && pass.leg <= paths.num_bounces[path], "passes", "must lie on legs in order of travel, leg",
              pass.leg);
      leg = pass.leg;
      validate_hit(pass.hit, *paths.scene);
      require(paths.scene->node_of(pass.hit.mesh_id).material->is_sheet(), "passes",
              "must lie on meshes whose materials have layers, mesh", pass.hit.mesh_id);
    }
  }
}

// Gives `out` the passes of the paths that are kept.
void select_passes(const Paths& paths, const std::vector<uint8_t>& keep, Paths& out) {
  if (paths.pass_offsets.empty()) return;
  out.pass_offsets.push_back(0);
  for (size_t path = 0; path < keep.size(); ++path) {
    if (!keep[path]) continue;
    const std::span<const Pass> own = paths.passes_of(path);
    out.passes.insert(out.passes.end(), own.begin(), own.end());
    out.pass_offsets.push_back(std::ssize(out.passes));
  }
  if (out.passes.empty()) out.pass_offsets.clear();
}

HitSet used_hits(const Paths& paths) {
  HitSet used(static_cast<size_t>(paths.num_hits()));
  for (size_t i = 0; i < paths.offsets.size(); ++i) {
    for (int k = 0; k < paths.num_bounces[i]; ++k) used.insert(static_cast<size_t>(paths.offsets[i] + k));
  }
  return used;
}

void validate_foci(const std::vector<Stratum>& strata) {
  for (const Stratum& stratum : strata) {
    const bool is_valid = stratum.focus_of == -1 || (stratum.focus_of >= 0 && stratum.focus_of < std::ssize(strata) &&
                                                     !strata[stratum.focus_of].is_focus());
    require(is_valid, "focus_of", "must be -1 or the index of a stratum that is no focus", stratum.focus_of);
  }
}

constexpr double kSizesOfShare = 1024.0, kPhasesOfShare = 4096.0;

}  // namespace

uint32_t beside_edge_flags(std::complex<double> share) {
  const auto size = static_cast<uint32_t>(std::clamp(std::round(kSizesOfShare * std::abs(share)), 1.0, 4095.0));
  const auto phase = static_cast<int>(std::round(kPhasesOfShare / kTwoPi * std::arg(share)));
  return kBesideEdge | size << 20 | (static_cast<uint32_t>(phase) & 4095u) << 8;
}

std::complex<double> share_of_endless(uint32_t flags) {
  if (!(flags & kBesideEdge)) return 1.0;
  return std::polar(std::max(flags >> 20, 1u) / kSizesOfShare, kTwoPi / kPhasesOfShare * (flags >> 8 & 4095u));
}

Vec3 Paths::mode_polarization() const {
  const Antenna& first = radar.transmitters.front();
  return in_world(first, first.polarization, radar.world_from_radar(frame.trace_time));
}

void Paths::validate() const {
  const size_t size = offsets.size();
  const std::pair<const char*, size_t> lengths[] = {{"num_bounces", num_bounces.size()},
                                                    {"diffuse", diffuse.size()},
                                                    {"weight", weight.size()},
                                                    {"stratum", stratum.size()},
                                                    {"batch", batch.size()},
                                                    {"flags", flags.size()},
                                                    {"curved_cell", curved_cell.empty() ? size : curved_cell.size()},
                                                    {"jones", jones.empty() ? size : jones.size()}};
  for (const auto& [name, length] : lengths)
    require(length == size, name, "must have one entry per path, as many as offsets: " + std::to_string(size), length);
  require(frame.batches >= 1 && frame.batches <= 64, "num_batches", "must lie in [1, 64]", frame.batches);
  require(size == 0 || !jones.empty() == (frame.polarization == PolarizationModel::kJones), "jones",
          "must be given for a frame that follows field vectors, and for no other, matrices", jones.size());
  validate_foci(frame.strata);
  std::optional<SceneEdges> edges;
  if (frame.edges) edges.emplace(*scene);
  for (size_t path = 0; path < size; ++path) {
    validate_path(path);
    validate_edges(*this, path, edges ? &*edges : nullptr);
  }
  for (const Hit& hit : *hits) validate_hit(hit, *scene);
  validate_passes(*this);
}

void Paths::validate_path(size_t path) const {
  const int count = num_bounces[path];
  require(count >= 1 && count <= 64, "num_bounces", "must lie in [1, 64]", count);
  require(offsets[path] >= 0 && offsets[path] <= num_hits() - count, "offsets", "must lead to hits", offsets[path]);
  require(count == 64 || diffuse[path] >> count == 0, "diffuse", "must have no bits beyond num_bounces", diffuse[path]);
  require(batch[path] == kNoBatch || batch[path] < frame.batches, "batch", "must be one of the frame's", int{batch[path]});
  require(stratum[path] == kNoStratum || stratum[path] < frame.strata.size(), "stratum", "must be one of the frame's",
          int{stratum[path]});
  require(is_finite(weight[path]), "weight", "must be finite", weight[path]);
  if (!curved_cell.empty()) {
    const bool are_finite = std::ranges::all_of(curved_cell[path], [](float x) { return std::isfinite(x); });
    require(are_finite, "curved_cell", "must be finite, path", path);
  }
  if (!jones.empty()) {
    require(std::ranges::all_of(jones[path], is_finite), "jones", "must be finite, path", path);
  }
}

void TraceStatistics::add(const TraceStatistics& of_part) {
  num_rays += of_part.num_rays;
  num_queries += of_part.num_queries;
  num_hits += of_part.num_hits;
  num_paths += of_part.num_paths;
  num_near_antenna += of_part.num_near_antenna;
  num_grazing += of_part.num_grazing;
  num_small_mirrors += of_part.num_small_mirrors;
  num_false_hits += of_part.num_false_hits;
  num_unaimed += of_part.num_unaimed;
  num_unfollowed_frusta += of_part.num_unfollowed_frusta;
  num_unsplit_rays += of_part.num_unsplit_rays;
  num_stopped_passes += of_part.num_stopped_passes;
  num_faint_paths += of_part.num_faint_paths;
}

Paths Paths::select(const std::vector<uint8_t>& keep, Job* job) const {
  require(std::ssize(keep) == num_paths(), "selection", "must have one entry per path", keep.size());
  const auto count = static_cast<size_t>(std::ranges::count_if(keep, [](uint8_t value) { return value != 0; }));
  const auto column = [&](const auto& values) { return kept(values, keep, count, job); };
  Paths out;
  out.hits = hits;
  for_each_column([&](auto each) { out.*each = column(this->*each); });
  if (!curved_cell.empty()) out.curved_cell = column(curved_cell);
  if (!jones.empty()) out.jones = column(jones);
  select_passes(*this, keep, out);
  out.scene = scene;
  out.radar = radar;
  out.frame = frame;
  return out;
}

Paths Paths::with_own_hits(Job* job) const {
  HitSet used = used_hits(*this);
  if (job) job->throw_if_cancelled();
  auto own = std::make_shared<std::vector<Hit>>();
  own->reserve(static_cast<size_t>(used.count()));
  for (size_t hit = 0; hit < static_cast<size_t>(num_hits()); ++hit) {
    if (used.has(hit)) own->push_back((*hits)[hit]);
  }
  if (job) job->throw_if_cancelled();
  Paths out = *this;
  out.hits = std::move(own);
  for (int64_t& offset : out.offsets) offset = used.rank(static_cast<size_t>(offset));
  return out;
}

}  // namespace echopath
