#include "echopath/sim/stream/keyframes.h"

#include <algorithm>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/power/faint_paths.h"
#include "echopath/trace/trace.h"
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

// Takes out the paths that a trace at another time could have had, too.
void take_out(const Radar& radar, double time, Paths& found, Job* job, KeptGeometry* kept) {
  if (found.num_paths() == 0) return;
  std::vector<uint8_t> keep = still_there(found, radar, time, job, kept);
  for (uint8_t& is_new : keep) is_new = !is_new;
  found = found.select(keep, job);
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
  KeptGeometry then, before;
  std::vector<double> times;
  for (ptrdiff_t look = 0; look < num_looks; ++look) {
    SurfaceSearchSettings settings;
    settings.time = stretches[(2 * look + 1) * num_stretches / (2 * num_looks)].middle;
    settings.num_rays = paths_.frame.statistics.num_rays;
    settings.seed = seed_of_search(paths_.frame.seed, static_cast<int>(look));
    const SurfaceSearch seen = trace_new_surface(paths_, radar, settings, job_, &then, &kept_);
    Paths found = thinned(seen.paths.select(seen.is_new, job_), job_);
    for (auto time = times.rbegin(); time != times.rend(); ++time) take_out(radar, *time, found, job_, &before);
    times.push_back(settings.time);
    if (found.num_paths() > 0) found_.push_back({found.with_own_hits(job_), seen.doubles.of_images_in(found)});
  }
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
    return {thinned(trace(paths_.scene, stretch.radar, settings, job_, &kept_), job_)};
  }
  std::vector<Paths> records = {renewed(paths_, stretch)};
  std::vector<PlaneDoubles> images;
  for (const auto& [paths, doubles] : found_) {
    Paths record = renewed(paths, stretch);
    if (record.num_paths() == 0) continue;
    images.push_back(doubles.of_images_in(record));
    records.push_back(std::move(record));
  }
  for (const PlaneDoubles& doubles : images) {
    for (Paths& record : records) doubles.leave_out(record, job_);
  }
  return records;
}

}  // namespace echopath
