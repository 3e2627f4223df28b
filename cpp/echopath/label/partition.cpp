#include "echopath/label/partition.h"

#include <limits>
#include <set>

#include "echopath/base/errors.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/base/text/quoted.h"

namespace echopath {
namespace {

constexpr uint32_t kMaxGroups = 1 << 16;  // each one costs a whole cube in synthesis
constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

constexpr size_t kManyParts = 4;

ECHOPATH_INLINE void assign(const uint8_t* taken, uint32_t part, size_t count, uint8_t* __restrict left,
                            uint32_t* __restrict group) {
  for (size_t path = 0; path < count; ++path) {
    left[path] ^= taken[path];
    group[path] = taken[path] ? part : group[path];
  }
}

// Refines the combined groups by one more partition; new groups are numbered by (old group, part).
void refine(CombinedPartition& combined, const Partition& partition) {
  const size_t num_parts = partition.names.size();
  std::vector<uint32_t> new_group(combined.num_groups * num_parts, kUnused);
  for (size_t path = 0; path < combined.group.size(); ++path) {
    new_group[combined.group[path] * num_parts + partition.group[path]] = 0;
  }
  const size_t num_done = combined.num_groups == 0 ? 0 : combined.part_of_group.size() / combined.num_groups;
  std::vector<uint32_t> table;
  uint32_t num_groups = 0;
  for (size_t pair = 0; pair < new_group.size(); ++pair) {
    if (new_group[pair] == kUnused) continue;
    new_group[pair] = num_groups++;
    const auto row = combined.part_of_group.begin() + static_cast<int64_t>(pair / num_parts * num_done);
    table.insert(table.end(), row, row + static_cast<int64_t>(num_done));
    table.push_back(static_cast<uint32_t>(pair % num_parts));
  }
  require(num_groups <= kMaxGroups, "partitions", "must have at most 65536 combinations of parts", num_groups);
  for (size_t path = 0; path < combined.group.size(); ++path) {
    combined.group[path] = new_group[combined.group[path] * num_parts + partition.group[path]];
  }
  combined.part_of_group = std::move(table);
  combined.num_groups = num_groups;
}

}  // namespace

void check_part_names(const std::vector<NamedSelection>& parts) {
  std::set<std::string> names;
  for (const NamedSelection& part : parts) {
    require(!part.name.empty(), "parts", "must have non-empty names", "an empty one");
    require(part.name.find('\0') == std::string::npos, "parts", "must have names free of the sign NUL", quoted(part.name));
    require(part.name != "other", "parts", "must not use the name of the rest", "other");
    require(names.insert(part.name).second, "parts", "must have names that differ", part.name + " twice");
  }
}

Partition make_partition(const Paths& paths, const std::vector<NamedSelection>& parts, Job* job) {
  check_part_names(parts);
  Partition partition;
  for (const NamedSelection& part : parts) partition.names.push_back(part.name);
  partition.names.push_back("other");
  const auto other = static_cast<uint32_t>(parts.size());
  partition.group.assign(paths.num_paths(), other);
  PathTraits traits(paths, parts.size() >= kManyParts);
  std::vector<uint8_t> left(partition.group.size(), 1);  // 1 for paths that are in no part yet
  for (uint32_t part = 0; part < other; ++part) {
    std::vector<uint8_t> taken = left;
    parts[part].selection.narrow(traits, taken, job);
    run_simd<assign>(taken.data(), part, taken.size(), left.data(), partition.group.data());
  }
  return partition;
}

CombinedPartition combine(std::vector<Partition> partitions, Job* job) {
  require(!partitions.empty(), "partitions", "must be one or more", "none");
  const size_t num_paths = partitions.front().group.size();
  CombinedPartition combined;
  combined.group.assign(num_paths, 0);
  combined.num_groups = num_paths > 0 ? 1 : 0;
  for (const Partition& partition : partitions) {
    if (job) job->throw_if_cancelled();
    const std::string rule = "must be of the same paths, " + std::to_string(num_paths);
    require(partition.group.size() == num_paths, "partitions", rule, partition.group.size());
    refine(combined, partition);
  }
  combined.partitions = std::move(partitions);
  return combined;
}

}  // namespace echopath
