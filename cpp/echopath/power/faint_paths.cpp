#include "echopath/power/faint_paths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <vector>

#include "echopath/base/bit_sum.h"
#include "echopath/base/random.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/power/path_power.h"
#include "echopath/power/shared_phase.h"

namespace echopath {
namespace {

constexpr int64_t kPathsDrawnTogether = 1 << 14;
// A path is kept at least once in 4^kMostLevels times: its amplitude, which may grow from what it is at the time of the
// trace, is multiplied by 8 at most.
constexpr int kMostLevels = 3;
// Points of surfaces persist from frame to frame but for the last bits of the hits there, which are micrometres: places are
// told apart by this length, m.
constexpr double kPlace = 1e-3;

bool look_alike(const Antenna& a, const Antenna& b) {
  return have_one_beam(a, b) && a.pattern.peak_gain == b.pattern.peak_gain && a.polarization == b.polarization;
}

// Returns the indices of antennas of which none looks like another, and like one of which each of the others looks. Antennas
// of one kind stand so close together that the power of a path is the same for all of them.
std::vector<size_t> kinds_of(const std::vector<Antenna>& antennas) {
  std::vector<size_t> kinds;
  for (size_t i = 0; i < antennas.size(); ++i) {
    const bool is_known = std::ranges::any_of(kinds, [&](size_t kind) { return look_alike(antennas[kind], antennas[i]); });
    if (!is_known) kinds.push_back(i);
  }
  return kinds;
}

std::vector<int64_t> diffuse_paths(const Paths& paths) {
  std::vector<int64_t> found;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    if (paths.diffuse[path] != 0) found.push_back(path);
  }
  return found;
}

// Returns the largest power in W of each of these paths over the kinds of antennas.
std::vector<double> largest_power(const Paths& paths, std::span<const int64_t> places, Job* job) {
  std::vector<double> power(places.size(), 0.0);
  for (const size_t tx : kinds_of(paths.radar.transmitters)) {
    for (const size_t rx : kinds_of(paths.radar.receivers)) {
      const std::vector<double> there = path_power(paths, places, one_channel(paths.radar, tx, rx), job);
      std::ranges::transform(there, power, power.begin(), std::ranges::max);
    }
  }
  return power;
}

// Returns n, where one such path in 4^n is kept.
int level_of(double power, double faint_power) {
  int level = 0;
  while (level < kMostLevels && power * static_cast<double>(4 << 2 * level) <= faint_power) ++level;
  return level;
}

// Draws which of the diffuse paths are kept. The paths of a run, which follow each other in the record, share a random
// phase, and so a number of the lot.
class Lot {
 public:
  // `power` [places] is that of these paths, W.
  Lot(Paths& paths, std::span<const int64_t> places, std::span<const double> power)
      : paths_(paths), places_(places), power_(power), keep_(paths.offsets.size(), 1) {
    for (const std::string& name : paths.scene->mesh_names()) {
      BitSum sum;
      sum.add_bytes(name.data(), name.size());
      mesh_keys_.push_back(sum.value());
    }
  }
  // Multiplies the weights of paths that count for others, and returns which paths are kept, [P].
  std::vector<uint8_t> draw() {
    parallel_for_chunks(std::ssize(places_), kPathsDrawnTogether,
                        [&](int64_t begin, int64_t end) { draw_runs_from(begin, end); });
    return std::move(keep_);
  }

 private:
  struct Entry {
    uint64_t meshes;
    double power;
    size_t path;
  };

  // Draws the runs that begin in [begin, end).
  void draw_runs_from(size_t begin, size_t end) {
    std::vector<Entry> entries;
    while (begin < end && !begins_run(begin)) ++begin;
    while (begin < end) {
      size_t next = begin + 1;
      while (next < places_.size() && !begins_run(next)) ++next;
      draw_run(begin, next, entries);
      begin = next;
    }
  }

  bool begins_run(size_t i) const { return i == 0 || !shares_phase(paths_, places_[i - 1], places_[i]); }

  void draw_run(size_t begin, size_t end, std::vector<Entry>& entries) {
    const double least =
        *std::min_element(power_.begin() + static_cast<ptrdiff_t>(begin), power_.begin() + static_cast<ptrdiff_t>(end));
    if (level_of(least, paths_.frame.faint_power) == 0) return;
    entries.clear();
    for (size_t i = begin; i < end; ++i) {
      const auto path = static_cast<size_t>(places_[i]);
      entries.push_back({meshes_of(path), power_[i], path});
    }
    std::ranges::sort(entries, {}, &Entry::meshes);
    const uint64_t hits = diffuse_hits_of(static_cast<size_t>(places_[begin]));
    const double number = uniform2(paths_.frame.seed, Stream::kFaintPath, hits, 0)[0];
    for (size_t i = 0, next = 0; i < entries.size(); i = next) {
      while (next < entries.size() && entries[next].meshes == entries[i].meshes) ++next;
      draw_together(std::span(entries).subspan(i, next - i), number);
    }
  }

  // Keeps or leaves out paths over the same meshes, as the strongest of them asks for.
  void draw_together(std::span<const Entry> entries, double number) {
    double strongest = 0.0;
    for (const Entry& entry : entries) strongest = std::max(strongest, entry.power);
    const int level = level_of(strongest, paths_.frame.faint_power);
    if (level == 0) return;
    for (const Entry& entry : entries) {
      keep_[entry.path] = number < 1.0 / static_cast<double>(1 << 2 * level);
      paths_.weight[entry.path] *= static_cast<float>(1 << level);
      paths_.flags[entry.path] |= kStandsForOthers;
    }
  }

  // Returns a number of the meshes of a path in their order, which is that of the path backward, too.
  uint64_t meshes_of(size_t path) const {
    const Hit* hits = paths_.hits_of(static_cast<int64_t>(path));
    const int count = paths_.num_bounces[path];
    BitSum forward, backward;
    for (int k = 0; k < count; ++k) {
      forward.add(mesh_keys_[hits[k].mesh_id]);
      backward.add(mesh_keys_[hits[count - 1 - k].mesh_id]);
    }
    return forward.value() + backward.value();
  }

  // Returns a number of the diffuse hits of a path, in whichever order it meets them. Meshes go by their names, since
  // objects that come and go change their IDs.
  uint64_t diffuse_hits_of(size_t path) const {
    const Hit* hits = paths_.hits_of(static_cast<int64_t>(path));
    uint64_t sum = 0;
    for (uint64_t left = paths_.diffuse[path]; left != 0; left &= left - 1) {
      const Hit& hit = hits[std::countr_zero(left)];
      BitSum of_hit;
      of_hit.add(mesh_keys_[hit.mesh_id]);
      of_hit.add(place_of(hit));
      of_hit.add(hit.triangle_id);
      sum += of_hit.value();
    }
    return sum;
  }

  // Returns where on its triangle a hit lies, along two of its edges, as they are in the mesh at rest.
  std::array<int64_t, 2> place_of(const Hit& hit) const {
    const Mesh& mesh = *paths_.scene->node_of(hit.mesh_id).mesh;
    const Triangle& corner = mesh.triangles()[hit.triangle_id];
    const Vec3& origin = mesh.vertices()[corner[0]];
    return {static_cast<int64_t>(hit.u * (mesh.vertices()[corner[1]] - origin).norm() / kPlace),
            static_cast<int64_t>(hit.v * (mesh.vertices()[corner[2]] - origin).norm() / kPlace)};
  }

  Paths& paths_;
  std::span<const int64_t> places_;
  std::span<const double> power_;
  std::vector<uint8_t> keep_;
  std::vector<uint64_t> mesh_keys_;  // [mesh ID]
};

}  // namespace

Paths thinned(Paths paths, Job* job) {
  if (paths.frame.faint_power == 0.0) return paths;
  const std::vector<int64_t> places = diffuse_paths(paths);
  if (places.empty()) return paths;
  const std::vector<double> power = largest_power(paths, places, job);
  const std::vector<uint8_t> keep = Lot(paths, places, power).draw();
  const auto num_left_out = std::ranges::count(keep, uint8_t{0});
  if (num_left_out == 0) return paths;
  Paths kept = paths.select(keep, job).with_own_hits(job);
  kept.frame.statistics.num_faint_paths += num_left_out;
  kept.frame.statistics.num_paths -= num_left_out;
  return kept;
}

}  // namespace echopath
