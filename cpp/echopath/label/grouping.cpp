#include "echopath/label/grouping.h"

#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

Partition partition_by_batches(const Paths& paths) {
  Partition partition;
  const auto num_batches = static_cast<uint32_t>(paths.frame.batches);
  for (uint32_t batch = 0; batch < num_batches; ++batch) {
    for (const char* kind : {" coherent", " diffuse"}) partition.names.push_back("batch " + std::to_string(batch) + kind);
  }
  partition.names.emplace_back(kAllBatches);
  partition.group.reserve(paths.batch.size());
  for (size_t path = 0; path < paths.batch.size(); ++path) {
    const uint32_t batch = paths.batch[path], is_diffuse = paths.diffuse[path] != 0 ? 1 : 0;
    partition.group.push_back(batch == kNoBatch ? 2 * num_batches : 2 * batch + is_diffuse);
  }
  return partition;
}

Partition flattened(CombinedPartition combined) {
  Partition partition;
  for (uint32_t group = 0; group < combined.num_groups; ++group) {
    std::string name;
    for (size_t i = 0; i < combined.partitions.size(); ++i) {
      if (i > 0) name += kBetweenNames;
      name += combined.partitions[i].names[combined.part_in(group, i)];
    }
    partition.names.push_back(std::move(name));
  }
  partition.group = std::move(combined.group);
  return partition;
}

}  // namespace

Grouping by_selections(std::vector<NamedSelection> parts) {
  return [parts = std::move(parts)](const Paths& paths, Job* job) { return make_partition(paths, parts, job); };
}

Grouping by_batches() {
  return [](const Paths& paths, Job*) { return partition_by_batches(paths); };
}

Grouping by_all(std::vector<Grouping> groupings) {
  require(!groupings.empty(), "groupings", "must be one or more", "none");
  return [groupings = std::move(groupings)](const Paths& paths, Job* job) {
    std::vector<Partition> partitions;
    for (const Grouping& grouping : groupings) partitions.push_back(grouping(paths, job));
    return flattened(combine(std::move(partitions), job));
  };
}

}  // namespace echopath
