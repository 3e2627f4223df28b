#include "echopath/validity/surface/seen_powers.h"

#include <algorithm>
#include <complex>
#include <numeric>
#include <utility>

#include "echopath/replay/replay.h"

namespace echopath {
namespace {

// Rays of the search over all times and antennas: some for each ray of the record, than which it need not know surface
// much better.
constexpr int64_t kSearchRaysPerRay = 2;
constexpr int64_t kLeastSearchRays = 1 << 14, kMostSearchRays = 1 << 17;
constexpr int64_t kLeastRaysOfLook = 1 << 12;
constexpr uint64_t kSearchSeed = 0x6c6f6f6b;  // combined with the trace's seed, so that the lattice differs from the trace's

// Holds what one look sees of an object: everything, and new surface.
struct SeenNow {
  BandSum seen, fresh;
};

// Returns the object of the last hit that is no image, as the path was traced, and whether its echo adds up as a field.
std::pair<size_t, bool> end_of(const Paths& paths, size_t path) {
  const Hit* hits = paths.hits_of(static_cast<int64_t>(path));
  const int count = paths.num_bounces[path];
  const bool is_reversed = paths.is_reversed(path);
  int last = edge_hit(paths.flags[path]);
  if (last >= 0 && !is_reversed) last += num_edge_hits(paths.flags[path]) - 1;
  for (int k = 0; k < count && last < 0; ++k) {
    const int hit = is_reversed ? k : count - 1 - k;
    const bool is_image = (!paths.is_of_a_ray(path) || paths.scene->node_of(hits[hit].mesh_id).material->mirror) &&
                          !(paths.diffuse[path] >> hit & 1);
    if (!is_image) last = hit;
  }
  const Hit& end = hits[last >= 0 ? last : is_reversed ? count - 1 : 0];
  return {static_cast<size_t>(paths.scene->meshes()[end.mesh_id].object), last >= 0 && paths.diffuse[path] == 0};
}

// Sums up what a look finds by object, for the first channel of `radar`.
std::map<size_t, SeenNow> seen_by(const SurfaceSearch& found, Radar radar, const BandSum::Band& band, Job* job) {
  radar.waveform.num_chirps = radar.waveform.num_samples = 1;
  std::vector<int64_t> all(found.paths.num_paths());
  std::iota(all.begin(), all.end(), 0);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  Replayer(found.paths, radar).evaluate(all, found.paths.frame.trace_time, lengths, amplitudes, job);
  std::map<size_t, SeenNow> seen;
  for (size_t i = 0; i < all.size(); ++i) {
    const auto [object, is_field] = end_of(found.paths, i);
    const Echo echo{amplitudes[i], lengths[i], false};
    seen[object].seen.add(echo, is_field, 1.0, band);
    if (found.is_new[i]) seen[object].fresh.add(echo, is_field, 1.0, band);
  }
  return seen;
}

}  // namespace

std::map<size_t, SeenPower> find_seen_powers(const Paths& paths, const Radar& radar, FrameCheck& check,
                                             ObjectsAtTimes& at_times, Job* job) {
  std::map<size_t, SeenPower> objects;
  if (!check.anything_moves() && !check.has_array()) return objects;
  const std::vector<double>& times = check.times().times;
  const auto num_base = static_cast<size_t>(check.times().num_base);
  const size_t num_pairs = check.num_antenna_pairs();
  SurfaceSearchSettings look;
  const int64_t num_looks = std::max<int64_t>(1, static_cast<int64_t>(num_pairs * times.size()));
  const int64_t num_wanted = kSearchRaysPerRay * settings_like(paths.frame).num_rays;
  look.num_rays = std::max(kLeastRaysOfLook, std::clamp(num_wanted, kLeastSearchRays, kMostSearchRays) / num_looks);
  look.seed = paths.frame.seed ^ kSearchSeed;
  const BandSum::Band band(radar.waveform);
  std::vector<std::unique_ptr<EmbreeScene>> left_over = check.take_geometries();
  KeptGeometry then(std::move(left_over.front())), now(left_over.size() > 1 ? std::move(left_over[1]) : nullptr);
  for (size_t time = 0; time < times.size(); ++time) {
    look.time = times[time];
    for (look.antenna = 0; look.antenna < num_pairs; ++look.antenna) {
      const SurfaceSearch found = trace_new_surface(paths, radar, look, job, &then, &now);
      const bool is_own = look.antenna == 0;  // what antennas at the rim see counts for shares alone
      for (const auto& [object, seen] : seen_by(found, is_own ? check.first_radar() : found.paths.radar, band, job)) {
        SeenPower& sums = objects[object];
        const double power = seen.seen.power();
        sums.seen += power;
        sums.fresh += seen.fresh.power();
        if (is_own) sums.largest = std::max(sums.largest, power);
        if (!is_own || time >= num_base) continue;
        at_times[object].resize(num_base);
        at_times[object][time].fresh.add(seen.fresh);
      }
    }
  }
  return objects;
}

}  // namespace echopath
