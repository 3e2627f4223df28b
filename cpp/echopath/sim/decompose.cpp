#include "echopath/sim/decompose.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "echopath/base/parallel.h"

namespace echopath {
namespace {

using Views = std::vector<std::vector<PartCube>>;

// Combinations of parts that are worth their memory, since each path is then synthesised once for several views.
constexpr size_t kFewGroups = 64;
constexpr size_t kMostGroups = 1 << 16;
// Cubes of combinations that are made at once, before they are added to their parts.
constexpr size_t kGroupsAtOnce = 32, kCubesAtOnce = size_t{64} << 20;  // and bytes of them, if more than one

// Views that are filled together.
struct ViewSet {
  std::vector<size_t> views;   // their indices
  CombinedPartition combined;  // in that order

  PathGroups groups() const { return {&combined.group, std::max(1, static_cast<int>(combined.num_groups))}; }
};

// With one more view, unless that makes many combinations.
std::optional<CombinedPartition> joined(const CombinedPartition& set, const Partition& view, Job* job) {
  const size_t most = std::max(kFewGroups, set.num_groups + view.names.size());
  if (set.num_groups * view.names.size() > kMostGroups) return std::nullopt;
  std::vector<Partition> partitions = set.partitions;
  partitions.push_back(view);
  CombinedPartition combined = combine(std::move(partitions), job);
  if (combined.num_groups > most) return std::nullopt;
  return combined;
}

void place(size_t view, Partition partition, std::vector<ViewSet>& sets, Job* job) {
  for (ViewSet& set : sets) {
    std::optional<CombinedPartition> combined = joined(set.combined, partition, job);
    if (!combined) continue;
    set.combined = std::move(*combined);
    set.views.push_back(view);
    return;
  }
  ViewSet& set = sets.emplace_back();
  set.views = {view};
  std::vector<Partition> alone;
  alone.push_back(std::move(partition));
  set.combined = combine(std::move(alone), job);
}

std::vector<ViewSet> sort_paths(const Paths& paths, const std::vector<Grouping>& views, Job* job) {
  std::vector<ViewSet> sets;
  for (size_t view = 0; view < views.size(); ++view) place(view, views[view](paths, job), sets, job);
  for (ViewSet& set : sets) {
    for (Partition& partition : set.combined.partitions) partition.group = {};  // only the combination is needed now
  }
  return sets;
}

void add_group(Cube cube, uint32_t group, const ViewSet& set, Views& out) {
  for (size_t i = 0; i < set.views.size(); ++i) {
    Cube& part = out[set.views[i]][set.combined.part_in(group, i)].cube;
    if (!part.values.empty()) part.add(cube);
    else if (i + 1 == set.views.size()) part = std::move(cube);
    else part = cube;
  }
}

// Adds up the groups of a set, in ascending order, to the parts of its views.
void sum_groups(const CubePass& pass, size_t way, const ViewSet& set, Views& out, Job* job) {
  const uint32_t num_groups = set.combined.num_groups;
  const auto at_once = static_cast<uint32_t>(std::clamp<size_t>(kCubesAtOnce / pass.cube_bytes(), 1, kGroupsAtOnce));
  for (uint32_t first = 0; first < num_groups; first += at_once) {
    std::vector<Cube> cubes(std::min(at_once, num_groups - first));
    parallel_for(static_cast<int64_t>(cubes.size()), [&](int64_t i) {
      cubes[static_cast<size_t>(i)] = pass.cube(way, static_cast<int>(first) + static_cast<int>(i), job);
    });
    for (uint32_t i = 0; i < cubes.size(); ++i) add_group(std::move(cubes[i]), first + i, set, out);
  }
}

Views decompose_record(const Paths& paths, const Radar& radar, const std::vector<Grouping>& views,
                       const CubeSettings& settings, Job* job) {
  const std::vector<ViewSet> sets = sort_paths(paths, views, job);
  std::vector<PathGroups> ways;
  Views out(views.size());
  for (const ViewSet& set : sets) {
    ways.push_back(set.groups());
    for (size_t i = 0; i < set.views.size(); ++i) {
      for (const std::string& name : set.combined.partitions[i].names) out[set.views[i]].push_back({name, {}});
    }
  }
  const CubePass pass(paths, radar, ways, settings, job);
  for (size_t way = 0; way < sets.size(); ++way) sum_groups(pass, way, sets[way], out, job);
  for (std::vector<PartCube>& parts : out) {
    for (PartCube& part : parts) {
      if (part.cube.values.empty()) part.cube = Cube::zeros(radar);
    }
  }
  return out;
}

// The part of that name; one that no earlier stretch has is put before the last.
PartCube& part_named(const std::string& name, std::vector<PartCube>& parts, const Radar& radar) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const PartCube& part) { return part.name == name; });
  if (found != parts.end()) return *found;
  return *parts.insert(parts.empty() ? parts.end() : parts.end() - 1, {name, Cube::zeros(radar)});
}

// Parts of another record of the same stretch, to those of the same names.
void add_parts(const Views& more, const Radar& radar, Views& sum) {
  for (size_t view = 0; view < sum.size(); ++view) {
    for (const PartCube& part : more[view]) part_named(part.name, sum[view], radar).cube.add(part.cube);
  }
}

}  // namespace

Views decompose(const Paths& paths, const Radar& radar, const std::vector<Grouping>& views, const CubeSettings& settings,
                Job* job) {
  const Retrace retrace = settings.keyframes.retrace;
  if (retrace == Retrace::kNever) return decompose_record(paths, radar, views, settings, job);
  Views frame(views.size());
  const std::vector<Stretch> stretches = stretches_for(paths, radar, settings, job);
  StretchRecords records(paths, radar, stretches, retrace, job);
  for (const Stretch& stretch : stretches) {
    StretchProbe probe(settings.probe, stretch);
    Views parts;
    for (const Paths& record : records.of(stretch)) {
      Views more = decompose_record(record, stretch.radar, views, within_stretch(settings, probe.next()), job);
      if (parts.empty()) parts = std::move(more);
      else add_parts(more, stretch.radar, parts);
    }
    const bool is_first = stretch.first_chirp == 0;
    for (size_t view = 0; view < views.size(); ++view) {
      for (const PartCube& part : parts[view]) {
        if (is_first) frame[view].push_back({part.name, Cube::zeros(radar)});
        part_named(part.name, frame[view], radar).cube.insert_chirps(part.cube, stretch.first_chirp);
      }
    }
  }
  return frame;
}

}  // namespace echopath
