#pragma once
// Sorts paths into named parts that always add up to the whole, and combines several such views in one synthesis.
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/label/expressions/selection.h"

namespace echopath {

struct NamedSelection {
  std::string name;
  Selection selection;
};

// Assigns every path to exactly one part.
struct Partition {
  std::vector<std::string> names;  // of the parts; the last one of make_partition is "other"
  std::vector<uint32_t> group;     // [P] index into names
};

// Raises invalid_argument when a name is empty, "other" or given twice.
void check_part_names(const std::vector<NamedSelection>& parts);

// The first selection that takes a path names its part; paths that none takes are "other". Raises as check_part_names, and
// invalid_argument when a glob takes no mesh; raises Cancelled when the job is cancelled.
Partition make_partition(const Paths& paths, const std::vector<NamedSelection>& parts, Job* job = nullptr);

// Combines several partitions of the same paths in one group index: one group per combination of parts that occurs.
struct CombinedPartition {
  std::vector<Partition> partitions;
  std::vector<uint32_t> group;  // [P]
  uint32_t num_groups = 0;
  std::vector<uint32_t> part_of_group;  // [num_groups, num_partitions] part in each partition, rows ascending

  uint32_t part_in(uint32_t combined_group, size_t partition) const {
    return part_of_group[combined_group * partitions.size() + partition];
  }
};

// Raises invalid_argument without partitions, when their path counts differ, or for more than 65536 combinations; raises
// Cancelled when the job is cancelled.
CombinedPartition combine(std::vector<Partition> partitions, Job* job = nullptr);

}  // namespace echopath
