#include "echopath/power/group_sums.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

#include "echopath/base/constants.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/power/interval/facet_phase.h"
#include "echopath/power/interval/mesh_views.h"
#include "echopath/power/interval/outlines.h"
#include "echopath/power/interval/row_differences.h"
#include "echopath/power/interval/triangle_points.h"
#include "echopath/power/shared_phase.h"
#include "echopath/record/near_antenna.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

// Returns the root of the gain that no antenna exceeds.
double largest_field(const std::vector<Antenna>& antennas) {
  double largest = 0.0;
  for (const Antenna& antenna : antennas) largest = std::max(largest, antenna.pattern.largest_field());
  return largest;
}

// Returns what an endless mirror sends back over a length in m, times that, sqrt(W) m.
double image_at_a_metre(const Radar& radar) {
  return std::sqrt(radar.transmit_power) * largest_field(radar.transmitters) * largest_field(radar.receivers) *
         kSpeedOfLight / (2.0 * kTwoPi * radar.waveform.start_frequency);
}

constexpr int64_t kBlock = 1 << 18;  // paths evaluated at a time: bounds the memory
constexpr int64_t kNoPath = -1;

// Holds the diffuse hit of a group whose paths are being added up (shared_phase.h).
struct OpenHit {
  int64_t path = kNoPath;
  size_t batch = 0;
  std::complex<double> field = 0.0;
  std::complex<double> lot_field = 0.0;  // of those paths that stand for others
};

constexpr uint64_t kMirrorsAlone = ~uint64_t{0};  // the kind of paths over flagged mirrors alone

// Returns the kind of a coherent path: the mesh that radiates and whether other surfaces come before it.
uint64_t kind_of(const Paths& paths, int64_t path) {
  const Hit* hits = paths.hits_of(path);
  if (!paths.is_of_a_ray(path)) return kMirrorsAlone;
  uint64_t radiating = 0, count = 0;
  for (int k = 0; k < paths.num_bounces[path]; ++k) {
    const uint32_t mesh = hits[paths.is_reversed(path) ? paths.num_bounces[path] - 1 - k : k].mesh_id;
    if (paths.scene->node_of(mesh).material->mirror) continue;
    radiating = mesh;
    ++count;
  }
  return count == 0 ? kMirrorsAlone : radiating << 1 | (count > 1);
}

bool has_bounced_before(uint64_t kind) { return kind != kMirrorsAlone && (kind & 1) != 0; }

uint32_t mesh_of(uint64_t kind) { return static_cast<uint32_t>(kind >> 1); }

// Returns whether the rims of the planes of its mesh bound what a kind sends back: it comes there over mirrors at most.
bool may_have_rims(uint64_t kind) { return kind != kMirrorsAlone && !has_bounced_before(kind); }

// Numbers the kinds that a group has so far. Paths that follow each other are mostly of one kind.
class KnownKinds {
 public:
  size_t index_of(uint64_t kind, std::vector<CoherentKind>& kinds) {
    if (!kinds.empty() && kind == last_) return last_index_;
    const auto [entry, is_new] = index_.try_emplace(kind, kinds.size());
    if (is_new) kinds.emplace_back().image_field = 0.0;  // so far
    last_ = kind;
    last_index_ = entry->second;
    return last_index_;
  }

  // Counts the ray of a path of the kind that was looked up last.
  void count_ray(const PlaneInView& met) {
    if (last_index_ >= views_.size()) views_.resize(last_index_ + 1);
    SeenPlanes& seen = views_[last_index_][met.view];
    if (met.solid_angle == 0.0) return;
    std::vector<double>& of_planes = seen[met.stratum];
    if (met.plane >= of_planes.size()) of_planes.resize(met.plane + 1);
    of_planes[met.plane] += met.solid_angle;
  }

  void set_shapes(FacetPhases& phases, MeshViews& views, double image_at_a_metre, std::vector<CoherentKind>& kinds) const {
    for (const auto& [kind, index] : index_) {
      if (kind == kMirrorsAlone) continue;
      kinds[index].facet_phase = phases.of(mesh_of(kind));
      if (index >= views_.size() || views_[index].empty()) continue;
      double sum = 0.0;
      for (const auto& [view, seen] : views_[index]) sum += views.at_most(view, seen);
      kinds[index].rims_at_most = image_at_a_metre * sum;
    }
  }

 private:
  std::vector<std::map<uint32_t, SeenPlanes>> views_;  // by index of the kind and of the view
  std::unordered_map<uint64_t, size_t> index_;
  uint64_t last_ = 0;
  size_t last_index_ = 0;
};

class Sums {
 public:
  Sums(const Paths& paths, size_t num_groups)
      : paths_(paths), open_(num_groups), rows_(num_groups), steady_rows_(num_groups), triangles_(num_groups),
        pieces_(*paths.scene), outlines_(num_groups), kinds_(num_groups), groups_(num_groups) {
    const auto num_entries = static_cast<size_t>(paths.frame.batches) + 1;
    for (GroupSums& group : groups_) {
      group.field.resize(num_entries);
      group.power.resize(num_entries);
    }
  }

  void add_diffuse(size_t group, int64_t path, std::complex<double> arriving) {
    OpenHit& open = open_[group];
    const size_t batch = batch_of(path);
    if (open.path == kNoPath || batch != open.batch || !shares_phase(paths_, path, open.path)) {
      close(group);
      open = {path, batch};
    }
    open.field += arriving;
    if (paths_.flags[path] & kStandsForOthers) open.lot_field += arriving;
  }

  // `arriving` holds one field for each of kCellViews, `stride` apart; `image_field` is that of an endless mirror, sqrt(W).
  void add_coherent(size_t group, int64_t path, uint64_t kind, const std::complex<double>* arriving, size_t stride,
                    double image_field, const PlaneInView& met) {
    GroupSums& sums = groups_[group];
    sums.field[batch_of(path)] += arriving[kAsLaunched * stride];
    CoherentKind& of_kind = sums.kinds[kinds_[group].index_of(kind, sums.kinds)];
    const bool has_cell = paths_.is_of_a_ray(static_cast<size_t>(path));  // others hold nothing between rays
    of_kind.has_cells = of_kind.has_cells || has_cell;
    of_kind.has_bounced = has_bounced_before(kind);
    if (met.view != PlaneInView::kNone) kinds_[group].count_ray(met);
    of_kind.image_field = std::max(of_kind.image_field, image_field);
    const size_t num_views = has_cell ? kNumCellViews : kPoints;
    for (size_t view = 0; view < num_views; ++view) {
      const std::complex<double> field = arriving[view * stride];
      of_kind.field[view] += field;
      of_kind.power[view] += std::norm(field);
    }
    if (has_cell) sums.largest_field += std::abs(arriving[kAsLaunched * stride]);
    const double edge = has_cell ? std::norm(arriving[kEdges * stride]) : 0.0;
    of_kind.edge_squares += edge * edge;
    const double power = std::norm(arriving[kAsLaunched * stride]), wide = std::norm(arriving[kHalfDensity * stride]);
    if (const uint32_t flags = paths_.flags[path]; flags & kBesideEdge)
      of_kind.endless_with_edges += power / std::norm(share_of_endless(flags));
    if (has_cell && power > 0.0) {  // no lattice can miss images
      const double kept = std::min(wide / power, 1.0), steady = power * (kept * kept) * (kept * kept);
      const int place = place_in_lattice(static_cast<size_t>(path));
      if (place > 0) steady_rows_[group][rows_index(static_cast<size_t>(path))].add(place, std::sqrt(steady));
      sums.steady_power += steady;
      sums.steady_squares += steady * steady;
    }
    ++sums.num_coherent_paths;
  }

  std::vector<GroupSums> finish(FacetPhases& phases, MeshViews& views, double image_at_a_metre) {
    for (size_t group = 0; group < groups_.size(); ++group) {
      close(group);
      kinds_[group].set_shapes(phases, views, image_at_a_metre, groups_[group].kinds);
      for (const RowDifferences& rows : rows_[group]) groups_[group].even_variance += rows.variance();
      for (const RowDifferences& rows : steady_rows_[group]) groups_[group].steady_variance += rows.variance_of_jumps();
      groups_[group].even_variance += triangles_[group].variance() + outlines_[group].variance();
    }
    return std::move(groups_);
  }

 private:
  size_t batch_of(int64_t path) const {
    return std::min<size_t>(paths_.batch[path], static_cast<size_t>(paths_.frame.batches));
  }

  int place_in_lattice(size_t path) const {
    return paths_.frame.sampler == Sampler::kLattice ? place_in_row(paths_.flags[path]) : 0;
  }

  // Packets of rays go on behind sheets one after the other.
  size_t rows_index(size_t path) const { return paths_.passes_of(path).empty() ? 0 : 1; }

  void close(size_t group) {
    OpenHit& open = open_[group];
    if (open.path == kNoPath) return;
    GroupSums& sums = groups_[group];
    const double power = std::norm(open.field);
    sums.power[open.batch] += power;
    // Behind a diffuse hit a ray goes where chance sends it. Elsewhere chance has a share in what stands for others alone,
    // beside paths that are there for certain: of the sum of both fields it leaves the square of their own power aside.
    const auto path = static_cast<size_t>(open.path);
    const bool is_drawn = paths_.frame.sampler == Sampler::kRandom || std::popcount(paths_.diffuse[path]) > 1;
    const double certain = is_drawn ? 0.0 : std::norm(open.field - open.lot_field);
    const double by_lot = is_drawn ? power : std::norm(open.lot_field);
    if (!is_drawn) add_even(group, path, certain);
    sums.drawn_squares += by_lot * by_lot + 2.0 * certain * by_lot;
    sums.strongest_hit = std::max(sums.strongest_hit, power);
    ++sums.num_diffuse_hits;
    open.path = kNoPath;
  }

  // Adds what even directions, or even points of surfaces, are there for certain to have found.
  void add_even(size_t group, size_t path, double power) {
    GroupSums& sums = groups_[group];
    sums.lattice_squares += power * power;
    const Hit& hit = paths_.hits_of(static_cast<int64_t>(path))[std::countr_zero(paths_.diffuse[path])];
    const int place = place_in_lattice(path);
    if (place > 0) {
      rows_[group][rows_index(path)].add(place, power);
    } else if (paths_.frame.scatterers == Scatterers::kSurface) {
      triangles_[group].add(hit, power);
    } else {
      outlines_[group].add(hit.mesh_id, pieces_.of(hit.mesh_id, hit.triangle_id), power);
    }
  }

  const Paths& paths_;
  std::vector<OpenHit> open_;
  std::vector<std::array<RowDifferences, 2>> rows_, steady_rows_;  // by group, of hits before and behind a sheet
  std::vector<TrianglePoints> triangles_;                          // by group
  MeshPieces pieces_;
  std::vector<Outlines> outlines_;  // by group, as the next two
  std::vector<KnownKinds> kinds_;
  std::vector<GroupSums> groups_;
};

// Evaluates the paths of a block and what they send back.
class Block {
 public:
  // `views` gets those of the coherent paths, and must outlive it.
  Block(const Paths& paths, const Radar& radar, MeshViews& views)
      : paths_(paths), views_(views), replayer_(paths, radar),
        turns_per_metre_(radar.waveform.start_frequency / kSpeedOfLight), image_at_a_metre_(image_at_a_metre(radar)) {}

  void evaluate(int64_t begin, int64_t end, PowerAndLength* of_paths) {
    diffuse_.clear();
    coherent_.clear();
    kinds_.clear();
    met_.clear();
    for (int64_t path = begin; path < end; ++path) {
      (paths_.diffuse[path] == 0 ? coherent_ : diffuse_).push_back(path);
    }
    for (const int64_t path : coherent_) {
      const uint64_t kind = kind_of(paths_, path);
      kinds_.push_back(kind);
      met_.push_back(may_have_rims(kind) ? views_.of(path, mesh_of(kind)) : PlaneInView{});
    }
    replayer_.evaluate(diffuse_, paths_.frame.trace_time, lengths_, diffuse_fields_);
    if (of_paths) note(diffuse_, diffuse_fields_, *of_paths);
    arrive(diffuse_.size(), 1, diffuse_fields_);
    replayer_.evaluate(coherent_, paths_.frame.trace_time, kCellViews, lengths_, coherent_fields_);
    if (of_paths) note(coherent_, coherent_fields_, *of_paths);
    arrive(coherent_.size(), kNumCellViews, coherent_fields_);
    std::swap(coherent_lengths_, lengths_);
  }

  void add_to(Sums& sums, std::span<const uint32_t> group_of_path) const {
    for (size_t i = 0; i < diffuse_.size(); ++i) {
      sums.add_diffuse(group_of_path[diffuse_[i]], diffuse_[i], diffuse_fields_[i]);
    }
    for (size_t i = 0; i < coherent_.size(); ++i) {
      const uint32_t group = group_of_path[coherent_[i]];
      sums.add_coherent(group, coherent_[i], kinds_[i], coherent_fields_.data() + i, coherent_.size(),
                        image_at_a_metre_ / std::max(coherent_lengths_[i], kNearAntenna), met_[i]);
    }
  }

 private:
  // The first of the amplitudes [copy, path] are those of the cells as launched.
  void note(std::span<const int64_t> paths, const std::vector<std::complex<double>>& amplitudes, PowerAndLength& out) const {
    static_assert(kAsLaunched == 0);
    for (size_t i = 0; i < paths.size(); ++i) {
      out.power[paths[i]] = std::norm(amplitudes[i]);
      out.length[paths[i]] = lengths_[i];
    }
  }

  // Turns amplitudes [copy, path] by the phases of the lengths.
  void arrive(size_t num_paths, size_t num_copies, std::vector<std::complex<double>>& fields) const {
    constexpr int64_t kTogether = 8192;
    parallel_for_chunks(static_cast<int64_t>(num_paths), kTogether, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i) {
        const Phasor phase = phasor_of_product(turns_per_metre_, lengths_[i]);
        const std::complex<double> turn(phase.re, -phase.im);
        for (size_t copy = 0; copy < num_copies; ++copy) fields[copy * num_paths + i] *= turn;
      }
    });
  }

  const Paths& paths_;
  MeshViews& views_;
  const Replayer replayer_;
  const double turns_per_metre_;
  const double image_at_a_metre_;
  std::vector<int64_t> diffuse_, coherent_;
  std::vector<uint64_t> kinds_;   // of the coherent ones
  std::vector<PlaneInView> met_;  // likewise
  std::vector<double> lengths_, coherent_lengths_;
  std::vector<std::complex<double>> diffuse_fields_, coherent_fields_;
};

}  // namespace

std::vector<std::vector<GroupSums>> sum_groups(const Paths& paths, const Radar& radar, std::span<const Sorting> sortings,
                                               Job* job, PowerAndLength* of_paths) {
  if (of_paths) {
    const auto num_paths = static_cast<size_t>(paths.num_paths());
    *of_paths = {std::vector<double>(num_paths), std::vector<double>(num_paths)};
  }
  std::vector<Sums> sums;
  for (const Sorting& sorting : sortings) sums.emplace_back(paths, sorting.num_groups);
  if (job) job->start(paths.num_paths());
  MeshViews views(paths, radar);
  std::optional<Block> block;
  if (paths.num_paths() > 0) block.emplace(paths, radar, views);
  for (int64_t begin = 0; begin < paths.num_paths(); begin += kBlock) {
    if (job) job->throw_if_cancelled();
    const int64_t end = std::min(begin + kBlock, paths.num_paths());
    block->evaluate(begin, end, of_paths);
    parallel_for(std::ssize(sums), [&](int64_t i) { block->add_to(sums[i], sortings[i].group_of_path); });
    if (job) job->advance(end - begin);
  }
  FacetPhases phases(*paths.scene, kTwoPi * radar.waveform.start_frequency / kSpeedOfLight, paths.frame.trace_time);
  std::vector<std::vector<GroupSums>> found;
  for (Sums& of_sorting : sums) found.push_back(of_sorting.finish(phases, views, image_at_a_metre(radar)));
  return found;
}

}  // namespace echopath
