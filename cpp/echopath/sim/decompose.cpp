#include "echopath/sim/decompose.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

using Views = std::vector<std::vector<PartCube>>;

// Up to so many combinations of parts are worth their memory, since each path is then synthesised once for several views.
constexpr size_t kFewGroups = 64;
constexpr size_t kMostGroups = 1 << 16;
// So many cubes of combinations are made at once, before they are added to their parts.
constexpr size_t kGroupsAtOnce = 32, kCubesAtOnce = size_t{64} << 20;  // and bytes of them, if more than one

// Holds views that are filled together.
struct ViewSet {
  std::vector<size_t> views;   // their indices
  CombinedPartition combined;  // in that order

  PathGroups groups() const { return {&combined.group, std::max(1, static_cast<int>(combined.num_groups))}; }
};

// Returns the set with one more view, unless that makes many combinations.
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
    // Only the combination is needed now.
    for (Partition& partition : set.combined.partitions) partition.group = std::vector<uint32_t>();
  }
  return sets;
}

void add_group(Cube cube, uint32_t group, const ViewSet& set, Views& out) {
  for (size_t i = 0; i < set.views.size(); ++i) {
    Cube& part = out[set.views[i]][set.combined.part_in(group, i)].cube;
    if (!part.values.empty()) part.add(cube);  // NOLINT(bugprone-use-after-move): moved from in the last round alone
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
    parallel_for(std::ssize(cubes),
                 [&](int64_t i) { cubes[i] = pass.cube(way, static_cast<int>(first) + static_cast<int>(i), job); });
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

// Returns the part of that name; one that no earlier record has is put before the last.
PartCube& part_named(const std::string& name, std::vector<PartCube>& parts, const Radar& radar) {
  const auto found = std::ranges::find_if(parts, [&](const PartCube& part) { return part.name == name; });
  if (found != parts.end()) return *found;
  return *parts.insert(parts.empty() ? parts.end() : parts.end() - 1, {name, Cube::zeros(radar)});
}

// Adds a record to the parts of a frame. The first one sets their order.
void add_parts(const Views& record, const Radar& radar, int first_chirp, Views& frame) {
  for (size_t view = 0; view < frame.size(); ++view) {
    std::vector<PartCube>& parts = frame[view];
    const bool is_first = parts.empty();
    for (const PartCube& part : record[view]) {
      if (is_first) parts.push_back({part.name, Cube::zeros(radar)});
      part_named(part.name, parts, radar).cube.add_chirps(part.cube, first_chirp);
    }
  }
}

}  // namespace

Views decompose(const Paths& paths, const Radar& radar, const std::vector<Grouping>& views, const CubeSettings& settings,
                Job* job) {
  if (settings.keyframes.retrace == Retrace::kNever) return decompose_record(paths, radar, views, settings, job);
  Views frame(views.size());
  const auto add = [&](const Paths& record, const Radar& of, const CubeSettings& alone, int first_chirp) {
    add_parts(decompose_record(record, of, views, alone, job), radar, first_chirp, frame);
  };
  for_each_record(paths, radar, settings, job, add);
  return frame;
}

}  // namespace echopath
