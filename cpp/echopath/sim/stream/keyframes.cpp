#include "echopath/sim/stream/keyframes.h"

#include <algorithm>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/power/faint_paths.h"
#include "echopath/sim/rays/thinned_trace.h"
#include "echopath/validity/renewal.h"
#include "echopath/validity/surface/new_surface.h"
#include "echopath/validity/validity.h"

namespace echopath {
namespace {

// Returns a seed that gives each look directions and random phases of its own.
uint64_t seed_of_search(uint64_t seed, int look) { return seed + 0x9e3779b97f4a7c15u * (static_cast<uint64_t>(look) + 1); }

// Has idle times that repeat from slot to slot begin with that of a slot.
void begin_with(int64_t slot, std::vector<double>& extra_idle) {
  if (extra_idle.empty()) return;
  std::rotate(extra_idle.begin(), extra_idle.begin() + slot % std::ssize(extra_idle), extra_idle.end());
}

bool is_whole(const Paths& paths) { return paths.num_paths() == paths.frame.statistics.num_paths; }

// Returns whether the record has images over planes that nobody flagged.
bool has_images_over_planes(const Paths& paths) {
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    if (!paths.is_over_images_alone(path)) continue;
    if (!paths.scene->node_of(paths.hits_of(static_cast<int64_t>(path))->mesh_id).material->mirror) return true;
  }
  return false;
}

}  // namespace

std::vector<Stretch> stretches_of(const Radar& radar, double start_time, int count) {
  const int num_chirps = radar.waveform.num_chirps;
  require(count >= 1 && count <= num_chirps, "keyframes", "must lie in [1, num_chirps]", count);
  std::vector<Stretch> stretches;
  for (int i = 0; i < count; ++i) {
    const auto bound = [&](int64_t k) { return static_cast<int>(k * num_chirps / count); };
    Stretch stretch;
    stretch.first_chirp = bound(i);
    const int64_t first_slot = int64_t{stretch.first_chirp} * radar.num_slots();
    stretch.start_time = start_time + radar.waveform.slot_start(first_slot);
    stretch.radar = radar;
    stretch.radar.waveform.num_chirps = bound(i + 1) - bound(i);
    begin_with(first_slot, stretch.radar.waveform.extra_idle);
    stretch.middle = stretch.radar.middle_of_frame(stretch.start_time);
    stretches.push_back(std::move(stretch));
  }
  return stretches;
}

int num_keyframes(const Paths& paths, const Radar& radar, const KeyframeSettings& settings, SpecularPoints specular,
                  Job* job) {
  require(settings.keyframes >= 0, "keyframes", "must not be negative", settings.keyframes);
  if (settings.keyframes > 0) return settings.keyframes;
  ValiditySettings asked;
  asked.specular = specular;
  const Validity found = validity(paths, radar, asked, job);
  return std::clamp(found.keyframes(), 1, radar.waveform.num_chirps);
}

StretchRecords::StretchRecords(const Paths& paths, const Radar& radar, const std::vector<Stretch>& stretches,
                               Retrace retrace, Job* job)
    : paths_(paths), retrace_(retrace), job_(job) {
  // A new trace knows nothing of a selection.
  require(retrace != Retrace::kAlways || is_whole(paths), "retrace",
          "'always' takes all paths of a trace, which decompose takes apart",
          "a selection of " + std::to_string(paths.num_paths()));
  const bool moves = radar.is_moving() || paths.scene->is_anything_moving();
  if (retrace == Retrace::kInvalid && is_whole(paths) && moves) find_new_surface(radar, stretches);
}

void StretchRecords::find_new_surface(const Radar& radar, const std::vector<Stretch>& stretches) {
  const auto num_stretches = std::ssize(stretches), num_looks = std::min<ptrdiff_t>(kMaxSurfaceSearches, num_stretches);
  KeptGeometry then;  // and as earlier looks had it
  const auto look_at = [&](double time, int look) {
    SurfaceSearchSettings settings;
    settings.time = time;
    settings.num_rays = paths_.frame.statistics.num_rays;
    settings.seed = seed_of_search(paths_.frame.seed, look);
    return trace_new_surface(paths_, radar, settings, job_, &then, &kept_);
  };
  if (has_images_over_planes(paths_)) own_doubles_ = look_at(paths_.frame.trace_time, -1).doubles.of_images_in(paths_);
  std::vector<Look> looks;
  for (ptrdiff_t look = 0; look < num_looks; ++look) {
    const double time = stretches[(2 * look + 1) * num_stretches / (2 * num_looks)].middle;
    SurfaceSearch seen = look_at(time, static_cast<int>(look));
    std::vector<uint8_t> keep = own_doubles_.doubles_in(seen.paths, job_);
    for (size_t path = 0; path < keep.size(); ++path) keep[path] |= seen.is_new[path];
    Paths found = thinned(seen.paths.select(keep, job_), job_);
    for (auto earlier = looks.rbegin(); earlier != looks.rend(); ++earlier) take_out(*earlier, radar, found, then);
    if (found.num_paths() > 0) found_.push_back(parted(found, seen.doubles));
    looks.push_back({time, std::move(seen.doubles)});
  }
}

StretchRecords::Found StretchRecords::parted(const Paths& found, const PlaneDoubles& doubles) const {
  std::vector<uint8_t> keep(found.num_paths());
  for (size_t path = 0; path < keep.size(); ++path) keep[path] = found.is_of_a_ray(path);
  Found parts{found.select(keep, job_).with_own_hits(job_), {}, doubles.of_images_in(found)};
  for (uint8_t& is_kept : keep) is_kept = !is_kept;
  parts.others = found.select(keep, job_).with_own_hits(job_);
  return parts;
}

// Takes out the paths that an earlier look could have had, too.
void StretchRecords::take_out(const Look& look, const Radar& radar, Paths& found, KeptGeometry& kept) const {
  if (found.num_paths() == 0) return;
  const std::vector<uint8_t> was_there = still_there(found, radar, look.time, job_, &kept);
  std::vector<uint8_t> keep = look.doubles.doubles_in(found, job_);
  for (size_t path = 0; path < keep.size(); ++path) keep[path] |= !was_there[path];
  found = found.select(keep, job_);
}

Paths StretchRecords::renewed(const Paths& paths, const Stretch& stretch) {
  Paths record = renew(paths, stretch.radar, stretch.middle, job_, &kept_).paths;
  record.frame.start_time = stretch.start_time;
  return record;
}

std::vector<Paths> StretchRecords::of(const Stretch& stretch) {
  if (retrace_ == Retrace::kAlways) {
    TraceSettings settings = settings_like(paths_.frame);
    settings.start_time = stretch.start_time;
    settings.guide = guide_like(paths_.frame.strata);
    return {thinned_trace(paths_.scene, stretch.radar, settings, job_, &kept_)};
  }
  // Images come first, because paths of rays for which they stand need no renewal.
  std::vector<Paths> records = {renewed(paths_, stretch)};
  std::vector<PlaneDoubles> images = {own_doubles_.of_images_in(records.front())};
  const auto add = [&](const Paths& paths) {
    if (paths.num_paths() == 0) return false;
    Paths record = renewed(paths, stretch);
    const bool is_there = record.num_paths() > 0;
    if (is_there) records.push_back(std::move(record));
    return is_there;
  };
  for (const Found& found : found_) {
    if (add(found.others)) images.push_back(found.doubles.of_images_in(records.back()));
  }
  const auto leave_out = [&](Paths& paths) {
    for (const PlaneDoubles& doubles : images) doubles.leave_out(paths, job_);
  };
  leave_out(records.front());
  const bool stand_for_rays = std::ranges::any_of(images, &PlaneDoubles::any);
  for (const Found& found : found_) {
    if (!stand_for_rays) {
      add(found.of_rays);
      continue;
    }
    Paths of_rays = found.of_rays;
    leave_out(of_rays);
    add(of_rays);
  }
  return records;
}

}  // namespace echopath
